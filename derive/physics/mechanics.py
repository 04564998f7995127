"""Mechanics of the doublet: inertia by integration, Lagrangian, equations of motion with generalised forces.

Two equal spheres (radius R = 2a, mass M = 2m) have centres at distance r = 4a + x in direction beta; both spin at xi
about their own centres. Forces enter through their virtual work.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import sympy as sp

from ..vocabulary.quantities import a, m, omega, u, x, xi
from ..vocabulary.quantities import r as r_of_x
from ..vocabulary.quantities import t as time

# Generalised forces with the signs of the laws: attraction and film resist opening, F_t reduces omega - xi.
F_n, F_c, F_t, arm = sp.symbols("F_n F_c F_t arm", real=True)
F_w = sp.Symbol("F_w", real=True)  # attraction along the line of centres other than the bridge's
S_n, S_t = sp.symbols("S_n S_t", real=True)


@cache
def sphere_inertia() -> sp.Expr:
    """Moment of inertia of one sphere about a diameter, (2/5) M R^2 = (16/5) m a^2, integrated over its volume."""
    radius, mass, s, azimuth = sp.symbols("R M s varphi", positive=True)
    cosine = sp.Symbol("cos_vartheta", real=True)  # of the polar angle: d(cosine) = -sin d(angle)
    density = mass / (sp.Rational(4, 3) * sp.pi * radius**3)
    lever_squared = s**2 * (1 - cosine**2)
    inertia = sp.integrate(density * lever_squared * s**2, (s, 0, radius), (cosine, -1, 1), (azimuth, 0, 2 * sp.pi))
    return inertia.subs({radius: 2 * a, mass: 2 * m})


@cache
def doublet_inertia() -> sp.Expr:
    """Moment of inertia I(x) of the doublet in rigid rotation: two spheres and the parallel-axis theorem."""
    return sp.expand(2 * (sphere_inertia() + 2 * m * (r_of_x / 2) ** 2))


@dataclass(frozen=True)
class Coordinates:
    """Generalised coordinates as functions of time."""

    x: sp.Expr
    beta: sp.Expr
    spin_angle: sp.Expr


def coordinates() -> Coordinates:
    """Gap, angle of the line of centres, and rotation angle of each sphere about its centre."""
    functions = [sp.Function(name, real=True)(time) for name in ("x", "beta", "alpha")]
    return Coordinates(*functions)


@cache
def kinetic_energy() -> sp.Expr:
    """Kinetic energy relative to the centre of mass, from the positions of both centres and both spins."""
    q = coordinates()
    half = (4 * a + q.x) / 2
    position = sp.Matrix([half * sp.cos(q.beta), half * sp.sin(q.beta)])  # the other sphere moves in mirror image
    velocity = position.diff(time)
    per_sphere = (
        sp.Rational(1, 2) * 2 * m * velocity.dot(velocity)
        + sp.Rational(1, 2) * sphere_inertia() * q.spin_angle.diff(time) ** 2
    )
    return sp.factor(without_sines(2 * per_sphere, q.beta))


def without_sines(expression: sp.Expr, angle: sp.Expr) -> sp.Expr:
    """A polynomial in sine and cosine of an angle, expanded, with its squared sines as 1 - cos^2.

    Lengths and products with unit vectors then no longer name the angle.
    """
    squared = sp.sin(angle) ** 2, 1 - sp.cos(angle) ** 2
    return sp.expand(sp.expand(expression).subs(*squared))


@cache
def generalised_forces() -> dict[str, sp.Expr]:
    """Generalised forces of film, bridge, strings and shear for each coordinate, from their virtual work.

    The sphere at +r/2 experiences -(F_n + F_c + F_w) along the line of centres and -F_t across it, the other sphere
    the opposite. The tangential forces act at a distance `arm` from the centres, with the torque F_t arm on each
    sphere.
    """
    q = coordinates()
    n = sp.Matrix([sp.cos(q.beta), sp.sin(q.beta)])
    across = sp.Matrix([-sp.sin(q.beta), sp.cos(q.beta)])
    force = -(F_n + F_c + F_w + S_n) * n - (F_t + S_t) * across
    position = (4 * a + q.x) / 2 * n
    work = {}
    for name, coordinate in (("x", q.x), ("beta", q.beta)):
        work[name] = sp.factor(without_sines(2 * force.dot(position.diff(coordinate)), q.beta))
    work["spin_angle"] = 2 * F_t * arm
    return work


@dataclass(frozen=True)
class EquationsOfMotion:
    """Accelerations and momenta of the doublet in the quantities of the vocabulary."""

    separation_acceleration: sp.Expr  # du/dt
    orbital_acceleration: sp.Expr  # domega/dt
    spin_acceleration: sp.Expr  # dxi/dt
    orbital_momentum: sp.Expr  # conjugate to beta
    orbital_momentum_rate: sp.Expr
    spin_momentum: sp.Expr  # conjugate to the spin angle of both spheres
    kinetic_energy: sp.Expr

    @property
    def angular_momentum(self) -> sp.Expr:
        return self.orbital_momentum + self.spin_momentum


@cache
def equations_of_motion() -> EquationsOfMotion:
    """Lagrange's equations d/dt dT/dq' - dT/dq = Q, solved for the accelerations."""
    q = coordinates()
    energy, forces = kinetic_energy(), generalised_forces()
    plain = {
        q.x.diff(time): u,
        q.beta.diff(time): omega,
        q.spin_angle.diff(time): xi,
    }

    def settle(expression: sp.Expr) -> sp.Expr:
        return expression.subs(plain).subs({q.x: x})

    acceleration: dict[str, sp.Expr] = {}
    momentum: dict[str, sp.Expr] = {}
    rate: dict[str, sp.Expr] = {}
    for name, coordinate in (("x", q.x), ("beta", q.beta), ("spin_angle", q.spin_angle)):
        conjugate = energy.diff(coordinate.diff(time))
        balance = conjugate.diff(time) - energy.diff(coordinate) - forces[name]
        second = coordinate.diff(time, 2)
        alone = sp.factor(-balance.subs(second, 0) / balance.diff(second))  # the balance is linear in it
        acceleration[name] = sp.expand(settle(alone))
        momentum[name] = sp.expand(settle(conjugate))
        rate[name] = settle(energy.diff(coordinate) + forces[name])
    return EquationsOfMotion(
        separation_acceleration=acceleration["x"],
        orbital_acceleration=acceleration["beta"],
        spin_acceleration=acceleration["spin_angle"],
        orbital_momentum=sp.factor(momentum["beta"]),
        orbital_momentum_rate=sp.factor(rate["beta"]),
        spin_momentum=sp.factor(momentum["spin_angle"]),
        kinetic_energy=settle(energy),
    )


def string_forces(potential: sp.Expr, distance: sp.Symbol, angle: sp.Symbol) -> tuple[sp.Expr, sp.Expr]:
    """Normal and tangential string force (S_n, S_t): minus the gradient of the potential U_s(r, beta)."""
    return potential.diff(distance), potential.diff(angle) / distance
