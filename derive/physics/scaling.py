"""Dimensionless groups: their number (nullspace), their definition (ratios of terms), and the substitution.

Scales are x0 for the gap, v0 for velocities, x0/v0 for time, and for angular velocities Omega = v0 T/(4a) with the
largest tangential speed v0 T at initial contact (omega0 where nothing spins): states are of order one.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import sympy as sp
from sympy.core.function import AppliedUndef

from ..vocabulary.quantities import (
    A_H,
    DIMENSIONS,
    R,
    a,
    adhesion,
    aspect,
    attraction,
    capillary,
    centrifugal,
    cohesive_centrifugal,
    elastic_gap,
    g,
    gap,
    glass_number,
    impact_partner_spin,
    impact_partner_spins,
    impact_spin,
    impact_spins,
    impact_turnings,
    initial_partner_spin,
    initial_partner_spins,
    initial_spin,
    initial_spins,
    initial_turning,
    initial_turnings,
    l_s,
    m,
    mu,
    normal_velocity,
    obliquity,
    omega,
    omega0,
    orbital_momentum,
    p_gt,
    pair_centrifugal,
    pair_rate,
    partner_spin,
    partner_spin_rate,
    r,
    rate_scale,
    rate_scale_pair,
    rate_scale_wall,
    reynolds,
    rho,
    rough_gap,
    rupture_gap,
    sigma,
    spin,
    stokes,
    string_ratio,
    theta0,
    u,
    v0,
    weight,
    x,
    x0,
    x_b,
    xi,
)
from .laws.attraction import van_der_waals_force
from .laws.elastic_length import elastic_length
from .laws.rupture import rupture_distance
from .laws.start import initial_rate

DISTANCE = sp.Symbol("distance", positive=True)  # r/a, named in emitted code


def dimension_matrix(symbols: Sequence[sp.Symbol]) -> sp.Matrix:
    """Matrix of dimension exponents: rows mass, length, time; a column for each quantity."""
    return sp.Matrix([[sp.Rational(DIMENSIONS[s].exponents[row]) for s in symbols] for row in range(3)])


def pi_groups(symbols: Sequence[sp.Symbol]) -> list[sp.Expr]:
    """A basis of the dimensionless monomials of `symbols`, from the nullspace of their dimension matrix."""
    basis = dimension_matrix(symbols).nullspace()
    return [sp.prod([s**power for s, power in zip(symbols, vector, strict=True)]) for vector in basis]


def exponents(monomial: sp.Expr, symbols: Sequence[sp.Symbol]) -> sp.Matrix:
    """Exponents of `symbols` in a monomial (numeric factors ignored)."""
    powers = sp.powsimp(monomial).as_powers_dict()
    return sp.Matrix([powers.get(s, 0) for s in symbols])


EQUAL = sp.Integer(4)  # centre distance at contact over a, of equal spheres

# The force scales in the equation of motion at initial contact
INERTIA = m * v0**2 / x0  # m du/dt
VISCOUS = 6 * sp.pi * mu * a**2 * v0 / x0  # F_n
CAPILLARY = sp.pi * R * sigma  # F_c
CENTRIFUGAL = m * a * omega0**2  # m r omega^2
VAN_DER_WAALS = van_der_waals_force().subs(x, x0)  # F_w at initial contact
LUBRICATION_PRESSURE = 3 * mu * a * v0 / x0**2


@cache
def group_definitions() -> dict[sp.Symbol, sp.Expr]:
    """Each group in SI quantities, as a ratio of two terms of the model."""
    return {
        stokes: INERTIA / VISCOUS,
        capillary: VISCOUS / CAPILLARY,
        centrifugal: (CENTRIFUGAL / (a * sigma)).subs(omega0, initial_rate()),
        adhesion: VAN_DER_WAALS / VISCOUS,
        reynolds: rho * v0 * x0 / mu,
        aspect: x0 / a,
        obliquity: sp.tan(theta0),
        glass_number: p_gt / LUBRICATION_PRESSURE,
        weight: m * g / INERTIA,
        string_ratio: l_s / a,
        elastic_gap: elastic_length() / x0,
        rough_gap: x_b / x0,
        rupture_gap: rupture_distance(bridge=True) / x0,
    }


@cache
def scale_definitions() -> dict[sp.Symbol, sp.Expr]:
    """Scales that are not quantities of a scene, in terms of those that are, and of T."""
    from .partners.bodies import centres  # which builds on this module's neighbours

    apart = centres() * a
    per_pair = v0 * sp.tan(theta0) / apart
    return {
        omega0: initial_rate(),
        pair_rate: per_pair,
        rate_scale: v0 * obliquity / (EQUAL * a),
        rate_scale_pair: v0 * obliquity / apart,
        rate_scale_wall: v0 * obliquity / a,
        pair_centrifugal: m * per_pair**2 / sigma,
        cohesive_centrifugal: generalised_centrifugal(attraction),
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
    scale = {"": scales[rate_scale], "pair": scales[rate_scale_pair], "wall": scales[rate_scale_wall]}[partner]
    tangent = sp.tan(theta0)
    if partner == "pair":
        first, second = radii()
        sideways = [tangent, first * sp.Abs(impact_spin) / v0, second * sp.Abs(impact_partner_spin) / v0]
    else:
        sideways = [tangent, (a if partner else R) * sp.Abs(impact_spin) / v0]
    rates = first_rates(scale)
    if partner != "pair":
        del rates[initial_partner_spin]
    return {obliquity: sp.Max(*sideways), **rates}


def _vector_groups() -> dict[sp.Symbol, sp.Expr]:
    """The same for vectors in the laboratory's axes: T is a length, so that no direction is distinguished."""
    from .partners.bodies import centres, radii

    levers = (centres() * a, *radii())
    rates = (impact_turnings, impact_spins, impact_partner_spins)
    speeds = sum(
        (lever**2 * each**2 for lever, vector in zip(levers, rates, strict=True) for each in vector), sp.Integer(0)
    )
    unit = scale_definitions()[rate_scale_pair]
    groups = (initial_turnings, initial_spins, initial_partner_spins)
    found = {obliquity: sp.sqrt(speeds) / v0}
    for vector, group in zip(rates, groups, strict=True):
        found |= {own: each / unit for own, each in zip(group, vector, strict=True)}
    return found


