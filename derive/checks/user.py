"""Checks of a user's model by name: dimensions, invariants, dissipation, limits."""

import cmath
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from itertools import product
from pathlib import Path
from random import Random

import sympy as sp

from ..equations.model import Model
from ..equations.terms import definitions
from ..laws import LAWS, Law, LawFunction, slot_calls
from ..laws.modelfile import read
from ..physics.scaling import ScalingError
from ..physics.structure import Structure
from ..user.structures import UserModel
from ..vocabulary.dimensions import DimensionError
from ..vocabulary.quantities import contact_angle, volume
from .attraction_certificate import force_falls
from .base import Check
from .emission import emission
from .pendulum_certificate import reach_of, taken_by
from .words import torque

# Values of the arguments at which laws are tried; any other argument is a group, tried over four decades
_TRIED: Mapping[str, tuple[float, ...]] = {
    "gap": (1e-3, 0.01, 0.1, 0.3, 0.7, 0.99), "distance": (4.001, 4.1, 4.5, 6.0), "approach": (1e-3, 0.1, 1.0),
    "normal_velocity": (-1.0, -0.1, -1e-3, 1e-3, 0.1, 1.0), "aspect": (1e-3, 0.05, 0.16), "volume": (1e-3, 0.01, 0.1),
    "contact_angle": (0.0, 0.5, 1.0), "offset_squared": (0.0, 1.0, 4.0), "string_ratio": (20.0, 100.0),
    "gap_over_radius": (1e-4, 0.01, 0.1, 0.3, 0.6, 1.0),  # here fractions of the rupture distance
}  # fmt: skip
_POINTS = 20
_EQUAL = 1e-12  # relative tolerance
_SIGNED = ("film.resistance", "shear.log_factor", "glass.pressure")


def model_checks(path: Path, text: str | None = None, name: str = "") -> tuple[UserModel | None, tuple[Check, ...]]:
    """The model of a file, None if it cannot be derived, and every check of it; ModelFileError if it is none."""
    try:
        model = read(path, text, name)
    except (DimensionError, ScalingError) as error:
        kind, statement = "dimensions", "every term of every law has the dimension that it must have"
        if isinstance(error, ScalingError):
            kind, statement = "groups", "every law is a function of its slot's arguments and of dimensionless groups"
        return None, (Check(kind, statement, False, str(error)),)
    return model, checks_of(model)


def checks_of(model: UserModel) -> tuple[Check, ...]:
    """Every check of a model that can be derived."""
    functions = sum(len(law.functions) for law in model.laws)
    result = [Check("dimensions", "every term has the dimension that it must have", True, f"{functions} functions")]
    named = ", ".join(str(group.symbol) for group in model.groups) or "none but the library's"
    result.append(Check("groups", "laws depend on their arguments and dimensionless groups", True, named))
    result += _term_checks(model)
    for law, emitted in zip(model.written, model.laws, strict=True):
        result += _law_checks(model, law, emitted)
    names = {name for check in result for name in (check.name, check.name.partition(":")[0])}
    for foreign in sorted(model.accepted - names):
        choices = ", ".join(dict.fromkeys(check.name.partition(":")[0] for check in result))
        result.append(
            Check("accept", "what a law accepts are checks", False, f"{foreign!r} is none; accepted: {choices}")
        )
    return tuple(_accepted(model, check) for check in result)


def _accepted(model: UserModel, check: Check) -> Check:
    if check.ok or not model.accepted & {check.name, check.name.partition(":")[0]}:
        return check
    figure = check.figure.partition("; known: ")[0]
    return replace(check, ok=None, figure=f"{figure} (accepted by the model)")


