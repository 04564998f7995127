"""Two spheres in space, each with its own spin: vectors in the laboratory's axes, with the line of centres as a state.

The torques are those of the plane for each transverse component of the slip omega - xi_i: the film is isotropic about
n. The component along n (twist) has no leading logarithm: no torque acts along n. A spin along n is not thereby
constant, as n turns away from it.

The lever arm is at mid-gap, so that the torques on the spheres balance that on their line of centres. In the reduced
form the partner's spin follows from the three components of the angular momentum L, and its twist from J . n = 0.
"""

from functools import cache
from itertools import chain

import sympy as sp

from ...vocabulary import quantities as q
from ..forces import SHEAR, TANGENTIAL
from ..law import Definition, slot_call
from ..scaling import DISTANCE, INERTIA
from .base import Rotation
from .bodies import CENTRES, centres, inertias, r, radii
from .pair import DRAG, INERTIA_RATIO, PARTNER_INERTIA, PARTNER_RADIUS, RADIUS, SPIN_INERTIA, scaled
from .rolling import R_1, R_2, torque_matrix
from .vectors import APART, FORCE, LINE_RATE, cross, dot, motion, named, on_the_sphere

MOMENTA, RATES = named("momentum"), named("orbital_rate")
SLIPS, PARTNER_SLIPS = named("slip"), named("partner_slip")
TORQUES, PARTNER_TORQUES = named("torque"), named("partner_torque")
STRENGTH = sp.Symbol("strength", positive=True)
MOMENTUM_SQUARE, RATE_SQUARE = sp.symbols("momentum_square rate_square", nonnegative=True)
TWIST, PARTNER_TWIST, ALONG, PARTNER_ALONG = sp.symbols("twist partner_twist along partner_along", real=True)

Eliminated = tuple[Definition, ...]  # the components of L, then those of the partner's spin in terms of them


