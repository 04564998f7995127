"""What a scene needs of the model: which states, terms, events and parameters exist at all."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product


@dataclass(frozen=True)
class Structure:
    """The shape of a model.

    Arguments:
        oblique: the impact has a tangential part; without it there is no rotation, spin or tangential force.
        bridge: a liquid bridge attracts.
        strings: pendulum strings pull back.
        reduced: the spin is eliminated through the conserved angular momentum (no strings, midgap arm).
    """

    oblique: bool
    bridge: bool
    strings: bool
    reduced: bool = False

    def __post_init__(self) -> None:
        if self.reduced and (self.strings or not self.oblique):
            raise ValueError("a reduced form needs a conserved angular momentum: oblique and without strings")

    @property
    def name(self) -> str:
        """Name of the emitted module."""
        parts = ["oblique" if self.oblique else "head_on"]
        parts += [word for word in ("bridge", "strings", "reduced") if getattr(self, word)]
        return "_".join(parts)


def structures() -> tuple[Structure, ...]:
    """Every structure there is: head-on or oblique, with or without bridge and strings, reduced where it can be."""
    full = [Structure(oblique, bridge, strings) for oblique, bridge, strings in product((False, True), repeat=3)]
    reduced = [Structure(True, bridge, False, reduced=True) for bridge in (False, True)]
    return (*full, *reduced)
