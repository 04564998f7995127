"""A scene's law as a WebAssembly module, and where the model ends, in C and in words."""

import gzip
import math
import re
from collections.abc import Sequence
from pathlib import Path

from casadi import SX, CodeGenerator, Function, vertcat

from ..engines.taylor.shipped import content_of
from ..errors import InputError
from ..export.law.texts import LawSource
from ..host.compiler import CannotCompile, webassembly
from ..host.user_cache import digest_of, fetch
from ..model.validity import LIMITS, WORDS, law_limits, needs
from ..scene.groups import si_values
from ..scene.scene import Scene

BUILT = Path(__file__).with_name("built")
"""Folder of the bundle and the modules that come with the package."""
SUFFIX = ".wasm.gz"
_EXPORTED = ("place", "size", "set_material", "many", "follow", "followed_events", "message", "outside")
FLAGS = (
    "-O2",
    "-msimd128",
    "-DLAW_LANES=2",
    "-fno-math-errno",
    "-ffp-contract=off",
    "-s",
    *(f"-Wl,--export={name}" for name in _EXPORTED),
)
_VALUES = re.compile(r"^law_\w+ law_default_\w+\(void\)\n\{.*?^\}\n", re.MULTILINE | re.DOTALL)
_HEAD = re.compile(r"\A/\*.*?\*/\n", re.DOTALL)
_LIMITS = "model_limits"
_OUTSIDE = """
/* Bits of the limits that a collision has exceeded. */
int outside(int k)
{{
    static const double least[] = {{{least}}}, most[] = {{{most}}};
    double numbers[{count}];
    const double other[] = {{{other}}};
    const double *arguments[] = {{(const double *)&material, other}};
    double *results[] = {{numbers}};
    int bits = 0;
    {name}(arguments, results, 0, 0, 0);
    for (int i = 0; i < {count}; i++)
        bits |= (numbers[i] < least[i] || numbers[i] > most[i]) << i;
    return bits;
}}
"""


def compilation(law: LawSource, behind: str = "") -> tuple[str, str]:
    """The C that a law's module is compiled from, the same for all scenes of a structure, and its digest.

    Arguments:
        behind: more C, which follows that of `shim.h`.
    """
    text = _VALUES.sub("", _HEAD.sub("", law.c))  # without what differs between scenes: its name and its numbers
    text = text.replace('#include "law.h"', _VALUES.sub("", law.header))
    text += Path(__file__).with_name("shim.h").read_text() + behind
    return text, digest_of("\0".join([text, *FLAGS]).encode())


def module(law: LawSource, behind: str = "") -> bytes:
    """The module of a law and the functions of `shim.h`: as shipped with the package, or else compiled once and cached.

    Arguments:
        behind: as for `compilation`.

    Raises:
        InputError: it is not shipped, and no compiler makes WebAssembly here.
    """
    text, digest = compilation(law, behind)
    try:
        return shipped(digest) or fetch(f"explorer-{digest}.wasm", lambda: webassembly(text, FLAGS))
    except CannotCompile as error:
        accepted = "an installed ziglang (pip install 'wetdoublet[explorer]'), or clang with lld and wasi-libc"
        problem = f"has no module of this law in the package, and no compiler for WebAssembly ({error})"
        raise InputError("explore", None, accepted, problem) from None


def shipped(digest: str) -> bytes | None:
    """The module that came with the package for the digest of a text; None if there is none that is whole."""
    packed = content_of(BUILT, digest, SUFFIX)
    return packed and gzip.decompress(packed)


def limits(scene: Scene, material: Sequence[str], entries: Sequence[str]) -> tuple[str, list[str]]:
    """C of a function `outside` behind that of `shim.h`, and the words of its bits.

    Arguments:
        material: members of the law's material, in their order.
        entries: members of the law's entries of a pair.
    """
    members = {name: SX.sym(name) for name in material}
    results = ("speed", "angle", "outcome", *needs(scene), "density")
    others = {name: SX.sym(name) for name in results}
    dense = "liquid_density" in entries
    values = {**si_values(scene, None, None), **members, **others}
    if not dense:
        del values["density"]
    limits, numbers = [], []
    for limit in (*LIMITS, *law_limits(scene)):
        number = limit.number(scene, values)
        if isinstance(number, float) and math.isnan(number):
            continue  # the question does not arise for this scene
        numbers.append(number)
        limits.append(limit)
    code = CodeGenerator(_LIMITS)
    code.add(Function(_LIMITS, [vertcat(*members.values()), vertcat(*others.values())], [vertcat(*numbers)]))
    given = [f"impacts[k].{name}" for name in results[:2]] + [f"collisions[k].{name}" for name in results[2:-1]]
    given.append("pair_entries.liquid_density" if dense else "0.0")
    least, most = (
        ", ".join(f"{bound!r}".replace("inf", "INFINITY") for bound in bounds)
        for bounds in zip(*(limit.bounds for limit in limits), strict=True)
    )
    shim = _OUTSIDE.format(count=len(limits), other=", ".join(given), name=_LIMITS, least=least, most=most)
    return str(code.dump()) + shim, [WORDS.get(limit.flag, limit.flag) for limit in limits]
