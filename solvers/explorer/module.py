"""A scene's law as a WebAssembly module."""

import hashlib
import re
from pathlib import Path

from ..errors import InputError
from ..export.law.texts import LawSource
from ..host.compiler import CannotCompile, webassembly
from ..host.user_cache import kept

_EXPORTED = ("place", "size", "set_material", "many", "follow", "followed_events", "message", "outside")
_FLAGS = (
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


def module(law: LawSource, behind: str = "") -> bytes:
    """The module of a law and the functions of `shim.h`; compiled once for all scenes of its structure, and kept.

    Arguments:
        behind: more C, which follows that of `shim.h`.

    Raises:
        InputError: no compiler makes WebAssembly here.
    """
    text = _VALUES.sub("", _HEAD.sub("", law.c))  # without what differs between scenes: its name and its numbers
    text = text.replace('#include "law.h"', _VALUES.sub("", law.header))
    text += Path(__file__).with_name("shim.h").read_text() + behind
    digest = hashlib.sha256("\0".join([text, *_FLAGS]).encode()).hexdigest()[:32]
    try:
        return kept(f"explorer-{digest}.wasm", lambda: webassembly(text, _FLAGS))
    except CannotCompile as error:
        accepted = "an installed ziglang (pip install 'wetdoublet[explorer]'), or clang with lld and wasi-libc"
        raise InputError("explore", None, accepted, f"has no compiler for WebAssembly ({error})") from None
