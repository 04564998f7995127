"""Mechanics of two unequal spheres: radii and masses from reduced ones and ratios, Lagrangian, equations of motion.

The centre of mass is among the coordinates, so that conservation of linear momentum can be checked.
"""

from dataclasses import dataclass
from functools import cache

import sympy as sp

from ...vocabulary.quantities import a, m, mass_ratio, omega, partner_spin_rate, radius_ratio, u, x, xi
from ...vocabulary.quantities import t as time
from ..mechanics import lagrange, sphere_inertia, without_sines

CENTRES = sp.Symbol("centres", positive=True)  # (R_1 + R_2)/a, named in emitted code
F, F_t, T_1, T_2 = sp.symbols("F F_t T_1 T_2", real=True)  # along the line of centres, across it, torques
r = CENTRES * a + x


@cache
def radii() -> tuple[sp.Expr, sp.Expr]:
    """R_1 and R_2 from a = R_1 R_2/(R_1 + R_2) and R_2 = radius_ratio R_1."""
    first = sp.Symbol("R_1", positive=True)
    (radius,) = sp.solve(sp.Eq(a, sp.simplify(first * radius_ratio * first / (first + radius_ratio * first))), first)
    return sp.factor(radius), sp.factor(radius * radius_ratio)


@cache
def masses() -> tuple[sp.Expr, sp.Expr]:
    """M_1 and M_2 from m = M_1 M_2/(M_1 + M_2) and M_2 = mass_ratio M_1."""
    shape = {a: m, radius_ratio: mass_ratio}
    radius, other = radii()
    return radius.subs(shape), other.subs(shape)


@cache
def centres() -> sp.Expr:
    """Centre distance at contact over a, (R_1 + R_2)/a; 4 for equal spheres."""
    return sp.factor(sum(radii()) / a)


@cache
def inertias() -> tuple[sp.Expr, sp.Expr]:
    """Moments of inertia (2/5) M_i R_i^2."""
    equal_sphere = sphere_inertia() / (2 * m * (2 * a) ** 2)  # that of a sphere of mass 2m and radius 2a over M R^2
    return tuple(sp.factor(equal_sphere * mass * radius**2) for mass, radius in zip(masses(), radii(), strict=True))


@dataclass(frozen=True)
class PairMotion:
    """Accelerations of the pair, its momenta and their rates, for the coordinates X, Y, x, beta, alpha_1, alpha_2."""

    accelerations: dict[str, sp.Expr]
    momenta: dict[str, sp.Expr]
    rates: dict[str, sp.Expr]
    kinetic_energy: sp.Expr


@cache
def equations_of_motion() -> PairMotion:
    """Lagrange's equations d/dt dT/dq' - dT/dq = Q for two free spheres with mutual forces only.

    Sphere 2, at the far end of the line of centres, experiences -F along it and -F_t across it, sphere 1 the opposite.
    """
    q = {name: sp.Function(name, real=True)(time) for name in ("X", "Y", "x", "beta", "alpha_1", "alpha_2")}
    mass_1, mass_2, inertia_1, inertia_2 = named = sp.symbols("M_1 M_2 I_1 I_2", positive=True)
    sizes = dict(zip(named, (*masses(), *inertias()), strict=True))
    line = sp.Matrix([sp.cos(q["beta"]), sp.sin(q["beta"])])
    centre = sp.Matrix([q["X"], q["Y"]])
    apart = (CENTRES * a + q["x"]) * line
    first = centre - mass_2 / (mass_1 + mass_2) * apart
    second = centre + mass_1 / (mass_1 + mass_2) * apart
    speeds = [position.diff(time) for position in (first, second)]
    translation = sum(mass * speed.dot(speed) for mass, speed in zip((mass_1, mass_2), speeds, strict=True)) / 2
    spins = ((inertia_1, "alpha_1"), (inertia_2, "alpha_2"))
    spinning = sp.Add(*(inertia * q[name].diff(time) ** 2 / 2 for inertia, name in spins))
    energy = without_sines(translation, q["beta"]) + spinning
    force = -F * line - F_t * line.diff(q["beta"])
    places = ("X", "Y", "x", "beta")
    work = {name: without_sines(force.dot((second - first).diff(q[name])), q["beta"]) for name in places}
    work |= {"alpha_1": T_1, "alpha_2": T_2}
    moving = {"x": u, "beta": omega, "alpha_1": xi, "alpha_2": partner_spin_rate}
    plain = {q[name].diff(time): rate for name, rate in moving.items()}

    def settle(expression: sp.Expr) -> sp.Expr:
        return sp.factor(expression.subs(plain).subs({q["x"]: x, **sizes}))

    motion = lagrange(energy, q, work)
    settled = {name: [settle(term) for term in parts] for name, parts in motion.items()}
    accelerations, momenta, rates = ({name: parts[k] for name, parts in settled.items()} for k in range(3))
    return PairMotion(accelerations, momenta, rates, settle(energy))
