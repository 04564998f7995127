# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Automaton sha256 74c3db73d2eb50ddc059f841912c1d34d2b981ebebe0f1c5a6d9d8d7681dd77f
"""A collision as a hybrid automaton: events, their guards and effects, rules, words, outcomes."""

from __future__ import annotations

from enum import IntEnum
from math import sqrt
from typing import Any, NamedTuple

CLOSING, OPENING = -1, 1

STICK = "stick"  # a certificate excludes separation, or the collision is cut off
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
    RESTS = 7  # a rebound too weak to open the gap is replaced by resting contact
    RELEASED = 8  # the normal force on a resting doublet turns outward
    RUPTURE = 9  # the bridge ruptures; without a bridge, the films part
    ROTATION_REVERSES = 10  # the strings turn the rotation back
    HALF_TURN = 11  # the line of centres has turned by pi and the strings cross
    ROLLS = 12  # friction holds the surfaces of a resting doublet together: its slip stays zero
    SLIDES = 13  # the surfaces of a resting doublet slide from zero slip: rolling needs more than friction gives

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
    "rolls",
    "slides",
)


class Criterion(NamedTuple):
    """A rebound criterion; `derive/equations/automaton.py` explains the fields."""

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
        sentence="rebounded because the liquid reached its glass transition",
    ),
    "elastic": Criterion(
        limit="elastic_gap",
        name="elastic length",
        contact=True,
        symbol="x_r",
        removed_by=("youngs_modulus", 1e+300),
        sentence="rebounded by elastic deformation of the spheres",
    ),
    "rough": Criterion(
        limit="rough_gap",
        name="roughness",
        contact=True,
        symbol="x_b",
        removed_by=("roughness", 0.0),
        sentence="rebounded by contact at the surface roughness",
    ),
}


class Status(IntEnum):
    """Status returned by the kernel; up to LAST_ANSWER the outcome is valid."""

    DECIDED = 0  # the outcome is decided
    PROVED_AT_TOUCH = 1  # a stick with a certificate at initial contact
    NO_BUDGET = 2  # the budget of steps is exhausted
    NOT_FINITE = 3  # the state is not finite
    CHATTER = 4  # the budget of steps is exhausted after more than CHATTER_PHASES phases
    TOO_OBLIQUE = 5  # the centrifugal force is beyond MOST_OBLIQUE
    ESCAPED = 6  # a stick that is proved separates when it is followed on: a defect
    WITHIN_ROUNDING = 7  # the doublet separates at less than LEAST_PARTING
    UNDECLARED = 8  # a declared event creates kinetic energy that it does not declare


LAST_ANSWER = Status.PROVED_AT_TOUCH


class Purpose(IntEnum):
    """Part of a trajectory that the kernel integrates."""

    WHOLE = 0  # to the end of the collision
    APPROACH = 1  # to the first turning point or rebound; without the glass criterion and certificates
    ESCAPE = 2  # until the doublet separates, falls back or rests; with certificates only while it approaches


RELEASE_SPEED = 1e-12  # in v0: with it a resting doublet is released. At rest, where no force is left, rounding would decide in which direction it starts
MOST_OBLIQUE = 1000000000.0  # in v0^2/x0: a larger centrifugal force reverses the motion within rounding of x0
LOOSEST = 1e-06  # largest relative tolerance; a larger one is reduced to it, as certificates need it
SAFETY = 30.0  # least margin of a certificate in tolerances of the largest energy: errors of the fastest motion persist in the energy, and errors of many steps add up
STILL = 1e-09  # in v0: a slower motion is at a turning point
NO_SLIP = 1e-12  # in units of the tangential velocity: a smaller slip in resting contact is none
CREEP = 1e-10  # the same in space, where friction is less by s/sqrt(s^2 + CREEP^2) at the slip s: rolling surfaces creep
CHATTER_PHASES = 100  # number of phases beyond which a trajectory is treated as chatter
CYCLES = 20  # successive maxima of the gap, none above the one before, that count as chatter
FILM_DEPTHS = 16  # gaps in geometric sequence down to contact at which the film certificate bounds the pressure
ATTRACTED_FILM_DEPTHS = 48  # the same with an attraction, which grows at small gaps
APPROACH_PARTS = 24  # parts of the film, in geometric sequence, of the approach certificate
DEEPEST_PART = 0.01  # where they end, over x0, unless solid contact is above
TUMBLES = 0.001  # in space: a doublet tumbles as one body where all other motion has less than this part of the energy of rigid rotation
TURNLESS = 3.552713678800501e-15  # in space: a component that is a smaller part of the largest vector of its kind is rounding, and where all are, nothing rotates
LEAST_SLIP = 1e-12  # in the scale of tangential speeds: below it at initial contact no ratio of slips is formed
LEAST_PARTING = 1.4210854715202004e-14  # in the scale of tangential speeds times sqrt(x0/a): a slower separation is what rounding of the angular momentum alone sets off, and decides nothing
LEAST_DEPTH = 1e-40  # least gap, relative to the present one, of the film certificate without contact


def is_parted(gap: float, rupture_gap: float) -> bool:
    """True if the gap is not below the rupture gap."""
    return gap >= rupture_gap


