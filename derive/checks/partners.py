"""Unequal partners: conserved quantities of a general pair (found by nullspace), friction, equal and wall limits."""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from ..equations.model import Model, derive
from ..physics.laws import LAWS
from ..physics.partners import bodies, rolling, wall
from ..physics.structure import Partner, Structure
from ..vocabulary.quantities import (
    a,
    decay,
    gap,
    initial_partner_spin,
    initial_spin,
    initial_turning,
    mass_ratio,
    mu,
    normal_velocity,
    orbital_momentum,
    partner_spin,
    radius_ratio,
    roll,
    slide,
    slide_rate,
    spin,
    xi,
)
from .base import Check, vanishing
from .closed import emitted_rates, filled, opened, opened_rates

_PARTNERS: tuple[Partner, ...] = ("pair", "wall")
_MIDGAP = {"arm": LAWS["arm"]["midgap"]}
_PAIR, _WALL = (Structure(True, True, False, attraction=True, partner=partner) for partner in _PARTNERS)


def conserved_momenta() -> list[dict[str, sp.Expr]]:
    """Linear combinations of the pair's momenta, by coordinate, whose rate vanishes for any forces.

    The tangential force follows from the torques: r F_t = T_1 + T_2.
    """
    motion = bodies.equations_of_motion()
    balance = {bodies.F_t: (bodies.T_1 + bodies.T_2) / bodies.r}
    rates = {name: sp.expand(sp.simplify(rate.subs(balance))) for name, rate in motion.rates.items()}
    terms = sorted({term for rate in rates.values() for term in rate.as_coefficients_dict()}, key=str)
    matrix = sp.Matrix([[rate.as_coefficients_dict()[term] for rate in rates.values()] for term in terms if term != 0])
    return [
        {name: weight for name, weight in zip(rates, vector, strict=True) if weight != 0}
        for vector in matrix.nullspace()
    ]


def momenta_are_found() -> Check:
    """Linear momentum and total angular momentum are the only invariants linear in the momenta."""
    found = conserved_momenta()
    expected = [{"X": 1}, {"Y": 1}, {"beta": 1, "alpha_1": 1, "alpha_2": 1}]
    missing = [each for each in expected if each not in found] + [each for each in found if each not in expected]
    return Check(
        "pair: conserved momenta",
        "two unequal spheres that act on each other only keep P_X, P_Y and L = m r^2 omega + I_1 xi_1 + I_2 xi_2",
        not missing,
        "; ".join(" + ".join(f"p_{name}" for name in each) for each in found),
    )


def angular_momentum_is_kept() -> Check:
    """The emitted equations conserve the emitted angular momentum, for any laws with the lever arm at mid-gap."""
    model = derive(_PAIR)
    momentum = opened(model, model["angular_momentum"]["angular_momentum"])
    rates = opened_rates(model)
    change = sum(
        (momentum.diff(state) * rates[state] for state in (orbital_momentum, spin, partner_spin)), sp.Integer(0)
    )
    statement = "dL/dt = 0 along the emitted equations (midgap arm, any law)"
    return vanishing("pair: angular momentum", statement, [filled(change, _MIDGAP)])


def energy_is_accounted_for() -> Check:
    """The kinetic energy changes by the work of film, shear, bridge and attraction only, for pair and wall."""
    left = []
    for structure in (_PAIR, _WALL):
        model = derive(structure)
        stored = opened(model, model["energies"]["kinetic"])
        change = sum((stored.diff(state) * rate for state, rate in opened_rates(model).items()), sp.Integer(0))
        left.append(change + sum(opened(model, rate) for _, rate in model["energy_rates"].outputs))
    return vanishing("pair, wall: energy", "d(kinetic)/dt = -(film + shear + bridge + attraction power)", left)


