"""Dimensionless groups: their number (nullspace), their definition (ratios of terms), and the substitution.

Scales are x0 for the gap, v0 for velocities, x0/v0 for time, and for angular velocities Omega = v0 T/(4a) with the
largest tangential speed v0 T at initial contact (omega0 where nothing spins): states are of order one.
"""

from collections.abc import Sequence
from functools import cache
from itertools import chain

import sympy as sp
from sympy.core.function import AppliedUndef

from ..vocabulary import quantities as q
from .attraction import van_der_waals_force
from .references import LIAN, RAGER, SERAYSSOL

DISTANCE = sp.Symbol("distance", positive=True)  # r/a, named in emitted code
COMMON = (LIAN,)  # publication of the rupture distance, unless a law has its own
ELASTIC = (RAGER, SERAYSSOL)  # publications of the elastic length
_MANY = 7  # roots and functions, beyond which sympy's polynomials in them are not factored


def rupture_distance() -> sp.Expr:
    """x_f = R V^(1/3) (1 + phi/2) of a bridge (Lian, Thornton & Adams 1993)."""
    return q.R * q.volume ** sp.Rational(1, 3) * (1 + q.contact_angle / 2)


def elastic_compliance() -> sp.Expr:
    """theta_e = 2 (1 - nu^2)/(pi E) of two equal spheres (1/Pa): the sum of (1 - nu_i^2)/(pi E_i)."""
    compliance = (1 - q.nu**2) / (sp.pi * q.E)
    return compliance + compliance


def elastic_length() -> sp.Expr:
    """x_r = (3 pi theta_e mu a^(3/2) v0/sqrt 2)^(2/5): gap at which elastic deformation stops the approach.

    From Davis, Rager & Good 2002, after Davis, Serayssol & Hinch 1986.
    """
    return (3 * sp.pi * elastic_compliance() * q.mu * q.a ** sp.Rational(3, 2) * q.v0 / sp.sqrt(2)) ** sp.Rational(2, 5)


def dimension_matrix(symbols: Sequence[sp.Symbol]) -> sp.Matrix:
    """Matrix of dimension exponents: rows mass, length, time; a column for each quantity."""
    return sp.Matrix([[sp.Rational(q.DIMENSIONS[s].exponents[row]) for s in symbols] for row in range(3)])


EQUAL = sp.Integer(4)  # centre distance at contact over a, of equal spheres

# The force scales in the equation of motion at initial contact
INERTIA = q.m * q.v0**2 / q.x0  # m du/dt
VISCOUS = 6 * sp.pi * q.mu * q.a**2 * q.v0 / q.x0  # F_n
CAPILLARY = sp.pi * q.R * q.sigma  # F_c
CENTRIFUGAL = q.m * q.a * q.omega0**2  # m r omega^2
VAN_DER_WAALS = van_der_waals_force().subs(q.x, q.x0)  # F_w at initial contact
LUBRICATION_PRESSURE = 3 * q.mu * q.a * q.v0 / q.x0**2


@cache
def group_definitions() -> dict[sp.Symbol, sp.Expr]:
    """Each group in SI quantities, as a ratio of two terms of the model."""
    return {
        q.stokes: INERTIA / VISCOUS,
        q.capillary: VISCOUS / CAPILLARY,
        q.centrifugal: (CENTRIFUGAL / (q.a * q.sigma)).subs(q.omega0, initial_rate()),
        q.adhesion: VAN_DER_WAALS / VISCOUS,
        q.reynolds: q.rho * q.v0 * q.x0 / q.mu,
        q.aspect: q.x0 / q.a,
        q.obliquity: sp.tan(q.theta0),
        q.glass_number: q.p_gt / LUBRICATION_PRESSURE,
        q.weight: q.m * q.g / INERTIA,
        q.string_ratio: q.l_s / q.a,
        q.elastic_gap: elastic_length() / q.x0,
        q.rough_gap: q.x_b / q.x0,
        q.rupture_gap: rupture_distance() / q.x0,
    }


