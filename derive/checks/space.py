"""Two spheres in space: what is conserved (found by nullspace), energy, the bound of the certificate, the plane."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import sympy as sp

from ..equations.invariants import NoInvariantError, conserved_components
from ..equations.model import Model, derive
from ..equations.quadratic_invariants import quadratic_invariants
from ..physics.laws import LAWS
from ..physics.partners import space, vectors
from ..physics.partners.pair import INERTIA_RATIO
from ..physics.scaling import DISTANCE
from ..physics.structure import Structure
from ..vocabulary.quantities import (
    Vector,
    aspect,
    beta,
    gap,
    normal,
    normal_velocity,
    orbital_momenta,
    orbital_momentum,
    partner_spin,
    partner_spins,
    spin,
    spins,
)
from .base import Check, vanishing
from .closed import SIZES, filled, opened, opened_rates

_SPACE = Structure(True, True, False, attraction=True, partner="space")
_MIDGAP = {"arm": LAWS["arm"]["midgap"]}
_OPEN = ("strength", "distance", "film_force", "bridge_force", "attraction_force")
_UNIT = vectors.dot(normal, normal) - 1
_ORTHOGONAL = vectors.dot(orbital_momenta, normal)


def _closed(symbol: sp.Symbol) -> bool:
    return symbol.name not in (*_OPEN, *SIZES)


@cache
def _rates() -> dict[sp.Symbol, sp.Expr]:
    """Rates as polynomials in the states; the friction's strength, the sizes and the forces along n are left open."""
    model = derive(_SPACE)
    named = model["right_hand_side"].by_name
    found: dict[sp.Symbol, sp.Expr] = {}
    for state in model.states:
        rate = sp.sympify(named[state.name])
        for symbol, value in reversed(model.definitions):
            if _closed(symbol):
                rate = rate.subs(symbol, value)
        found[state] = sp.expand(rate)
    return found


def _on_the_surface(expression: sp.Expr) -> sp.Expr:
    return vectors.on_the_sphere(expression, normal, orbital_momenta)


def spin_turns_with_the_torque() -> Check:
    """Lagrange's equations of a sphere in Euler angles: in the laboratory's axes, only a torque changes its spin."""
    return vanishing("space: spin", "I dw/dt = T for a sphere, from Lagrange's equations", list(vectors.spin_balance()))


def momenta_in_space_are_found() -> Check:
    """The three components of the angular momentum are found among the invariants linear in the momenta."""
    name, statement = "space: angular momentum", "J + I_1 xi_1 + I_2 xi_2 is conserved, component by component"
    try:
        found = conserved_components(derive(_SPACE))
    except NoInvariantError as error:
        return Check(name, statement, False, str(error))
    model = derive(_SPACE)
    momenta = [dict(model.definitions)[momentum] for momentum in space.MOMENTA]
    left = [model.expanded(one.expression - momentum) for one, momentum in zip(found, momenta, strict=True)]
    return vanishing(name, statement, left)


def directions_are_found() -> Check:
    """|n|^2 and, where it is 1, J . n are the only invariants quadratic in n and J."""
    unit = quadratic_invariants(_rates(), normal)
    across = quadratic_invariants(_rates(), (*normal, *orbital_momenta), _UNIT)
    expected = [_UNIT + 1, _ORTHOGONAL]
    missing = [each for each in expected if not any(sp.expand(each - one) == 0 for one in across)]
    ok = not missing and len(across) == 2 and list(unit) == expected[:1]
    return Check("space: directions", "|n| = 1 and J . n = 0 are conserved", ok, "; ".join(map(str, across)))


def energy_in_space() -> Check:
    """The kinetic energy changes by the work of film, shear, bridge and attraction only."""
    model, rates = derive(_SPACE), _rates()

    def half_open(expression: sp.Expr) -> sp.Expr:
        for symbol, value in reversed(model.definitions):
            if _closed(symbol):
                expression = expression.subs(symbol, value)
        return expression

    stored = half_open(model["energies"]["kinetic"])
    change = stored.diff(DISTANCE) * dict(model.definitions)[DISTANCE].diff(gap) * normal_velocity
    change += sum((stored.diff(state) * rate for state, rate in rates.items()), sp.Integer(0))
    lost = sum((half_open(rate) for _, rate in model["energy_rates"].outputs), sp.Integer(0))
    left = _on_the_surface(sp.expand(change + lost))
    statement = "d(kinetic)/dt = -(film + shear + bridge + attraction power)"
    return vanishing("space: energy", statement, [left])