def first_rates(scale: sp.Expr) -> dict[sp.Symbol, sp.Expr]:
    """The rates at initial contact over their scale."""
    return {
        initial_turning: sp.tan(theta0) / obliquity,
        initial_spin: impact_spin / scale,
        initial_partner_spin: impact_partner_spin / scale,
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
    film = aspect * a
    definitions = group_definitions()

    def solved(group: sp.Symbol, quantity: sp.Symbol) -> sp.Expr:
        return sp.solve(sp.Eq(definitions[group], group), quantity)[0].subs(x0, film)

    mass = solved(stokes, m)
    return {
        m: mass,
        x0: film,
        sigma: solved(capillary, sigma),
        p_gt: solved(glass_number, p_gt),
        g: solved(weight, g).subs(m, mass),
        A_H: solved(adhesion, A_H),
        l_s: solved(string_ratio, l_s),
        omega0: v0 * obliquity * initial_turning / (centres * a),
        rate_scale: v0 * obliquity / (centres * a),
        x: film * gap,
        u: v0 * normal_velocity,
        omega: rate_scale * orbital_momentum / DISTANCE**2,
        xi: rate_scale * spin,
        partner_spin_rate: rate_scale * partner_spin,
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
    result = sp.simplify(_substituted(body, {**rules, x: a * (DISTANCE - centres)}))
    left = sorted(s.name for s in result.free_symbols if s in DIMENSIONS and any(DIMENSIONS[s].exponents))
    if left:
        raise ScalingError(f"{', '.join(left)} did not cancel from {expression}")
    return result


def _substituted(expression: sp.Expr, rules: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    for _ in range(3):  # rotation rate -> its scale -> v0 and T
        expression = expression.xreplace(rules)
    if isinstance(expression, AppliedUndef):
        return expression.func(*(sp.simplify(argument) for argument in expression.args))
    return expression


def centrifugal_identity() -> sp.Expr:
    """Ce in terms of the other groups: (pi/8) (x0/a) tan^2(theta0) St Ca."""
    definition = group_definitions()[centrifugal].subs(sp.tan(theta0), obliquity)
    return nondimensional(definition)


def paper_normalisation() -> sp.Expr:
    """The centrifugal term m r omega^2 over a sigma, scaled as in the paper: Ce (4 + x/a) (omega/omega0)^2."""
    term = m * r * omega**2 / (a * sigma)
    return sp.factor(term.subs(m, centrifugal * sigma / omega0**2))
