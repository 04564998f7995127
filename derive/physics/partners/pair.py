"""Two unequal spheres, each with its own spin: rotation, friction and angular momentum in dimensionless form."""

from functools import cache

import sympy as sp

from ...vocabulary import quantities as q
from ..forces import SHEAR, TANGENTIAL
from ..law import Definition, slot_call
from ..scaling import DISTANCE, INERTIA, nondimensional
from .base import Rotation, relative_change
from .bodies import CENTRES, T_1, T_2, F_t, centres, equations_of_motion, inertias, r, radii
from .rolling import R_1, R_2, torque_matrix

RADIUS, PARTNER_RADIUS, SPIN_INERTIA, PARTNER_INERTIA = sp.symbols(
    "radius partner_radius spin_inertia partner_inertia", positive=True
)
ORBITAL_RATE, SLIP, PARTNER_SLIP = sp.symbols("orbital_rate slip partner_slip", real=True)
LEVER, INERTIA_RATIO, DRAG = sp.symbols("lever inertia_ratio drag", positive=True)
MOMENTUM = sp.Symbol("momentum", real=True)
TORQUE, PARTNER_TORQUE, SHEAR_FORCE = sp.symbols("torque partner_torque shear_force", real=True)


def scaled(expression: sp.Expr) -> sp.Expr:
    """A dimensionless SI expression in states and groups; the centre distance at contact is `centres` a."""
    return nondimensional(expression, CENTRES)


def _turned(expression: sp.Expr) -> sp.Expr:
    return scaled(expression).subs(q.orbital_momentum, ORBITAL_RATE * DISTANCE**2)


def friction() -> tuple[tuple[sp.Expr, sp.Expr], sp.Expr]:
    """Torques on the two spheres and the tangential force, in SI.

    The torques are the leading logarithms, multiplied by a factor from the law for the lever arm. For `midgap` the
    factor is r/(R_1 + R_2), so that they add up to r F_t and dL/dt = 0 exactly.
    """
    log = SHEAR * slot_call("shear", "log_factor", q.x / q.x0, q.x0 / q.a)
    slips = sp.Matrix([q.omega - q.xi, q.omega - q.partner_spin_rate])
    torques = torque_matrix() * slips * log
    stretch = slot_call("arm", "lever", 4 * r / (CENTRES * q.a)) / 2  # lever arm for equal spheres over their radius 2a
    return (stretch * torques[0], stretch * torques[1]), (torques[0] + torques[1]) / (R_1 + R_2)


def _friction() -> list[Definition]:
    log = SHEAR * slot_call("shear", "log_factor", q.x / q.x0, q.x0 / q.a)
    unit = 2 * sp.pi * q.mu * q.a**3  # coefficients of the slip rates in the torques
    shape = (torque_matrix() / unit).subs({R_1: q.a * RADIUS, R_2: q.a * PARTNER_RADIUS})
    torque, partner_torque = LEVER * DRAG * sp.simplify(shape) * sp.Matrix([SLIP, PARTNER_SLIP])
    return [
        (DRAG, scaled(log * unit * q.rate_scale / (TANGENTIAL * q.a))),
        (LEVER, slot_call("arm", "lever", 4 * DISTANCE / CENTRES) / 2),
        (TORQUE, sp.factor(torque)),
        (PARTNER_TORQUE, sp.factor(partner_torque)),
        (SHEAR_FORCE, (TORQUE + PARTNER_TORQUE) / (LEVER * CENTRES)),
    ]


def _definitions() -> tuple[Definition, ...]:
    named = (*(radius / q.a for radius in radii()), *(inertia / (q.m * q.a**2) for inertia in inertias()))
    return (
        (CENTRES, centres()),
        (DISTANCE, CENTRES + q.aspect * q.gap),
        (ORBITAL_RATE, scaled(q.omega / q.rate_scale)),
        *zip((RADIUS, PARTNER_RADIUS, SPIN_INERTIA, PARTNER_INERTIA), map(sp.factor, named), strict=True),
        (MOMENTUM, q.orbital_momentum + SPIN_INERTIA * q.spin + PARTNER_INERTIA * q.partner_spin),
        (INERTIA_RATIO, DISTANCE**2 + SPIN_INERTIA + PARTNER_INERTIA),
        (SLIP, ORBITAL_RATE - q.spin),
        (PARTNER_SLIP, ORBITAL_RATE - q.partner_spin),
        *_friction(),
    )


@cache
def rotation() -> Rotation:
    """The rotation of an unequal pair, for its equations."""
    motion = equations_of_motion()
    named = {F_t: TANGENTIAL * SHEAR_FORCE, T_1: TANGENTIAL * q.a * TORQUE, T_2: TANGENTIAL * q.a * PARTNER_TORQUE}
    per_time = q.x0 / (q.v0 * q.m * q.a**2 * q.rate_scale)

    def rate(coordinate: str) -> sp.Expr:
        return scaled(motion.rates[coordinate].subs(named) * per_time)

    power = F_t * r * q.omega - T_1 * q.xi - T_2 * q.partner_spin_rate
    rigid, orbit = MOMENTUM / INERTIA_RATIO, (CENTRES + q.aspect) ** 2 * q.initial_turning
    least = scaled((q.m * q.a**2 * q.rate_scale * MOMENTUM) ** 2 / (2 * q.m * q.a**2 * INERTIA_RATIO) / (q.m * q.v0**2))
    orbital = _turned(q.m * r**2 * q.omega**2 / 2 / (q.m * q.v0**2))  # the centre of mass is at rest
    unit = scaled(q.m * q.a**2 * q.rate_scale**2 / 2 / (q.m * q.v0**2))
    opened = motion.accelerations["x"]
    centrifugal = sp.expand(opened - opened.subs(q.omega, 0))
    assert sp.expand(centrifugal - r * q.omega**2) == 0
    return Rotation(
        states=(q.orbital_momentum, q.spin, q.partner_spin),
        definitions=_definitions(),
        centrifugal=_turned(q.m * r * q.omega**2 / INERTIA),
        rates={
            q.orbital_momentum: rate("beta"),
            q.spin: rate("alpha_1") / SPIN_INERTIA,
            q.partner_spin: rate("alpha_2") / PARTNER_INERTIA,
        },
        turning=_turned(q.omega * q.x0 / q.v0),
        kinetic=orbital + unit * SPIN_INERTIA * q.spin**2 + unit * PARTNER_INERTIA * q.partner_spin**2,
        power=_turned(power.subs(named) * q.x0 / q.v0 / (q.m * q.v0**2)),
        momentum=relative_change(
            MOMENTUM, (orbit, SPIN_INERTIA * q.initial_spin, PARTNER_INERTIA * q.initial_partner_spin)
        ),
        outputs={
            "tangential_restitution": DISTANCE * ORBITAL_RATE / ((CENTRES + q.aspect) * q.initial_turning),
            "final_rotation_rate": ORBITAL_RATE,
            "final_spin": q.spin,
            "final_spin_partner": q.partner_spin,
        },
        surface_slip=DISTANCE * ORBITAL_RATE - LEVER * (RADIUS * q.spin + PARTNER_RADIUS * q.partner_spin),
        least=(least, least.diff(INERTIA_RATIO) * 2 * DISTANCE * q.aspect),
        rigid={q.orbital_momentum: DISTANCE**2 * rigid, q.spin: rigid, q.partner_spin: rigid},
        start={q.orbital_momentum: orbit, q.spin: q.initial_spin, q.partner_spin: q.initial_partner_spin},
    )