@cache
def scale_definitions() -> dict[sp.Symbol, sp.Expr]:
    """Scales that are not quantities of a scene, in terms of those that are, and of T."""
    from .partners.bodies import centres  # which builds on this module's neighbours

    apart = centres() * q.a
    per_pair = q.v0 * sp.tan(q.theta0) / apart
    return {
        q.omega0: initial_rate(),
        q.pair_rate: per_pair,
        q.rate_scale: q.v0 * q.obliquity / (EQUAL * q.a),
        q.rate_scale_pair: q.v0 * q.obliquity / apart,
        q.rate_scale_wall: q.v0 * q.obliquity / q.a,
        q.pair_centrifugal: q.m * per_pair**2 / q.sigma,
        q.cohesive_centrifugal: generalised_centrifugal(q.attraction),
    }


@cache
def impact_groups(partner: str = "") -> dict[sp.Symbol, sp.Expr]:
    """T, and the rates at initial contact over their scale, for a partner: "", "pair", "wall" or "space".

    T is a scale and no more: no result depends on it, so its own derivatives are never needed. Where nothing moves
    sideways it vanishes, and any other number does.
    """
    from .partners.bodies import radii

    if partner == "space":
        return _vector_groups()
    scales = scale_definitions()
    scale = {"": scales[q.rate_scale], "pair": scales[q.rate_scale_pair], "wall": scales[q.rate_scale_wall]}[partner]
    levers = {"": (q.R,), "pair": radii(), "wall": (q.a,)}[partner]
    spins = zip(levers, (q.impact_spin, q.impact_partner_spin), strict=False)
    rates = first_rates(scale)
    if partner != "pair":
        del rates[q.initial_partner_spin]
    return {q.obliquity: sp.Max(sp.tan(q.theta0), *(lever * sp.Abs(rate) / q.v0 for lever, rate in spins)), **rates}


def _vector_groups() -> dict[sp.Symbol, sp.Expr]:
    """The same for vectors in the laboratory's axes: T is a length, so that no direction is distinguished."""
    from .partners.bodies import centres, radii

    levers = (centres() * q.a, *radii())
    rates = (q.impact_turnings, q.impact_spins, q.impact_partner_spins)
    speeds = sp.Add(*(lever**2 * rate**2 for lever, vector in zip(levers, rates, strict=True) for rate in vector))
    unit = scale_definitions()[q.rate_scale_pair]
    groups = (q.initial_turnings, q.initial_spins, q.initial_partner_spins)
    pairs = zip(chain(*groups), chain(*rates), strict=True)
    return {q.obliquity: sp.sqrt(speeds) / q.v0, **{group: rate / unit for group, rate in pairs}}


def first_rates(scale: sp.Expr) -> dict[sp.Symbol, sp.Expr]:
    """The rates at initial contact over their scale."""
    return {
        q.initial_turning: sp.tan(q.theta0) / q.obliquity,
        q.initial_spin: q.impact_spin / scale,
        q.initial_partner_spin: q.impact_partner_spin / scale,
    }


def generalised_centrifugal(force: sp.Expr) -> sp.Expr:
    """Ce_F = m omega0^2 a/F: the scale of the centrifugal force over an attraction F of any law.

    The paper's Ce = m omega0^2/sigma is Ce_F with F = a sigma, so for the constant bridge Ce_F = Ce/(4 pi cos(phi)).
    """
    return CENTRIFUGAL / force


@cache
def to_groups(centres: sp.Expr = EQUAL) -> dict[sp.Symbol, sp.Expr]:
    """SI quantities in terms of groups, a, v0 and mu (which cancel from every dimensionless expression).

    Arguments:
        centres: the centre distance at contact over a.
    """
    film = q.aspect * q.a
    definitions = group_definitions()

    def solved(group: sp.Symbol, quantity: sp.Symbol) -> sp.Expr:
        # groups are monomials in the quantity: there is one solution, and nothing in it to simplify
        (solution,) = sp.solve(sp.Eq(definitions[group], group), quantity, check=False, simplify=False)
        return solution.subs(q.x0, film)

    mass = solved(q.stokes, q.m)
    return {
        q.m: mass,
        q.x0: film,
        q.sigma: solved(q.capillary, q.sigma),
        q.p_gt: solved(q.glass_number, q.p_gt),
        q.g: solved(q.weight, q.g).subs(q.m, mass),
        q.A_H: solved(q.adhesion, q.A_H),
        q.l_s: solved(q.string_ratio, q.l_s),
        q.omega0: q.v0 * q.obliquity * q.initial_turning / (centres * q.a),
        q.rate_scale: q.v0 * q.obliquity / (centres * q.a),
        q.x: film * q.gap,
        q.u: q.v0 * q.normal_velocity,
        q.omega: q.rate_scale * q.orbital_momentum / DISTANCE**2,
        q.xi: q.rate_scale * q.spin,
        q.partner_spin_rate: q.rate_scale * q.partner_spin,
    }


