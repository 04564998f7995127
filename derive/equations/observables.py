"""Functions of a state: ledger of energy and angular momentum, outputs, and the least energy of the certificate."""

from itertools import combinations

import sympy as sp

from ..physics.forces import TANGENTIAL
from ..physics.law import slot_call
from ..physics.mechanics import doublet_inertia, equations_of_motion
from ..physics.partners import rotation
from ..physics.partners.base import relative_change
from ..physics.pendulum import offset_squared
from ..physics.scaling import DISTANCE, nondimensional
from ..physics.structure import Structure
from ..vocabulary import quantities as q
from . import friction, terms
from .events import start
from .intermediates import (
    ATTRACTION_FORCE,
    BRIDGE_FORCE,
    FILM_FORCE,
    INERTIA_RATIO,
    LEVER,
    MOMENTUM,
    ORBITAL_RATE,
    SHEAR_FORCE,
    SLIP,
    STRING_PULL,
    by_orbital_rate,
)
from .invariants import angular_momentum as angular_momentum_invariant


def energies(structure: Structure) -> dict[str, sp.Expr]:
    """Energies of the state over m v0^2."""
    stored = {"kinetic": _kinetic(structure)}
    if structure.strings:
        stored["strings"] = _lifted()
    return stored | terms.stored(structure)


def _kinetic(structure: Structure) -> sp.Expr:
    if structure.partner:
        return q.normal_velocity**2 / 2 + rotation(structure).kinetic
    energy = sp.expand(equations_of_motion().kinetic_energy / (q.m * q.v0**2))
    if not structure.oblique:
        return nondimensional(energy.subs({q.omega: 0, q.xi: 0}))
    orbital = sp.Rational(1, 2) * q.m * q.r**2 * q.omega**2 / (q.m * q.v0**2)
    return nondimensional(sp.expand(energy - sp.expand(orbital))) + by_orbital_rate(nondimensional(orbital))


def excess_energy(stored: sp.Expr) -> sp.Expr:
    """What stored energy exceeds the least at the same gap and angular momentum, as a sum of squares.

    Over m v0^2 that is the energy of the normal velocity, and with the moments A_i of the rates of the orbit and of the
    spins the sum over pairs of A_i A_j (omega_i - omega_j)^2, over that of A_i (Lagrange; `derive.checks.enclosure`).
    """
    excess, unit = q.normal_velocity**2 / 2, stored.diff(ORBITAL_RATE, 2) / 2
    if unit == 0:
        return excess
    moments = {rate: sp.cancel(stored.diff(rate, 2) / 2 / unit) for rate in (ORBITAL_RATE, q.spin, q.partner_spin)}
    slips = [moments[i] * moments[j] * (i - j) ** 2 for i, j in combinations(moments, 2)]
    return excess + unit * sp.Add(*slips) / sp.Add(*moments.values())


def _lifted() -> sp.Expr:
    """Potential energy of the spheres on their strings."""
    rise = slot_call("strings", "rise", q.string_ratio, offset_squared)
    return nondimensional(4 * q.m * q.g * q.a / (q.m * q.v0**2)) * rise


def energy_rates(structure: Structure) -> dict[str, sp.Expr]:
    """Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2."""
    taken = {"normal_lubrication": FILM_FORCE * q.normal_velocity}
    if structure.bridge:
        taken["capillary"] = BRIDGE_FORCE * q.normal_velocity
    if structure.attraction:
        taken["attraction"] = ATTRACTION_FORCE * q.normal_velocity
    if structure.partner:
        taken["tangential_lubrication"] = rotation(structure).power
    elif structure.oblique and not structure.reduced:
        power = TANGENTIAL * SHEAR_FORCE * (q.a * DISTANCE * q.rate_scale * ORBITAL_RATE - 2 * q.a * LEVER * q.xi)
        taken["tangential_lubrication"] = nondimensional(power * q.x0 / q.v0 / (q.m * q.v0**2))
    if structure.friction:
        taken["dry_friction"] = friction.resting_power(structure)
    return taken | terms.taken(structure)


