"""Dissipation, term by term: the energy taken by film, shear and solids is not negative.

The lever arm of the tangential force determines both its torque on the doublet, F_t (2 arm - r), and the shear's power
F_t (r omega - 2 arm xi). With F_t ~ omega - xi the power vanishes at xi = omega and at xi = omega r/(2 arm): it is a
square, and L is conserved, only for arm = r/2.
"""

from collections.abc import Iterable
from functools import cache

import sympy as sp

from ..equations.intermediates import BRIDGE_FORCE, ORBITAL_RATE
from ..equations.invariants import Invariant, invariants
from ..equations.model import derive
from ..physics.forces import force_laws
from ..physics.law import Law, filled
from ..physics.mechanics import F_t, S_t, arm, equations_of_motion, sphere_inertia
from ..physics.scaling import DISTANCE, nondimensional
from ..physics.structure import FREE, Structure
from ..vocabulary import quantities as q
from .base import Check, Evidence, check, models, nonnegative, readable, vanishing


def _taken(term: str) -> sp.Expr:
    """An emitted loss with the forces substituted; distance and orbital rate stay symbols of known sign."""
    model = derive(FREE)
    return model.expanded(model["energy_rates"][term], (ORBITAL_RATE.name, DISTANCE.name))


@cache
@check("film dissipates: {0.name}", "F_n u >= 0 for 0 < x <= x0")
def film_dissipates(law: Law) -> Evidence:
    """The power of the film, F_n u, is not negative at any gap inside it."""
    yield nonnegative(filled(_taken("normal_lubrication"), {"film": law}), q.gap, sp.Integer(1))


@cache
@check(
    "shear dissipates: {0.name}, {1.name} arm", "F_t (r omega - 2 arm xi) >= 0 inside the edge of the tangential force"
)
def shear_dissipates(law: Law, lever: Law) -> Evidence:
    """The power of the shear, F_t (r omega - 2 arm xi), is not negative inside its edge if the arm conserves L."""
    rate = filled(_taken("tangential_lubrication"), {"shear": law, "arm": lever})
    yield nonnegative(rate, q.gap, law["edge"](q.aspect))


@cache
def torque(lever: Law) -> sp.Expr:
    """dL/dt of a free doublet for an arm, in SI and in terms of F_t: the torques on the orbit and on both spins."""
    motion = equations_of_motion()
    whole = motion.orbital_momentum_rate.subs(S_t, 0) + 2 * sphere_inertia() * motion.spin_acceleration
    return sp.factor(sp.expand(filled(whole.subs(arm, force_laws()[arm]), {"arm": lever})))


@cache
def conserves(lever: Law) -> bool:
    """True if angular momentum is among the invariants found for the free doublet with this arm."""
    return any(invariant.is_angular_momentum for invariant in conserved(lever))


@cache
def conserved(lever: Law, structure: Structure = FREE) -> tuple[Invariant, ...]:
    """The invariants of a structure with this arm, for any other laws."""
    return invariants(derive(structure), {"arm": lever})


def angular_momentum(lever: Law) -> Check:
    """dL/dt for an arm along the emitted equations, for any tangential and bridge law: zero, or a failure."""
    name, residuals = f"angular momentum, {lever.name} arm", []
    expected = torque(lever)
    per_time = q.x0 / (q.v0 * q.m * q.a**2 * q.rate_scale)
    lost = nondimensional(expected.subs(F_t, force_laws()[F_t]) * per_time) if expected != 0 else expected
    for model in models(lambda s: s.oblique and not s.strings and not s.reduced):
        rates = model.by_state("right_hand_side")
        change = filled(rates[q.orbital_momentum] + sp.Rational(32, 5) * rates[q.spin], {"arm": lever})
        residuals.append(change - model.expanded(lost))
    if conserves(lever):
        words = "; ".join(invariant.describe() for invariant in conserved(lever))
        return vanishing(
            name, "dL/dt = 0 without strings, for every tangential and bridge law", residuals, f"found: {words}"
        )
    return Check(name, "dL/dt = 0 without strings", False, f"dL/dt = {readable(expected)}")


def arms(levers: Iterable[Law], shears: Iterable[Law]) -> tuple[Check, ...]:
    """For each arm dL/dt, and for each tangential law with it the sign of the shear's power."""
    tangential, checks = [*shears], []
    for lever in levers:
        checks += [angular_momentum(lever), *(shear_dissipates(law, lever) for law in tangential)]
    return tuple(checks)


@check("bridge does work only", "F_c = F_c(x): its work W_c(x) is a potential, for any bridge law")
def bridge_does_work() -> Evidence:
    """The bridge force depends on the gap only, so it has a potential W_c(x), the same while closing and opening."""
    for model in models(lambda structure: structure.bridge):
        force = model.expanded(BRIDGE_FORCE)
        yield from [force.diff(state) for state in (q.normal_velocity, q.orbital_momentum, q.spin, q.beta)]
        yield model.expanded(model["energy_rates"]["capillary"]) - force * q.normal_velocity


@check("rebound's energy", "kinetic energy before - after = (1 - e_dry^2) u^2/2, all else continuous")
def rebound_is_charged() -> Evidence:
    """A rebound loses exactly the kinetic energy of `rebound_loss`."""
    for model in models():
        before = model.expanded(model["energies"]["kinetic"])
        charged = model.expanded(model["rebound_loss"]["dry_contact"])
        yield before - before.subs(model.by_state("rebound"), simultaneous=True) - charged


@check("rebound dissipates", "(1 - e_dry^2) u^2/2 >= 0 for 0 < e_dry <= 1")
def rebound_dissipates() -> Evidence:
    """`rebound_loss` is not negative for 0 <= e_dry <= 1."""
    for charged in {model.expanded(model["rebound_loss"]["dry_contact"]) for model in models()}:
        yield nonnegative(charged, q.e_dry, sp.Integer(1))