def friction_in_space_dissipates() -> Check:
    """The power of shear is the planar quadratic form of the slips, summed over the directions: never negative."""
    first, second = sp.symbols("s_1 s_2", real=True)
    one, other = space.torques((first, second))
    form = sp.expand(one * first + other * second)
    hessian = sp.hessian(form, (first, second))
    positive = bool(hessian[0, 0].is_positive and sp.expand(hessian.det()).is_positive)
    parts = sp.Integer(0)
    for each in range(3):
        across = {first: space.SLIPS[each] - space.TWIST * normal[each]}
        across[second] = space.PARTNER_SLIPS[each] - space.PARTNER_TWIST * normal[each]
        parts += form.subs(across, simultaneous=True)
    model = derive(_SPACE)
    torque = {
        symbol: value for symbol, value in model.definitions if symbol.name.startswith(("torque", "partner_torq"))
    }
    lost = vectors.dot(space.TORQUES, space.SLIPS) + vectors.dot(space.PARTNER_TORQUES, space.PARTNER_SLIPS)
    along = {space.ALONG: space.torques((space.TWIST, space.PARTNER_TWIST))[0]}
    along[space.PARTNER_ALONG] = space.torques((space.TWIST, space.PARTNER_TWIST))[1]
    twists = {
        space.TWIST: vectors.dot(space.SLIPS, normal),
        space.PARTNER_TWIST: vectors.dot(space.PARTNER_SLIPS, normal),
    }
    left = lost.subs(torque).subs(along) - space.STRENGTH * parts
    rest = _on_the_surface(sp.expand(left.subs(twists)))
    check = vanishing("space: friction", "shear takes energy from every slip across n, and none from twist", [rest])
    return check if positive else Check(check.name, check.statement, False, "not positive definite")


def least_energy_in_space() -> Check:
    """E_rot - |L|^2/(2 I) is a sum of squares for every n, J and both spins, I the inertia across the line of centres.

    So no direction of the line of centres, and no twist about it, takes the energy at a gap below that of rigid
    rotation about an axis across it: the barrier for |L| holds for good.
    """
    model = derive(_SPACE)
    kinetic = model["energies"]["kinetic"] - normal_velocity**2 / 2
    least = model["effective_potential"]["energy"]
    unit = sp.simplify(kinetic / space.energy(orbital_momenta, spins, partner_spins))
    apart = opened(model, kinetic - least - unit * space.slip_energy())
    statement = "T = |L|^2/(2 I) + T of the deviation from rotation at L/I, for any directions"
    return vanishing("space: least energy", statement, [apart])


def outward_at_smaller_gaps() -> Check:
    """The bound of the centrifugal force by which `solvers.certificates.rebounds` excludes that a gap is reached again.

    It is J^2/r^3 with |J| <= |L| r^2/I + r sqrt(2 D), D the slip energy. While the gap closes from r to a smaller r', D
    grows by the work of the attractions at most, as L^2/(2 I) grows: the root of the bound then grows by
    sqrt(2 work/r). At r' its two parts, |L| sqrt(r)/I and sqrt(2 D/r), are at most (r/r')^2 times those at r.
    """
    near, apart, work = sp.symbols("near apart work", positive=True)
    far = near + apart
    added = space.centrifugal(DISTANCE**2 * 2 * work / space.energy_unit())
    inertia = dict(derive(_SPACE).definitions)[INERTIA_RATIO]
    here, there = inertia.subs(DISTANCE, far), inertia.subs(DISTANCE, near)
    falls = [
        sp.expand(far**2 * there - near**2 * here),  # I/I' <= (r/r')^2, and sqrt(r') <= sqrt(r)
        sp.expand(far**3 - near**3),  # sqrt(r/r') <= (r/r')^2
        sp.expand(here - there),  # L^2/(2 I) is no smaller at r'
    ]
    statement = "C' <= (sqrt C + sqrt(2 work/r))^2 (r/r')^4 for a smaller distance r'"
    check = vanishing("space: rebounds", statement, [added - 2 * work * aspect / DISTANCE])
    positive = all(each.is_positive for each in falls)
    return check if positive else replace(check, ok=False, figure=f"not all positive: {falls}")


