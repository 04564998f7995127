"""The forces of the model in SI, with every law as a call to its slot, and the dimensionless string forces.

Laws remain calls (`bridge.force(...)`), and film and shear are flags (1 where the force acts, 0 beyond its edge), so
one set of forces serves every variant. The string forces are scaled in a form without cancellation.
"""

from functools import cache

import sympy as sp

from ..vocabulary import quantities as q
from .law import slot_call
from .mechanics import F_c, F_n, F_t, F_w, S_n, S_t, arm
from .pendulum import offset_squared, swing_squared
from .pendulum import r as string_distance
from .scaling import DISTANCE, INERTIA, VAN_DER_WAALS, nondimensional

# Flags for where film and shear act, named as in emitted code
FILM, SHEAR = sp.symbols("film shear", nonnegative=True)

TANGENTIAL = q.m * q.a * q.rate_scale * q.v0 / q.x0  # scale of the tangential force


@cache
def force_laws(spread: bool = False) -> dict[sp.Symbol, sp.Expr]:
    """The forces of the model in SI, with slot calls in place of the selectable laws.

    Arguments:
        spread: the film law depends on the bridge volume.
    """
    offset = (swing_squared() / q.a**2).subs(string_distance, q.r)
    stiffness = slot_call("strings", "stiffness", q.l_s / q.a, offset)
    # S = dU/dr with U = 4 m g a rise(l/a, (d/a)^2) and stiffness = 2 d rise/d (d/a)^2
    lift = 4 * q.m * q.g * q.a * stiffness / 2
    sliding = 8 * sp.pi * q.mu * q.a**2 * (q.omega - q.xi)
    film = (q.x / q.x0, q.x0 / q.a, q.volume) if spread else (q.x / q.x0,)
    return {
        F_n: FILM * 6 * sp.pi * q.mu * q.a**2 * q.u / q.x0 * slot_call("film", "resistance", *film),
        F_w: VAN_DER_WAALS * slot_call("attraction", "force", q.x / q.x0),
        F_c: sp.pi * q.R * q.sigma * slot_call("bridge", "force", q.x / q.R, q.volume, q.contact_angle),
        F_t: SHEAR * sliding * slot_call("shear", "log_factor", q.x / q.x0, q.x0 / q.a),
        arm: q.a * slot_call("arm", "lever", q.r / q.a),
        S_n: lift * (swing_squared().diff(string_distance) / q.a**2).subs(string_distance, q.r),
        S_t: lift * (swing_squared().diff(q.beta) / string_distance / q.a**2).subs(string_distance, q.r),
    }


@cache
def scaled_strings(oblique: bool) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Dimensionless normal and tangential string force and squared swing over a^2; head-on beta = 0."""
    turn = q.beta if oblique else sp.Integer(0)
    apart = swing_squared().subs(string_distance - 4 * q.a, q.x)  # x and r = 4a + x kept separate: no cancellation
    by_distance = apart.diff(q.x) + apart.diff(string_distance)
    by_angle = sp.simplify(apart.diff(q.beta) / string_distance)

    def scaled(expression: sp.Expr) -> sp.Expr:
        lengths = {q.x: q.a * q.aspect * q.gap, string_distance: q.a * DISTANCE}
        return expression.subs(q.beta, turn).subs(lengths, simultaneous=True)

    stiffness = slot_call("strings", "stiffness", q.string_ratio, offset_squared)
    pull = nondimensional(4 * q.m * q.g / INERTIA) * stiffness / 2
    sideways = nondimensional(4 * q.m * q.g / TANGENTIAL) * stiffness / 2 if oblique else sp.Integer(0)
    return (
        sp.expand(2 * scaled(by_distance) / q.a) * (pull / 2),
        sp.expand(scaled(by_angle) / q.a) * sideways,
        sp.expand(scaled(apart) / q.a**2),
    )
