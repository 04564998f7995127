r"""A user's model: one small Python file that declares laws, and the quantities that they need, over the vocabulary.

    from wetdoublet.derive.user import *

    stress = quantity("yield_stress", r"\tau_y", unit="Pa", default="10 Pa", bounds=">= 0")
    law("bridge", "mine", force=pi * R * sigma * 2 * cos(phi) + 4 * pi * a**2 * stress, source="...")

A law fills a slot of the library's (`film`, `shear`, `arm`, `glass`, `bridge`, `strings`, ...). Its functions are given
as they are in SI, or dimensionless in the slot's own arguments; `declared` reads such a file.
"""

import re
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from typing import Any

import sympy as sp

from ..physics.law import RANGES, Law, Range
from ..physics.references import Reference
from ..physics.slots import SLOTS, places
from ..physics.terms import VELOCITIES
from ..vocabulary.allowed_values import Bounds, BoundsError
from ..vocabulary.dimensions import (
    ENERGY,
    FORCE,
    LENGTH,
    ONE,
    Dimension,
    DimensionError,
    UnitError,
    dimension_of,
    dimension_of_unit,
)
from ..vocabulary.quantities import DIMENSIONS, VOCABULARY, omega, u, x, xi
from ..vocabulary.quantities import t as time
from . import own_events
from .kinks import guarded
from .names import EMITTED, taken

_LAW_NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
_BIBTEX = re.compile(r"\s*@\w+\s*\{[^{},]+,.*\}\s*", re.S)
_NAME = re.compile(r"[a-z][a-z0-9_]*")


class ModelFileError(ValueError):
    """An error in a model file: field, value, what is accepted, and the problem in words."""

    def __init__(self, name: str, value: object, accepted: str, problem: str = "is not accepted") -> None:
        super().__init__(f"{name}: {value!r} {problem}; accepted: {accepted}")
        self.field, self.value, self.accepted, self.problem = name, value, accepted, problem


@dataclass(frozen=True)
class Declared:
    """A quantity declared by a model; `over` is the monomial that makes it dimensionless (None: to be determined)."""

    symbol: sp.Symbol
    latex: str
    unit: str
    dimension: Dimension
    default: str | float | None
    bounds: Bounds
    meaning: str
    over: sp.Expr | None
    group: str

    @property
    def name(self) -> str:
        return str(self.symbol.name)


@dataclass(frozen=True)
class Intermediate:
    """A named part of an expression, declared with `let`."""

    symbol: sp.Symbol
    expression: sp.Expr
    latex: str


Source = str | Reference | tuple[Reference, ...]


_PUBLICATION = 'authors as ("Family, Initials", ...), the year as a whole number, all else as text'


def published(source: Source, remark: str = "") -> tuple[Any, tuple[Reference, ...]]:
    """A source in words, and its publications."""
    named = source if isinstance(source, tuple) else (source,)
    publications = tuple(item for item in named if isinstance(item, Reference))
    if publications != named:
        return source + remark if isinstance(source, str) else source, ()  # what is no text is refused as one
    for work in publications:
        texts = [work.key, work.title, work.journal, work.abbreviated, work.volume, work.pages, work.doi]
        authors = work.authors if isinstance(work.authors, tuple) and work.authors else (None,)
        if not all(isinstance(text, str) for text in (*texts, *authors)) or not isinstance(work.year, int):
            raise ModelFileError("source", work, _PUBLICATION, "has a part of another kind")
    return "; ".join(item.short for item in publications) + remark, publications


@dataclass(frozen=True)
class Formula:
    """An expression of a law that has a text or publications of its own, as `Formula(..., source=...)`.

    Arguments:
        expression: in SI or dimensionless.
        doc: what it is, if not what the slot says.
        source: its origin, if not that of the law: text, or publications.
        remark: what is said after them.
    """

    expression: sp.Expr
    doc: str = ""
    source: Source = ""
    remark: str = ""


@dataclass(frozen=True)
class Proposed:
    """A law as declared in the file, without its functions, and these by name, in SI or dimensionless."""

    law: Law
    functions: Mapping[str, Formula]
    accept: tuple[str, ...]
    bibtex: str
    falls: bool


@dataclass(frozen=True)
class Criterion:
    """A rebound criterion as declared: the gap in SI at which it is met, and its group, that gap over x0."""

    name: str
    gap: sp.Expr
    group: sp.Symbol
    meaning: str
    source: str

    @property
    def word(self) -> str:
        return self.name.replace("_", " ")


