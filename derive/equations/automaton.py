"""A collision as a hybrid automaton: modes, events with their guards and effects, rules, ends and report words.

Plain data, which `derive/emit/` writes for the CasADi engine, for the kernel and for the documentation. An event is a
guard (what reaches which target, and where it is watched), a word and a list of actions. The CasADi engine interprets
the table. The kernel's search for events, their effects and their derivatives are emitted from it; written by hand are
the search for a root of a series and what the actions call. That both engines decide alike is tested.
"""

import re
from dataclasses import dataclass

CLOSING, OPENING = -1, 1
APPROACH_PARTS, DEEPEST_PART = 24, 0.01
CREEP = 1e-10


@dataclass(frozen=True)
class Component:
    """A component of the mode.

    Arguments:
        values: pairs of a value and its name.
        void_without: conditions on this component are ignored in structures without this event.
    """

    name: str
    values: tuple[tuple[int, str], ...]
    meaning: str
    void_without: str = ""


COMPONENTS = (
    Component("film", ((1, "inside the film"), (0, "beyond the film")),
              "position of the gap relative to x0; the film acts below x0", void_without="film_edge"),
    Component("shear", ((1, "inside the tangential edge"), (0, "beyond the tangential edge")),
              "position of the gap relative to the reach of the tangential force"),
    Component("motion", ((CLOSING, "closing"), (OPENING, "opening")), "sign of the normal relative velocity"),
    Component("resting", ((0, "moving"), (1, "resting")), "resting: the gap is held in contact"),
    Component("cavitated", ((0, "wetting"), (1, "cavitated")),
              "cavitated: the film exerts no force (a cavitating liquid while opening)"),
    Component("sliding", ((0, "not sliding"), (1, "sliding"), (-1, "sliding back")),
              "with friction, the sign of the slip in resting contact", void_without="slipping"),
    Component("rolling", ((0, "not rolling"), (1, "rolling")),
              "with friction, a resting doublet that does not slip", void_without="slipping"),
)  # fmt: skip