def is_too_weak(inward_force: float, normal_velocity: float, rtol: float, gap: float) -> bool:
    """True if a rebound does not open the gap."""
    return inward_force > 0 and normal_velocity*normal_velocity/(2*inward_force) < rtol*gap


def has_no_slip(slip: float) -> bool:
    """True if the surfaces do not slip."""
    return abs(slip) < NO_SLIP


def friction_holds(holding: float, limit: float) -> bool:
    """True if friction can hold the surfaces together."""
    return abs(holding) <= limit


def is_within_rounding(normal_velocity: float, obliquity: float, aspect: float) -> bool:
    """True if rounding of the angular momentum could have opened the doublet."""
    return normal_velocity < LEAST_PARTING*obliquity*sqrt(aspect)


def is_on_edge(gap: float, edge: float) -> bool:
    """True if the gap is on an edge."""
    return gap == edge


def is_too_oblique(obliquity: float, aspect: float) -> bool:
    """True if the centrifugal force reverses the motion within rounding."""
    return obliquity*obliquity*aspect/16 > MOST_OBLIQUE


class Event(NamedTuple):
    """An event: its guard and its effect; docs/reference/events.md explains them."""

    name: str
    functions: tuple[str, ...]
    where: tuple[tuple[str, int], ...]
    words: tuple[str, ...]
    actions: tuple[str, ...]
    target: str
    follows: str
    dips: bool
    within_reach: bool
    driven: bool
    scale: str
    chosen_by: str


# Component of the mode -> event; conditions on it are ignored in structures without that event.
VOID_WITHOUT = {
    "film": "film_edge",
    "sliding": "slipping",
    "rolling": "slipping",
}

ENDS = ("separate", "cut off")  # actions that end a collision

EVENTS = (  # in order of precedence among coincident ones
    Event(
        name="turning",
        functions=("turning",),
        where=(("resting", 0),),
        words=("turned", "fell back"),
        actions=("velocity = 0", "turn"),
        target="",
        follows="motion",
        dips=True,
        within_reach=False,
        driven=False,
        scale="",
        chosen_by="motion",
    ),
    Event(
        name="glass",
        functions=("glass",),
        where=(("resting", 0), ("motion", -1)),
        words=("glass",),
        actions=("rebound",),
        target="",
        follows="",
        dips=True,
        within_reach=False,
        driven=False,
        scale="glass_number",
        chosen_by="",
    ),
    Event(
        name="contact",
        functions=("elastic", "rough"),
        where=(("resting", 0), ("motion", -1)),
        words=("elastic", "rough"),
        actions=("gap = target", "rebound"),
        target="contact",
        follows="",
        dips=False,
        within_reach=False,
        driven=False,
        scale="",
        chosen_by="larger gap",
    ),
    Event(
        name="rupture",
        functions=("rupture",),
        where=(("resting", 0), ("motion", 1), ("film", 0)),
        words=("rupture",),
        actions=("gap = target", "separate"),
        target="rupture",
        follows="",
        dips=False,
        within_reach=False,
        driven=False,
        scale="",
        chosen_by="",
    ),
    Event(
        name="film_edge",
        functions=("film_edge",),
        where=(("resting", 0),),
        words=("film edge",),
        actions=("gap = target", "cross film edge"),
        target="film edge",
        follows="film",
        dips=False,
        within_reach=False,
        driven=False,
        scale="",
        chosen_by="",
    ),
    Event(
        name="tangential_edge",
        functions=("tangential_edge",),
        where=(("resting", 0),),
        words=("tangential edge",),
        actions=("gap = target", "cross tangential edge"),
        target="tangential edge",
        follows="shear",
        dips=False,
        within_reach=True,
        driven=False,
        scale="",
        chosen_by="",
    ),
    Event(
        name="release",
        functions=("release",),
        where=(("resting", 1),),
        words=("released",),
        actions=("open",),
        target="",
        follows="",
        dips=True,
        within_reach=False,
        driven=True,
        scale="",
        chosen_by="",
    ),
    Event(
        name="slipping",
        functions=("slipping",),
        where=(("resting", 1), ("rolling", 0)),
        words=("rolls", "slides"),
        actions=("roll or slide",),
        target="",
        follows="sliding",
        dips=True,
        within_reach=False,
        driven=False,
        scale="",
        chosen_by="grip",
    ),
    Event(
        name="rolling",
        functions=("rolling",),
        where=(("resting", 1), ("rolling", 1)),
        words=("slides",),
        actions=("slide",),
        target="",
        follows="",
        dips=True,
        within_reach=False,
        driven=False,
        scale="",
        chosen_by="",
    ),
    Event(
        name="half_turn",
        functions=("half_turn",),
        where=(),
        words=("half turn",),
        actions=("cut off",),
        target="half turn",
        follows="",
        dips=False,
        within_reach=False,
        driven=False,
        scale="",
        chosen_by="",
    ),
    Event(
        name="unwinding",
        functions=("unwinding",),
        where=(),
        words=("rotation reverses",),
        actions=("cut off",),
        target="",
        follows="",
        dips=True,
        within_reach=False,
        driven=False,
        scale="",
        chosen_by="",
    ),
)