@dataclass
class Declarations:
    """Everything that a file declares, in order.

    Arguments:
        taken: names of laws by slot that are the library's.
        library: the file is one of the library, whose names its emitted text has.
    """

    taken: Mapping[str, Collection[str]] = field(default_factory=dict)
    library: bool = False

    quantities: dict[str, Declared] = field(default_factory=dict)
    intermediates: dict[str, Intermediate] = field(default_factory=dict)
    laws: dict[tuple[str, str], Proposed] = field(default_factory=dict)
    events: dict[str, own_events.Proposed] = field(default_factory=dict)
    positive: list[sp.Expr] = field(default_factory=list)
    energies: list[sp.Expr] = field(default_factory=list)
    forces: list[tuple[str, sp.Expr]] = field(default_factory=list)
    criteria: dict[str, Criterion] = field(default_factory=dict)


_here = ContextVar("declarations", default=Declarations())  # noqa: B039 -- of a model file that is run directly


def _declarations() -> Declarations:
    return _here.get()


@contextmanager
def collecting(taken: Mapping[str, Collection[str]] | None = None, library: bool = False) -> Iterator[Declarations]:
    """Collect the declarations made inside the block.

    Arguments:
        taken: names of laws by slot that none may have.
        library: of a file of the library.
    """
    token = _here.set(Declarations(taken or {}, library))
    try:
        yield _here.get()
    finally:
        _here.reset(token)


def quantity(
    name: str,
    latex: str = "",
    *,
    unit: str = "1",
    default: str | float | None = None,
    bounds: str = "> 0",
    meaning: str = "",
    over: sp.Expr | None = None,
    group: str = "",
) -> sp.Symbol:
    """Declare a quantity of the model; scenes give its value in their `[custom]` table.

    Arguments:
        name: its name in scene files and in emitted code.
        latex: its symbol in print; by default the name, upright.
        unit: coherent SI, as "Pa", "N/m", "kg m^2/s"; "1" for a plain number. One that is declared before may stand as
            an exponent, as in "Pa s^index".
        default: value with unit for scenes that give none, as "10 Pa"; None: scenes must give one.
        bounds: allowed values, in `unit`: ">", ">=", "<" or "<=" and a number, two of them joined by "and", or
            "0 to 1", which includes its ends.
        over: quantities that make it dimensionless: quantity/over is a group; determined if not given.
        group: name of that group; by default NAME_number.

    Raises:
        ModelFileError: names the wrong argument and what is accepted.
    """
    model = _declarations()
    group = group or f"{name}_number"
    numbers = {item.name: item.symbol for item in model.quantities.values() if item.dimension == ONE}
    try:
        dimension, limits = dimension_of_unit(unit, numbers), Bounds.read(bounds)
    except UnitError as error:
        raise ModelFileError(f"{name}.unit", unit, 'coherent SI, as "Pa", "N/m", "kg m^2/s", "1"', str(error)) from None
    except BoundsError:
        raise ModelFileError(f"{name}.bounds", bounds, '"> 0", ">= 0", "0 to 1", "> 0 and <= 5"') from None
    _check_name("quantity", name, model, in_functions=dimension == ONE)
    _check_name(f"{name}.group", group, model)
    if over is not None and not isinstance(over, sp.Expr):
        raise ModelFileError(f"{name}.over", over, "an expression of the vocabulary, as mu*v0/x0")
    sign = {"positive": True} if limits.positive else {"nonnegative": True} if limits.not_negative else {"real": True}
    symbol = sp.Symbol(name, **sign)
    upright = rf"\mathrm{{{name.replace('_', ' ')}}}".replace(" ", r"\ ")
    printed, meaning = latex or upright, meaning or name.replace("_", " ")
    model.quantities[name] = Declared(symbol, printed, unit, dimension, default, limits, meaning, over, group)
    return symbol


def let(name: str, expression: object, latex: str = "") -> sp.Symbol:
    """Name a part of an expression; the name is kept in print, and in emitted code unless it means something there."""
    model = _declarations()
    means = {} if model.library else taken()
    written = f"{name}_" if isinstance(name, str) and name in means.keys() - VOCABULARY.keys() else name
    _check_name("let", written, model)
    value = _expression(name, expression)
    claimed = value.xreplace({claim: sp.Dummy(positive=True) for claim in model.positive})
    sign = next((kind for kind in ("positive", "nonnegative") if getattr(claimed, f"is_{kind}")), "real")
    symbol = sp.Symbol(written, **{sign: True})
    upright = rf"\mathrm{{{name}}}".replace("_", r"\_")
    model.intermediates[written] = Intermediate(symbol, value, latex or upright)
    return symbol


