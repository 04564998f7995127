"""Unequal partners: conserved quantities of a general pair (found by nullspace), friction, equal and wall limits."""

from dataclasses import replace

import sympy as sp

from ..equations.model import derive
from ..laws import filled
from ..physics.partners import bodies, rolling, wall
from ..physics.structure import Partner, Structure
from ..vocabulary import quantities as q
from .base import MIDGAP, SIZES, Check, Evidence, check, checks, special_case

_PARTNERS: tuple[Partner, ...] = ("pair", "wall")
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
    vectors = (zip(rates, vector, strict=True) for vector in matrix.nullspace())
    return [{name: weight for name, weight in vector if weight != 0} for vector in vectors]


@checks
def momenta_are_found() -> Check:
    """Linear momentum and total angular momentum are the only invariants linear in the momenta."""
    result = conserved_momenta()
    expected = [{"X": 1}, {"Y": 1}, {"beta": 1, "alpha_1": 1, "alpha_2": 1}]
    missing = len(result) != len(expected) or any(momentum not in result for momentum in expected)
    statement = (
        "two unequal spheres that act on each other only keep P_X, P_Y and L = m r^2 omega + I_1 xi_1 + I_2 xi_2"
    )
    figure = "; ".join(" + ".join(f"p_{name}" for name in names) for names in result)
    return Check("pair: conserved momenta", statement, not missing, figure)


@check("pair: angular momentum", "dL/dt = 0 along the emitted equations (midgap arm, any law)")
def angular_momentum_is_kept() -> Evidence:
    """The emitted equations conserve the emitted angular momentum, for any laws with the lever arm at mid-gap."""
    model = derive(_PAIR)
    momentum = model.expanded(model["angular_momentum"]["angular_momentum"], SIZES)
    rates = model.by_state("right_hand_side", SIZES)
    change = sp.Add(*(momentum.diff(state) * rates[state] for state in (q.orbital_momentum, q.spin, q.partner_spin)))
    yield filled(change, MIDGAP)


@check("pair, wall: energy", "d(kinetic)/dt = -(film + shear + bridge + attraction power)")
def energy_is_accounted_for() -> Evidence:
    """The kinetic energy changes by the work of film, shear, bridge and attraction only, for pair and wall."""
    for structure in (_PAIR, _WALL):
        model = derive(structure)
        stored = model.expanded(model["energies"]["kinetic"], SIZES)
        rates = model.by_state("right_hand_side", SIZES)
        change = sum(stored.diff(state) * rate for state, rate in rates.items())
        yield change + sum(model.results("energy_rates", SIZES).values())


@check("pair: friction", "T_i = A_ij (omega - xi_j) ln(h_outer/x): A symmetric, positive definite; r F_t = T_1 + T_2")
def friction_dissipates() -> Evidence:
    """The torque matrix is symmetric (Lorentz) and positive definite, and the force vanishes in rigid rotation."""
    matrix = rolling.torque_matrix()
    positive = bool(matrix[0, 0].is_positive and sp.expand(matrix.det()).is_positive)
    yield matrix[0, 1] - matrix[1, 0]
    # the force from stress and pressure on a sphere agrees with the torques and dL/dt = 0
    reduced = rolling.R_1 * rolling.R_2 / (rolling.R_1 + rolling.R_2)
    by_torque = (matrix[0, :] + matrix[1, :]) / (rolling.R_1 + rolling.R_2)
    yield from [sp.simplify(entry.subs(q.a, reduced)) for entry in by_torque - rolling.force_on_second()]
    shear, pressed = rolling.stresses(), rolling.pressure_forces()
    yield sp.simplify((sum(shear) + sum(pressed)).subs(q.a, reduced))
    yield positive, "not positive definite"


@check(
    "pair, wall: published logarithms",
    "Y^A_11, Y^B_11, Y^C_11, Y^C_12 of Jeffrey & Onishi (1984); Goldman, Cox & Brenner (1967) beside a wall",
)
def published_logarithms() -> Evidence:
    """The leading logarithms of Jeffrey & Onishi (1984) and, beside a wall, of Goldman, Cox & Brenner (1967)."""
    lam = q.radius_ratio
    matrix = rolling.torque_matrix().subs(dict(zip((rolling.R_1, rolling.R_2), bodies.radii(), strict=True)))
    first, other = bodies.radii()
    total = (sum(matrix[0, :]) + sum(matrix[1, :])) / (first + other) ** 2  # force per relative velocity, no spins
    coupling = sum(matrix[0, :]) / (first + other)  # torque on 1 per relative velocity
    yield from (
        total - 6 * sp.pi * q.mu * first * sp.Rational(4, 15) * lam * (2 + lam + 2 * lam**2) / (1 + lam) ** 3,  # Y^A_11
        coupling - 4 * sp.pi * q.mu * first**2 * lam * (4 + lam) / (5 * (1 + lam) ** 2),  # Y^B_11
        matrix[0, 0] - 8 * sp.pi * q.mu * first**3 * sp.Rational(2, 5) * lam / (1 + lam),  # Y^C_11
        matrix[0, 1] - sp.pi * q.mu * (first + other) ** 3 * sp.Rational(4, 5) * lam**2 / (1 + lam) ** 4,  # Y^C_12
    )
    torque, force = wall.friction()
    yield from (
        force - 6 * sp.pi * q.mu * q.a * (sp.Rational(8, 15) * q.slide_rate - sp.Rational(2, 15) * q.a * q.xi),
        torque - 8 * sp.pi * q.mu * q.a**2 * (q.slide_rate / 10 - sp.Rational(2, 5) * q.a * q.xi),
    )


