"""Two spheres in space: what is conserved (found by nullspace), energy, the bound of the certificate, the plane."""

from dataclasses import replace
from functools import cache

import sympy as sp

from ..equations.invariants import NoInvariantError, conserved_components, quadratic_invariants
from ..equations.model import derive
from ..physics.law import filled
from ..physics.partners import space, vectors
from ..physics.partners.pair import INERTIA_RATIO, PARTNER_INERTIA, SPIN_INERTIA
from ..physics.scaling import DISTANCE
from ..physics.structure import Structure
from ..vocabulary import quantities as q
from .base import MIDGAP, SIZES, Check, Evidence, check, checks, special_case, vanishing

_SPACE = Structure(True, True, False, attraction=True, partner="space")
_OPEN = ("strength", "distance", "film_force", "bridge_force", "attraction_force", *SIZES)
_UNIT = vectors.dot(q.normal, q.normal) - 1
_ORTHOGONAL = vectors.dot(q.orbital_momenta, q.normal)


@cache
def _rates() -> dict[sp.Symbol, sp.Expr]:
    """Rates as polynomials in the states; the friction's strength, the sizes and the forces along n are left open."""
    return {s: sp.expand(rate) for s, rate in derive(_SPACE).by_state("right_hand_side", _OPEN).items()}


def _on_the_surface(expression: sp.Expr) -> sp.Expr:
    return vectors.on_the_sphere(expression, q.normal, q.orbital_momenta)


@check("space: spin", "I dw/dt = T for a sphere, from Lagrange's equations")
def spin_turns_with_the_torque() -> Evidence:
    """Lagrange's equations of a sphere in Euler angles: in the laboratory's axes, only a torque changes its spin."""
    yield from vectors.spin_balance()


@checks
def momenta_in_space_are_found() -> Check:
    """The three components of the angular momentum are found among the invariants linear in the momenta."""
    name, statement = "space: angular momentum", "J + I_1 xi_1 + I_2 xi_2 is conserved, component by component"
    try:
        result = conserved_components(derive(_SPACE))
    except NoInvariantError as error:
        return Check(name, statement, False, str(error))
    model = derive(_SPACE)
    momenta = [dict(model.definitions)[momentum] for momentum in space.MOMENTA]
    residuals = [model.expanded(form.expression - momentum) for form, momentum in zip(result, momenta, strict=True)]
    return vanishing(name, statement, residuals)


@checks
def directions_are_found() -> Check:
    """|n|^2 and, where it is 1, J . n are the only invariants quadratic in n and J."""
    unit = quadratic_invariants(_rates(), q.normal)
    across = quadratic_invariants(_rates(), (*q.normal, *q.orbital_momenta), _UNIT)
    expected = [_UNIT + 1, _ORTHOGONAL]
    missing = [form for form in expected if not any(sp.expand(form - invariant) == 0 for invariant in across)]
    ok = not missing and len(across) == 2 and list(unit) == expected[:1]
    return Check("space: directions", "|n| = 1 and J . n = 0 are conserved", ok, "; ".join(map(str, across)))


@check("space: energy", "d(kinetic)/dt = -(film + shear + bridge + attraction power)")
def energy_in_space() -> Evidence:
    """The kinetic energy changes by the work of film, shear, bridge and attraction only."""
    model, rates = derive(_SPACE), _rates()
    stored = model.expanded(model["energies"]["kinetic"], _OPEN)
    change = stored.diff(DISTANCE) * dict(model.definitions)[DISTANCE].diff(q.gap) * q.normal_velocity
    change += sp.Add(*(stored.diff(state) * rate for state, rate in rates.items()))
    lost = sp.Add(*model.results("energy_rates", _OPEN).values())
    yield _on_the_surface(sp.expand(change + lost))


