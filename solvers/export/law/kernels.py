"""The kernels of an exported law: which structures they are of, and their texts."""

import re
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ...collision.space.collide_pair import check_scene
from ...engines.settings import KERNEL_STEPS, KERNEL_STEPS_IN_SPACE
from ...engines.taylor.call import variant
from ...engines.taylor.headers import headers
from ...engines.taylor.source import Variant, files
from ...errors import CheckFailed, InputError
from ...host.thread_caches import once
from ...model.key import ModelKey
from ...model.model import load
from ...scene.scene import Scene

HEAD_ON, PLANE, SPACE = "head_on", "plane", "space"
BOOKED = "booked_"
"""Prefix of kernels with the energy ledger, before that of their geometry."""
IMPACT = {"speed": "speed", "angle": "angle", "impact_spin": "spin", "impact_partner_spin": "partner_spin"}
"""Quantities of an impact, and their names in it."""
_OWN = Path(__file__).resolve().parent / "c"
"""Hand-written C that only the exported law has, and templates."""
_MAPPED = 1e-6  # relative tolerance of maps
_COMPONENTS = ("_x", "_y", "_z")
_EMPTY = ("nearness.h", "saltation.h", "step_record.h", "tangent_step.h", "tangents.h", "tape.h")
"""Files of the runtime that have no code in a kernel without derivatives and without a trajectory."""
_FOR_PYTHON = re.compile(r"^(?:STATIC_ASSERT.*|const char \w+_names\[\][^;]*;)\n", re.MULTILINE)
"""What Python reads of a compiled kernel: names, and assertions of the layout."""


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
    def files(self) -> dict[str, str]:
        """Texts of the files that its source includes besides the runtime's, by name; InputError without a kernel."""
        texts = files(self.variant, self._headers)
        # the C compiler decides on the lanes (`law.c.in`), not this machine
        texts["settings.h"] = re.sub(r"^#define LANES .*\n", "", texts["settings.h"], flags=re.MULTILINE)
        texts |= {path.name: path.read_text() for path in _OWN.glob("*.h")} | dict.fromkeys(_EMPTY, "")
        texts |= {name: _FOR_PYTHON.sub("", texts[name]) for name in ("layout.h", "model.h")}
        return texts | {
            "in_si.h": rendered(
                "in_si.h.in",
                in_space=self.prefix == SPACE,
                head_on=self.prefix.endswith(HEAD_ON),
                wall=self.scene.wall,
                steps=KERNEL_STEPS_IN_SPACE if self.prefix == SPACE else KERNEL_STEPS,
                quantities=self.quantities,
                material=self.material,
                impact=IMPACT,
                outputs=load(self.choice).names("outputs"),
            )
        }

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


def rendered(file: str, /, **values: Any) -> str:
    """A file of the folder `c`: what is in it of `@{value}` and of lines that begin with `//%`, by jinja2.

    Imported here, since nothing but an export needs it.
    """
    return str(_templates().get_template(file).render(**values))


@once
def _templates() -> Any:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    templates = Environment(
        loader=FileSystemLoader(_OWN), undefined=StrictUndefined, keep_trailing_newline=True,
        variable_start_string="@{", variable_end_string="}", line_statement_prefix="//%",
    )  # fmt: skip
    templates.filters |= {"repr": repr, "braced": _braced}
    return templates


def _braced(value: Any) -> str:
    """A number, or rows of numbers of any depth, as C's initialiser."""
    if isinstance(value, list | tuple) or np.ndim(value):
        return f"{{{', '.join(map(_braced, value))}}}"
    if isinstance(value, float | np.floating):
        return "NAN" if np.isnan(value) else repr(float(value))
    return str(int(value))