@dataclass(frozen=True)
class Criterion:
    """A rebound criterion.

    Arguments:
        word: its name in reports and of its event function.
        limit: dimensionless group at which it is met: a gap, or a pressure.
        name: of the gap or pressure `limit`, in texts.
        sentence: the reason of a bounce in which it was met first.
        symbol: of its gap, in figures.
        removed_by: a quantity and the value (SI) for which the criterion is never met.
        contact: met at the gap `limit`, with a symbol and a quantity that removes it; otherwise met where the film
            pressure reaches `limit`.
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
        """Reject a contact criterion without a symbol or without a quantity that removes it."""
        if self.contact and not (self.symbol and self.removed_by):
            raise ValueError(f"the rebound criterion {self.word!r} is met at a gap and needs symbol and removed_by")


# The order in which criteria that hold at the start of a closing phase apply: the first causes the rebound.
CRITERIA = (
    Criterion("glass", "glass_number", "glass transition",
              "the film pressure on the axis reaches the glass-transition pressure",
              "rebounded because the liquid reached its glass transition", contact=False),
    Criterion("elastic", "elastic_gap", "elastic length", "the gap is down to the elastic length",
              "rebounded by elastic deformation of the spheres", symbol="x_r",
              removed_by=("youngs_modulus", 1e300)),
    Criterion("rough", "rough_gap", "roughness", "the gap is down to the roughness",
              "rebounded by contact at the surface roughness", symbol="x_b", removed_by=("roughness", 0.0)),
)  # fmt: skip
CONTACTS = tuple(criterion for criterion in CRITERIA if criterion.contact)


@dataclass(frozen=True)
class Word:
    """The name of an event in reports. The position in WORDS is its number in the kernel; criteria come first."""

    word: str
    meaning: str

    @property
    def name(self) -> str:
        return self.word.upper().replace(" ", "_")


WORDS = (
    *(Word(criterion.word, f"rebound: {criterion.meaning}") for criterion in CRITERIA),
    Word("turned", "the normal velocity rises through zero, no rebound criterion met"),
    Word("fell back", "the normal velocity falls through zero"),
    Word("film edge", "the gap passes x0"),
    Word("tangential edge", "the gap passes the reach of the tangential force"),
    Word("rests", "a rebound too weak to open the gap is replaced by resting contact"),
    Word("released", "the normal force on a resting doublet turns outward"),
    Word("rupture", "the bridge ruptures; without a bridge, the films part"),
    Word("rotation reverses", "the strings turn the rotation back"),
    Word("half turn", "the line of centres has turned by pi and the strings cross"),
    Word("rolls", "friction holds the surfaces of a resting doublet together: its slip stays zero"),
    Word("slides", "the surfaces of a resting doublet slide from zero slip: rolling needs more than friction gives"),
)


@dataclass(frozen=True)
class Action:
    """A step of the effect of an event, by name."""

    name: str
    meaning: str


ACTIONS = (
    Action("gap = target", "put the gap on the gap of the event"),
    Action("velocity = 0", "the normal velocity is zero"),
    Action("rebound", "the solids rebound; the rules of a rebound decide the next phase"),
    Action("turn", "closing becomes opening, and opening becomes closing"),
    Action("cross film edge", "inside the film becomes beyond; the tangential edge is crossed as well if it coincides"),
    Action("cross tangential edge", "inside the tangential edge becomes beyond, and beyond becomes inside"),
    Action("open", "the next phase opens from the present gap, at RELEASE_SPEED; on an edge, it is beyond that edge"),
    Action("roll or slide", "rolling if friction can hold the surfaces together, else sliding"),
    Action("slide", "sliding in the direction in which the surfaces are driven past each other"),
    Action("separate", "the collision ends: separated"),
    Action("cut off", "the collision ends: a stick without a certificate"),
)


@dataclass(frozen=True)
class Event:
    """A guard and its effect. The position in EVENTS is the order of precedence among coincident events.

    Arguments:
        functions: event functions of the structures; if several, the first to vanish triggers the event.
        where: mode components and the values for which it is watched.
        words: names under which it may be reported.
        actions: the effect, in order.
        series: what reaches the target, as defined in `events.py`; of several, the first that does.
        target: a gap or an angle that `events.py` defines, or the name of a dimensionless group; zero if empty.
        direction: 1 if the series falls to its target, -1 if it rises to it.
        follows: the direction is multiplied by this component: the sign of the motion or of the slip, or +1 inside and
            -1 beyond.
        bound: by which the kernel excludes the event within a step: "monotonic" (the value at the end; for the gap,
            which is monotonic up to a turn), "terms" (the sum of the magnitudes of all terms but the first) or
            "parabola" (the minimum of the first three terms less the magnitudes of the others).
        structures: features of a structure that has the event, and "not" features of one that has not.
        dips: the function may become negative and positive again within one integration step.
        within_reach: watched only where its gap lies between contact and rupture and is not the film's edge.
        driven: watched only where a tangential force other than that of the dry contact acts, or a declared one may.
        scale: dimensionless group that gives the magnitude of the function; 1 if empty.
        least: constant below which the series is zero at first: its sign there is rounding, and the event happens where
            the series is below minus this constant.
        chosen_by: what selects among the words: "motion" (closing, opening), "larger gap" (the criterion met first),
            "grip" (whether friction holds the surfaces).
    """

    name: str
    functions: tuple[str, ...]
    where: tuple[tuple[str, int], ...]
    words: tuple[str, ...]
    actions: tuple[str, ...]
    series: tuple[str, ...]
    target: str = ""
    direction: int = 1
    follows: str = ""
    bound: str = "parabola"
    structures: tuple[str, ...] = ()
    dips: bool = False
    within_reach: bool = False
    driven: bool = False
    scale: str = ""
    least: str = ""
    chosen_by: str = ""

    @property
    def ends(self) -> bool:
        return self.actions[-1] in ENDS

    @property
    def at_gap(self) -> bool:
        return self.series == ("gap",)


ENDS = ("separate", "cut off")
_MOVING, _RESTING = ("resting", 0), ("resting", 1)
_CLOSING, _OPENING = ("motion", CLOSING), ("motion", OPENING)

# Turning comes first: at zero normal velocity there is no approach, so touching a contact gap is no rebound. Events at
# a gap stand together: the kernel searches for the nearest gap ahead.
EVENTS = (
    Event("turning", ("turning",), (_MOVING,), ("turned", "fell back"), ("velocity = 0", "turn"),
          series=("normal_velocity",), follows="motion", dips=True, chosen_by="motion"),
    Event("glass", ("glass",), (_MOVING, _CLOSING), ("glass",), ("rebound",),
          series=("glass_clearance",), dips=True, scale="glass_number"),
    Event("contact", tuple(criterion.word for criterion in CONTACTS), (_MOVING, _CLOSING),
          tuple(criterion.word for criterion in CONTACTS), ("gap = target", "rebound"),
          series=("gap",), target="contact", bound="monotonic", chosen_by="larger gap"),
    Event("rupture", ("rupture",), (_MOVING, _OPENING, ("film", 0)), ("rupture",), ("gap = target", "separate"),
          series=("gap",), target="rupture", direction=-1, bound="monotonic"),
    Event("film_edge", ("film_edge",), (_MOVING,), ("film edge",), ("gap = target", "cross film edge"),
          series=("gap",), target="film edge", direction=-1, follows="film", bound="monotonic",
          structures=("bridge", "not spread")),
    Event("tangential_edge", ("tangential_edge",), (_MOVING,), ("tangential edge",),
          ("gap = target", "cross tangential edge"), series=("gap",), target="tangential edge", direction=-1,
          follows="shear", bound="monotonic", structures=("oblique",), within_reach=True),
    Event("release", ("release",), (_RESTING,), ("released",), ("open",),  # beside a wall no force changes at rest
          series=("acceleration",), direction=-1, bound="terms", structures=("oblique", "not wall"), dips=True,
          driven=True),
    Event("slipping", ("slipping",), (_RESTING, ("rolling", 0)), ("rolls", "slides"), ("roll or slide",),
          series=("slip",), follows="sliding", structures=("friction", "not space"), dips=True, least="NO_SLIP",
          chosen_by="grip"),
    Event("rolling", ("rolling",), (_RESTING, ("rolling", 1)), ("slides",), ("slide",),
          series=("grip_backward", "grip_forward"), structures=("friction", "not space"), dips=True),
    Event("half_turn", ("half_turn",), (), ("half turn",), ("cut off",),
          series=("rotation",), target="half turn", direction=-1, bound="terms", structures=("oblique", "strings")),
    Event("unwinding", ("unwinding",), (), ("rotation reverses",), ("cut off",),
          series=("orbital_momentum",), bound="terms", structures=("oblique", "strings"), dips=True),
)  # fmt: skip


@dataclass(frozen=True)
class Rule:
    """A decision that is not taken at a zero of an event function. `words` are reported if the rule applies.

    Arguments:
        tests: its condition as expressions, each with a name and its meaning: both engines have functions of that name.
    """

    name: str
    condition: str
    effect: str
    words: tuple[str, ...] = ()
    tests: tuple[tuple[str, str, str], ...] = ()


RULES = (
    Rule("entry", "a phase starts closing and not resting, and a rebound criterion already holds",
         "a rebound by the first of these criteria, in their order", tuple(criterion.word for criterion in CRITERIA)),
    Rule("parted", "a rebound at a gap not below the rupture gap",
         "the collision ends: separated. Without a bridge this is a criterion that holds at initial contact",
         ("rupture",), (("is_parted", "the gap is not below the rupture gap", "gap >= rupture_gap"),)),
    Rule("rest", "after a rebound the net force points inward, and the rebound would rise, without drag, by less than "
         "the relative tolerance times the gap",
         "the gap is held in contact; the energy of the rebound is booked as dry contact", ("rests",),
         (("is_too_weak", "a rebound does not open the gap",
           "inward_force > 0 and normal_velocity*normal_velocity/(2*inward_force) < rtol*gap"),)),
    Rule("friction", "a rebound of a scene with friction, by solid contact or, if asked for, by glass",
         "a tangential impulse that reverses the slip times contact_tangential_restitution (it sticks), or Coulomb's "
         "limit if that is less (it slides). If the doublet comes to rest, the limit is that of the approach alone"),
    Rule("grip", "a rebound of a scene with friction rests",
         "it slides; if it has no slip (less than NO_SLIP) and friction can hold the surfaces, it rolls. In space "
         "it slides in the direction of the slip, which may turn, and rolls where that is less than CREEP", ("rolls",),
         (("has_no_slip", "the surfaces do not slip", "abs(slip) < NO_SLIP"),
          ("friction_holds", "friction can hold the surfaces together", "abs(holding) <= limit"))),
    Rule("parting", "the doublet ruptures at a normal velocity below LEAST_PARTING", "no outcome is decided",
         tests=(("is_within_rounding", "rounding of the angular momentum could have opened the doublet",
                 "normal_velocity < LEAST_PARTING*obliquity*sqrt(aspect)"),)),
    Rule("opening", "the doublet opens or rests on the edge of the film or of the tangential force",
         "it is beyond that edge", tests=(("is_on_edge", "the gap is on an edge", "gap == edge"),)),
    Rule("obliqueness", "the centrifugal force exceeds MOST_OBLIQUE times v0^2/x0", "the collision is refused",
         tests=(("is_too_oblique", "the centrifugal force reverses the motion within rounding",
                 "obliquity*obliquity*aspect/16 > MOST_OBLIQUE"),)),
)  # fmt: skip


def arguments(test: str) -> tuple[str, ...]:
    """The quantities in an expression of a rule, in order of appearance; constants are upper case."""
    return tuple(dict.fromkeys(re.findall(r"\b(?!and\b|or\b|abs\b|sqrt\b)[a-z]\w*", test)))


@dataclass(frozen=True)
class Outcome:
    """A possible outcome of a collision. The position in OUTCOMES is its number in all results."""

    word: str
    name: str
    condition: str


OUTCOMES = (
    Outcome("stick", "STICK", "a certificate excludes separation, or the collision is cut off"),
    Outcome("stick-rotate-separate", "ROTATE", "separated, and no rebound criterion was met"),
    Outcome("bounce", "BOUNCE", "separated after a rebound criterion was met"),
)


@dataclass(frozen=True)
class Status:
    """A status returned by the kernel. The position in STATUSES is its number.

    Arguments:
        answers: the outcome is valid. These statuses come first.
    """

    name: str
    meaning: str
    answers: bool = False


STATUSES = (
    Status("DECIDED", "the outcome is decided", True),
    Status("PROVED_AT_TOUCH", "a stick with a certificate at initial contact", True),
    Status("NO_BUDGET", "the budget of steps is exhausted"),
    Status("NOT_FINITE", "the state is not finite"),
    Status("CHATTER", "the budget of steps is exhausted after more than CHATTER_PHASES phases"),
    Status("TOO_OBLIQUE", "the centrifugal force is beyond MOST_OBLIQUE"),
    Status("ESCAPED", "a stick that is proved separates when it is followed on: a defect"),
    Status("WITHIN_ROUNDING", "the doublet separates at less than LEAST_PARTING"),
    Status("UNDECLARED", "a declared event creates kinetic energy that it does not declare"),
)


@dataclass(frozen=True)
class Purpose:
    """The part of a trajectory that the kernel integrates. The position in PURPOSES is its number."""

    name: str
    meaning: str


PURPOSES = (
    Purpose("WHOLE", "to the end of the collision"),
    Purpose("APPROACH", "to the first turning point or rebound; without the glass criterion and certificates"),
    Purpose("ESCAPE", "until the doublet separates, falls back or rests; with certificates only while it approaches"),
)


@dataclass(frozen=True)
class Constant:
    """A constant of the rules."""

    name: str
    value: float | int
    meaning: str


CONSTANTS = (
    Constant("RELEASE_SPEED", 1e-12, "in v0: with it a resting doublet is released. At rest, where no force is left, "
             "rounding would decide in which direction it starts"),
    Constant("MOST_OBLIQUE", 1e9, "in v0^2/x0: a larger centrifugal force reverses the motion within rounding of x0"),
    Constant("LOOSEST", 1e-6, "largest relative tolerance; a larger one is reduced to it, as certificates need it"),
    Constant("SAFETY", 30.0, "least margin of a certificate in tolerances of the largest energy: errors of the fastest "
             "motion persist in the energy, and errors of many steps add up"),
    Constant("STILL", 1e-9, "in v0: a slower motion is at a turning point"),
    Constant("NO_SLIP", 1e-12, "in units of the tangential velocity: a smaller slip in resting contact is none"),
    Constant(
        "CREEP", CREEP,
        "the same in space, where friction is less by s/sqrt(s^2 + CREEP^2) at the slip s: rolling surfaces creep",
    ),
    Constant("CHATTER_PHASES", 100, "number of phases beyond which a trajectory is treated as chatter"),
    Constant("CYCLES", 20, "successive maxima of the gap, none above the one before, that count as chatter"),
    Constant("FILM_DEPTHS", 16, "gaps in geometric sequence down to contact at which the film certificate bounds the "
             "pressure"),
    Constant("ATTRACTED_FILM_DEPTHS", 48, "the same with an attraction, which grows at small gaps"),
    Constant("APPROACH_PARTS", APPROACH_PARTS, "parts of the film, in geometric sequence, of the approach certificate"),
    Constant("DEEPEST_PART", DEEPEST_PART, "where they end, over x0, unless solid contact is above"),
    Constant("TUMBLES", 1e-3, "in space: a doublet tumbles as one body where all other motion has less than this part "
             "of the energy of rigid rotation"),
    Constant("TURNLESS", 16 * 2.0**-52, "in space: a component that is a smaller part of the largest vector of its "
             "kind is rounding, and where all are, nothing rotates"),
    Constant("LEAST_SLIP", 1e-12, "in the scale of tangential speeds: below it at initial contact no ratio of slips is "
             "formed"),
    Constant("LEAST_PARTING", 2.0**-46, "in the scale of tangential speeds times sqrt(x0/a): a slower separation is "
             "what rounding of the angular momentum alone sets off, and decides nothing"),
    Constant("LEAST_DEPTH", 1e-40, "least gap, relative to the present one, of the film certificate without contact"),
)  # fmt: skip
