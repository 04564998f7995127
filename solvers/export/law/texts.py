"""The folder of an exported law: its C file and header, and what shows how to use it."""

import re
from dataclasses import dataclass
from importlib.metadata import version
from typing import Self

from ...engines.settings import RTOL
from ...scene.scene import Scene
from ...space.pairs import Bodies
from ..equations import file_name
from . import space
from .amalgam import OWN, Source, digests, merged
from .header import ctypes_fields, default_material, header, message_function, structures
from .items import items
from .kernels import BOOKED, HEAD_ON, PLANE, SPACE, Kernel, kernels, only_in_a_plane
from .material import Number, Result, checks, impact, material, results
from .pair import pair_entries, pair_function
from .vectors import table

ROOTS = ("integrate.h", "follow.h")
"""Files of a kernel whose functions the law calls, with what they include."""
CALLERS = ("collide.h", "contact.h")
"""Files behind the kernels, which call their functions."""
_TAKEN = ("check", "example", "vectors", "add", "oblique", HEAD_ON, PLANE, SPACE, f"{SPACE}_set")
"""Names of other files of the folder, and beginnings of names within the law that would be those of its types."""
_LINE = re.compile(r'^#(?:pragma once|include "[^"]+")\n', re.MULTILINE)
_LANES = """\
/* Doubles side by side: as many as a vector register holds, or one in plain C. -DLAW_LANES=1 chooses. */
#if defined(LAW_LANES)
#define LANES LAW_LANES
#elif defined(__AVX512DQ__) && defined(__GNUC__)
#define LANES 8
#elif defined(__AVX2__) && defined(__GNUC__)
#define LANES 4
#elif (defined(__SSE2__) || defined(__ARM_NEON)) && defined(__GNUC__)
#define LANES 2
#else
#define LANES 1
#endif
#include <float.h>
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || defined(_M_FP_FAST)
#error "NaN and infinity are compared here: compile without -ffast-math and -ffinite-math-only"
#endif
#if defined(__ASSOCIATIVE_MATH__) || (defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1)
#error "Sums are rounded as they stand, to doubles: compile without -fassociative-math and with -mfpmath=sse"
#endif
"""


@dataclass(frozen=True)
class _Numbers:
    """What a host gives, and the statuses that it may get."""

    material: tuple[Number, ...]
    impact: tuple[Number, ...]
    entries: tuple[Number, ...]
    statuses: tuple[Result, ...]

    @classmethod
    def of(cls, scene: Scene, law_kernels: tuple[Kernel, ...]) -> Self:
        of_material, of_impact = material(scene, law_kernels), impact(scene)
        entries = pair_entries(scene, of_material)
        statuses = results((*of_material, *of_impact), entries)
        in_space = () if only_in_a_plane(scene) else space.RESULTS
        return cls(of_material, of_impact, entries, (*statuses, *in_space))


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
    law_kernels = kernels(scene, rtol, ledger)
    numbers = _Numbers.of(scene, law_kernels)
    declared = header(scene, numbers.material, numbers.impact, numbers.entries, numbers.statuses, ledger)
    return LawSource(declared, _law(scene, law_kernels, numbers), numbers.entries, numbers.impact)


def law_name(scene: Scene) -> str:
    """The prefix of a scene's law and the name of its files, unlike its neighbours' names and prefixes within it."""
    name = file_name(scene)
    return f"{name}_law" if name in _TAKEN else name


def texts(scene: Scene, rtol: float = RTOL) -> dict[str, str]:
    """Texts of the files by name; errors as of `source`, and ComputationError if no engine computes test vectors."""
    name, law_kernels = law_name(scene), kernels(scene, rtol)
    law = source(scene, rtol)
    declared = law.header
    files = {
        f"{name}.h": _head(scene, law_kernels) + declared,
        f"{name}.c": law.c,
        "vectors.h": table(scene, law_kernels),
    }
    files |= {path: _filled(file, scene, declared) for path, file in _files(scene).items()}
    return {file: _named(name, text) for file, text in files.items()}


