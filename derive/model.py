"""From a structure to its nondimensional equations, events, jumps, ledger and outputs, ready to be emitted.

Everything follows from `mechanics`, `laws` and `scaling`. Laws stay calls to their slots (`bridge.force(...)`), film
and shear stay flags of the region (1 inside, 0 beyond the edge), so one set of equations serves every variant.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import sympy as sp

from .laws import slot_call
from .laws.base import Definition
from .laws.strings import offset_squared, swing_squared
from .laws.strings import r as string_distance
from .mechanics import F_c, F_n, F_t, S_n, S_t, arm, doublet_inertia, equations_of_motion
from .quantities import (
    R,
    a,
    aspect,
    beta,
    capillary,
    contact_angle,
    e_dry,
    elastic_gap,
    g,
    gap,
    glass_number,
    l_s,
    m,
    mu,
    obliquity,
    omega,
    omega0,
    opening,
    orbit,
    r,
    rough_gap,
    rupture_gap,
    sigma,
    spin,
    stokes,
    string_ratio,
    u,
    v0,
    volume,
    weight,
    x,
    x0,
    xi,
)
from .scaling import DISTANCE, INERTIA, nondimensional
from .structure import Structure

# Flags of the region, and names of intermediates, as they appear in emitted code.
FILM, SHEAR = sp.symbols("film shear", nonnegative=True)
ORBITAL_RATE, SLIP = sp.symbols("orbital_rate slip", real=True)
FILM_FORCE, BRIDGE_FORCE, SHEAR_FORCE = sp.symbols("film_force bridge_force shear_force", real=True)
STRING_PULL, STRING_SIDEWAYS, CENTRIFUGAL_FORCE = sp.symbols("string_pull string_sideways centrifugal_force", real=True)
LEVER, MOMENTUM, INERTIA_RATIO = sp.symbols("lever momentum inertia_ratio", positive=True)

TANGENTIAL = m * a * omega0 * v0 / x0  # scale of tangential forces


@dataclass(frozen=True)
class ModelFunction:
    """A function of state and groups that will be emitted: `outputs` are (name, expression) pairs."""

    name: str
    doc: str
    outputs: tuple[tuple[str, sp.Expr], ...]
    regional: bool = False  # depends on the region's flags


@dataclass(frozen=True)
class Model:
    """The nondimensional model of a structure."""

    structure: Structure
    states: tuple[sp.Symbol, ...]
    groups: tuple[sp.Symbol, ...]
    slots: tuple[str, ...]
    definitions: tuple[Definition, ...]
    functions: tuple[ModelFunction, ...]

    def __getitem__(self, name: str) -> ModelFunction:
        return next(each for each in self.functions if each.name == name)

    def expanded(self, expression: sp.Expr) -> sp.Expr:
        """`expression` with every named intermediate put back in."""
        for symbol, value in reversed(self.definitions):
            expression = expression.subs(symbol, value)
        return expression


def _scaled(force: sp.Expr, scale: sp.Expr) -> sp.Expr:
    return nondimensional(force / scale)


@cache
def force_laws() -> dict[sp.Symbol, sp.Expr]:
    """The forces of the model in SI, with slot calls in place of the selectable laws."""
    offset = (swing_squared() / a**2).subs(string_distance, r)
    stiffness = slot_call("strings", "stiffness", l_s / a, offset)
    # S = dU/dr with U = 4 m g a rise(l/a, (d/a)^2) and stiffness = 2 d rise/d (d/a)^2
    lift = 4 * m * g * a * stiffness / 2
    return {
        F_n: FILM * 6 * sp.pi * mu * a**2 * u / x0 * slot_call("film", "resistance", x / x0),
        F_c: sp.pi * R * sigma * slot_call("bridge", "force", x / R, volume, contact_angle),
        F_t: SHEAR * 8 * sp.pi * mu * a**2 * (omega - xi) * slot_call("shear", "log_factor", x / x0, x0 / a),
        arm: a * slot_call("arm", "lever", r / a),
        S_n: lift * (swing_squared().diff(string_distance) / a**2).subs(string_distance, r),
        S_t: lift * (swing_squared().diff(beta) / string_distance / a**2).subs(string_distance, r),
    }


def _scaled_strings(oblique: bool) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """String pull, sideways force and the squared swing over a^2, scaled; head-on beta = 0."""
    turn = beta if oblique else sp.Integer(0)
    apart = swing_squared().subs(string_distance - 4 * a, x)  # x and r = 4a + x kept apart: no cancellation
    by_distance = apart.diff(x) + apart.diff(string_distance)
    by_angle = sp.simplify(apart.diff(beta) / string_distance)

    def scaled(expression: sp.Expr) -> sp.Expr:
        return expression.subs(beta, turn).subs({x: a * aspect * gap, string_distance: a * DISTANCE}, simultaneous=True)

    stiffness = slot_call("strings", "stiffness", string_ratio, offset_squared)
    pull = nondimensional(4 * m * g / INERTIA) * stiffness / 2
    sideways = nondimensional(4 * m * g / TANGENTIAL) * stiffness / 2 if oblique else sp.Integer(0)
    return (
        sp.expand(2 * scaled(by_distance) / a) * (pull / 2),
        sp.expand(scaled(by_angle) / a) * sideways,
        sp.expand(scaled(apart) / a**2),
    )


@cache
def derive(structure: Structure) -> Model:
    """The nondimensional model of `structure`."""
    oblique, bridge, strings = structure.oblique, structure.bridge, structure.strings
    motion = equations_of_motion()
    laws = force_laws()

    states = [gap, opening]
    if oblique:
        states += [orbit] + ([] if structure.reduced else [spin]) + ([beta] if strings else [])
    slots = ["film", "glass"] + (["shear"] if oblique else []) + (["arm"] if oblique and not structure.reduced else [])
    slots += (["bridge"] if bridge else []) + (["strings"] if strings else [])

    # Named intermediates, in the order of the derivation.
    definitions: list[Definition] = [(DISTANCE, 4 + aspect * gap)]
    initial_distance = 4 + aspect
    momentum = nondimensional(motion.angular_momentum / (m * a**2 * omega0))
    if oblique:
        definitions.append((ORBITAL_RATE, nondimensional(omega / omega0)))
        if structure.reduced:
            # the invariant handed in: L, at its start value (4 + x0/a)^2; solved for the spin it eliminates
            definitions.append((MOMENTUM, initial_distance**2))
            definitions.append((spin, sp.solve(sp.Eq(momentum, MOMENTUM), spin)[0]))
        else:
            definitions.append((MOMENTUM, momentum))
        definitions.append((SLIP, ORBITAL_RATE - spin))
        definitions.append((INERTIA_RATIO, nondimensional(doublet_inertia() / (m * a**2))))
        slip_form = _scaled(laws[F_t], TANGENTIAL)
        definitions.append(
            (SHEAR_FORCE, sp.factor(slip_form.subs(orbit, ORBITAL_RATE * DISTANCE**2)).subs(ORBITAL_RATE - spin, SLIP))
        )
        definitions.append(
            (CENTRIFUGAL_FORCE, nondimensional(m * r * omega**2 / INERTIA).subs(orbit, ORBITAL_RATE * DISTANCE**2))
        )
    definitions.append((FILM_FORCE, _scaled(laws[F_n], INERTIA)))
    if bridge:
        definitions.append((BRIDGE_FORCE, _scaled(laws[F_c], INERTIA)))
    if strings:
        pull, sideways, swing = _scaled_strings(oblique)
        definitions.append((offset_squared, swing))
        definitions.append((STRING_PULL, pull))
        if oblique:
            definitions.append((STRING_SIDEWAYS, sideways))
    if oblique and not structure.reduced:
        definitions.append((LEVER, slot_call("arm", "lever", DISTANCE)))

    functions = _functions(structure, tuple(states))
    used = _closure(functions, definitions)
    definitions = [(s, e) for s, e in definitions if s in used]
    groups = [q for q in _GROUP_ORDER if q in used]
    return Model(structure, tuple(states), tuple(groups), tuple(slots), tuple(definitions), functions)


_GROUP_ORDER = (
    stokes, aspect, obliquity, capillary, volume, contact_angle, weight, string_ratio,
    glass_number, elastic_gap, rough_gap, rupture_gap, e_dry,
)  # fmt: skip


def _closure(functions: tuple[ModelFunction, ...], definitions: list[Definition]) -> set[sp.Basic]:
    used: set[sp.Basic] = set()
    for function in functions:
        for _, expression in function.outputs:
            used |= expression.free_symbols
    for symbol, expression in reversed(definitions):
        if symbol in used:
            used |= expression.free_symbols
    return used


def _rates(structure: Structure) -> dict[sp.Symbol, sp.Expr]:
    """Time derivatives of the states per v0/x0, out of the equations of motion."""
    motion = equations_of_motion()
    named = {
        F_n: FILM_FORCE,
        F_c: BRIDGE_FORCE if structure.bridge else 0,
        S_n: STRING_PULL if structure.strings else 0,
    }
    named_tangential = {F_t: SHEAR_FORCE, S_t: STRING_SIDEWAYS if structure.strings else 0}
    normal = {force: INERTIA * value for force, value in named.items()}
    tangential = {force: TANGENTIAL * value for force, value in named_tangential.items()}
    rate: dict[sp.Symbol, sp.Expr] = {gap: nondimensional(u / v0)}
    acceleration = motion.separation_acceleration.subs(normal)
    if not structure.oblique:
        rate[opening] = sp.expand(nondimensional(acceleration.subs(omega, 0) * x0 / v0**2))
        return rate
    # the centrifugal term is named: what is left is minus the forces
    centrifugal = sp.expand(acceleration - acceleration.subs(omega, 0))
    assert sp.expand(centrifugal - r * omega**2) == 0
    rate[opening] = CENTRIFUGAL_FORCE + sp.expand(nondimensional(acceleration.subs(omega, 0) * x0 / v0**2))
    pull_round = motion.orbital_momentum_rate.subs(tangential) / (m * a**2 * omega0) * x0 / v0
    rate[orbit] = nondimensional(pull_round)
    if not structure.reduced:
        spin_up = motion.spin_acceleration.subs(tangential).subs(arm, a * LEVER)
        rate[spin] = nondimensional(spin_up * x0 / (v0 * omega0))
    if structure.strings:
        rate[beta] = nondimensional(omega * x0 / v0).subs(orbit, ORBITAL_RATE * DISTANCE**2)
    return rate


def _functions(structure: Structure, states: tuple[sp.Symbol, ...]) -> tuple[ModelFunction, ...]:
    rates = _rates(structure)
    inward = -(rates[opening].subs(FILM_FORCE, 0))
    functions = [
        ModelFunction(
            "right_hand_side",
            "Rates of the states per v0/x0.",
            tuple((s.name, rates[s]) for s in states),
            regional=True,
        )
    ]
    if structure.oblique:
        held = {gap: sp.Integer(0), opening: sp.Integer(0)}
        functions.append(
            ModelFunction(
                "resting_rates",
                "Rates of the states per v0/x0 in resting contact: gap held, the rotation goes on.",
                tuple((s.name, held.get(s, rates[s])) for s in states),
                regional=True,
            )
        )
        functions.append(
            ModelFunction(
                "turning_rate",
                "Rate of the angle turned by the line of centres, rad per x0/v0 (a quadrature without strings).",
                ((beta.name, nondimensional(omega * x0 / v0).subs(orbit, ORBITAL_RATE * DISTANCE**2)),),
            )
        )
    functions.append(
        ModelFunction(
            "inward_force",
            "What holds a doublet at rest together, over m v0^2/x0: positive inward.",
            (("inward_force", inward),),
        )
    )
    functions.append(_events(structure, inward))
    functions.append(
        ModelFunction(
            "reversal",
            "State just after a reversal by the solids: u -> -e_dry u, all else continues.",
            tuple((s.name, -e_dry * opening if s == opening else s) for s in states),
        )
    )
    start: dict[sp.Symbol, sp.Expr] = {
        gap: sp.Integer(1),
        opening: sp.Integer(-1),
        orbit: (4 + aspect) ** 2,
        spin: sp.Integer(0),
        beta: sp.Integer(0),
    }
    functions.append(ModelFunction("start", "State at first touch.", tuple((s.name, start[s]) for s in states)))
    functions += _ledger(structure)
    functions.append(_outputs(structure))
    functions += _level(structure)
    return tuple(functions)


def _events(structure: Structure, inward: sp.Expr) -> ModelFunction:
    """Event functions, each positive before its event."""
    events: list[tuple[str, sp.Expr]] = [
        ("glass", glass_number - slot_call("glass", "pressure", gap, -opening)),
        ("elastic", gap - elastic_gap),
        ("rough", gap - rough_gap),
        ("turning", opening),
        ("rupture", (rupture_gap if structure.bridge else 1) - gap),
    ]
    if structure.bridge:
        events.append(("film_edge", 1 - gap))
    if structure.oblique:
        events.append(("tangential_edge", slot_call("shear", "edge", aspect) - gap))
        events.append(("release", inward))
    if structure.oblique and structure.strings:
        events += [("half_turn", sp.pi - beta), ("unwinding", orbit)]
    doc = (
        "Event functions, each positive before its event: the criteria while closing, `turning` the opening velocity "
        "(its sign tells closing from opening), `release` in resting contact."
    )
    return ModelFunction("events", doc, tuple(events))


def _kinetic(structure: Structure) -> sp.Expr:
    energy = sp.expand(equations_of_motion().kinetic_energy / (m * v0**2))
    if not structure.oblique:
        energy = energy.subs({omega: 0, xi: 0})
    orbital = sp.Rational(1, 2) * m * r**2 * omega**2 / (m * v0**2)
    rest = sp.expand(energy - sp.expand(orbital)) if structure.oblique else energy
    result = nondimensional(rest)
    if structure.oblique:
        result += nondimensional(orbital).subs(orbit, ORBITAL_RATE * DISTANCE**2)
    return result


def _ledger(structure: Structure) -> list[ModelFunction]:
    energies = [("kinetic", _kinetic(structure))]
    if structure.strings:
        energies.append(
            (
                "strings",
                nondimensional(4 * m * g * a / (m * v0**2))
                * slot_call("strings", "rise", string_ratio, offset_squared),
            )
        )
    rates = [("normal_lubrication", FILM_FORCE * opening)]
    if structure.bridge:
        rates.append(("capillary", BRIDGE_FORCE * opening))
    functions = []
    if structure.oblique and not structure.reduced:
        power = TANGENTIAL * SHEAR_FORCE * (a * DISTANCE * omega0 * ORBITAL_RATE - 2 * a * LEVER * xi)
        rates.append(("tangential_lubrication", nondimensional(power * x0 / v0 / (m * v0**2))))
        drift = MOMENTUM / (4 + aspect) ** 2
        functions.append(
            ModelFunction("angular_momentum", "Angular momentum over its start value.", (("angular_momentum", drift),))
        )
    dry = sp.Rational(1, 2) * opening**2 * (1 - e_dry**2)
    return [
        ModelFunction("energies", "Energies of the state over m v0^2.", tuple(energies)),
        ModelFunction(
            "energy_rates",
            "Energy taken per x0/v0 by the film, the bridge and the shear, over m v0^2.",
            tuple(rates),
            regional=True,
        ),
        ModelFunction(
            "reversal_loss",
            "Energy lost in a reversal that starts from this state, over m v0^2.",
            (("dry_contact", dry),),
        ),
        *functions,
    ]


def _outputs(structure: Structure) -> ModelFunction:
    outputs: list[tuple[str, sp.Expr]] = [("restitution", opening)]
    if structure.oblique:
        outputs += [
            ("tangential_restitution", DISTANCE * ORBITAL_RATE / (4 + aspect)),
            ("final_rotation_rate", ORBITAL_RATE),
            ("final_spin", spin),
        ]
    doc = "What a separated doublet shows: restitutions, and rates over omega0."
    return ModelFunction("outputs", doc, tuple(outputs))


def _level(structure: Structure) -> list[ModelFunction]:
    """Pieces of the stick certificate: least energy at a gap for the state's angular momentum, and its slope."""
    if structure.oblique and structure.strings:
        return []
    energy, slope = sp.Integer(0), sp.Integer(0)
    if structure.oblique:
        square = (m * a**2 * omega0 * MOMENTUM) ** 2
        energy += nondimensional(square / (2 * m * a**2 * INERTIA_RATIO) / (m * v0**2))
        body = (doublet_inertia() / (m * a**2)).diff(x) * x0  # d inertia_ratio / d gap
        slope += energy.diff(INERTIA_RATIO) * nondimensional(body)
    if structure.bridge:
        slope += BRIDGE_FORCE
    if structure.strings:
        energy += nondimensional(4 * m * g * a / (m * v0**2)) * slot_call(
            "strings", "rise", string_ratio, offset_squared
        )
        slope += STRING_PULL
    doc = (
        "Least energy over m v0^2 of a doublet with this gap and angular momentum, capillary work left out, "
        "and the slope with it."
    )
    return [ModelFunction("effective_potential", doc, (("energy", energy), ("slope", slope)))]
