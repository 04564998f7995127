"""Friction of the dry contact: what a tangential impulse at the model's lever arm does to the bodies.

The slip velocity is what the tangential force does work on, and the answer to an impulse is that of the equations of
motion to the force, both from the virtual work of the Lagrangian. Walton & Braun (J. Rheol. 30, 949, 1986): a contact
sticks, with the impulse that turns the slip v_s into -beta_0 v_s, unless Coulomb's limit, mu_f times the normal
impulse, is smaller; then it slides.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache

import sympy as sp

from ..vocabulary.quantities import (
    a,
    m,
    obliquity,
    omega,
    orbital_momentum,
    partner_spin,
    partner_spin_rate,
    rate_scale,
    roll,
    slide,
    slide_rate,
    spin,
    v0,
    xi,
)
from .mechanics import F_t, arm, equations_of_motion
from .partners import bodies, pair, wall
from .partners.pair import LEVER, ORBITAL_RATE
from .scaling import DISTANCE, nondimensional


@dataclass(frozen=True)
class Rubbing:
    """The dry contact of a structure; slip in units of the tangential velocity, impulses in m times that.

    Arguments:
        slip: velocity of the surfaces past each other.
        compliance: slip that a unit impulse takes away; the reduced mass over the effective tangential mass.
        changes: of the tangential states, by a unit impulse.
        grip: a normal impulse over m v0, in units of the tangential one.
        energy: product of impulse and slip over m v0^2.
    """

    slip: sp.Expr
    compliance: sp.Expr
    changes: Mapping[sp.Symbol, sp.Expr]
    grip: sp.Expr
    energy: sp.Expr


@dataclass(frozen=True)
class Answer:
    """A tangential force F in SI: the slip that it works on, and the rates that it changes, per unit force."""

    slip: sp.Expr
    rates: Mapping[sp.Symbol, sp.Expr]

    @property
    def compliance(self) -> sp.Expr:
        """Slip taken away per unit impulse: the inverse of the effective tangential mass."""
        return sp.simplify(-sum(self.slip.diff(rate) * change for rate, change in self.rates.items()))


@cache
def equal_spheres() -> Answer:
    """Two equal spheres with one spin, the force at `arm` from the centres."""
    motion = equations_of_motion()
    moment = motion.orbital_momentum_rate.diff(F_t)  # virtual work per angle of the line of centres
    turning = motion.spin_momentum.diff(xi) * motion.spin_acceleration.diff(F_t)  # per spin angle
    rates = {omega: motion.orbital_acceleration.diff(F_t), xi: motion.spin_acceleration.diff(F_t)}
    return Answer(sp.expand(-moment * omega - turning * xi), rates)


@cache
def unequal_spheres() -> Answer:
    """Two spheres with two spins, the force at `LEVER` times the radius from either centre."""
    motion, (one, other) = bodies.equations_of_motion(), bodies.radii()
    at_contact = {bodies.T_1: LEVER * one * bodies.F_t, bodies.T_2: LEVER * other * bodies.F_t}
    coordinates = {"beta": omega, "alpha_1": xi, "alpha_2": partner_spin_rate}

    def per_force(expression: sp.Expr) -> sp.Expr:
        return sp.factor(expression.subs(at_contact).diff(bodies.F_t))

    slip = -sum(per_force(motion.rates[name]) * rate for name, rate in coordinates.items())
    return Answer(slip, {rate: per_force(motion.accelerations[name]) for name, rate in coordinates.items()})


@cache
def beside_wall() -> Answer:
    """A sphere beside a wall: the limit of the pair, in which the force acts on the sphere's surface."""
    radius = wall.limit(bodies.radii()[0])
    _, along, spun = (each.subs(bodies.T_1, radius * bodies.F_t).diff(bodies.F_t) for each in wall.accelerations())
    inertia = wall.limit(bodies.inertias()[0])
    return Answer(-m * along * slide_rate - inertia * spun * xi, {slide_rate: along, xi: spun})


def rubbing(partner: str) -> Rubbing:
    """The dry contact of a structure with this partner ("" for an equal sphere).

    In space that of a pair, for each component across the line of centres: spheres answer alike in all of them.
    """
    if partner == "wall":
        return _beside_wall()
    return _pair() if partner else _equal()


@cache
def _equal() -> Rubbing:
    def scaled(expression: sp.Expr) -> sp.Expr:
        turned = nondimensional(expression.subs(arm, a * LEVER))
        return sp.sympify(turned).subs(orbital_momentum, ORBITAL_RATE * DISTANCE**2)

    answer = equal_spheres()
    return _scaled(answer, scaled, {omega: orbital_momentum, xi: spin})


@cache
def _pair() -> Rubbing:
    def scaled(expression: sp.Expr) -> sp.Expr:
        one, other = bodies.radii()
        named = expression.subs({one: a * pair.RADIUS, other: a * pair.PARTNER_RADIUS})
        return pair.scaled(named).subs(orbital_momentum, ORBITAL_RATE * DISTANCE**2)

    spins = {xi: spin, partner_spin_rate: partner_spin}
    return _scaled(unequal_spheres(), scaled, {omega: orbital_momentum, **spins})


def _scaled(answer: Answer, scaled: Callable[[sp.Expr], sp.Expr], states: Mapping[sp.Symbol, sp.Symbol]) -> Rubbing:
    """The dry contact of two spheres: velocities in a rate_scale, impulses in m a rate_scale."""
    unit = m * a * rate_scale
    changes = {}
    for rate, state in states.items():
        change = scaled(answer.rates[rate] * unit / rate_scale)
        changes[state] = sp.factor(change * DISTANCE**2 if state == orbital_momentum else change)
    return Rubbing(
        slip=sp.expand(scaled(answer.slip / (a * rate_scale))),
        compliance=sp.expand(scaled(answer.compliance * m)),
        changes=changes,
        grip=scaled(v0 / (a * rate_scale)),
        energy=scaled(a**2 * rate_scale**2 / v0**2),
    )


@cache
def _beside_wall() -> Rubbing:
    answer, sideways = beside_wall(), v0 * obliquity
    return Rubbing(
        slip=sp.expand(wall.scaled(answer.slip / sideways)),
        compliance=wall.scaled(answer.compliance * m),
        changes={slide: wall.scaled(answer.rates[slide_rate] * m), roll: wall.scaled(answer.rates[xi] * m * a)},
        grip=1 / obliquity,
        energy=obliquity**2,
    )