def positive(expression: object) -> sp.Expr:
    """The expression, claimed to be positive wherever a law of the file is used: no guard is put where it vanishes.

    It is dimensionless, in the arguments of the slot.
    """
    model = _declarations()
    model.positive.append(_expression("positive", expression))
    return model.positive[-1]


def law(
    slot: str,
    name: str,
    *,
    source: Source = "",
    remark: str = "",
    bibtex: str = "",
    meaning: str = "",
    accept: tuple[str, ...] = (),
    validity: Mapping[str, Range] | None = None,
    falls: bool = False,
    spread: bool = False,
    **functions: object,
) -> None:
    """Declare a law.

    Arguments:
        slot: the slot that it fills.
        name: its name in scenes.
        source: its origin, text or publications.
        remark: what is said after them.
        bibtex: the publication as a BibTeX entry, for `wetdoublet cite`.
        meaning: a description in one line.
        accept: names of checks that it is known to fail.
        validity: (least, largest) of `volume`, `contact_angle` (rad) and `separation` (gap over R) for which its source
            gives it, None for no bound; outside of it a warning is given.
        falls: the slot's first function never increases with its first argument, as some certificates require; checked.
        spread: of a film, its rim follows the bridge's volume: its functions take `aspect` and `V` beside the gap.
        functions: the slot's functions as expressions or `Formula`: of the slot's dimension in SI, or dimensionless.

    Raises:
        ModelFileError: names the wrong argument and what is accepted.
    """
    model, label = _declarations(), f"law {slot} {name}"
    if slot not in SLOTS:
        raise ModelFileError("law", slot, "a slot: " + ", ".join(SLOTS), "is not a slot")
    if not isinstance(name, str) or not _LAW_NAME.fullmatch(name):
        raise ModelFileError(f"law {slot}", name, "a name of small letters, digits and single dashes")
    if name in model.taken.get(slot, ()):
        raise ModelFileError(f"law {slot}", name, "a name of your own", "is a law of the library")
    if (slot, name) in model.laws:
        raise ModelFileError(f"law {slot}", name, "each name once", "is declared twice")
    by_name = {place.function: place for place in places().values() if place.slot == slot}
    for foreign in functions.keys() - by_name.keys():
        raise ModelFileError(label, foreign, "the functions " + ", ".join(by_name), "is no function of this slot")
    for missing in (function for function, place in by_name.items() if place.required and function not in functions):
        raise ModelFileError(f"{label}.{missing}", None, f"{missing} = an expression", "is missing")
    for option, value in (("falls", falls), ("spread", spread)):
        if not isinstance(value, bool):
            raise ModelFileError(f"{label}.{option}", value, "True, False")
    if not isinstance(accept, tuple | list) or not all(isinstance(check, str) for check in accept):
        raise ModelFileError(
            f"{label}.accept", accept, 'names of checks, as ("angular momentum",)', "is no list of them"
        )
    if spread and slot != "film":
        raise ModelFileError(f"{label}.spread", spread, "no such argument", "is of a film")
    formulas = {f: _formula(f"{label}.{f}", functions[f]) for f in by_name if f in functions}
    if "suction" in formulas and formulas["suction"].expression != 0:
        suction = str(formulas["suction"].expression)
        raise ModelFileError(f"{label}.suction", suction, "0, or no suction", "is not what cavitation leaves")
    origin, references = published(source, str(remark))
    _check_texts(label, source=origin, remark=remark, bibtex=bibtex, meaning=meaning)
    if bibtex and not _BIBTEX.fullmatch(bibtex):
        raise ModelFileError(f"{label}.bibtex", bibtex, "an entry such as @article{key, author = {...}, ...}")
    meaning, origin = meaning or f"{name}, a user's law", origin or "no source given"
    if not isinstance(validity, Mapping | None):
        raise ModelFileError(f"{label}.validity", validity, "ranges by name: " + ", ".join(RANGES), "is no mapping")
    for quantity, ends in (validity or {}).items():
        if quantity not in RANGES:
            raise ModelFileError(f"{label}.validity", quantity, ", ".join(RANGES), "has no range")
        if not _is_range(ends):
            raise ModelFileError(f"{label}.validity", ends, "(least, largest), a number each, or None")
    valid = tuple((name, validity[name]) for name in RANGES if validity and name in validity)
    declared = Law(slot, name, meaning, origin, (), valid, references, spread)
    model.laws[slot, name] = Proposed(declared, formulas, tuple(accept), bibtex, falls)