@check("space: friction", "shear takes energy from every slip across n, and none from twist")
def friction_in_space_dissipates() -> Evidence:
    """The power of shear is the planar quadratic form of the slips, summed over the directions: never negative."""
    first, second = sp.symbols("s_1 s_2", real=True)
    moment, other = space.torques((first, second))
    form = sp.expand(moment * first + other * second)
    hessian = sp.hessian(form, (first, second))
    positive = bool(hessian[0, 0].is_positive and sp.expand(hessian.det()).is_positive)
    parts = sp.Integer(0)
    for axis in range(3):
        across = {first: space.SLIPS[axis] - space.TWIST * q.normal[axis]}
        across[second] = space.PARTNER_SLIPS[axis] - space.PARTNER_TWIST * q.normal[axis]
        parts += form.subs(across, simultaneous=True)
    model = derive(_SPACE)
    torque = {s: value for s, value in model.definitions if s.name.startswith(("torque", "partner_torq"))}
    lost = vectors.dot(space.TORQUES, space.SLIPS) + vectors.dot(space.PARTNER_TORQUES, space.PARTNER_SLIPS)
    turned = (space.TWIST, space.PARTNER_TWIST)
    along = dict(zip((space.ALONG, space.PARTNER_ALONG), space.torques(turned), strict=True))
    slips = zip(turned, (space.SLIPS, space.PARTNER_SLIPS), strict=True)
    twists = {twist: vectors.dot(slip, q.normal) for twist, slip in slips}
    residual = lost.subs(torque).subs(along) - space.STRENGTH * parts
    yield _on_the_surface(sp.expand(residual.subs(twists)))
    yield positive, "not positive definite"


@check("space: least energy", "T = |L|^2/(2 I) + T of the deviation from rotation at L/I, for any directions")
def least_energy_in_space() -> Evidence:
    """E_rot - |L|^2/(2 I) is a sum of squares for every n, J and both spins, I the inertia across the line of centres.

    So no direction of the line of centres, and no twist about it, takes the energy at a gap below that of rigid
    rotation about an axis across it: the barrier for |L| holds for good.
    """
    model = derive(_SPACE)
    kinetic = model["energies"]["kinetic"] - q.normal_velocity**2 / 2
    least = model["effective_potential"]["energy"]
    unit = sp.simplify(kinetic / space.energy(q.orbital_momenta, q.spins, q.partner_spins))
    apart = model.expanded(kinetic - least - unit * space.slip_energy(), SIZES)
    yield apart


@check("space: excess of J", "|J - r^2 L/I|^2 <= 2 D r^2 (I_1 + I_2)/I, D the slip energy")
def excess_of_orbital_momentum() -> Evidence:
    """What J and spins deviate from rotation at L/I by has no angular momentum: the spins have a share of its energy.

    The lack of the bound is r^2 I_1 I_2/I times the square of the difference of both spins.
    """
    model = derive(_SPACE)
    inertias = (SPIN_INERTIA, PARTNER_INERTIA)
    excess = sp.Matrix(q.orbital_momenta) - DISTANCE**2 * sp.Matrix(space.MOMENTA) / INERTIA_RATIO
    apart = sp.Matrix(q.spins) - sp.Matrix(q.partner_spins)
    bound = 2 * space.slip_energy() * DISTANCE**2 * sum(inertias) / INERTIA_RATIO
    spare = DISTANCE**2 * sp.Mul(*inertias) / INERTIA_RATIO * vectors.dot(apart, apart)
    names = (DISTANCE.name, *(inertia.name for inertia in inertias))
    yield model.expanded(bound - vectors.dot(excess, excess) - spare, names)
    rigid = DISTANCE**2 * sp.sqrt(space.MOMENTUM_SQUARE) / INERTIA_RATIO
    yield space.outward_at_most() - space.centrifugal((rigid + sp.sqrt(bound)) ** 2)


@check("space: rebounds", "C' <= (sqrt C + sqrt(2 work/r))^2 (r/r')^4 for a smaller distance r'")
def outward_at_smaller_gaps() -> Evidence:
    """The bound of the centrifugal force that excludes that a gap is reached again.

    It is J^2/r^3 with |J| <= |L| r^2/I + r sqrt(2 D s), D the slip energy and s = (I_1 + I_2)/I < 1. While the gap
    closes from r to a smaller r', D grows by the work of the attractions at most, as L^2/(2 I) grows: the root of the
    bound then grows by sqrt(2 work/r) at most. At r' its two parts, |L| sqrt(r)/I and sqrt(2 D s/r), are at most
    (r/r')^2 times those at r.
    """
    near, apart, work = sp.symbols("near apart work", positive=True)
    far = near + apart
    added = space.centrifugal(DISTANCE**2 * 2 * work / space.energy_unit())
    inertia = dict(derive(_SPACE).definitions)[INERTIA_RATIO]
    here, inner = inertia.subs(DISTANCE, far), inertia.subs(DISTANCE, near)
    falls = [
        sp.expand(far**2 * inner - near**2 * here),  # I/I' <= (r/r')^2, and sqrt(r') <= sqrt(r)
        sp.expand(far**3 * inner - near**3 * here),  # r I/(r' I') <= (r/r')^4
        sp.expand(here - inner),  # L^2/(2 I) is no smaller at r'
    ]
    positive = all(slope.is_positive for slope in falls)
    yield added - 2 * work * q.aspect / DISTANCE
    yield positive, f"not all positive: {falls}"