def torques(slips: tuple[sp.Expr, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    """Torques on the two spheres over `STRENGTH`, of the slips of both in one direction across the line of centres."""
    shape = (torque_matrix() / (2 * sp.pi * q.mu * q.a**3)).subs({R_1: q.a * RADIUS, R_2: q.a * PARTNER_RADIUS})
    first, second = sp.simplify(shape) * sp.Matrix(slips)
    return first, second


def torque_coefficients() -> dict[str, sp.Expr]:
    """The torques' matrix, which is symmetric (`rolling.torque_matrix`): torque over slip, each in its own unit."""
    own, beside = torques((sp.Integer(1), sp.Integer(0))), torques((sp.Integer(0), sp.Integer(1)))
    assert sp.expand(own[1] - beside[0]) == 0
    return {"torque_own": STRENGTH * own[0], "torque_mutual": STRENGTH * own[1], "torque_partner": STRENGTH * beside[1]}


def start() -> dict[sp.Symbol, sp.Expr]:
    """State of the rotation at initial contact."""
    momenta = [(CENTRES + q.aspect) ** 2 * rate for rate in q.initial_turnings]
    vectors = (q.normal, q.orbital_momenta, q.spins, q.partner_spins)
    first = (q.initial_normals, momenta, q.initial_spins, q.initial_partner_spins)
    return dict(zip(chain(*vectors), chain(*first), strict=True))


def sizes() -> list[Definition]:
    """Centre distances, radii over a, and moments of inertia over m a^2."""
    named = (*(radius / q.a for radius in radii()), *(inertia / (q.m * q.a**2) for inertia in inertias()))
    scaled_sizes = zip((RADIUS, PARTNER_RADIUS, SPIN_INERTIA, PARTNER_INERTIA), map(sp.factor, named), strict=True)
    return [(CENTRES, centres()), (DISTANCE, CENTRES + q.aspect * q.gap), *scaled_sizes]


def _momenta() -> list[Definition]:
    rows = zip(MOMENTA, q.orbital_momenta, q.spins, q.partner_spins, strict=True)
    return [(name, orbital + SPIN_INERTIA * spin + PARTNER_INERTIA * other) for name, orbital, spin, other in rows]


def _twists(eliminated: Eliminated) -> list[Definition]:
    """Components along n of the two slips; omega has none."""
    if not eliminated:
        return [(TWIST, dot(SLIPS, q.normal)), (PARTNER_TWIST, dot(PARTNER_SLIPS, q.normal))]
    follows = sp.expand(dict(eliminated)[q.partner_spins[0]])
    by_momentum, by_spin = (follows.coeff(symbol) for symbol in (MOMENTA[0], q.spins[0]))
    return [(TWIST, -dot(q.spins, q.normal)), (PARTNER_TWIST, by_spin * TWIST - by_momentum * dot(MOMENTA, q.normal))]


def definitions(eliminated: Eliminated = ()) -> tuple[Definition, ...]:
    """Named intermediates, in order."""
    log = SHEAR * slot_call("shear", "log_factor", q.x / q.x0, q.x0 / q.a)
    unit = 2 * sp.pi * q.mu * q.a**3
    result = [*sizes(), *(eliminated or _momenta())]
    result += [(rate, momentum / DISTANCE**2) for rate, momentum in zip(RATES, q.orbital_momenta, strict=True)]
    result += [(MOMENTUM_SQUARE, dot(MOMENTA, MOMENTA)), (RATE_SQUARE, dot(RATES, RATES))]
    result.append((INERTIA_RATIO, DISTANCE**2 + SPIN_INERTIA + PARTNER_INERTIA))
    result += [(slip, rate - spin) for slip, rate, spin in zip(SLIPS, RATES, q.spins, strict=True)]
    result += [(slip, rate - spin) for slip, rate, spin in zip(PARTNER_SLIPS, RATES, q.partner_spins, strict=True)]
    result += _twists(eliminated)
    result.append((DRAG, scaled(log * unit * q.rate_scale / (TANGENTIAL * q.a))))
    result.append((STRENGTH, DRAG * DISTANCE / CENTRES))
    result += list(zip((ALONG, PARTNER_ALONG), torques((TWIST, PARTNER_TWIST)), strict=True))
    across = [torques(both) for both in zip(SLIPS, PARTNER_SLIPS, strict=True)]
    for place, (symbols, along) in enumerate(((TORQUES, ALONG), (PARTNER_TORQUES, PARTNER_ALONG))):
        rows = zip(symbols, across, q.normal, strict=True)
        result += [(symbol, STRENGTH * (both[place] - along * line)) for symbol, both, line in rows]
    return tuple(result)


def rates() -> dict[sp.Symbol, sp.Expr]:
    """Rates of n, J and both spins, per v0/x0."""
    moved = motion()
    pull, shear = sp.Symbol("F", real=True), named("S")  # on sphere 2: -F n - S x n, with r S = T_1 + T_2
    force = -pull * sp.Matrix(q.normal) - cross(shear, q.normal)
    by_force = dict(zip(FORCE, force, strict=True))
    torque = [on_the_sphere(component.subs(by_force), q.normal, shear) for component in moved.orbital_momentum]
    assert list(torque) == [-APART * component for component in shear]
    opening = moved.opening.subs(by_force) - APART * dot(LINE_RATE, LINE_RATE) + pull / q.m
    assert on_the_sphere(opening, q.normal, shear) == 0
    turned = scaled(q.rate_scale * q.x0 / q.v0) * moved.normal.subs(dict(zip(LINE_RATE, RATES, strict=True)))
    result = dict(zip(q.normal, turned, strict=True))
    assert scaled(TANGENTIAL * q.a * q.x0 / (q.v0 * q.m * q.a**2 * q.rate_scale)) == 1
    for place in range(3):
        result[q.orbital_momenta[place]] = -(TORQUES[place] + PARTNER_TORQUES[place])
        result[q.spins[place]] = TORQUES[place] / SPIN_INERTIA
        result[q.partner_spins[place]] = PARTNER_TORQUES[place] / PARTNER_INERTIA
    return result


def centrifugal(square: sp.Expr) -> sp.Expr:
    """Centrifugal force over m v0^2/x0 for a square of the orbital momentum."""
    return sp.expand(scaled(q.m * r * q.omega**2 / INERTIA).subs(q.orbital_momentum**2, square))


def energy_unit() -> sp.Expr:
    """M a^2 Omega^2 over m v0^2."""
    return scaled(q.m * q.a**2 * q.rate_scale**2 / (q.m * q.v0**2))


def energy(orbital: q.Vector | sp.Matrix, first: q.Vector | sp.Matrix, second: q.Vector | sp.Matrix) -> sp.Expr:
    """Kinetic energy over m a^2 Omega^2 of an orbital momentum and two spins."""
    spinning = SPIN_INERTIA * dot(first, first) + PARTNER_INERTIA * dot(second, second)
    return (dot(orbital, orbital) / DISTANCE**2 + spinning) / 2


def slip_energy() -> sp.Expr:
    """What the energy of rotation exceeds |L|^2/(2 I) by, I the inertia across the line of centres.

    It is the energy of the deviation from a rotation of everything at L/I, whatever the directions of n, J and the
    spins (`derive.checks.space.least_energy_in_space`).
    """
    rigid = sp.Matrix(MOMENTA) / INERTIA_RATIO
    apart = sp.Matrix(q.orbital_momenta) - DISTANCE**2 * rigid
    return energy(apart, sp.Matrix(q.spins) - rigid, sp.Matrix(q.partner_spins) - rigid)


def wobble() -> sp.Expr:
    """Energy over m a^2 Omega^2 of what is neither the rotation of a rigid doublet across n nor twist."""
    line = sp.Matrix(q.normal)
    rigid = (sp.Matrix(MOMENTA) - dot(MOMENTA, q.normal) * line) / INERTIA_RATIO
    first = sp.Matrix(q.spins) - dot(q.spins, q.normal) * line - rigid
    second = sp.Matrix(q.partner_spins) - dot(q.partner_spins, q.normal) * line - rigid
    return energy(sp.Matrix(q.orbital_momenta) - DISTANCE**2 * rigid, first, second)


def rigid_rotation() -> dict[str, sp.Expr]:
    """Angular momentum over m a^2 Omega, and what it turns a rigid doublet's line of centres by, per v0/x0.

    With twist such a doublet precesses: n, J and both spins turn about L at |L|/I.
    """
    momentum = {f"momentum_{axis}": component for axis, component in zip(q.AXES, MOMENTA, strict=True)}
    return {**momentum, "per_momentum": scaled(q.rate_scale * q.x0 / q.v0) / INERTIA_RATIO}


def outward_at_most() -> sp.Expr:
    """Centrifugal force on a resting doublet from now on, at most: its slip energy never grows, so |J| is bounded.

    What J exceeds rigid rotation by, the spins fall short of, as L is conserved: both have a part of the slip energy.
    """
    spins = (SPIN_INERTIA + PARTNER_INERTIA) / INERTIA_RATIO
    rigid = DISTANCE**2 * sp.sqrt(MOMENTUM_SQUARE) / INERTIA_RATIO
    return centrifugal((rigid + DISTANCE * sp.sqrt(2 * spins * slip_energy())) ** 2)


def surface_slips() -> list[sp.Expr]:
    """Components of n x the relative velocity of the surfaces at the contact, over a Omega."""
    return [
        DISTANCE / CENTRES * (RADIUS * (slip - TWIST * line) + PARTNER_RADIUS * (other - PARTNER_TWIST * line))
        for slip, other, line in zip(SLIPS, PARTNER_SLIPS, q.normal, strict=True)
    ]


def surface_slip() -> sp.Expr:
    """Magnitude of the relative velocity of the surfaces at the contact, over a Omega."""
    across = [component / (DISTANCE / CENTRES) for component in surface_slips()]
    return DISTANCE / CENTRES * sp.sqrt(dot(across, across))


def drift() -> sp.Expr:
    """1 + |L - L(0)| over the sum of its parts at initial contact."""
    first = start()
    vectors = [[first[symbol] for symbol in vector] for vector in (q.orbital_momenta, q.spins, q.partner_spins)]
    apart = sp.Matrix([name - value.subs(first, simultaneous=True) for name, value in _momenta()])
    weighted = zip(vectors, (1, SPIN_INERTIA, PARTNER_INERTIA), strict=True)
    return 1 + sp.sqrt(dot(apart, apart)) / sum(inertia * sp.sqrt(dot(vector, vector)) for vector, inertia in weighted)


def _outputs() -> dict[str, sp.Expr]:
    names = ("final_normal", "final_rotation_rate", "final_spin", "final_spin_partner")
    vectors = zip(names, (q.normal, RATES, q.spins, q.partner_spins), strict=True)
    return {f"{name}_{axis}": value for name, vector in vectors for axis, value in zip(q.AXES, vector, strict=True)}


@cache
def rotation(reduced: bool) -> Rotation:
    """The rotation of two spheres in space, for their equations.

    Arguments:
        reduced: without the partner's spin, which `definitions` then take from what is conserved.
    """
    values = rates()
    states = (*q.normal, *q.orbital_momenta, *q.spins, *(() if reduced else q.partner_spins))
    lost = dot(TORQUES, SLIPS) + dot(PARTNER_TORQUES, PARTNER_SLIPS)
    least = energy_unit() * MOMENTUM_SQUARE / (2 * INERTIA_RATIO)
    return Rotation(
        states=states,
        definitions=definitions(),
        centrifugal=centrifugal(RATE_SQUARE * DISTANCE**4),
        rates={state: values[state] for state in states},
        turning=None,
        kinetic=energy_unit() * energy(q.orbital_momenta, q.spins, q.partner_spins),
        power=scaled(TANGENTIAL * q.a * q.rate_scale * q.x0 / q.v0 / (q.m * q.v0**2)) * lost,
        momentum=drift(),
        outputs=_outputs(),
        surface_slip=surface_slip(),
        least=(least, least.diff(INERTIA_RATIO) * 2 * DISTANCE * q.aspect),
        rigid={},
        start=start(),
        outward_at_most=outward_at_most(),
        wobble=energy_unit() * wobble(),
        rigid_rotation=rigid_rotation(),
    )