def _is_range(ends: object) -> bool:
    """Whether these are two ends, finite numbers or None, of which the first is below the second."""
    if not isinstance(ends, tuple | list) or len(ends) != 2:
        return False
    bounds = [sp.sympify(end) for end in ends if end is not None]
    return all(end.is_number and end.is_finite for end in bounds) and (len(bounds) < 2 or bool(bounds[0] < bounds[1]))


def _formula(label: str, value: object) -> Formula:
    """A function of a law as it is declared, its expression and its texts judged."""
    formula = value if isinstance(value, Formula) else Formula(value)
    _check_texts(label, doc=formula.doc, source=published(formula.source, formula.remark)[0])
    return replace(formula, expression=_expression(label, formula.expression))


def event(
    name: str,
    *,
    guard: object,
    where: str = "any",
    jump: Mapping[sp.Symbol, object] | None = None,
    ends: str = "",
    releases: object = 0,
    word: str = "",
    meaning: str = "",
    source: str = "",
) -> sp.Symbol:
    """Declare an event; it happens once in a collision, where its guard is not positive while it is watched.

    Arguments:
        name: its name; in emitted code with underscores for spaces.
        guard: positive before the event: an SI expression of x, u, omega, xi, beta (rad), t (s) and quantities.
        where: "closing", "opening" or "any", and "inside the film" or "beyond the film" if it matters.
        jump: u, omega or xi just after the event, in SI; what is left out is continuous.
        ends: "separated" (while opening only) or "stick" if the event ends the collision.
        releases: stored energy that the jump may give to the motion, J.
        word: its name in reports; by default the name.

    Returns:
        Its mark, 1 before the event and 0 after it, which laws of the same file may use as a factor.

    Raises:
        ModelFileError: names the wrong argument and what is accepted.
    """
    model, label = _declarations(), f"event {name}"
    name = name.replace(" ", "_") if isinstance(name, str) else name
    _check_name("event", name, model)
    if name in own_events.TAKEN_NAMES:
        raise ModelFileError("event", name, "a name of your own", "is an event of the library")
    _check_name(f"{label}, mark", own_events.MARK + name, model)
    reported = word or name.replace("_", " ")
    if not isinstance(reported, str) or not own_events.WORD.fullmatch(reported):
        raise ModelFileError(f"{label}.word", reported, "small letters, digits and single spaces")
    words = own_events.TAKEN_WORDS.union(other.word for other in model.events.values())
    if reported in words:
        raise ModelFileError(f"{label}.word", reported, f"any word but {', '.join(sorted(words))}", "exists already")
    if where not in own_events.PLACES:
        raise ModelFileError(f"{label}.where", where, ", ".join(own_events.PLACES))
    if ends not in own_events.ENDINGS:
        raise ModelFileError(f"{label}.ends", ends, '"separated", "stick", or "" for an event that ends nothing')
    if ends == "separated" and not where.startswith("opening"):  # a restitution would be negative
        accepted = '"opening", "opening inside the film" or "opening beyond the film" with ends="separated"'
        raise ModelFileError(f"{label}.where", where, accepted, "may be on approach, where nothing separates")
    _check_texts(label, meaning=meaning, source=source)
    tested = _of_event(f"{label}.guard", guard, model)
    if not unfolded(tested, model).free_symbols & set(own_events.MOVING):
        raise ModelFileError(f"{label}.guard", guard, "an expression of x, u, omega, xi, beta or t", "never changes")
    if jump is not None and not isinstance(jump, Mapping):
        raise ModelFileError(f"{label}.jump", jump, "a table of u, omega or xi, as {u: u/2}")
    after = []
    for target, value in (jump or {}).items():
        if target == x:
            problem = "jumps, but surfaces move apart and together continuously: a gap"
            raise ModelFileError(f"{label}.jump", "x", "u, omega, xi", problem)
        if target not in own_events.JUMPS:
            raise ModelFileError(f"{label}.jump", target, "u, omega, xi", "is no velocity of the particles")
        new = _of_event(f"{label}.jump", value, model, own_events.JUMPS[target])
        still = sp.simplify(unfolded(new, model).subs({omega: 0, xi: 0}))
        if target != u and still != 0:
            accepted = "a jump that vanishes with omega and xi, as omega/2"
            raise ModelFileError(
                f"{label}.jump", str(new), accepted, "turns what does not turn, as in a head-on collision"
            )
        after.append((target, new))
    if ends == "stick" and after:
        raise ModelFileError(f"{label}.jump", jump, 'no jump beside ends = "stick"', "would not be seen")
    mark = sp.Symbol(own_events.MARK + name, nonnegative=True)
    released = _of_event(f"{label}.releases", releases, model, ENERGY)
    meaning, source = meaning or f"{reported}, a user's event", source or "no source given"
    model.events[name] = own_events.Proposed(
        name, reported, mark, tested, where, tuple(after), ends, released, meaning, source
    )
    return mark


