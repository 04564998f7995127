"""Structures: the combinations of states, terms, events and parameters that scenes need."""

from dataclasses import dataclass, replace
from itertools import product
from typing import Literal

from .terms import Terms

Partner = Literal["", "pair", "wall", "space"]
Friction = Literal["", "solid", "all"]


@dataclass(frozen=True)
class Structure:
    """The shape of a model.

    Arguments:
        oblique: the impact has a tangential part; without it there is no rotation, spin or tangential force.
        bridge: with a liquid bridge.
        strings: the spheres hang from pendulum strings.
        reduced: the spin is eliminated by conservation of angular momentum (no strings, lever arm at mid-gap).
        attraction: with an attraction besides the bridge's (van der Waals).
        spread: the rim of the film follows from the bridge volume, so there is no film edge event.
        partner: the partner of the sphere: "" an equal sphere, "pair" another sphere, "wall" a wall, "space" any
            sphere, with vectors in the laboratory's axes in place of a plane of motion.
        friction: of the dry contact: at no rebound, at those by solid contact, or at all.
        terms: what a model file adds to the equations of motion.
    """

    oblique: bool
    bridge: bool
    strings: bool
    reduced: bool = False
    attraction: bool = False
    spread: bool = False
    partner: Partner = ""
    friction: Friction = ""
    terms: Terms | None = None

    def __post_init__(self) -> None:
        if self.reduced and (self.strings or not self.oblique):
            raise ValueError("a reduced form needs a conserved angular momentum: oblique and without strings")
        if self.spread and not self.bridge:
            raise ValueError("a film of constant volume needs the bridge whose volume it is")
        if self.partner and (not self.oblique or self.strings):
            raise ValueError("another partner than an equal is oblique (head-on it makes no difference) and free")
        if self.friction and (not self.oblique or self.reduced):
            raise ValueError("friction is oblique, and acts on the spin, which stays a state")
        if self.reduced and self.partner not in ("", "space"):
            raise ValueError("a spin of an unequal pair in the plane is not eliminated")

    @property
    def name(self) -> str:
        """Name of the emitted module."""
        parts = ["oblique" if self.oblique else "head_on"]
        parts += [self.partner] if self.partner else []
        parts += [word for word in ("bridge", "strings", "attraction", "spread", "reduced") if getattr(self, word)]
        parts += {"": [], "solid": ["friction"], "all": ["friction", "all"]}[self.friction]
        return "_".join(parts)

    def has(self, *features: str) -> bool:
        """True if the structure has these features: a field, or a partner; "not" in front: has it not."""
        return all(
            (self.partner == name or bool(getattr(self, name, False))) != feature.startswith("not ")
            for feature in features
            for name in [feature.removeprefix("not ")]
        )


FREE = Structure(oblique=True, bridge=False, strings=False)
BRIDGED = Structure(oblique=True, bridge=True, strings=False)


def structures() -> tuple[Structure, ...]:
    """The structures of the paper: head-on or oblique, with or without bridge and strings, reduced where possible."""
    full = [Structure(oblique, bridge, strings) for oblique, bridge, strings in product((False, True), repeat=3)]
    reduced = [Structure(True, bridge, False, reduced=True) for bridge in (False, True)]
    return (*full, *reduced)


def all_structures() -> tuple[Structure, ...]:
    """Every structure that a scene can request: another partner, another attraction, a spreading film, friction."""
    others = [Structure(True, bridge, False, partner=partner) for partner in _PARTNERS for bridge in _EITHER]
    space = [Structure(True, bridge, False, reduced, partner="space") for bridge in _EITHER for reduced in _EITHER]
    shapes = (*structures(), *others, *space)
    extended = []
    for attraction, spread in product(_EITHER, repeat=2):
        extended += [replace(s, attraction=attraction, spread=spread) for s in shapes if s.bridge or not spread]
    spun = [s for s in extended if s.oblique and not s.reduced]
    rough = [replace(s, friction=friction) for friction in _FRICTIONS for s in spun]
    return (*extended, *rough)


def committed() -> tuple[Structure, ...]:
    """The structures emitted in advance; the others are derived when a scene first needs them.

    Those of the paper, with unequal spheres and walls; not both bridge and strings.
    """
    plain = (s for s in all_structures() if not (s.friction or s.attraction or s.spread or s.partner == "space"))
    return tuple(s for s in plain if not (s.bridge and s.strings))


_EITHER = (False, True)
_PARTNERS: tuple[Partner, ...] = ("pair", "wall")
_FRICTIONS: tuple[Friction, ...] = ("solid", "all")
