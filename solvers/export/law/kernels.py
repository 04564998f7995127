"""The kernels of an exported law: which structures they are of, and their texts."""

import re
from dataclasses import dataclass, replace
from functools import cached_property

from ...engines.settings import KERNEL_STEPS, KERNEL_STEPS_IN_SPACE
from ...engines.taylor.call import variant
from ...engines.taylor.headers import headers
from ...engines.taylor.source import Variant, files
from ...errors import CheckFailed, InputError
from ...model.key import ModelKey
from ...model.model import load
from ...scene.scene import Scene
from ...space.collide_pair import check_scene
from .amalgam import Source

HEAD_ON, PLANE, SPACE = "head_on", "plane", "space"
BOOKED = "booked_"
"""Prefix of kernels with the energy ledger, before that of their geometry."""
IMPACT = {"speed": "speed", "angle": "angle", "impact_spin": "spin", "impact_partner_spin": "partner_spin"}
"""Quantities of an impact, and their names in it."""
_MAPPED = 1e-6  # relative tolerance of maps
_COMPONENTS = ("_x", "_y", "_z")
_SHOWN = {
    "restitution": "c->restitution = {};",
    "tangential_restitution": "c->tangential_restitution = {};",
    "final_rotation_rate": "c->final_rotation_rate = {}*rate;",
    "final_spin": "c->final_spin = {}*rate;",
    "final_spin_partner": "c->final_partner_spin = {}*rate;",
}
"""C line that stores each output of a structure; {} is its value."""


@dataclass(frozen=True)
class Kernel:
    """A kernel of the law: its prefix, and its variant of the model."""

    prefix: str
    variant: Variant
    scene: Scene

    @property
    def choice(self) -> ModelKey:
        return self.variant.choice

    @property
    def _headers(self) -> tuple[str, ...]:
        emitted = headers(self.choice)
        if emitted is None:
            accepted = "a model that has one: laws with recurrences (docs/reference/models.md)"
            raise InputError("--to", "c", accepted, "cannot be written for this model, which has no Taylor kernel")
        return emitted

    @cached_property
    def generated_files(self) -> dict[str, str]:
        """Texts of the generated files that its source includes, by name; InputError without a Taylor kernel."""
        texts = files(self.variant, self._headers)
        # the C compiler decides on the lanes (`texts._LANES`), not this machine
        texts["settings.h"] = re.sub(r"^#define LANES .*\n", "", texts["settings.h"], flags=re.MULTILINE)
        return texts | {"in_si.h": self._header_in_si()}

    @property
    def material(self) -> tuple[str, ...]:
        """Names of those of its quantities that are the material's."""
        return tuple(name for name in self.quantities if name not in IMPACT and not name.endswith(_COMPONENTS))

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names of the quantities in SI that it takes, in order."""
        names = re.search(r"const char quantity_names\[\] =(.*?);", "\n".join(self._headers), re.DOTALL)
        if names is None:
            raise CheckFailed("a kernel without quantities")
        return tuple(re.findall(r'"(\w+) ?"', names[1]))

    def source(self, roots: tuple[str, ...]) -> Source:
        return Source(self.prefix, self.generated_files, roots)

    def _header_in_si(self) -> str:
        lines = self._places() if self.prefix == SPACE else [*self._columns(), *self._show()]
        return "\n".join(
            [
                "/* Where the kernel's quantities come from, and where its outputs go. */",
                "#pragma once",
                "",
                '#include "block.h"',
                '#include "state.h"',
                "",
                "/* Step limit of a collision, or of one call where a collision may be resumed. */",
                f"enum {{ MOST_STEPS_TAKEN = {KERNEL_STEPS_IN_SPACE if self.prefix == SPACE else KERNEL_STEPS} }};",
                "",
                *lines,
            ]
        )

    def _places(self) -> list[str]:
        names = load(self.choice).names("outputs")
        vectors = [(k, name.removesuffix("_x")) for k, name in enumerate(names) if not name.endswith(("_y", "_z"))]
        lines = [f"enum {{ {', '.join(f'AT_{name.upper()} = {k}' for k, name in vectors)} }}; /* in `shown` */", ""]
        lines += ["static void set_material(buffer *columns, const law_material *m)", "{"]
        lines += ["    for (int k = 0; k < QUANTITIES; k++)", "        columns[k].bytes = sizeof(double);"]
        lines += [f"    columns[SI_{name.upper()}].at = (void *)&m->{name};" for name in self.material]
        return [*lines, "}", ""]

    def _columns(self) -> list[str]:
        lines = ["static void set_columns(buffer *columns, const law_material *m, const block *b)", "{"]
        lines += ["    for (int k = 0; k < QUANTITIES; k++)", "        columns[k].bytes = sizeof(double);"]
        for name in self.quantities:
            if name in IMPACT:
                lines.append(f"    columns[SI_{name.upper()}].at = (void *)b->{IMPACT[name]};")
                lines.append(f"    columns[SI_{name.upper()}].bytes = sizeof b->{IMPACT[name]};")
            else:
                lines.append(f"    columns[SI_{name.upper()}].at = (void *)&m->{name};")
        return [*lines, "}", ""]

    def _show(self) -> list[str]:
        names = load(self.choice).names("outputs")
        lines = ["/* `rate`: the unit of angular velocities, rad/s. */"]
        lines += ["static void show(const answer *a, double rate, law_collision *c)", "{"]
        lines += [f"    {_SHOWN[name].format(f'a->shown[{k}]')}" for k, name in enumerate(names) if name in _SHOWN]
        if self.prefix.endswith(HEAD_ON):
            lines += ["    c->final_spin = c->final_partner_spin = c->final_rotation_rate = 0.0;", "    (void)rate;"]
        else:
            lines.append("    c->slip_restitution = a->slip;")
            if self.scene.wall:
                lines.append("    c->final_partner_spin = 0.0;")
            elif "final_spin_partner" not in names:
                lines.append("    c->final_partner_spin = c->final_spin;")
        return [*lines, "}", ""]


def kernels(scene: Scene, rtol: float, ledger: bool = False) -> tuple[Kernel, ...]:
    """The kernels of a scene's law: along the line of centres, in a plane, and of two spheres in space.

    With the ledger contacts have kernels of their own, the others the order for maps, and there is none for space.

    Each of two spheres has its own spin; only on strings they share one.
    """
    package = scene.package
    if package is not None and package.terms is not None and package.terms.rotates:
        problem = "has terms on a rotation, and the spheres of an exported law have spins of their own"
        raise InputError("model", package.name, "a model with terms of x and u on the gap", problem)
    spinning = scene
    if not scene.wall and scene.pendulum is None:
        spinning = scene.with_entries({"impact.partner_spin": 0.0})
    result = []
    for prefix, oblique in ((HEAD_ON, False), (PLANE, True)):
        own = variant(spinning, oblique, _MAPPED if ledger else rtol, fold=False)
        result.append(Kernel(prefix, replace(own, limit=not ledger), spinning))
        if ledger:
            booked = replace(variant(spinning, oblique, rtol, ledger=True, fold=False), limit=True)
            result.append(Kernel(BOOKED + prefix, booked, spinning))
    if not ledger and not scene.wall and not only_in_a_plane(scene):
        result.append(Kernel(SPACE, variant(scene, True, rtol, space=True), spinning))
    return tuple(result)


def only_in_a_plane(scene: Scene) -> str:
    """Why a scene has no collisions in space; empty if it has."""
    try:
        check_scene(scene)
    except InputError as error:
        return f"{error.field} {error.problem}"
    return ""