def criterion(name: str, *, gap: object, meaning: str = "", source: str = "") -> None:
    """Declare a rebound criterion: the doublet rebounds, as on its roughness, when the gap has closed to an expression.

    Arguments:
        name: its name in reports.
        gap: m, of quantities and the impact speed v0, as the thickness of a soft layer; the largest gap at which any
            criterion is met is where the solids meet.
        meaning: what it is, as in "the gap is down to ...".

    Raises:
        ModelFileError: names what is wrong, and what is accepted.
    """
    model, label = _declarations(), f"criterion {name}"
    name = name.replace(" ", "_") if isinstance(name, str) else name
    _check_name("criterion", name, model)
    group = f"{name}_gap"
    _check_name(f"{label}.group", group, model)
    if name in own_events.TAKEN_NAMES or name.replace("_", " ") in own_events.TAKEN_WORDS:
        raise ModelFileError("criterion", name, "a name of your own", "is a word of the library")
    _check_texts(label, meaning=meaning, source=source)
    value = unfolded(_of_event(f"{label}.gap", gap, model, LENGTH), model)
    marks = {other.mark for other in model.events.values()}
    if moving := sorted(str(s) for s in value.free_symbols & {*own_events.MOVING, *marks}):
        accepted = "a length of quantities and v0, which stays as it is during a collision"
        raise ModelFileError(f"{label}.gap", ", ".join(moving), accepted, "varies along a trajectory")
    meaning = meaning or f"the {name.replace('_', ' ')}"
    symbol = sp.Symbol(group, nonnegative=True)
    model.criteria[name] = Criterion(name, value, symbol, meaning, source or "no source given")


def energy(expression: object) -> None:
    """Add a term to the energy of the motion, J: a potential of x and beta, or squares of u, omega and xi.

    Several add up. A kinetic one is added inertia: its factors may depend on x and beta. The equations follow from the
    Lagrangian; in the ledger the energy is of `own_terms`.

    Raises:
        ModelFileError: names what is wrong, and what is accepted.
    """
    model = _declarations()
    value = _of_term("energy", expression, model, ENERGY)
    whole, squares = unfolded(value, model), {rate: rate**2 for rate in VELOCITIES.values()}
    inertia = {rate: sp.simplify(whole.diff(rate, 2)) for rate in squares}
    kinetic = sp.Add(*(inertia[rate] * square / 2 for rate, square in squares.items()))
    rest = sp.simplify(whole - whole.subs(dict.fromkeys(squares, 0)) - kinetic)
    if rest != 0 or any(factor.free_symbols & squares.keys() for factor in inertia.values()):
        accepted = "a potential of x and beta, and squares of u, omega and xi, as added*u**2/2"
        raise ModelFileError("energy", str(value), accepted, "is neither a potential nor a kinetic energy")
    model.energies.append(value)


def force_on(coordinate: str, expression: object) -> None:
    """Add a generalised force, by virtual work: N on the "gap", positive outward; N m on the "rotation" or "spin".

    A torque on the rotation turns the line of centres, one on the spin both spheres alike. Several add up. In the
    ledger the work is of `own_terms`.

    Raises:
        ModelFileError: names what is wrong, and what is accepted.
    """
    model, label = _declarations(), f"force_on {coordinate}"
    if coordinate not in VELOCITIES:
        raise ModelFileError("force_on", coordinate, ", ".join(VELOCITIES), "is no coordinate")
    value = _of_term(label, expression, model, FORCE if coordinate == "gap" else ENERGY)
    model.forces.append((coordinate, value))


