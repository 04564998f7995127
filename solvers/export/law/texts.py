"""The folder of an exported law: its C file and header, and what shows how to use it."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

from ....generated.automaton import CRITERIA, KINDS, OUTCOMES
from ...collision.space.pairs import Bodies
from ...engines.settings import KERNEL_STEPS, KERNEL_STEPS_IN_SPACE, RTOL, TOLERANCE
from ...scene.scene import Scene
from ..equations import file_name
from .c_file import digests, kernels_text
from .kernels import BOOKED, HEAD_ON, PLANE, SPACE, Kernel, kernels, only_in_a_plane, rendered
from .material import LARGEST, Number, endless, impact, material, results
from .pair_material import computed, pair_entries
from .vectors import RTOL as VECTOR_RTOL
from .vectors import TOLERANCE as VECTOR_TOLERANCE
from .vectors import pair_vectors, vectors

_TAKEN = ("check", "example", "vectors", "add", "dry", "oblique", HEAD_ON, PLANE, SPACE, f"{SPACE}_set")
"""Names of other files of the folder, and beginnings of names within the law that would be those of its types."""
Fields = list[tuple[str, str, tuple[int, ...]]]
"""Members of a structure: type, name, shape."""


@dataclass(frozen=True)
class LawSource:
    """A law before it has the scene's name: `law_` is its prefix, and the C file includes "law.h".

    Arguments:
        header: text of the header, without the comment at its head.
        c: text of the C file.
        entries: of a pair, with the scene's values.
        impact: of a collision.
    """

    header: str
    c: str
    entries: tuple[Number, ...]
    impact: tuple[Number, ...]


def source(scene: Scene, rtol: float = RTOL, ledger: bool = False) -> LawSource:
    """The C of a scene's law; InputError if one of its laws has no recurrence.

    Arguments:
        ledger: contacts that a host interrupts have the energy ledger, and there are no collisions in space.
    """
    law_kernels, planar = kernels(scene, rtol, ledger), only_in_a_plane(scene)
    of_material, of_impact = material(scene, law_kernels), impact(scene)
    entries = pair_entries(scene, of_material)
    values: dict[str, Any] = {
        "scene": scene, "material": of_material, "impact": of_impact, "entries": entries,
        "statuses": results((*of_material, *of_impact), entries, in_space=not planar),
        "ledger": ledger, "planar": planar, "unforced": _without_forces(scene), "largest": LARGEST,
    }  # fmt: skip
    header = rendered(
        "law.h.in",
        **values,
        outcomes=OUTCOMES,
        criteria=[(word, KINDS.index(word), row.name) for word, row in CRITERIA.items()],
        steps=KERNEL_STEPS,
        steps_in_space=KERNEL_STEPS_IN_SPACE,
    )
    c = rendered(
        "law.c.in",
        **values,
        head=_head(scene, law_kernels),
        kernels=kernels_text(law_kernels),
        tolerance=Number("rtol", "1", "", TOLERANCE.range, 1e-9),
        endless=endless(scene),
        of_entries=computed(scene, entries, of_material),
        booked=BOOKED if ledger else "",
        in_space=not planar and not ledger,
    )
    return LawSource(header, c, entries, of_impact)


def _without_forces(scene: Scene) -> str:
    """Why a scene in space has no forces for time steps; empty if it has."""
    if scene.package is not None and (scene.package.events or scene.package.terms is not None):
        return "model: declared events and terms act in whole collisions"
    return "partner.wall: only of two spheres" if scene.wall else ""


def law_name(scene: Scene) -> str:
    """The prefix of a scene's law and the name of its files, unlike its neighbours' names and prefixes within it."""
    name = file_name(scene)
    return f"{name}_law" if name in _TAKEN else name


def texts(scene: Scene, rtol: float = RTOL) -> dict[str, str]:
    """Texts of the files by name; errors as of `source`, and ComputationError if no engine computes test vectors."""
    name, law_kernels, law, pairs = law_name(scene), kernels(scene, rtol), source(scene, rtol), []
    layout, planar = structures(law.header), only_in_a_plane(scene)
    others = {"Makefile": "Makefile", "README.md": "README.md", "check.c": "check.c", "example.py": "example.py.in"}
    if planar:
        others["example.c"] = "example.c"
    else:
        others |= {"example.c": "example-space.c", "pairs.py": "pairs.py.in"}
        pairs = pair_vectors(scene, _members(layout["law_pair"]), _members(layout["law_pair_after"]))
    numbers = {"rtol": VECTOR_RTOL, "tolerance": VECTOR_TOLERANCE}
    radii, masses = _sizes(scene)
    example = {
        "name": name, "speed": f"{0.1 / scene.stokes_per_speed:.3g}", "radii": radii, "masses": masses,
        "fields": {structure: _ctypes(fields) for structure, fields in layout.items()},
    }  # fmt: skip
    files = {
        f"{name}.h": _head(scene, law_kernels) + law.header,
        f"{name}.c": law.c,
        "vectors.h": rendered("vectors.h.in", vectors=vectors(scene, law_kernels), pairs=pairs, **numbers),
        **{path: rendered(file, **example) for path, file in others.items()},
    }
    return {file: _named(name, text) for file, text in files.items()}


def structures(header: str) -> dict[str, Fields]:
    """The structures that a host fills or reads, by name."""
    plain = re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)  # comments may have braces, of LaTeX
    bodies = re.findall(r"typedef struct \{([^}]*)\} (law_\w+);", plain)
    return {
        name: [
            (kind, member, tuple(map(int, re.findall(r"\d+", shape))))
            for kind, member, shape in re.findall(r"^ *(int|double|law_\w+) (\w+)((?:\[\d+\])*);", body, re.MULTILINE)
        ]
        for body, name in bodies
    }


def _members(fields: Fields) -> list[str]:
    return [name for _, name, _ in fields]


def _ctypes(fields: Fields) -> str:
    """The members as fields of a ctypes structure."""
    kinds = ("".join([f"ctypes.c_{kind}", *(f" * {n}" for n in reversed(shape))]) for kind, _, shape in fields)
    return ", ".join(f'("{name}", {kind})' for kind, (_, name, _) in zip(kinds, fields, strict=True))


def _sizes(scene: Scene) -> tuple[tuple[float, float], tuple[float, float]]:
    """Radii and masses, m and kg; zero of a wall."""
    if not scene.wall:
        bodies = Bodies.of(scene)
        return bodies.radius, bodies.mass
    return (float(scene.material["reduced_radius"]), 0.0), (float(scene.material["reduced_mass"]), 0.0)


def _head(scene: Scene, law_kernels: Sequence[Kernel]) -> str:
    """The comment at the head of both files: what they are, and what they come from."""
    lines = [f"Collisions of wet particles: the law of the scene `{scene.name or 'scene'}`.", ""]
    lines += [f"Exported by wetdoublet {version('wetdoublet')}. Do not edit: change the scene and export it again."]
    for kernel in law_kernels:
        laws = ", ".join(f"{slot} {law}" for slot, law in kernel.choice.laws)
        lines.append(f"Kernel {kernel.prefix}: structure {kernel.choice.structure}; laws: {laws}.")
    lines += ["Digests of what is emitted from the derivation:", *(f"  {digest}" for digest in digests(law_kernels))]
    inside = "\n".join(f" * {line}".rstrip() for line in lines).replace("*/", "* /")
    return f"/*\n{inside}\n */\n"


def _named(name: str, text: str) -> str:
    """The text with the law's own prefix."""
    text = text.replace('"law.h"', f'"{name}.h"')
    text = re.sub(r"\blaw_(?=\w)", f"{name}_", text)
    return re.sub(r"(?:\b|(?<=-D))LAW_(?=\w)", f"{name.upper()}_", text)
