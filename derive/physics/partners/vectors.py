"""Mechanics of two spheres in space: rates of vectors in the laboratory's axes, from the Lagrangian.

Sphere 2 lies at r n from sphere 1. The angular velocity of the line of centres is omega = n x dn/dt; it has no
component along n. The angular velocity of each sphere is any vector. Sphere 2 experiences the force F, sphere 1 its
opposite.
"""

from dataclasses import dataclass
from functools import cache

import sympy as sp

from ...vocabulary.quantities import AXES, Vector, m, u
from ...vocabulary.quantities import normal as n
from ...vocabulary.quantities import t as time


def named(name: str) -> Vector:
    """Symbols of a vector's components."""
    first, second, third = (sp.Symbol(f"{name}_{axis}", real=True) for axis in AXES)
    return first, second, third


FORCE, LINE_RATE = named("F"), named("omega")
APART = sp.Symbol("r", positive=True)


def dot(first: Vector | sp.Matrix, second: Vector | sp.Matrix) -> sp.Expr:
    """Scalar product."""
    return sp.Add(*(component * other for component, other in zip(first, second, strict=True)))


def cross(first: Vector | sp.Matrix, second: Vector | sp.Matrix) -> sp.Matrix:
    """Vector product."""
    return sp.Matrix(first).cross(sp.Matrix(second))


def on_the_sphere(expression: sp.Expr, normal: Vector = n, across: Vector = LINE_RATE) -> sp.Expr:
    """A polynomial reduced by |n|^2 = 1 and by n . omega = 0, so that what vanishes by these is zero."""
    top, bottom = sp.fraction(sp.together(sp.expand(expression)))
    symbols = (*across, *normal)
    basis = sp.groebner([dot(normal, normal) - 1, dot(normal, across)], *symbols, order="grevlex")
    return sp.factor(sp.reduced(sp.expand(top), basis.exprs, *symbols, order="grevlex")[1] / bottom)


@dataclass(frozen=True)
class SpaceMotion:
    """Rates in SI: du/dt, of n and of the orbital momentum m r^2 omega, for FORCE; spins turn with their torques."""

    opening: sp.Expr
    normal: sp.Matrix
    orbital_momentum: sp.Matrix


@cache
def relative_acceleration() -> sp.Matrix:
    """d^2(r n)/dt^2 from Lagrange's equations for the two centres, with the centre of mass among the coordinates."""
    mass_1, mass_2 = sp.symbols("M_1 M_2", positive=True)
    centre, apart = (sp.Matrix([sp.Function(f"{name}_{axis}")(time) for axis in AXES]) for name in ("C", "q"))
    first = centre - mass_2 / (mass_1 + mass_2) * apart
    second = centre + mass_1 / (mass_1 + mass_2) * apart
    speeds = [place.diff(time) for place in (first, second)]
    energy = (mass_1 * speeds[0].dot(speeds[0]) + mass_2 * speeds[1].dot(speeds[1])) / 2
    result = []
    for coordinate in apart:
        work = dot(FORCE, (second - first).diff(coordinate))
        balance = sp.expand(energy.diff(coordinate.diff(time)).diff(time) - energy.diff(coordinate) - work)
        result += sp.solve(balance, coordinate.diff(time, 2))
    reduced = sp.Matrix(result).applyfunc(lambda entry: sp.simplify(entry.subs(mass_2, m * mass_1 / (mass_1 - m))))
    assert not reduced.has(mass_1)  # only the reduced mass remains
    return reduced


@cache
def spin_balance() -> sp.Matrix:
    """Lagrange's equations of a free sphere in Euler angles, as I dw/dt - T in the laboratory's axes; zero."""
    inertia = sp.Symbol("I", positive=True)
    turn, tilt, roll = (sp.Function(name)(time) for name in ("phi", "theta", "psi"))
    angles = (turn, tilt, roll)
    turning, tilting, rolling = (angle.diff(time) for angle in angles)
    along = sp.cos(turn) * tilting + sp.sin(turn) * sp.sin(tilt) * rolling
    across = sp.sin(turn) * tilting - sp.cos(turn) * sp.sin(tilt) * rolling
    rates = sp.Matrix([along, across, turning + sp.cos(tilt) * rolling])
    energy = inertia * rates.dot(rates) / 2
    by_rates = rates.jacobian([angle.diff(time) for angle in angles])  # work of T: T . w
    lagrange = sp.Matrix([energy.diff(angle.diff(time)).diff(time) - energy.diff(angle) for angle in angles])
    work = by_rates.T * inertia * rates.diff(time) - lagrange  # of I dw/dt - T: by_rates can be inverted
    sines = {sp.sin(angle) ** 2: 1 - sp.cos(angle) ** 2 for angle in angles}
    return by_rates.T.LUsolve(work.applyfunc(lambda entry: sp.expand(sp.expand(entry).subs(sines))))


@cache
def motion() -> SpaceMotion:
    """The rates, from the accelerations of the relative vector q = r n and the balance of each sphere's spin.

    They are written as chosen below; the assertion holds them to the derivatives of n = q/r, of u = n . dq/dt and of
    q x dq/dt.
    """
    place = sp.Matrix([sp.Function(f"q_{axis}")(time) for axis in AXES])
    length = sp.Function("r")(time)  # dr/dt = u follows from r^2 = q . q
    derived = [
        (place.dot(place.diff(time)) / length).diff(time),
        *(place / length).diff(time),
        *(m * cross(place, place.diff(time))).diff(time),
    ]
    chosen = SpaceMotion(
        opening=APART * dot(LINE_RATE, LINE_RATE) + dot(n, FORCE) / m,
        normal=cross(LINE_RATE, n),
        orbital_momentum=APART * cross(n, FORCE),
    )
    moved = u * sp.Matrix(n) + APART * cross(LINE_RATE, n)
    rules = [
        dict(zip(place.diff(time, 2), relative_acceleration(), strict=True)),
        {length.diff(time): u, **dict(zip(place.diff(time), moved, strict=True))},
        {length: APART, **dict(zip(place, APART * sp.Matrix(n), strict=True))},
    ]
    for rule in rules:
        derived = [rate.subs(rule) for rate in derived]
    wanted = [chosen.opening, *chosen.normal, *chosen.orbital_momentum]
    assert all(on_the_sphere(rate - other) == 0 for rate, other in zip(derived, wanted, strict=True))
    return chosen
