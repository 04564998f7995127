"""What kernels are compiled for: instruction sets, the lanes that follow from them, and the one of this machine."""

import platform
from collections.abc import Collection
from functools import cache
from pathlib import Path
from typing import NamedTuple


class InstructionSet(NamedTuple):
    """A set of instructions that kernels are compiled for.

    Arguments:
        name: of the level, as the psABI of x86-64 has it; of the architecture elsewhere.
        lanes: doubles in a vector register.
        needed: features of the processor, as Linux reports them.
        flags: of compilers; those of the features, which also compilers know that do not know the level's name.
    """

    name: str
    lanes: int
    needed: frozenset[str] = frozenset()
    flags: tuple[str, ...] = ()


_V3 = {"abm": "lzcnt", "avx2": "avx2", "bmi1": "bmi", "bmi2": "bmi2", "f16c": "f16c", "fma": "fma", "movbe": "movbe"}
_V4 = _V3 | {name: name for name in ("avx512bw", "avx512cd", "avx512dq", "avx512f", "avx512vl")}
SETS = {
    "x86_64": (
        *(
            InstructionSet(name, lanes, frozenset(features), tuple(f"-m{flag}" for flag in features.values()))
            for name, lanes, features in (("x86-64-v4", 8, _V4), ("x86-64-v3", 4, _V3))
        ),
        InstructionSet("x86-64", 2),
    ),
    "aarch64": (InstructionSet("armv8-a", 2),),
}
"""Instruction sets of a kind of machine, widest first; all have the last."""
_SPELLINGS = {"amd64": "x86_64", "arm64": "aarch64"}


def sets_of(machine: str, features: Collection[str]) -> tuple[InstructionSet, ...]:
    """The instruction sets that a processor has, widest first."""
    name = machine.lower()
    sets = SETS.get(_SPELLINGS.get(name, name), (InstructionSet("scalar", 1),))
    return tuple(instructions for instructions in sets if instructions.needed <= set(features))


@cache
def own_sets() -> tuple[InstructionSet, ...]:
    """The instruction sets of this machine, widest first; kernels are compiled for the first."""
    return sets_of(platform.machine(), _features())


def lanes() -> int:
    """Number of doubles in a vector register of this machine."""
    return own_sets()[0].lanes


def _features() -> frozenset[str]:
    """Processor features, as Linux reports them; none elsewhere."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    for line in lines:
        name, _, value = line.partition(":")
        if name.strip() in ("flags", "Features"):
            return frozenset(value.split())
    return frozenset()


def described() -> str:
    """The machine in words: two that differ in them may compute other last digits."""
    return f"{platform.machine()} {own_sets()[0].name}"