def friction_dissipates() -> Check:
    """The torque matrix is symmetric (Lorentz) and positive definite, and the force vanishes in rigid rotation."""
    matrix = rolling.torque_matrix()
    positive = bool(matrix[0, 0].is_positive and sp.expand(matrix.det()).is_positive)
    left = [matrix[0, 1] - matrix[1, 0]]
    # the force from stress and pressure on a sphere agrees with the torques and dL/dt = 0
    reduced = rolling.R_1 * rolling.R_2 / (rolling.R_1 + rolling.R_2)
    by_torque = (matrix[0, :] + matrix[1, :]) / (rolling.R_1 + rolling.R_2)
    left += [sp.simplify(each.subs(a, reduced)) for each in by_torque - rolling.force_on_second()]
    shear, pressed = rolling.stresses(), rolling.pressure_forces()
    left.append(sp.simplify((sum(shear) + sum(pressed)).subs(a, reduced)))  # action and reaction
    check = vanishing(
        "pair: friction",
        "T_i = A_ij (omega - xi_j) ln(h_outer/x): A symmetric, positive definite; r F_t = T_1 + T_2",
        left,
    )
    return check if positive else Check(check.name, check.statement, False, "not positive definite")


def published_logarithms() -> Check:
    """The leading logarithms of Jeffrey & Onishi (1984) and, beside a wall, of Goldman, Cox & Brenner (1967)."""
    lam = radius_ratio
    matrix = rolling.torque_matrix().subs(dict(zip((rolling.R_1, rolling.R_2), bodies.radii(), strict=True)))
    own, other = bodies.radii()
    total = (sum(matrix[0, :]) + sum(matrix[1, :])) / (own + other) ** 2  # force per relative velocity, no spins
    coupling = sum(matrix[0, :]) / (own + other)  # torque on 1 per relative velocity
    published = [
        total - 6 * sp.pi * mu * own * sp.Rational(4, 15) * lam * (2 + lam + 2 * lam**2) / (1 + lam) ** 3,  # Y^A_11
        coupling - 4 * sp.pi * mu * own**2 * lam * (4 + lam) / (5 * (1 + lam) ** 2),  # Y^B_11
        matrix[0, 0] - 8 * sp.pi * mu * own**3 * sp.Rational(2, 5) * lam / (1 + lam),  # Y^C_11
        matrix[0, 1] - sp.pi * mu * (own + other) ** 3 * sp.Rational(4, 5) * lam**2 / (1 + lam) ** 4,  # Y^C_12
    ]
    torque, force = wall.friction()
    published += [
        force - 6 * sp.pi * mu * a * (sp.Rational(8, 15) * slide_rate - sp.Rational(2, 15) * a * xi),
        torque - 8 * sp.pi * mu * a**2 * (slide_rate / 10 - sp.Rational(2, 5) * a * xi),
    ]
    return vanishing(
        "pair, wall: published logarithms",
        "Y^A_11, Y^B_11, Y^C_11, Y^C_12 of Jeffrey & Onishi (1984); Goldman, Cox & Brenner (1967) beside a wall",
        published,
    )


def equal_is_the_doublet() -> Check:
    """A pair of ratio 1 keeps its spins equal, and is then the doublet of equal spheres."""
    left = []
    pair, equal = derive(_PAIR), derive(Structure(True, True, False, attraction=True))
    together = {radius_ratio: 1, mass_ratio: 1, partner_spin: spin, initial_partner_spin: initial_spin}
    for arm in LAWS["arm"].values():
        rates = {s: filled(rate, {"arm": arm}).subs(together) for s, rate in emitted_rates(pair).items()}
        expected = {s: filled(rate, {"arm": arm}) for s, rate in emitted_rates(equal).items()}
        left += [rates[s] - rate for s, rate in expected.items()]
        left.append(rates[partner_spin] - rates[spin])  # equal spins stay equal
    left += _outputs_differ(pair, equal, together)
    return vanishing("pair of ratio 1", "spins stay equal, and every equation is the equal doublet's", left)


def _outputs_differ(pair: Model, equal: Model, together: dict[sp.Symbol, sp.Expr]) -> list[sp.Expr]:
    left = []
    for name in ("energies", "angular_momentum", "effective_potential", "inward_force", "turning_rate", "outputs"):
        there = pair[name].by_name
        for key, expression in equal[name].outputs:
            left.append(pair.expanded(there[key]).subs(together) - equal.expanded(expression))
    return left


