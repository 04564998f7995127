"""What the last digits of a result depend on besides the request: equations, programs and this machine's processor."""

import hashlib
import platform
from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path

from ...generated import scaling
from ..host.compiler import compiler, more_flags
from .machine import described, lanes
from .taylor.shipped import shipped_digest

_NONE = "none"


def arithmetic() -> dict[str, str]:
    """Names and descriptions; two processes where all are equal compute the same digits."""
    tool = compiler()
    return {
        "kernels": shipped_digest() or _NONE,
        "compiler": _NONE if tool is None else tool.version,
        "WETDOUBLET_CFLAGS": " ".join(more_flags()) or _NONE,
        "lanes": str(lanes()),
        "processor": described(),
        **_software(),
    }


@cache
def _software() -> Mapping[str, str]:
    emitted = Path(scaling.__file__).with_name("manifest.json").read_bytes()
    runtime = sorted(Path(__file__).with_name("taylor").glob("runtime/*.h"))
    digest = hashlib.sha256(emitted + b"".join(path.read_bytes() for path in runtime)).hexdigest()[:16]
    return {
        "equations": digest,
        "C library": " ".join(platform.libc_ver()).strip() or platform.platform(),
        **{name: version(name) for name in ("wetdoublet", "casadi", "numpy")},
    }


def has_kernel(description: Mapping[str, str]) -> bool:
    """True if a process of this arithmetic has Taylor kernels: shipped ones, or a compiler."""
    return any(description[name] != _NONE for name in ("kernels", "compiler"))


def difference(first: Mapping[str, str], other: Mapping[str, str]) -> str:
    """How the first of two processes differs from the second, in words; "" if not."""
    for name in other:
        mine, theirs = first.get(name, _NONE), other[name]
        if mine != theirs:
            if name == "processor":
                lacks, has = (
                    " ".join(sorted({*a.split()} - {*b.split()})) for a, b in ((theirs, mine), (mine, theirs))
                )
                return f"its processor has not {lacks[:60] or '-'}, and has {has[:60] or '-'} besides"
            return f"its {name} is {mine}, not {theirs}"
    return ""