def _law_checks(model: UserModel, law: Law, emitted: Law) -> Iterator[Check]:
    label = f"{law.slot} {law.name}"
    yield _finite(model, law, label)
    yield emission(model, emitted, law, label, partial(_samples, model, law))
    if law.slot == "arm":
        rate = torque(model, law)
        figure = "identity" if rate == 0 else f'dL/dt over its scale = {rate}; known: accept=("angular momentum",)'
        yield Check(f"angular momentum: {label}", "dL/dt = 0 without strings, for every other law", rate == 0, figure)
    yield from force_falls([law], last=1 if law.slot in ("film", "shear") else sp.oo)
    for function in (item for item in law.functions if item.for_proof):
        yield reach_of(law) if law.slot == "glass" else taken_by(law, function.name)
    for function in law.functions:
        if f"{law.slot}.{function.name}" in _SIGNED:
            yield _sign(model, law, function, label)
    if law.slot == "strings":
        rise, stiffness = law["rise"], law["stiffness"]
        difference = sp.simplify(2 * rise(*rise.arguments).diff(rise.arguments[1]) - stiffness(*stiffness.arguments))
        figure = "identity" if difference == 0 else f"left over: {difference}"
        yield Check(f"potential: {label}", "stiffness is twice the slope of rise", difference == 0, figure)
    for group in model.groups:
        if group.quantity.bounds.low == 0 and not group.quantity.bounds.low_open:
            yield from _without(model, law, group.symbol, label)


def _term_checks(model: UserModel) -> Iterator[Check]:
    """Of declared terms: balance of energy and rate of the angular momentum along the equations, and inertia."""
    if model.terms is None:
        return
    shape = Structure(oblique=True, bridge=True, strings=False, terms=model.terms)
    statement = "d(kinetic + declared energy)/dt = -(power taken by film, shear, bridge and declared forces)"
    rest = _balance_at_points(model.derived(shape))
    yield Check("energy: terms", statement, rest < _EQUAL, f"{_POINTS} states: {rest:.0e} of the largest power left")
    rate = torque(model)
    figure = "identity" if rate == 0 else f"dL/dt over its scale = {rate}: not conserved"
    yield Check("angular momentum: terms", "dL/dt of the spheres = 0 without strings", rate == 0 or None, figure)
    values = []
    for share in (share for symbol, share in definitions(shape) if symbol.is_nonnegative):
        at = {s: _TRIED.get(s.name) or _tried(model, s) for s in sorted(share.free_symbols, key=str)}
        values += [complex(share.subs(dict(zip(at, point, strict=True)))).real for point in product(*at.values())]
    if values:
        figure = f"least value {min(values):.3g} of that of the spheres"
        yield Check("inertia: terms", "a declared kinetic energy is never negative", min(values) >= 0, figure)


def _balance_at_points(model: Model) -> float:
    """The largest residual of the balance of energy at states and groups at random, over the largest power there."""
    rates, draw = model.by_state("right_hand_side"), Random(1)
    stored = sp.Add(*model.results("energies").values())
    powers = [stored.diff(state) * rate for state, rate in rates.items()] + list(model.results("energy_rates").values())
    calls = {node: sp.Dummy() for power in powers for node in slot_calls(power)}
    powers = [power.xreplace(calls) for power in powers]
    symbols = sorted(set().union(*(power.free_symbols for power in powers)), key=str)
    compiled, worst = sp.lambdify(symbols, powers, modules=["math"]), 0.0
    for _ in range(_POINTS):
        values = compiled(*(draw.uniform(0.1, 0.9) for _ in symbols))
        worst = max(worst, abs(math.fsum(values)) / max(map(abs, values)))
    return worst


def _samples(
    model: UserModel, law: Law, function: LawFunction, tried: Mapping[str, tuple[float, ...]] = _TRIED
) -> Iterator[dict[sp.Symbol, float]]:
    ranges = [tried.get(symbol.name) or _tried(model, symbol) for symbol in function.arguments]
    edge = _evaluated(law["edge"]) if f"{law.slot}.{function.name}" == "shear.log_factor" else None
    for values in product(*ranges):
        at = dict(zip(function.arguments, values, strict=True))
        reach = next((s for s in at if s.name == "gap_over_radius"), None)
        if reach is not None:  # up to the rupture distance over R
            at[reach] *= at.get(volume, 0.1) ** (1 / 3) * (1 + at.get(contact_angle, 0.0) / 2)
        if edge is not None:
            at[function.arguments[0]] *= float(edge(*(at.get(s, 1.0) for s in law["edge"].arguments)))
        yield at