def _files(scene: Scene) -> dict[str, str]:
    """The other files by name, and where their texts are."""
    names = ("Makefile", "README.md", "check.c", "example.c")
    files = {**{name: name for name in names}, "example.py": "example.py.in"}
    return files | ({} if only_in_a_plane(scene) else {"example.c": "example-space.c", "pairs.py": "pairs.py.in"})


def _filled(file: str, scene: Scene, declared: str) -> str:
    """A text with the scene's names and numbers in their places."""
    places = {
        "NAME": law_name(scene),
        "SPEED": f"{0.1 / scene.stokes_per_speed:.3g}",
        **{name.removeprefix("law_").upper(): ctypes_fields(fields) for name, fields in structures(declared).items()},
    }
    radii, masses = _sizes(scene)
    places |= {"RADII": ", ".join(map(repr, radii)), "MASSES": ", ".join(map(repr, masses))}
    text = (OWN / file).read_text()
    for name, value in places.items():
        text = text.replace(f"@{name}@", value)
    return text


def _sizes(scene: Scene) -> tuple[tuple[float, float], tuple[float, float]]:
    """Radii and masses, m and kg; zero of a wall."""
    if not scene.wall:
        bodies = Bodies.of(scene)
        return bodies.radius, bodies.mass
    return (float(scene.material["reduced_radius"]), 0.0), (float(scene.material["reduced_mass"]), 0.0)


def _law(scene: Scene, law_kernels: tuple[Kernel, ...], numbers: _Numbers) -> str:
    """Text of NAME.c: its kernels, and behind them the functions that a host calls."""
    called, parts = list(CALLERS), []
    booked = [kernel.prefix for kernel in law_kernels if kernel.prefix.startswith(BOOKED)]
    if not booked and not only_in_a_plane(scene):
        called += space.callers(scene)
        parts.append(space.bodies(scene))
    behind = "\n".join(
        [
            default_material(numbers.material),
            message_function(numbers.statuses),
            checks(scene, numbers.material, numbers.impact, law_kernels),
            pair_function(scene, numbers.entries, numbers.material),
            *parts,
            *(_LINE.sub("", (OWN / name).read_text()) for name in called),
        ]
    )
    for prefix in booked:
        behind = behind.replace(f" {prefix.removeprefix(BOOKED)}_follow(", f" {prefix}_follow(")
    text, always, sometimes = merged(_sources(scene, law_kernels), items("law", behind)[1])
    return "\n".join([_head(scene, law_kernels), '#include "law.h"', "", *always, "", _LANES, *sometimes, text, behind])


def _sources(scene: Scene, law_kernels: tuple[Kernel, ...]) -> list[Source]:
    types = () if only_in_a_plane(scene) else space.TYPES
    in_plane = (*ROOTS, *types)
    return [kernel.source(space.ROOTS if kernel.prefix == SPACE else in_plane) for kernel in law_kernels]


def _head(scene: Scene, law_kernels: tuple[Kernel, ...]) -> str:
    """The comment at the head of both files: what they are, and what they come from."""
    lines = [f"Collisions of wet particles: the law of the scene `{scene.name or 'scene'}`.", ""]
    lines += [f"Exported by wetdoublet {version('wetdoublet')}. Do not edit: change the scene and export it again."]
    for kernel in law_kernels:
        laws = ", ".join(f"{slot} {law}" for slot, law in kernel.choice.laws)
        lines.append(f"Kernel {kernel.prefix}: structure {kernel.choice.structure}; laws: {laws}.")
    hashes = digests(_sources(scene, law_kernels))
    lines += ["Digests of what is emitted from the derivation:", *(f"  {digest}" for digest in hashes)]
    inside = "\n".join(f" * {line}".rstrip() for line in lines).replace("*/", "* /")
    return f"/*\n{inside}\n */\n"


def _named(name: str, text: str) -> str:
    """The text with the law's own prefix."""
    text = text.replace('"law.h"', f'"{name}.h"')
    text = re.sub(r"\blaw_(?=\w)", f"{name}_", text)
    return re.sub(r"(?:\b|(?<=-D))LAW_(?=\w)", f"{name.upper()}_", text)
