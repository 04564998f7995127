"""What a model file adds to the motion, judged on the spot: events, rebound criteria, energies and forces."""

from collections.abc import Mapping

import sympy as sp

from ..physics.terms import VELOCITIES
from ..vocabulary.dimensions import ENERGY, FORCE, LENGTH, ONE, Dimension, DimensionError
from ..vocabulary.quantities import DIMENSIONS, omega, u, x, xi
from ..vocabulary.quantities import t as time
from . import own_events
from .declarations import (
    Criterion,
    Declarations,
    ModelFileError,
    check_name,
    check_texts,
    declarations,
    read_expression,
    unfolded,
)
from .kinks import guarded
from .names import as_written, dimension_as_written


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
    model, label = declarations(), f"event {name}"
    name = name.replace(" ", "_") if isinstance(name, str) else name
    check_name("event", name, model)
    if name in own_events.TAKEN_NAMES:
        raise ModelFileError("event", name, "a name of your own", "is an event of the library")
    check_name(f"{label}, mark", own_events.MARK + name, model)
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
    check_texts(label, meaning=meaning, source=source)
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
                f"{label}.jump", str(as_written(new)), accepted, "turns what does not turn, as in a head-on collision"
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
    model, label = declarations(), f"criterion {name}"
    name = name.replace(" ", "_") if isinstance(name, str) else name
    check_name("criterion", name, model)
    group = f"{name}_gap"
    check_name(f"{label}.group", group, model)
    if name in own_events.TAKEN_NAMES or name.replace("_", " ") in own_events.TAKEN_WORDS:
        raise ModelFileError("criterion", name, "a name of your own", "is a word of the library")
    check_texts(label, meaning=meaning, source=source)
    value = unfolded(_of_event(f"{label}.gap", gap, model, LENGTH), model)
    marks = {other.mark for other in model.events.values()}
    if moving := sorted(str(as_written(s)) for s in value.free_symbols & {*own_events.MOVING, *marks}):
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
    model = declarations()
    value = _of_term("energy", expression, model, ENERGY)
    whole, squares = unfolded(value, model), {rate: rate**2 for rate in VELOCITIES.values()}
    inertia = {rate: sp.simplify(whole.diff(rate, 2)) for rate in squares}
    kinetic = sp.Add(*(inertia[rate] * square / 2 for rate, square in squares.items()))
    rest = sp.simplify(whole - whole.subs(dict.fromkeys(squares, 0)) - kinetic)
    if rest != 0 or any(factor.free_symbols & squares.keys() for factor in inertia.values()):
        accepted = "a potential of x and beta, and squares of u, omega and xi, as added*u**2/2"
        raise ModelFileError("energy", str(as_written(value)), accepted, "is neither a potential nor a kinetic energy")
    model.energies.append(value)


def force_on(coordinate: str, expression: object) -> None:
    """Add a generalised force, by virtual work: N on the "gap", positive outward; N m on the "rotation" or "spin".

    A torque on the rotation turns the line of centres, one on the spin both spheres alike. Several add up. In the
    ledger the work is of `own_terms`.

    Raises:
        ModelFileError: names what is wrong, and what is accepted.
    """
    model, label = declarations(), f"force_on {coordinate}"
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
        accepted = "an expression of x, u, omega, xi, beta and quantities"
        raise ModelFileError(label, str(as_written(symbol)), accepted, problem)
    if kinks := guarded(whole, own_events.MOVING):
        accepted = "a smooth expression, as sqrt(u**2 + c**2) for Abs(u); laws and events may have kinks"
        raise ModelFileError(label, str(as_written(kinks[0])), accepted, "has a kink where it vanishes")
    return result


def _of_event(label: str, value: object, model: Declarations, wanted: Dimension | None = None) -> sp.Expr:
    """An expression of an event or a term, its symbols and its dimension judged."""
    result = read_expression(label, value)
    whole = unfolded(result, model)
    dimensions = {item.symbol: item.dimension for item in model.quantities.values()}
    dimensions |= {other.mark: ONE for other in model.events.values()}
    for symbol in sorted(whole.free_symbols, key=str):
        if symbol not in dimensions and not own_events.may_use(symbol):
            raise ModelFileError(
                label,
                str(as_written(symbol)),
                own_events.ACCEPTED,
                f"is not known to {'an event' if label.startswith('event') else 'a term'}",
            )
    try:
        dimension = dimension_as_written(whole, {**DIMENSIONS, **dimensions})
    except DimensionError as error:
        raise ModelFileError(label, str(as_written(whole)), "terms of one dimension", str(error)) from None
    if wanted is not None and dimension not in (None, wanted):
        raise ModelFileError(label, str(as_written(whole)), f"dimension {wanted}", f"has dimension {dimension}")
    return result