def slip_energy_adds() -> Check:
    """The energy of a state is that of rigid rotation with its angular momentum plus that of its deviation from it.

    So at a given gap and angular momentum, J exceeds its value in rigid rotation by no more than its slip energy allows
    (`solvers.certificates.barrier`, resting contact).
    """
    left = []
    for structure in (_PAIR, replace(_PAIR, partner="")):
        model = derive(structure)
        kinetic = opened(model, model["energies"]["kinetic"]).subs(normal_velocity, 0)
        rigid = {s: opened(model, model["rigid_rotation"][s.name]) for s in model.states[2:]}
        least = opened(model, model["effective_potential"]["energy"])
        apart = kinetic.subs({state: state - value for state, value in rigid.items()}, simultaneous=True)
        left.append(kinetic - least - apart)
    return vanishing("pair, doublet: slip energy", "T = L^2/(2 I) + T of the deviation from rigid rotation", left)


def wall_is_head_on() -> Check:
    """Beside a wall the motion along the line of centres is the head-on one, independent of the tangential motion.

    Its rates, its events and its certificate are those of the head-on structure, expression by expression: a stick,
    bounce or certificate of the head-on structure is one of the oblique structure.
    """
    beside, alone = derive(_WALL), derive(Structure(False, True, False, attraction=True))
    rates, expected = emitted_rates(beside), emitted_rates(alone)
    left = [rates[state] - expected[state] for state in (gap, normal_velocity)]
    for name in ("events", "inward_force", "effective_potential", "rebound", "rebound_loss"):
        here = beside[name].by_name
        left += [beside.expanded(here[key]) - alone.expanded(value) for key, value in alone[name].outputs]
    (escape,), (kinetic,) = beside["escape_energy"].outputs, alone["energies"].outputs
    left.append(escape[1] - kinetic[1])
    statement = "no centrifugal force is left: rates, events, rebound and stick proofs of the gap are the head-on ones"
    return vanishing("wall: normal motion", statement, left)


def wall_friction_decays() -> Check:
    """Slide and roll as sums of two exponentials of one state solve the equations of friction.

    They stay positive if the sphere does not spin at first.
    """
    model = derive(_WALL)
    known, (rate,) = dict(model.definitions), wall.rotation().rates.values()
    definitions, rates = wall.friction_rates()
    modes = {wall.SLOW_MODE: known[wall.SLOW_MODE], wall.FAST_MODE: known[wall.FAST_MODE]}
    solved = {state: known[state].subs(modes) for state in (slide, roll)}
    left = [solved[slide].subs(decay, 0) - initial_turning, solved[roll].subs(decay, 0) - initial_spin]
    left += [solved[s].diff(decay) * rate - rates[s].subs(dict(definitions)).subs(solved) for s in (slide, roll)]
    check = vanishing(
        "wall: friction",
        "slide and roll decay in two modes of constant shape; the gap enters through their common rate alone",
        left,
    )
    ratio = known[wall.FAST_MODE].args[0] / -decay
    slower = sp.Symbol("slower", positive=True)
    unspun = {initial_turning: 1, initial_spin: 0}
    shares = [known[s].subs(unspun).subs(wall.SLOW_MODE, wall.FAST_MODE + slower) for s in (slide, roll)]
    positive = sp.simplify(ratio) > 1 and all(sp.expand(share).is_positive for share in shares)
    return check if positive else Check(check.name, check.statement, False, f"not positive: {shares}")


def partner_checks() -> tuple[Check, ...]:
    """Every check of unequal partners."""
    return (
        momenta_are_found(),
        angular_momentum_is_kept(),
        energy_is_accounted_for(),
        friction_dissipates(),
        published_logarithms(),
        equal_is_the_doublet(),
        slip_energy_adds(),
        wall_is_head_on(),
        wall_friction_decays(),
    )