def angular_momentum(structure: Structure) -> sp.Expr | None:
    """1 + the change of L over the size of L at initial contact; None beside a wall, where L is not conserved.

    Its size is the sum of the magnitudes of the orbital part and of the spins': L itself may vanish.
    """
    if structure.partner:
        return rotation(structure).momentum
    whole = angular_momentum_invariant()
    first = start(structure)
    parts = [whole.coeff(momentum) * first[momentum] for momentum in (q.orbital_momentum, q.spin)]
    return relative_change(MOMENTUM, parts)


def outputs(structure: Structure) -> dict[str, sp.Expr]:
    """Results for a separated doublet: restitutions, and rates over Omega."""
    results: dict[str, sp.Expr] = {"restitution": q.normal_velocity}
    if structure.partner:
        return results | dict(rotation(structure).outputs)
    if structure.oblique:
        results["tangential_restitution"] = DISTANCE * ORBITAL_RATE / ((4 + q.aspect) * q.initial_turning)
        results["final_rotation_rate"] = ORBITAL_RATE
        results["final_spin"] = q.spin
    return results


def surface_slip(structure: Structure) -> sp.Expr:
    """Relative velocity of the surfaces at the contact, at the lever arms of the torques, over a Omega."""
    if structure.partner:
        return rotation(structure).surface_slip
    if structure.reduced:  # the lever arm is r/2
        return DISTANCE * SLIP
    return DISTANCE * ORBITAL_RATE - 2 * LEVER * q.spin


def effective_potential(structure: Structure) -> dict[str, sp.Expr]:
    """Least energy at a gap for the state's angular momentum, and its slope along the gap (stick certificate)."""
    energy, slope = sp.Integer(0), sp.Integer(0)
    if structure.partner:
        energy, slope = rotation(structure).least
    elif structure.oblique:
        square = (q.m * q.a**2 * q.rate_scale * MOMENTUM) ** 2
        energy += nondimensional(square / (2 * q.m * q.a**2 * INERTIA_RATIO) / (q.m * q.v0**2))
        body = (doublet_inertia() / (q.m * q.a**2)).diff(q.x) * q.x0  # d inertia_ratio / d gap
        slope += energy.diff(INERTIA_RATIO) * nondimensional(body)
    slope += BRIDGE_FORCE * int(structure.bridge) + ATTRACTION_FORCE * int(structure.attraction)
    if structure.strings:
        energy += _lifted()
        slope += STRING_PULL
    if structure.terms is not None:  # a potential: with a conserved angular momentum, the least energy is without u
        own = sp.Add(*terms.stored(structure).values()).subs(q.normal_velocity, 0)
        energy += own
        slope += own.diff(q.gap)
    return {"energy": energy, "slope": slope}


def rigid_rotation(structure: Structure) -> dict[sp.Symbol, sp.Expr]:
    """The state of least energy at this gap for the state's angular momentum: u = 0, omega = xi = L/I."""
    if structure.partner:
        return {q.gap: q.gap, q.normal_velocity: sp.Integer(0), **rotation(structure).rigid}
    rate = MOMENTUM / INERTIA_RATIO if structure.oblique else sp.Integer(0)
    return {q.gap: q.gap, q.normal_velocity: sp.Integer(0), q.orbital_momentum: DISTANCE**2 * rate, q.spin: rate}


def restitution_ceiling(structure: Structure) -> dict[str, sp.Expr]:
    """Upper bound of e_n^2 for separation at this gap, without strings and without the work of the bridge.

    It is twice the initial energy minus the least rotational energy at this gap for the initial L.
    """
    first = start(structure)
    at_start = {ORBITAL_RATE: first[q.orbital_momentum] / DISTANCE**2, q.normal_velocity: -1, q.spin: first[q.spin]}
    initial = _kinetic(structure).subs(at_start).subs(DISTANCE, 4 + q.aspect)
    least = sp.Integer(0)
    if structure.oblique:
        momentum = (q.m * q.a**2 * q.rate_scale * angular_momentum_invariant().subs(first)) ** 2
        least = nondimensional(momentum / (2 * q.m * q.a**2) / (q.m * q.v0**2)) / INERTIA_RATIO
    return {"squared": 2 * initial - 2 * least}