@check("pair of ratio 1", "spins stay equal, and every equation is the equal doublet's")
def equal_is_the_doublet() -> Evidence:
    """A pair of ratio 1 keeps its spins equal, and is then the doublet of equal spheres."""
    pair, equal = derive(_PAIR), derive(Structure(True, True, False, attraction=True))
    together = {q.radius_ratio: 1, q.mass_ratio: 1, q.partner_spin: q.spin, q.initial_partner_spin: q.initial_spin}
    rates = {s: filled(rate, MIDGAP).subs(together) for s, rate in pair.by_state("right_hand_side").items()}
    expected = {s: filled(rate, MIDGAP) for s, rate in equal.by_state("right_hand_side").items()}
    yield from [rates[s] - rate for s, rate in expected.items()]
    yield rates[q.partner_spin] - rates[q.spin]
    names = ("energies", "angular_momentum", "effective_potential", "inward_force", "turning_rate", "outputs")
    yield from special_case(equal, names, pair, lambda expression: expression.subs(together))


@check("pair, doublet: slip energy", "T = L^2/(2 I) + T of the deviation from rigid rotation")
def slip_energy_adds() -> Evidence:
    """The energy of a state is that of rigid rotation with its angular momentum plus that of its deviation from it.

    So at a given gap and angular momentum, J exceeds its value in rigid rotation by no more than its slip energy allows
    (resting contact).
    """
    for structure in (_PAIR, replace(_PAIR, partner="")):
        model = derive(structure)
        kinetic = model.expanded(model["energies"]["kinetic"], SIZES).subs(q.normal_velocity, 0)
        rigid = {s: model.expanded(model["rigid_rotation"][s.name], SIZES) for s in model.states[2:]}
        least = model.expanded(model["effective_potential"]["energy"], SIZES)
        apart = kinetic.subs({state: state - value for state, value in rigid.items()}, simultaneous=True)
        yield kinetic - least - apart


@check(
    "wall: normal motion",
    "no centrifugal force is left: rates, events, rebound and stick proofs of the gap are the head-on ones",
)
def wall_is_head_on() -> Evidence:
    """Beside a wall the motion along the line of centres is the head-on one, independent of the tangential motion.

    Its rates, its events and its certificate are those of the head-on structure, expression by expression: a stick,
    bounce or certificate of the head-on structure is one of the oblique structure, with friction of the contact, too.
    """
    alone = derive(Structure(False, True, False, attraction=True))
    expected = alone.by_state("right_hand_side")
    names = ("events", "inward_force", "effective_potential", "rebound", "rebound_loss")
    for beside in (derive(_WALL), derive(replace(_WALL, friction="all"))):
        rates = beside.by_state("right_hand_side")
        yield from [rates[state] - expected[state] for state in (q.gap, q.normal_velocity)]
        yield from special_case(alone, names, beside, lambda expression: expression)
    impulse = beside.by_state("rubbed")
    yield from [impulse[state] - state for state in (q.gap, q.normal_velocity)]
    (escape,), (kinetic,) = beside["escape_energy"].outputs, alone["energies"].outputs
    yield escape[1] - kinetic[1]


@check(
    "wall: friction",
    "slide and roll decay in two modes of constant shape; the gap enters through their common rate alone",
)
def wall_friction_decays() -> Evidence:
    """Slide and roll as sums of two exponentials of one state solve the equations of friction.

    They stay positive if the sphere does not spin at first.
    """
    model = derive(_WALL)
    values, (rate,) = dict(model.definitions), wall.rotation().rates.values()
    definitions, rates = wall.friction_rates()
    modes = {wall.SLOW_MODE: values[wall.SLOW_MODE], wall.FAST_MODE: values[wall.FAST_MODE]}
    solved = {state: values[state].subs(modes) for state in (q.slide, q.roll)}
    yield from (solved[q.slide].subs(q.decay, 0) - q.initial_turning, solved[q.roll].subs(q.decay, 0) - q.initial_spin)
    yield from [
        solved[s].diff(q.decay) * rate - rates[s].subs(dict(definitions)).subs(solved) for s in (q.slide, q.roll)
    ]
    ratio = values[wall.FAST_MODE].args[0] / -q.decay
    slower = sp.Symbol("slower", positive=True)
    unspun = {q.initial_turning: 1, q.initial_spin: 0}
    shares = [values[s].subs(unspun).subs(wall.SLOW_MODE, wall.FAST_MODE + slower) for s in (q.slide, q.roll)]
    positive = sp.simplify(ratio) > 1 and all(sp.expand(share).is_positive for share in shares)
    yield positive, f"not positive: {shares}"