def rebounds_do_not_come_back() -> Check:
    """The balance by which `solvers.certificates.rebounds` excludes that a maximum of the gap is reached again.

    Along the line of centres u^2/2 changes at the rate u (C - P - film), P the attraction and C the centrifugal force:
    what is not the inward force P - C is linear in u, a resistance, and only takes energy. From a maximum, the
    attraction's work W down to a rebound a depth below is at least P depth where it falls with the gap, say P depth +
    s. The rebound leaves e^2 W at most; the way back takes W - C depth at least. With (1 - e^2) P = C + d the lack is d
    depth + (1 - e^2) s: positive.
    """
    model = derive(_SPACE)
    rate, inward = (model[each].by_name for each in ("right_hand_side", "inward_force"))
    film = sp.expand(opened(model, rate[normal_velocity.name] + inward["inward_force"]))
    left = [film.subs(normal_velocity, 0), film.diff(normal_velocity, 2)]
    depth, surplus, spare, centrifugal, lost = sp.symbols("depth surplus spare centrifugal lost", positive=True)
    work = (centrifugal + spare) / lost * depth + surplus  # lost = 1 - e^2
    lack = sp.expand(work - centrifugal * depth - (1 - lost) * work)
    left.append(lack - spare * depth - lost * surplus)
    statement = "e^2 W < W - C depth if C < (1 - e^2) P and P falls with the gap"
    return vanishing("space: no return", statement, left)


def reduced_in_space() -> Check:
    """The form without the partner's spin has the rates of the full one."""
    reduced, full = derive(replace(_SPACE, reduced=True)), derive(_SPACE)
    spun = {symbol: value for symbol, value in reduced.definitions if symbol in partner_spins}
    begun = {symbol: value for symbol, value in reduced.definitions if symbol in space.MOMENTA}
    assert len(spun) == len(begun) == 3
    left = []
    for name in ("right_hand_side", "energies", "inward_force"):
        there = full[name].by_name
        for key, expression in reduced[name].outputs:
            difference = _by_momenta(full, there[key]).subs(spun) - _by_momenta(reduced, expression)
            left.append(_on_the_surface(sp.expand(difference)))
    statement = "with the partner's spin from L and its twist from J . n = 0, the rates are the full ones"
    return vanishing("space: reduced", statement, left)


def _by_momenta(model: Model, expression: sp.Expr) -> sp.Expr:
    for symbol, value in reversed(model.definitions):
        if symbol.name not in (*_OPEN, *SIZES) and symbol not in space.MOMENTA:
            expression = expression.subs(symbol, value)
    return expression


def plane_in_space() -> Check:
    """With n in a plane, and J and both spins along its normal, every equation is the planar pair's."""
    model, pair = derive(_SPACE), derive(replace(_SPACE, partner="pair"))
    line = (sp.cos(beta), sp.sin(beta), sp.Integer(0))

    def upright(scalar: sp.Expr) -> tuple[sp.Expr, ...]:
        return sp.Integer(0), sp.Integer(0), scalar

    planar = _components((normal, line), (orbital_momenta, upright(orbital_momentum)))
    planar |= _components((spins, upright(spin)), (partner_spins, upright(partner_spin)))
    turning = opened(pair, pair["turning_rate"][beta.name])
    expected = {state: filled(rate, _MIDGAP) for state, rate in opened_rates(pair).items()}
    moved = _components((normal, tuple(each.diff(beta) * turning for each in line)))
    for vector, state in ((orbital_momenta, orbital_momentum), (spins, spin), (partner_spins, partner_spin)):
        moved |= _components((vector, upright(expected[state])))
    moved |= {state: expected[state] for state in (gap, normal_velocity)}
    rates = opened_rates(model)
    left = [rates[state].subs(planar, simultaneous=True) - moved[state] for state in model.states]
    for name in ("energies", "energy_rates", "inward_force", "effective_potential"):
        there = pair[name].by_name
        for key, expression in model[name].outputs:
            here = opened(model, expression).subs(planar, simultaneous=True)
            left.append(here - filled(opened(pair, there[key]), _MIDGAP))
    return vanishing("space: plane", "in the plane, rates and energies are those of the planar pair", left)


def _components(*pairs: tuple[Vector, tuple[sp.Expr, ...]]) -> dict[sp.Symbol, sp.Expr]:
    return {of: value for vector, values in pairs for of, value in zip(vector, values, strict=True)}


def space_checks() -> tuple[Check, ...]:
    """Every check of two spheres in space."""
    return (
        spin_turns_with_the_torque(),
        momenta_in_space_are_found(),
        directions_are_found(),
        energy_in_space(),
        friction_in_space_dissipates(),
        least_energy_in_space(),
        outward_at_smaller_gaps(),
        rebounds_do_not_come_back(),
        reduced_in_space(),
        plane_in_space(),
    )
