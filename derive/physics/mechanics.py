"""Mechanics of the doublet: inertia by integration, Lagrangian, equations of motion with generalised forces.

Two equal spheres (radius R = 2a, mass M = 2m) have centres at distance r = 4a + x in direction beta; both spin at xi
about their own centres. Forces enter through their virtual work.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import sympy as sp

from ..vocabulary.quantities import a, beta, m, omega, u, x, xi
from ..vocabulary.quantities import r as r_of_x
from ..vocabulary.quantities import t as time

# Generalised forces with the signs of the laws: attraction and film resist opening, F_t reduces omega - xi.
F_n, F_c, F_t, arm = sp.symbols("F_n F_c F_t arm", real=True)
F_w = sp.Symbol("F_w", real=True)  # attraction along the line of centres other than the bridge's
S_n, S_t = sp.symbols("S_n S_t", real=True)
# What a model file adds to the equation of motion of each coordinate: a generalised force and an inertia
Q_x, Q_beta, Q_spin = sp.symbols("Q_x Q_beta Q_spin", real=True)
M_x, M_beta, M_spin = sp.symbols("M_x M_beta M_spin", nonnegative=True)


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


@cache
def coordinates() -> dict[str, sp.Expr]:
    """Gap, angle of the line of centres, and rotation angle of each sphere about its centre, as functions of time."""
    names = {"x": "x", "beta": "beta", "spin_angle": "alpha"}
    return {coordinate: sp.Function(name, real=True)(time) for coordinate, name in names.items()}


def _line() -> sp.Matrix:
    angle = coordinates()["beta"]
    return sp.Matrix([sp.cos(angle), sp.sin(angle)])


@cache
def kinetic_energy() -> sp.Expr:
    """Kinetic energy relative to the centre of mass, from the positions of both centres and both spins."""
    q = coordinates()
    velocity = ((4 * a + q["x"]) / 2 * _line()).diff(time)  # the other sphere moves in mirror image
    spinning = sp.Rational(1, 2) * sphere_inertia() * q["spin_angle"].diff(time) ** 2
    return sp.factor(without_sines(2 * (m * velocity.dot(velocity) + spinning), q["beta"]))


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
    q, n = coordinates(), _line()
    force = -(F_n + F_c + F_w + S_n) * n - (F_t + S_t) * n.diff(q["beta"])
    position = (4 * a + q["x"]) / 2 * n
    work = {name: sp.factor(without_sines(2 * force.dot(position.diff(q[name])), q["beta"])) for name in ("x", "beta")}
    return work | {"spin_angle": 2 * F_t * arm}


def lagrange(
    energy: sp.Expr, coordinates: Mapping[str, sp.Expr], work: Mapping[str, sp.Expr]
) -> dict[str, tuple[sp.Expr, sp.Expr, sp.Expr]]:
    """Acceleration, momentum and the momentum's rate of each coordinate: d/dt dT/dq' = dT/dq + Q."""
    result = {}
    for name, coordinate in coordinates.items():
        momentum, rate = energy.diff(coordinate.diff(time)), energy.diff(coordinate) + work[name]
        inertia, force = _balance(momentum, rate, coordinate)
        result[name] = force / inertia, momentum, rate
    return result


def _balance(momentum: sp.Expr, rate: sp.Expr, coordinate: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Inertia and force of a coordinate: d/dt momentum = rate is linear in its acceleration."""
    balance, second = momentum.diff(time) - rate, coordinate.diff(time, 2)
    return balance.diff(second), -balance.subs(second, 0)


def added(energy: sp.Expr, work: Mapping[str, sp.Expr]) -> dict[str, tuple[sp.Expr, sp.Expr]]:
    """Inertia and force that a term of the Lagrangian and generalised forces add for each coordinate, in SI."""
    result = {}
    for name, coordinate in coordinates().items():
        moving = _moving(energy)
        momentum, rate = moving.diff(coordinate.diff(time)), moving.diff(coordinate) + _moving(work[name])
        inertia, force = _balance(momentum, rate, coordinate)
        result[name] = sp.simplify(_settled(inertia)), sp.simplify(_settled(force))
    return result


def _moving(expression: sp.Expr) -> sp.Expr:
    """An expression in SI with the coordinates and their velocities as functions of time."""
    q = coordinates()
    velocities = {rate: coordinate.diff(time) for rate, coordinate in zip((u, omega, xi), q.values(), strict=True)}
    return expression.subs({x: q["x"], beta: q["beta"]} | velocities, simultaneous=True)


def _settled(expression: sp.Expr) -> sp.Expr:
    """The reverse of `_moving`."""
    q = coordinates()
    plain = {coordinate.diff(time): rate for coordinate, rate in zip(q.values(), (u, omega, xi), strict=True)}
    return expression.subs(plain).subs({q["x"]: x, q["beta"]: beta})


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
def equations_of_motion(terms: bool = False) -> EquationsOfMotion:
    """Lagrange's equations of the doublet, solved for the accelerations.

    Arguments:
        terms: with the generalised forces Q and the inertia M that a model file adds; M varies as Q says.
    """
    q, settle = coordinates(), _settled
    energy, work = kinetic_energy(), generalised_forces()
    if terms:
        energy += sum(mass * at.diff(time) ** 2 / 2 for mass, at in zip((M_x, M_beta, M_spin), q.values(), strict=True))
        work = {on: force + more for (on, force), more in zip(work.items(), (Q_x, Q_beta, Q_spin), strict=True)}
    motion = lagrange(energy, q, work)
    opened, turned, spun = (sp.expand(settle(sp.factor(acceleration))) for acceleration, _, _ in motion.values())
    return EquationsOfMotion(
        separation_acceleration=opened,
        orbital_acceleration=turned,
        spin_acceleration=spun,
        orbital_momentum=sp.factor(settle(motion["beta"][1])),
        orbital_momentum_rate=sp.factor(settle(motion["beta"][2])),
        spin_momentum=sp.factor(settle(motion["spin_angle"][1])),
        kinetic_energy=settle(kinetic_energy()),
    )


def string_forces(potential: sp.Expr, distance: sp.Symbol, angle: sp.Symbol) -> tuple[sp.Expr, sp.Expr]:
    """Normal and tangential string force (S_n, S_t): minus the gradient of the potential U_s(r, beta)."""
    return potential.diff(distance), potential.diff(angle) / distance
