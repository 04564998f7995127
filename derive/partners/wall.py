"""Sphere against wall: the pair as the partner's radius and mass go to infinity, in quantities that stay finite.

r omega becomes the velocity v along the wall, while omega, and with it the centrifugal force m v^2/r, goes to zero: the
line of centres does not turn, and the motion along it no longer knows of that across it. The wall does not spin.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from ..forces import SHEAR
from ..laws import slot_call
from ..quantities import (
    a,
    m,
    mass_ratio,
    obliquity,
    omega,
    partner_spin_rate,
    radius_ratio,
    roll,
    slide,
    slide_rate,
    u,
    v0,
    x,
    x0,
    xi,
)
from ..scaling import nondimensional
from .base import Rotation
from .bodies import CENTRES, T_1, F_t, centres, equations_of_motion, inertias, r, radii
from .rolling import R_1, R_2, torque_matrix

SHEAR_FORCE, TORQUE = sp.symbols("shear_force torque", real=True)


def limit(expression: sp.Expr) -> sp.Expr:
    """An SI expression of the pair beside a wall: omega = v/r, no spin of the partner, R_2 and M_2 to infinity."""
    at_rest = expression.subs(partner_spin_rate, 0).subs(omega, slide_rate / r)
    one, other = radii()
    in_ratios = at_rest.subs({R_1: one, R_2: other}).subs(CENTRES, centres())
    for ratio in (mass_ratio, radius_ratio):
        in_ratios = sp.limit(sp.factor(in_ratios), ratio, sp.oo)
    return sp.factor(in_ratios)


@cache
def friction() -> tuple[sp.Expr, sp.Expr]:
    """Torque on the sphere and the force against its sliding, in SI, over ln(h_outer/x)."""
    torques = torque_matrix() * sp.Matrix([omega - xi, omega - partner_spin_rate])
    return limit(torques[0]), limit((torques[0] + torques[1]) / (R_1 + R_2))


@cache
def accelerations() -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Of the gap (less the forces along it), along the wall (of v = r omega), and of the spin; in SI."""
    motion = equations_of_motion().accelerations
    opened = motion["x"]
    along = u * omega + r * motion["beta"]  # d(r omega)/dt
    return limit(opened - opened.subs(omega, 0)), limit(along), limit(motion["alpha_1"])


def scaled(expression: sp.Expr) -> sp.Expr:
    """A dimensionless SI expression in states and groups; v over v0 tan(theta0), the spin over that per a."""
    sideways = v0 * obliquity
    return nondimensional(expression.subs({slide_rate: sideways * slide, xi: sideways / a * roll}, simultaneous=True))


@cache
def rotation() -> Rotation:
    """What the equations beside a wall are made of."""
    log = SHEAR * slot_call("shear", "log_factor", x / x0, x0 / a)
    unit = m * v0 * obliquity * v0 / x0  # of tangential forces
    torque, force = friction()
    opened, along, spun = accelerations()
    assert opened == 0  # no centrifugal force
    inertia = limit(inertias()[0])
    named = {F_t: unit * SHEAR_FORCE, T_1: unit * a * TORQUE}
    kinetic = (m * slide_rate**2 + inertia * xi**2) / 2
    power = F_t * slide_rate - T_1 * xi
    return Rotation(
        states=(slide, roll),
        definitions=((SHEAR_FORCE, scaled(log * force / unit)), (TORQUE, scaled(log * torque / (unit * a)))),
        centrifugal=sp.Integer(0),
        rates={
            slide: scaled(along.subs(named) * x0 / (v0 * v0 * obliquity)),
            roll: scaled(spun.subs(named) * x0 / v0 * a / (v0 * obliquity)),
        },
        turning=None,
        kinetic=scaled(kinetic / (m * v0**2)),
        power=scaled(power.subs(named) * x0 / v0 / (m * v0**2)),
        momentum=None,
        outputs={"tangential_restitution": slide, "final_rotation_rate": sp.Integer(0), "final_spin": roll},
        least=(sp.Integer(0), sp.Integer(0)),
        rigid={slide: slide, roll: roll},
        start={slide: sp.Integer(1), roll: sp.Integer(0)},
    )