def _tried(model: UserModel, symbol: sp.Symbol) -> tuple[float, ...]:
    quantity = next((group.quantity for group in model.groups if group.symbol == symbol), None)
    if quantity is None:
        return (0.1, 10.0)
    low, high = quantity.bounds.low, quantity.bounds.high
    if quantity.symbol == symbol and math.isfinite(low) and math.isfinite(high):
        return (low + 1e-3 * (high - low), (low + high) / 2, high - 1e-3 * (high - low))
    least = (0.0,) if quantity.bounds.not_negative and not quantity.bounds.low_open else ()
    # 1.09: no gap of `PASSED`, where a kink at a multiple of x0 has no slope
    return (*least, 0.01, 1.09, 100.0) if quantity.bounds.not_negative else (-1.09, -0.01, 0.01, 1.09)


def _evaluated(function: LawFunction) -> sp.Lambda:
    named = list(function.definitions)  # statements of the compiled function: nothing is substituted
    return sp.lambdify(function.arguments, function.result, modules=["math"], cse=lambda result: (named, result))


def _value(compiled: sp.Lambda, at: Mapping[sp.Symbol, float]) -> float:
    try:
        value = complex(compiled(*at.values()))
    except (ArithmeticError, ValueError, TypeError):
        return math.nan
    return value.real if cmath.isfinite(value) and value.imag == 0 else math.nan


def _finite(model: UserModel, law: Law, label: str) -> Check:
    name, statement, count = f"limits: {label}", "finite from the smallest gap to the largest", 0
    for function in law.functions:
        compiled = _evaluated(function)
        for at in _samples(model, law, function):
            count += 1
            if math.isnan(_value(compiled, at)):
                own = " and ".join(group.quantity.name for group in model.groups if group.symbol in at)
                hint = f": bounds= of {own} say which values to expect" if own else ""
                return Check(name, statement, False, f"{function.name} is not a finite number at {_at(at)}{hint}")
    return Check(name, statement, True, f"{count} states")


def _sign(model: UserModel, law: Law, function: LawFunction, label: str) -> Check:
    name, statement = f"dissipation: {label}", f"{function.name} is never of the sign that would give energy"
    if law.slot == "glass":
        name, statement = f"sign: {label}", f"{function.name} is not negative while closing"
    compiled, least = _evaluated(function), math.inf
    for at in _samples(model, law, function):
        least = min(least, value := _value(compiled, at))
        if value < 0:
            hint = ": its sign is that of u, as of u*Abs(u)**(n - 1)" * (law.slot == "film")
            return Check(name, statement, False, f"{function.name} = {value:.3g} at {_at(at)}{hint}")
    return Check(name, statement, True, f"least value {least:.3g}")


def _without(model: UserModel, law: Law, symbol: sp.Symbol, label: str) -> Iterator[Check]:
    """The law of the library that remains if a quantity is zero, by values; reported, not required."""
    for limit in LAWS[law.slot].values():
        if all(_same(model, law, function, limit, symbol) for function in law.functions):
            statement = f"without {symbol.name} it is a law of the library"
            yield Check(f"limit: {label}", statement, True, f"{symbol.name} = 0 gives {limit.name}")
            return


def _same(model: UserModel, law: Law, function: LawFunction, limit: Law, symbol: sp.Symbol) -> bool:
    twin = next((f for f in limit.functions if f.name == function.name), None)
    if twin is None or not set(twin.arguments) <= set(function.arguments):
        return False
    mine, theirs = _evaluated(function), _evaluated(twin)
    samples = _samples(model, law, function)
    pairs = ((_value(mine, {**at, symbol: 0.0}), _value(theirs, {s: at[s] for s in twin.arguments})) for at in samples)
    return all(abs(value - other) <= _EQUAL * abs(other) for value, other in pairs)


def _at(at: Mapping[sp.Symbol, float]) -> str:
    return ", ".join(f"{symbol.name} = {value:.3g}" for symbol, value in at.items())
