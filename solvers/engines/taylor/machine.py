"""What kernels are compiled for: the processor's features, the lanes that follow from them, and its compiler flag."""

import platform
from collections.abc import Collection
from functools import cache
from pathlib import Path

_NEEDED = ((8, "avx512dq"), (4, "avx2"), (2, "sse2"), (2, "asimd"))  # doubles in a register of that feature
_BASELINE = frozenset({"sse2"})  # assumed where the system does not report features; every such machine has two lanes
_ARM = ("aarch64", "arm64")


def native(machine: str) -> str:
    """The compiler flag for the processor of this kind of machine; on ARM -march names the architecture alone."""
    return "-mcpu=native" if machine in _ARM else "-march=native"


def lanes_of(features: Collection[str]) -> int:
    """Number of doubles in the widest vector register of a processor with these features.

    >>> lanes_of(["fp", "asimd", "aes"])
    2
    """
    return next((count for count, feature in _NEEDED if feature in features), 1)


@cache
def lanes() -> int:
    """Number of doubles in a vector register of this machine."""
    return lanes_of(features())


@cache
def features() -> frozenset[str]:
    """Processor features, as Linux reports them."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    for line in lines:
        name, _, value = line.partition(":")
        if name.strip() in ("flags", "Features"):
            return frozenset(value.split())
    return _BASELINE


def described() -> str:
    """The machine in words that tell two processors apart for which different code is compiled."""
    return f"{platform.machine()} {' '.join(sorted(features()))}"