class ScalingError(ValueError):
    """A dimensional quantity remains in an expression that should be dimensionless."""


@cache
def nondimensional(expression: sp.Expr, centres: sp.Expr = EQUAL) -> sp.Expr:
    """A dimensionless SI expression in states and groups: arguments of laws in the gap, everything else in r/a.

    Arguments:
        centres: the centre distance at contact over a.

    Raises:
        ScalingError: a dimensional quantity remains; the message names it.
    """
    rules = to_groups(centres)
    calls = {node: _substituted(node, rules) for node in expression.atoms(AppliedUndef)}
    body = sp.sympify(expression).xreplace(calls)
    result = sp.simplify(_substituted(body, {**rules, q.x: q.a * (DISTANCE - centres)}))
    if remainder := dimensional(result):
        raise ScalingError(f"{', '.join(remainder)} did not cancel from {expression}")
    return result


def dimensional(expression: sp.Expr) -> list[str]:
    """Names of the quantities with a dimension in an expression."""
    return sorted(s.name for s in expression.free_symbols if s in q.DIMENSIONS and any(q.DIMENSIONS[s].exponents))


def cancelled(label: str, by_term: sp.Expr, whole: sp.Expr) -> sp.Expr:
    """An expression simplified by its terms, or as a whole if a quantity is left in one; ScalingError if it stays.

    What is left in a condition, an extreme or a power is cancelled by units in which it is 1: the whole is a number.
    """
    result = sp.simplify(whole) if dimensional(by_term) else by_term
    result = result.subs(dict.fromkeys((q.a, q.v0, q.mu), sp.Integer(1)))
    if remainder := dimensional(result):
        raise ScalingError(f"{label}: {', '.join(remainder)} did not cancel from {result}")
    return result


def as_product(expression: sp.Expr) -> sp.Expr:
    """An expression in factors, in common ones of its terms only where full ones take sympy too long.

    That time grows exponentially with the number of roots and functions: 0.3 s for seven, 6 s for twelve. exp(50 z)
    is exp(z)**50 to it, of a polynomial of that degree, so that such an exponential has a name meanwhile.
    """
    high = {node: sp.Dummy(positive=True) for node in expression.atoms(sp.exp) if _degree(node.exp) > _MANY}
    if high:
        return as_product(expression.xreplace(high)).xreplace({name: node for node, name in high.items()})
    atoms = expression.atoms(sp.Pow, sp.Function)
    irrational = {atom.base if isinstance(atom, sp.Pow) else atom for atom in atoms if not _is_whole_power(atom)}
    return sp.factor(expression) if len(irrational) <= _MANY else sp.factor_terms(expression)


def _degree(exponent: sp.Expr) -> sp.Expr:
    return max(abs(term.as_coeff_Mul()[0]) for term in sp.Add.make_args(exponent))


def _is_whole_power(atom: sp.Basic) -> bool:
    return isinstance(atom, sp.Pow) and bool(atom.exp.is_Integer)


def _substituted(expression: sp.Expr, rules: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    for _ in range(3):  # rotation rate -> its scale -> v0 and T
        expression = expression.xreplace(rules)
    if isinstance(expression, AppliedUndef):
        return expression.func(*(sp.simplify(argument) for argument in expression.args))
    return expression


def initial_rate() -> sp.Expr:
    """omega0: the tangential speed v0 tan(theta0) over the centre distance, taken as 4a as in the paper."""
    return q.v0 * sp.tan(q.theta0) / (EQUAL * q.a)


def start_values() -> dict[sp.Symbol, sp.Expr]:
    """SI values of x, u, omega, xi and beta at initial contact: at x = x0 with v0 and theta0; spheres may spin."""
    return {q.x: q.x0, q.u: -q.v0, q.omega: initial_rate(), q.xi: q.impact_spin, q.beta: sp.Integer(0)}
