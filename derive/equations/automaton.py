"""A collision as a hybrid automaton: modes, events with their guards and effects, rules, ends and report words.

Plain data, which `derive/emit/` writes for the CasADi engine, for the kernel and for the documentation. An event is a
guard (functions of the emitted structures, where they are watched), a word and a list of actions. The CasADi engine
interprets all of it. In the kernel numbers, words and effects are emitted; its guards are written by hand in `events.h`
and its rules in `transitions.h`. Tests hold them to this table: where each event is watched, which of coincident ones
counts, and that both engines decide alike.
"""

from __future__ import annotations

from dataclasses import dataclass

CLOSING, OPENING = -1, 1


@dataclass(frozen=True)
class Component:
    """One part of the mode.

    Arguments:
        values: pairs of a value and its name.
        void_without: event without which conditions on this component are void, since the structure does not have it.
    """

    name: str
    values: tuple[tuple[int, str], ...]
    meaning: str
    void_without: str = ""


COMPONENTS = (
    Component("film", ((1, "inside the film"), (0, "beyond the film")),
              "whether the gap is below x0, where the film acts", void_without="film_edge"),
    Component("shear", ((1, "inside the tangential edge"), (0, "beyond the tangential edge")),
              "whether the gap is below the reach of the tangential force"),
    Component("motion", ((CLOSING, "closing"), (OPENING, "opening")), "sign of the normal relative velocity"),
    Component("resting", ((0, "moving"), (1, "resting")), "whether the gap is held in contact"),
    Component("cavitated", ((0, "wetting"), (1, "cavitated")),
              "whether the film cavitates and exerts no force: a cavitating liquid while opening"),
)  # fmt: skip


@dataclass(frozen=True)
class Criterion:
    """A rebound criterion: where it is met, and what is said of it.

    Arguments:
        word: what the report calls it; its event function has the same name.
        limit: dimensionless group at which it is met: a gap, or a pressure.
        name: of what it is met at, in texts.
        sentence: why a collision that met it first has bounced.
        symbol: of its gap, in pictures.
        removed_by: quantity and value (SI) with which it is never met.
        contact: it is met at a gap, that of its limit, and then has a symbol and is removed by a quantity; else it is
            met where the film's pressure reaches the limit.
    """

    word: str
    limit: str
    name: str
    meaning: str
    sentence: str
    symbol: str = ""
    removed_by: tuple[str, float] | None = None
    contact: bool = True

    def __post_init__(self) -> None:
        """Refuse a gap that pictures cannot name or that no quantity removes."""
        if self.contact and not (self.symbol and self.removed_by):
            raise ValueError(f"the rebound criterion {self.word!r} is met at a gap and needs symbol and removed_by")


# In the order in which those that already hold where a closing phase starts apply: the first reverses the motion.
CRITERIA = (
    Criterion("glass", "glass_number", "glass transition",
              "the film pressure on the axis reaches the glass-transition pressure",
              "rebound by the glass criterion, the liquid's own pressure", contact=False),
    Criterion("elastic", "elastic_gap", "elastic length", "the gap is down to the elastic length",
              "rebound by the elastic criterion, the spheres' deformation", symbol="x_r",
              removed_by=("youngs_modulus", 1e300)),
    Criterion("rough", "rough_gap", "roughness", "the gap is down to the roughness",
              "rebound by contact of the surfaces' roughness", symbol="x_b", removed_by=("roughness", 0.0)),
)  # fmt: skip
CONTACTS = tuple(each for each in CRITERIA if each.contact)


@dataclass(frozen=True)
class Word:
    """What the report calls an event. The position in WORDS is its number in the kernel; criteria come first."""

    word: str
    meaning: str

    @property
    def name(self) -> str:
        """Its name in an enumeration."""
        return self.word.upper().replace(" ", "_")