def _of_term(label: str, value: object, model: Declarations, wanted: Dimension) -> sp.Expr:
    """The expression of a term: of the motion, but not of the time or of events, and smooth along a trajectory."""
    result = _of_event(label, value, model, wanted)
    whole, marks = unfolded(result, model), {other.mark for other in model.events.values()}
    for symbol in sorted(whole.free_symbols & {time, *marks}, key=str):
        problem = "is in a term: resting contact would not end with it"
        raise ModelFileError(label, str(symbol), "an expression of x, u, omega, xi, beta and quantities", problem)
    if kinks := guarded(whole, own_events.MOVING):
        accepted = "a smooth expression, as sqrt(u**2 + c**2) for Abs(u); laws and events may have kinks"
        raise ModelFileError(label, str(kinks[0]), accepted, "has a kink where it vanishes")
    return result


def _of_event(label: str, value: object, model: Declarations, wanted: Dimension | None = None) -> sp.Expr:
    """An expression of an event or a term, its symbols and its dimension judged."""
    result = _expression(label, value)
    whole = unfolded(result, model)
    dimensions = {item.symbol: item.dimension for item in model.quantities.values()}
    dimensions |= {other.mark: ONE for other in model.events.values()}
    for symbol in sorted(whole.free_symbols, key=str):
        if symbol not in dimensions and not own_events.may_use(symbol):
            raise ModelFileError(
                label,
                str(symbol),
                own_events.ACCEPTED,
                f"is not known to {'an event' if label.startswith('event') else 'a term'}",
            )
    try:
        dimension = dimension_of(whole, {**DIMENSIONS, **dimensions})
    except DimensionError as error:
        raise ModelFileError(label, str(whole), "terms of one dimension", str(error)) from None
    if wanted is not None and dimension not in (None, wanted):
        raise ModelFileError(label, str(whole), f"dimension {wanted}", f"has dimension {dimension}")
    return result


def unfolded(expression: sp.Expr, model: Declarations) -> sp.Expr:
    """The expression with every `let` substituted."""
    for definition in reversed(model.intermediates.values()):
        expression = expression.xreplace({definition.symbol: definition.expression})
    return expression


def _check_texts(label: str, **texts: object) -> None:
    for what, text in texts.items():
        if not isinstance(text, str):
            raise ModelFileError(f"{label}.{what}", text, "text")


def _check_name(what: str, name: object, model: Declarations, in_functions: bool = True) -> None:
    """ModelFileError for a name that is declared already, or means something where it is written."""
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise ModelFileError(what, name, "a name of small letters, digits and underscores")
    declared = {*model.quantities, *model.intermediates, *(other.group for other in model.quantities.values())}
    declared |= {word for other in model.events for word in (other, own_events.MARK + other)}
    declared |= {word for other in model.criteria for word in (other, f"{other}_gap")}
    of_library = VOCABULARY.get(name)
    local = what == "let" and of_library is not None and not own_events.may_use(of_library.symbol)  # in no law
    meaning = "" if local or model.library else taken().get(name, "")
    if name in declared or (meaning and (in_functions or meaning != EMITTED)):
        problem = "is taken already" + (f": it is {meaning}" if meaning else "")
        raise ModelFileError(what, name, "a name that is not taken", problem)


def _expression(label: str, value: object) -> sp.Expr:
    """A sympy expression with every decimal as an exact rational."""
    try:
        result = sp.sympify(value)
    except (sp.SympifyError, TypeError, AttributeError):
        raise ModelFileError(label, value, "a sympy expression") from None
    if not isinstance(result, sp.Expr) or isinstance(value, str):
        raise ModelFileError(label, value, "a sympy expression")
    return result.xreplace({number: sp.Rational(str(float(number))) for number in result.atoms(sp.Float)})


def latex_names(model: Declarations, groups: Mapping[str, str]) -> dict[str, str]:
    """LaTeX of every name that a model adds to the vocabulary."""
    names = {item.name: item.latex for item in model.quantities.values()}
    names |= {item.symbol.name: item.latex for item in model.intermediates.values()}
    names |= {item.mark.name: rf"1_{{\mathrm{{{item.word}}}}}".replace(" ", r"\ ") for item in model.events.values()}
    return names | dict(groups)
