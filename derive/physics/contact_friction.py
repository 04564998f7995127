"""Friction of the dry contact: what a tangential impulse at the model's lever arm does to the bodies.

The slip velocity is what the tangential force does work on, and the answer to an impulse is that of the equations of
motion to the force, both from the virtual work of the Lagrangian. Walton & Braun (J. Rheol. 30, 949, 1986): a contact
sticks, with the impulse that turns the slip v_s into -beta_0 v_s, unless Coulomb's limit, mu_f times the normal
impulse, is smaller; then it slides.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache

import sympy as sp

from ..vocabulary import quantities as q
from .mechanics import arm
from .partners import bodies, pair, wall
from .partners.pair import LEVER, ORBITAL_RATE
from .scaling import DISTANCE, EQUAL, nondimensional


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
    """Two equal spheres with one spin, the force at `arm` from the centres: the pair of ratio 1."""
    answer, ratios = unequal_spheres(), dict.fromkeys((q.radius_ratio, q.mass_ratio), 1)
    equal = {**ratios, bodies.CENTRES: EQUAL, LEVER: arm / q.R, q.partner_spin_rate: q.xi}
    rates = {rate: sp.expand(answer.rates[rate].subs(equal)) for rate in (q.omega, q.xi)}
    return Answer(sp.expand(answer.slip.subs(equal)), rates)


@cache
def unequal_spheres() -> Answer:
    """Two spheres with two spins, the force at `LEVER` times the radius from either centre."""
    motion, (radius, other) = bodies.equations_of_motion(), bodies.radii()
    at_contact = {bodies.T_1: LEVER * radius * bodies.F_t, bodies.T_2: LEVER * other * bodies.F_t}
    coordinates = {"beta": q.omega, "alpha_1": q.xi, "alpha_2": q.partner_spin_rate}

    def per_force(expression: sp.Expr) -> sp.Expr:
        return sp.factor(expression.subs(at_contact).diff(bodies.F_t))

    slip = -sum(per_force(motion.rates[name]) * rate for name, rate in coordinates.items())
    return Answer(slip, {rate: per_force(motion.accelerations[name]) for name, rate in coordinates.items()})


@cache
def beside_wall() -> Answer:
    """A sphere beside a wall: the limit of the pair, in which the force acts on the sphere's surface."""
    radius = wall.limit(bodies.radii()[0])
    _, along, spun = (rate.subs(bodies.T_1, radius * bodies.F_t).diff(bodies.F_t) for rate in wall.accelerations())
    inertia = wall.limit(bodies.inertias()[0])
    return Answer(-q.m * along * q.slide_rate - inertia * spun * q.xi, {q.slide_rate: along, q.xi: spun})


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
        turned = nondimensional(expression.subs(arm, q.a * LEVER))
        return sp.sympify(turned).subs(q.orbital_momentum, ORBITAL_RATE * DISTANCE**2)

    return _scaled(equal_spheres(), scaled, {q.omega: q.orbital_momentum, q.xi: q.spin})


@cache
def _pair() -> Rubbing:
    def scaled(expression: sp.Expr) -> sp.Expr:
        radius, other = bodies.radii()
        named = expression.subs({radius: q.a * pair.RADIUS, other: q.a * pair.PARTNER_RADIUS})
        return pair.scaled(named).subs(q.orbital_momentum, ORBITAL_RATE * DISTANCE**2)

    spins = {q.xi: q.spin, q.partner_spin_rate: q.partner_spin}
    return _scaled(unequal_spheres(), scaled, {q.omega: q.orbital_momentum, **spins})


def _scaled(answer: Answer, scaled: Callable[[sp.Expr], sp.Expr], states: Mapping[sp.Symbol, sp.Symbol]) -> Rubbing:
    """The dry contact of two spheres: velocities in a rate_scale, impulses in m a rate_scale."""
    unit = q.m * q.a * q.rate_scale
    changes = {}
    for rate, state in states.items():
        change = scaled(answer.rates[rate] * unit / q.rate_scale)
        changes[state] = sp.factor(change * DISTANCE**2 if state == q.orbital_momentum else change)
    return Rubbing(
        slip=sp.expand(scaled(answer.slip / (q.a * q.rate_scale))),
        compliance=sp.expand(scaled(answer.compliance * q.m)),
        changes=changes,
        grip=scaled(q.v0 / (q.a * q.rate_scale)),
        energy=scaled(q.a**2 * q.rate_scale**2 / q.v0**2),
    )


@cache
def _beside_wall() -> Rubbing:
    answer = beside_wall()
    along, spun = answer.rates[q.slide_rate] * q.m, answer.rates[q.xi] * q.m * q.a
    return Rubbing(
        slip=sp.expand(wall.scaled(answer.slip / (q.v0 * q.obliquity))),
        compliance=wall.scaled(answer.compliance * q.m),
        changes={q.slide: wall.scaled(along), q.roll: wall.scaled(spun)},
        grip=1 / q.obliquity,
        energy=q.obliquity**2,
    )