WORDS = (
    *(Word(each.word, f"rebound: {each.meaning}") for each in CRITERIA),
    Word("turned", "the normal velocity rises through zero, no rebound criterion met"),
    Word("fell back", "the normal velocity falls through zero"),
    Word("film edge", "the gap passes x0"),
    Word("tangential edge", "the gap passes the reach of the tangential force"),
    Word("rests", "a rebound too weak to leave is taken for resting contact"),
    Word("released", "the normal force on a resting doublet turns outward"),
    Word("rupture", "the bridge ruptures; without a bridge, the films part"),
    Word("rotation reverses", "the strings turn the rotation back"),
    Word("half turn", "the line of centres has turned by pi and the strings cross"),
)  # fmt: skip


@dataclass(frozen=True)
class Action:
    """A step of an event's effect, in symbols."""

    name: str
    meaning: str


ACTIONS = (
    Action("gap = contact", "put the gap on the largest at which a criterion is met"),
    Action("gap = film edge", "put the gap on x0"),
    Action("gap = tangential edge", "put the gap on the reach of the tangential force"),
    Action("gap = rupture", "put the gap on the rupture gap"),
    Action("velocity = 0", "the normal velocity is zero"),
    Action("rebound", "the solids reverse the motion; the rules of a rebound decide what follows"),
    Action("turn", "closing becomes opening, and opening closing"),
    Action("cross film edge", "inside becomes beyond; the tangential edge with it where both are one"),
    Action("cross tangential edge", "inside becomes beyond, and beyond inside"),
    Action("open", "the doublet opens from where it is; on an edge, beyond it at once"),
    Action("separate", "the collision ends: separated"),
    Action("cut off", "the collision ends: a stick that is not proved"),
)  # fmt: skip


@dataclass(frozen=True)
class Event:
    """A guard and its effect. The position in EVENTS is the order of precedence among coincident events.

    Arguments:
        functions: event functions of the structures; of several, the first to vanish counts.
        where: components and values for which it is watched.
        follows: the guard is its function times this component: the sign of the motion, or +1 inside and -1 beyond.
        dips: the function may fall below zero and return within a step of an integrator.
        within_reach: watched only where its gap lies between contact and rupture and is not the film's edge.
        scale: dimensionless group that is the size of the function; 1 if empty.
        words: what may be reported.
        chosen_by: what selects the word: "motion" (closing, opening), "larger gap" (the criterion met first).
        actions: the effect, in order.
    """

    name: str
    functions: tuple[str, ...]
    where: tuple[tuple[str, int], ...]
    words: tuple[str, ...]
    actions: tuple[str, ...]
    follows: str = ""
    dips: bool = False
    within_reach: bool = False
    scale: str = ""
    chosen_by: str = ""

    @property
    def ends(self) -> bool:
        """Whether the collision is over with it."""
        return self.actions[-1] in ENDS

    @property
    def rebounds(self) -> bool:
        """Whether the doublet rebounds at it."""
        return self.actions[-1] == "rebound"


ENDS = ("separate", "cut off")
_MOVING, _RESTING = ("resting", 0), ("resting", 1)
_CLOSING, _OPENING = ("motion", CLOSING), ("motion", OPENING)

# A turn comes first: at zero velocity the solids have nothing to give back, so a touch without speed is no rebound.
EVENTS = (
    Event("turning", ("turning",), (_MOVING,), ("turned", "fell back"), ("velocity = 0", "turn"),
          follows="motion", dips=True, chosen_by="motion"),
    Event("glass", ("glass",), (_MOVING, _CLOSING), ("glass",), ("rebound",), dips=True, scale="glass_number"),
    Event("contact", tuple(each.word for each in CONTACTS), (_MOVING, _CLOSING),
          tuple(each.word for each in CONTACTS), ("gap = contact", "rebound"), chosen_by="larger gap"),
    Event("rupture", ("rupture",), (_MOVING, _OPENING, ("film", 0)), ("rupture",), ("gap = rupture", "separate")),
    Event("film_edge", ("film_edge",), (_MOVING,), ("film edge",), ("gap = film edge", "cross film edge"),
          follows="film"),
    Event("tangential_edge", ("tangential_edge",), (_MOVING,), ("tangential edge",),
          ("gap = tangential edge", "cross tangential edge"), follows="shear", within_reach=True),
    Event("release", ("release",), (_RESTING,), ("released",), ("open",), dips=True),
    Event("half_turn", ("half_turn",), (), ("half turn",), ("cut off",)),
    Event("unwinding", ("unwinding",), (), ("rotation reverses",), ("cut off",), dips=True),
)  # fmt: skip