@check("space: no return", "e^2 W < W - C depth if C < (1 - e^2) P and P falls with the gap")
def rebounds_do_not_come_back() -> Evidence:
    """The balance that excludes that a maximum of the gap is reached again.

    Along the line of centres u^2/2 changes at the rate u (C - P - film), P the attraction and C the centrifugal force:
    what is not the inward force P - C is linear in u, a resistance, and only takes energy. From a maximum, the
    attraction's work W down to a rebound a depth below is at least P depth where it falls with the gap, say P depth +
    s. The rebound leaves e^2 W at most; the way back takes W - C depth at least. With (1 - e^2) P = C + d the lack is d
    depth + (1 - e^2) s: positive.
    """
    model = derive(_SPACE)
    rate, inward = (model[key].by_name for key in ("right_hand_side", "inward_force"))
    film = sp.expand(model.expanded(rate[q.normal_velocity.name] + inward["inward_force"], SIZES))
    yield from (film.subs(q.normal_velocity, 0), film.diff(q.normal_velocity, 2))
    depth, surplus, spare, centrifugal, lost = sp.symbols("depth surplus spare centrifugal lost", positive=True)
    work = (centrifugal + spare) / lost * depth + surplus  # lost = 1 - e^2
    lack = sp.expand(work - centrifugal * depth - (1 - lost) * work)
    yield lack - spare * depth - lost * surplus


@check("space: reduced", "with the partner's spin from L and its twist from J . n = 0, the rates are the full ones")
def reduced_in_space() -> Evidence:
    """The form without the partner's spin has the rates of the full one."""
    reduced, full = derive(replace(_SPACE, reduced=True)), derive(_SPACE)
    spun = {symbol: value for symbol, value in reduced.definitions if symbol in q.partner_spins}
    begun = {symbol: value for symbol, value in reduced.definitions if symbol in space.MOMENTA}
    keep = (*_OPEN, *(momentum.name for momentum in space.MOMENTA))
    assert len(spun) == len(begun) == 3
    names = ("right_hand_side", "energies", "inward_force")
    for difference in special_case(reduced, names, full, lambda expression: expression.subs(spun), keep):
        yield _on_the_surface(sp.expand(difference))


@check("space: plane", "in the plane, rates and energies are those of the planar pair")
def plane_in_space() -> Evidence:
    """With n in a plane, and J and both spins along its normal, every equation is the planar pair's."""
    model, pair = derive(_SPACE), derive(replace(_SPACE, partner="pair"))
    line = (sp.cos(q.beta), sp.sin(q.beta), sp.Integer(0))

    def upright(scalar: sp.Expr) -> tuple[sp.Expr, ...]:
        return sp.Integer(0), sp.Integer(0), scalar

    planar = _components((q.normal, line), (q.orbital_momenta, upright(q.orbital_momentum)))
    planar |= _components((q.spins, upright(q.spin)), (q.partner_spins, upright(q.partner_spin)))
    turning = pair.expanded(pair["turning_rate"][q.beta.name], SIZES)
    expected = {state: filled(rate, MIDGAP) for state, rate in pair.by_state("right_hand_side", SIZES).items()}
    moved = _components((q.normal, tuple(component.diff(q.beta) * turning for component in line)))
    turning_states = (q.orbital_momentum, q.spin, q.partner_spin)
    for vector, state in zip((q.orbital_momenta, q.spins, q.partner_spins), turning_states, strict=True):
        moved |= _components((vector, upright(expected[state])))
    moved |= {state: expected[state] for state in (q.gap, q.normal_velocity)}
    rates = model.by_state("right_hand_side", SIZES)
    yield from [rates[state].subs(planar, simultaneous=True) - moved[state] for state in model.states]
    for name in ("energies", "energy_rates", "inward_force", "effective_potential"):
        of_pair = pair.results(name, SIZES)
        for key, expression in model.results(name, SIZES).items():
            yield expression.subs(planar, simultaneous=True) - filled(of_pair[key], MIDGAP)


def _components(*pairs: tuple[q.Vector, tuple[sp.Expr, ...]]) -> dict[sp.Symbol, sp.Expr]:
    return {of: value for vector, values in pairs for of, value in zip(vector, values, strict=True)}
