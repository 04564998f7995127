"""The forces of the model in SI, with every law as a call to its slot, and the dimensionless string forces.

Laws remain calls (`bridge.force(...)`), and film and shear are flags (1 where the force acts, 0 beyond its edge), so
one set of forces serves every variant. The string forces are scaled in a form without cancellation.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from ..vocabulary.quantities import (
    R,
    a,
    aspect,
    beta,
    contact_angle,
    g,
    gap,
    l_s,
    m,
    mu,
    omega,
    r,
    rate_scale,
    sigma,
    string_ratio,
    u,
    v0,
    volume,
    x,
    x0,
    xi,
)
from .laws import slot_call
from .laws.strings import offset_squared, swing_squared
from .laws.strings import r as string_distance
from .mechanics import F_c, F_n, F_t, F_w, S_n, S_t, arm
from .scaling import DISTANCE, INERTIA, VAN_DER_WAALS, nondimensional

# Flags for where film and shear act, named as in emitted code
FILM, SHEAR = sp.symbols("film shear", nonnegative=True)

TANGENTIAL = m * a * rate_scale * v0 / x0  # scale of the tangential force


@cache
def force_laws(spread: bool = False) -> dict[sp.Symbol, sp.Expr]:
    """The forces of the model in SI, with slot calls in place of the selectable laws.

    Arguments:
        spread: the film law depends on the bridge volume.
    """
    offset = (swing_squared() / a**2).subs(string_distance, r)
    stiffness = slot_call("strings", "stiffness", l_s / a, offset)
    # S = dU/dr with U = 4 m g a rise(l/a, (d/a)^2) and stiffness = 2 d rise/d (d/a)^2
    lift = 4 * m * g * a * stiffness / 2
    film = (x / x0, x0 / a, volume) if spread else (x / x0,)
    return {
        F_n: FILM * 6 * sp.pi * mu * a**2 * u / x0 * slot_call("film", "resistance", *film),
        F_w: VAN_DER_WAALS * slot_call("attraction", "force", x / x0),
        F_c: sp.pi * R * sigma * slot_call("bridge", "force", x / R, volume, contact_angle),
        F_t: SHEAR * 8 * sp.pi * mu * a**2 * (omega - xi) * slot_call("shear", "log_factor", x / x0, x0 / a),
        arm: a * slot_call("arm", "lever", r / a),
        S_n: lift * (swing_squared().diff(string_distance) / a**2).subs(string_distance, r),
        S_t: lift * (swing_squared().diff(beta) / string_distance / a**2).subs(string_distance, r),
    }


@cache
def scaled_strings(oblique: bool) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Dimensionless normal and tangential string force and squared swing over a^2; head-on beta = 0."""
    turn = beta if oblique else sp.Integer(0)
    apart = swing_squared().subs(string_distance - 4 * a, x)  # x and r = 4a + x kept separate: no cancellation
    by_distance = apart.diff(x) + apart.diff(string_distance)
    by_angle = sp.simplify(apart.diff(beta) / string_distance)

    def scaled(expression: sp.Expr) -> sp.Expr:
        return expression.subs(beta, turn).subs({x: a * aspect * gap, string_distance: a * DISTANCE}, simultaneous=True)

    stiffness = slot_call("strings", "stiffness", string_ratio, offset_squared)
    pull = nondimensional(4 * m * g / INERTIA) * stiffness / 2
    sideways = nondimensional(4 * m * g / TANGENTIAL) * stiffness / 2 if oblique else sp.Integer(0)
    return (
        sp.expand(2 * scaled(by_distance) / a) * (pull / 2),
        sp.expand(scaled(by_angle) / a) * sideways,
        sp.expand(scaled(apart) / a**2),
    )
