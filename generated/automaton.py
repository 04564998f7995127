# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Automaton sha256 e133df14a0b0711d0bc0ec37c43b1130793527e341e48fdf7463d2b089cb91e8
"""A collision as a hybrid automaton: events, their guards and effects, rules, words, outcomes."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

CLOSING, OPENING = -1, 1

STICK = "stick"  # it is proved that the two never separate, or the collision is cut off
ROTATE = "stick-rotate-separate"  # separated, and no rebound criterion was met
BOUNCE = "bounce"  # separated after a rebound criterion was met
OUTCOMES = (STICK, ROTATE, BOUNCE)  # by number


class EventKind(IntEnum):
    """Number of an event in a report; KINDS has its word."""

    GLASS = 0  # rebound: the film pressure on the axis reaches the glass-transition pressure
    ELASTIC = 1  # rebound: the gap is down to the elastic length
    ROUGH = 2  # rebound: the gap is down to the roughness
    TURNED = 3  # the normal velocity rises through zero, no rebound criterion met
    FELL_BACK = 4  # the normal velocity falls through zero
    FILM_EDGE = 5  # the gap passes x0
    TANGENTIAL_EDGE = 6  # the gap passes the reach of the tangential force
    RESTS = 7  # a rebound too weak to leave is taken for resting contact
    RELEASED = 8  # the normal force on a resting doublet turns outward
    RUPTURE = 9  # the bridge ruptures; without a bridge, the films part
    ROTATION_REVERSES = 10  # the strings turn the rotation back
    HALF_TURN = 11  # the line of centres has turned by pi and the strings cross

KINDS = (
    "glass",
    "elastic",
    "rough",
    "turned",
    "fell back",
    "film edge",
    "tangential edge",
    "rests",
    "released",
    "rupture",
    "rotation reverses",
    "half turn",
)


class Criterion(NamedTuple):
    """A rebound criterion: the group at which it is met, its name and symbol, and what removes it."""

    limit: str
    name: str
    contact: bool
    symbol: str
    removed_by: tuple[str, float] | None
    sentence: str


CRITERIA = {  # by word, in the order in which they apply on entry
    "glass": Criterion(
        limit="glass_number",
        name="glass transition",
        contact=False,
        symbol="",
        removed_by=None,
        sentence="rebound by the glass criterion, the liquid's own pressure",
    ),
    "elastic": Criterion(
        limit="elastic_gap",
        name="elastic length",
        contact=True,
        symbol="x_r",
        removed_by=("youngs_modulus", 1e+300),
        sentence="rebound by the elastic criterion, the spheres' deformation",
    ),
    "rough": Criterion(
        limit="rough_gap",
        name="roughness",
        contact=True,
        symbol="x_b",
        removed_by=("roughness", 0.0),
        sentence="rebound by contact of the surfaces' roughness",
    ),
}


class Status(IntEnum):
    """What the kernel says of a collision; up to LAST_ANSWER its outcome stands."""

    DECIDED = 0  # the outcome is decided
    PROVED_AT_TOUCH = 1  # a stick that is proved at initial contact
    NO_BUDGET = 2  # the steps are spent
    NOT_FINITE = 3  # the state is not finite
    CHATTER = 4  # the steps are spent in more than CHATTER_PHASES phases
    TOO_OBLIQUE = 5  # the centrifugal force is beyond MOST_OBLIQUE


LAST_ANSWER = Status.PROVED_AT_TOUCH


class Purpose(IntEnum):
    """What the kernel integrates a collision for."""

    WHOLE = 0  # to its end
    APPROACH = 1  # until it turns or is reversed; without the glass criterion, and nothing is proved
    ESCAPE = 2  # until it separates, falls back or rests; proved a stick only while it approaches


REST_SPEED = 1e-09  # of v0: a slower rebound into an inward force rests
MOST_OBLIQUE = 1000000000.0  # of v0^2/x0: a larger centrifugal force turns the motion within rounding of x0
LOOSEST = 1e-06  # relative tolerance: a looser one is tightened to it, or sticks stay unproved
SAFETY = 30.0  # a proof holds by more than this many times the tolerance of the largest energy: an error made when the motion was fastest stays in it, and errors of many steps add up
CHATTER_PHASES = 100  # phases: more are rebound after rebound, and no approach and escape
FILM_DEPTHS = 16  # steps of equal ratio from the gap to contact, at each of which the film certificate bounds the pressure
ATTRACTED_FILM_DEPTHS = 48  # the same beside an attraction, which a small gap makes large
LEAST_DEPTH = 1e-40  # of the gap: where no contact is met, the film certificate looks no deeper


class Event(NamedTuple):
    """A guard and its effect; `generated/automaton.md` explains them."""

    name: str
    functions: tuple[str, ...]
    where: tuple[tuple[str, int], ...]
    words: tuple[str, ...]
    actions: tuple[str, ...]
    follows: str
    dips: bool
    within_reach: bool
    scale: str
    chosen_by: str


# Conditions on a part of the mode that are void where a structure lacks an event function.
VOID_WITHOUT = {
    "film": "film_edge",
}

ENDS = ("separate", "cut off")  # actions that end a collision

EVENTS = (  # in order of precedence among coincident ones
    Event(
        name="turning",
        functions=("turning",),
        where=(("resting", 0),),
        words=("turned", "fell back"),
        actions=("velocity = 0", "turn"),
        follows="motion",
        dips=True,
        within_reach=False,
        scale="",
        chosen_by="motion",
    ),
    Event(
        name="glass",
        functions=("glass",),
        where=(("resting", 0), ("motion", -1)),
        words=("glass",),
        actions=("rebound",),
        follows="",
        dips=True,
        within_reach=False,
        scale="glass_number",
        chosen_by="",
    ),
    Event(
        name="contact",
        functions=("elastic", "rough"),
        where=(("resting", 0), ("motion", -1)),
        words=("elastic", "rough"),
        actions=("gap = contact", "rebound"),
        follows="",
        dips=False,
        within_reach=False,
        scale="",
        chosen_by="larger gap",
    ),
    Event(
        name="rupture",
        functions=("rupture",),
        where=(("resting", 0), ("motion", 1), ("film", 0)),
        words=("rupture",),
        actions=("gap = rupture", "separate"),
        follows="",
        dips=False,
        within_reach=False,
        scale="",
        chosen_by="",
    ),
    Event(
        name="film_edge",
        functions=("film_edge",),
        where=(("resting", 0),),
        words=("film edge",),
        actions=("gap = film edge", "cross film edge"),
        follows="film",
        dips=False,
        within_reach=False,
        scale="",
        chosen_by="",
    ),
    Event(
        name="tangential_edge",
        functions=("tangential_edge",),
        where=(("resting", 0),),
        words=("tangential edge",),
        actions=("gap = tangential edge", "cross tangential edge"),
        follows="shear",
        dips=False,
        within_reach=True,
        scale="",
        chosen_by="",
    ),
    Event(
        name="release",
        functions=("release",),
        where=(("resting", 1),),
        words=("released",),
        actions=("open",),
        follows="",
        dips=True,
        within_reach=False,
        scale="",
        chosen_by="",
    ),
    Event(
        name="half_turn",
        functions=("half_turn",),
        where=(),
        words=("half turn",),
        actions=("cut off",),
        follows="",
        dips=False,
        within_reach=False,
        scale="",
        chosen_by="",
    ),
    Event(
        name="unwinding",
        functions=("unwinding",),
        where=(),
        words=("rotation reverses",),
        actions=("cut off",),
        follows="",
        dips=True,
        within_reach=False,
        scale="",
        chosen_by="",
    ),
)