@dataclass(frozen=True)
class Rule:
    """What is decided where no function vanishes. `words` are reported if it applies."""

    name: str
    condition: str
    effect: str
    words: tuple[str, ...] = ()


RULES = (
    Rule("entry", "a phase starts closing and not resting, and a rebound criterion already holds",
         "the first of the criteria, in their order, reverses the motion", tuple(each.word for each in CRITERIA)),
    Rule("parted", "the solids have reversed the motion at a gap not below the rupture gap",
         "the collision ends: separated. Without a bridge this is a criterion that holds at initial contact",
         ("rupture",)),
    Rule("rest", "after a rebound the net force points inward, and the rebound is slower than REST_SPEED or, "
         "without drag, would rise by less than the relative tolerance times the gap",
         "the gap is held in contact; the energy of the rebound is booked as dry contact", ("rests",)),
    Rule("opening", "the doublet opens on the edge of the film or of the tangential force", "it is beyond that edge"),
    Rule("obliqueness", "the centrifugal force exceeds MOST_OBLIQUE times v0^2/x0", "the collision is refused"),
)  # fmt: skip


@dataclass(frozen=True)
class Outcome:
    """How a collision can end. The position in OUTCOMES is its number everywhere."""

    word: str
    name: str
    condition: str


OUTCOMES = (
    Outcome("stick", "STICK", "it is proved that the two never separate, or the collision is cut off"),
    Outcome("stick-rotate-separate", "ROTATE", "separated, and no rebound criterion was met"),
    Outcome("bounce", "BOUNCE", "separated after a rebound criterion was met"),
)  # fmt: skip


@dataclass(frozen=True)
class Status:
    """What the kernel says of a collision. The position in STATUSES is its number.

    Arguments:
        answers: the outcome stands; else the collision is handed over. Those that answer come first.
    """

    name: str
    meaning: str
    answers: bool = False


STATUSES = (
    Status("DECIDED", "the outcome is decided", True),
    Status("PROVED_AT_TOUCH", "a stick that is proved at initial contact", True),
    Status("NO_BUDGET", "the steps are spent"),
    Status("NOT_FINITE", "the state is not finite"),
    Status("CHATTER", "the steps are spent in more than CHATTER_PHASES phases"),
    Status("TOO_OBLIQUE", "the centrifugal force is beyond MOST_OBLIQUE"),
)  # fmt: skip


@dataclass(frozen=True)
class Purpose:
    """What the kernel integrates a collision for. The position in PURPOSES is its number."""

    name: str
    meaning: str


PURPOSES = (
    Purpose("WHOLE", "to its end"),
    Purpose("APPROACH", "until it turns or is reversed; without the glass criterion, and nothing is proved"),
    Purpose("ESCAPE", "until it separates, falls back or rests; proved a stick only while it approaches"),
)  # fmt: skip


@dataclass(frozen=True)
class Constant:
    """A number in the rules."""

    name: str
    value: float | int
    meaning: str


CONSTANTS = (
    Constant("REST_SPEED", 1e-9, "of v0: a slower rebound into an inward force rests"),
    Constant("MOST_OBLIQUE", 1e9, "of v0^2/x0: a larger centrifugal force turns the motion within rounding of x0"),
    Constant("LOOSEST", 1e-6, "relative tolerance: a looser one is tightened to it, or sticks stay unproved"),
    Constant("SAFETY", 30.0, "a proof holds by more than this many times the tolerance of the largest energy: an "
             "error made when the motion was fastest stays in it, and errors of many steps add up"),
    Constant("CHATTER_PHASES", 100, "phases: more are rebound after rebound, and no approach and escape"),
    Constant("FILM_DEPTHS", 16, "steps of equal ratio from the gap to contact, at each of which the film certificate "
             "bounds the pressure"),
    Constant("ATTRACTED_FILM_DEPTHS", 48, "the same beside an attraction, which a small gap makes large"),
    Constant("LEAST_DEPTH", 1e-40, "of the gap: where no contact is met, the film certificate looks no deeper"),
)  # fmt: skip
