"""What a scene needs of the model: which states, terms, events and parameters exist at all."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import Literal

Partner = Literal["", "pair", "wall"]


@dataclass(frozen=True)
class Structure:
    """The shape of a model.

    Arguments:
        oblique: the impact has a tangential part; without it there is no rotation, spin or tangential force.
        bridge: a liquid bridge attracts.
        strings: pendulum strings pull back.
        reduced: the spin is eliminated through the conserved angular momentum (no strings, midgap arm).
        attraction: another attraction than the bridge's acts (van der Waals).
        spread: the film's rim follows the volume of the bridge, so that the film has no edge.
        partner: what the sphere meets: "" its equal, "pair" another sphere, "wall" a wall.
    """

    oblique: bool
    bridge: bool
    strings: bool
    reduced: bool = False
    attraction: bool = False
    spread: bool = False
    partner: Partner = ""

    def __post_init__(self) -> None:
        if self.reduced and (self.strings or not self.oblique):
            raise ValueError("a reduced form needs a conserved angular momentum: oblique and without strings")
        if self.spread and not self.bridge:
            raise ValueError("a film of constant volume needs the bridge whose volume it is")
        if self.partner and (not self.oblique or self.strings or self.reduced):
            raise ValueError("another partner than an equal is oblique (head-on it makes no difference) and free")

    @property
    def name(self) -> str:
        """Name of the emitted module."""
        parts = ["oblique" if self.oblique else "head_on"]
        parts += [self.partner] if self.partner else []
        parts += [word for word in ("bridge", "strings", "attraction", "spread", "reduced") if getattr(self, word)]
        return "_".join(parts)


def structures() -> tuple[Structure, ...]:
    """The paper's structures: head-on or oblique, with or without bridge and strings, reduced where it can be."""
    full = [Structure(oblique, bridge, strings) for oblique, bridge, strings in product((False, True), repeat=3)]
    reduced = [Structure(True, bridge, False, reduced=True) for bridge in (False, True)]
    return (*full, *reduced)


def known() -> tuple[Structure, ...]:
    """Every structure that a scene can ask for: the paper's, another partner, another attraction, a spreading film."""
    others = [Structure(True, bridge, False, partner=partner) for partner in _PARTNERS for bridge in _EITHER]
    shapes = (*structures(), *others)
    extended = []
    for attraction, spread in product(_EITHER, repeat=2):
        extended += [replace(s, attraction=attraction, spread=spread) for s in shapes if s.bridge or not spread]
    return tuple(extended)


def committed() -> tuple[Structure, ...]:
    """The structures that are emitted ahead; the others are derived when a scene first asks for one.

    Left out is what puts together more than one of strings, another attraction and a spreading film.
    """
    return tuple(s for s in known() if s.strings + s.attraction + s.spread < 2)


_EITHER = (False, True)
_PARTNERS: tuple[Partner, ...] = ("pair", "wall")
