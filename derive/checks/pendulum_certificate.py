"""Checks of the pendulum certificate: each of its steps, on the emitted equations.

`equations/certificates/pendulum.py` combines the steps; `margins` checks that the emitted margins are these bounds in
the worst case.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from ..equations.certificates.pendulum import outward_at, pull_at, rigid_momentum
from ..equations.intermediates import BRIDGE_FORCE, CENTRIFUGAL_FORCE, FILM_FORCE
from ..equations.model import Model, derive
from ..equations.rates import rates
from ..physics.forces import SHEAR
from ..physics.laws import LAWS
from ..physics.laws.base import filled
from ..physics.laws.strings import offset_squared
from ..physics.scaling import DISTANCE
from ..physics.structure import Structure
from ..vocabulary import quantities as q
from . import impulse, margins
from .base import Check, Evidence, check, run, vanishing
from .signs import positive

_PENDULUM = Structure(oblique=True, bridge=False, strings=True)
_HALF = sp.Symbol("half_angle_sine", nonnegative=True)  # sin(beta/2), which grows with beta up to half a turn
_BEYOND = sp.Symbol("beyond", nonnegative=True)  # a quantity minus its least value


def _model() -> Model:
    return derive(_PENDULUM)


def _midgap(expression: sp.Expr) -> sp.Expr:
    return filled(expression, {"arm": LAWS["arm"]["midgap"]})


def momentum_falls() -> Check:
    """dL/dt = -r S_t, and S_t has the sign of sin(beta); only the strings exert a torque on the doublet."""
    result = _model().by_state("right_hand_side")
    total = _midgap(result[q.orbital_momentum] + sp.Rational(32, 5) * result[q.spin])
    lever = sp.sin(q.beta) * sp.Function("strings.stiffness", real=True)(q.string_ratio, _swing())
    share = sp.simplify(total / lever)
    ok = bool(positive(-share))
    return Check(
        "strings only take from L", "dL/dt = -r S_t <= 0 while 0 <= beta <= pi", ok, f"dL/dt ~ {share} sin(beta)"
    )


def _swing() -> sp.Expr:
    return dict(_model().definitions)[offset_squared].subs(DISTANCE, 4 + q.aspect * q.gap)


def orbital_momentum_is_bounded() -> Check:
    """J decreases where it exceeds its share of L in rigid rotation, and that share grows with the gap and with L."""
    model = _model()
    momentum = q.orbital_momentum + sp.Rational(32, 5) * q.spin
    share = rigid_momentum(momentum, DISTANCE)
    slip = model.expanded(q.orbital_momentum / DISTANCE**2 - q.spin).subs(DISTANCE, 4 + q.aspect * q.gap)
    inverse = (1 / DISTANCE**2 + sp.Rational(5, 32)).subs(DISTANCE, 4 + q.aspect * q.gap)
    identity = slip - (q.orbital_momentum - share.subs(DISTANCE, 4 + q.aspect * q.gap)) * inverse
    # dJ/dt contains only the shear, with the sign of the slip, and the strings
    log_factor = sp.Function("shear.log_factor", real=True)(q.gap, q.aspect)
    without = model.by_state("right_hand_side")[q.orbital_momentum].subs(log_factor, 0)
    shear = sp.simplify((model.by_state("right_hand_side")[q.orbital_momentum] - without) / (SHEAR * log_factor * slip))
    level = sp.Symbol("momentum", positive=True)
    slope = sp.together(rigid_momentum(level, DISTANCE).diff(DISTANCE))
    rest = vanishing("", "", [identity])
    ok = (
        rest.ok and bool(positive(-shear)) and bool(positive(slope)) and bool(positive(rigid_momentum(level, DISTANCE)))
    )
    return Check(
        "J stays below J_max",
        "dJ/dt <= 0 where J > L r^2/(r^2 + (32/5) a^2), a share that grows with r and with L",
        ok,
        f"omega - xi = (J - J_rigid) ({sp.simplify(1 / DISTANCE**2 + sp.Rational(5, 32))})"
        if ok
        else f"left over: {rest.figure}",
    )


def pull_grows() -> tuple[Check, ...]:
    """S_n grows with the gap and with the angle, for both string laws."""
    checks = []
    for name, law in LAWS["strings"].items():
        pull = filled(pull_at(q.gap, q.beta), {"strings": law}).subs(sp.sin(q.beta / 2), _HALF)
        # 2 * stiffness'/stiffness^3 > 0 and swing' > 0, numerator' > 0: written out in d(pull)
        stiffness = law["stiffness"].result
        hanging = sp.Symbol("hanging", positive=True)  # vertical extent squared, string_ratio^2 - offset_squared
        steeper = stiffness.diff(offset_squared).subs(offset_squared, q.string_ratio**2 - hanging)
        swing = (q.aspect * q.gap) ** 2 / 4 + (4 + q.aspect * q.gap) * 4 * _HALF**2
        across = sp.simplify(pull / stiffness.subs(offset_squared, swing))
        grows = [positive(across.diff(each)) and positive(swing.diff(each)) for each in (q.gap, _HALF)]
        ok = all(grows) and bool(positive(across)) and sp.simplify(steeper).is_nonnegative is True
        checks.append(
            Check(
                f"S_n grows, {name} strings",
                "dS_n/dr >= 0 and dS_n/dbeta >= 0 up to beta = pi",
                ok,
                f"S_n ~ ({sp.factor(across / q.weight)}) stiffness",
            )
        )
    return tuple(checks)


def centrifugal_falls() -> Check:
    """At a given J the centrifugal force decreases with the distance."""
    level = sp.Symbol("momentum", positive=True)
    slope = outward_at(level, DISTANCE).diff(DISTANCE)
    return Check("J^2/r^3 falls", "d(J^2/r^3)/dr < 0 at fixed J", bool(positive(-slope)), f"{sp.factor(slope)}")


@check("the film stops", "d(u St/v0)/dx = -resistance - St (inward)/u <= -resistance")
def film_stops() -> Evidence:
    """While opening against an inward force, u - stopping(gap)/St never grows."""
    law = LAWS["film"]["finite"]
    yield from (
        law["stopping"].result.diff(q.gap) + law["resistance"].result,
        law["stopping"].result.subs(q.gap, 1),
        rates(_PENDULUM)[q.normal_velocity].coeff(FILM_FORCE) + 1,
        rates(_PENDULUM)[q.normal_velocity].coeff(CENTRIFUGAL_FORCE) - 1,
        rates(_PENDULUM)[q.normal_velocity].diff(BRIDGE_FORCE),
        dict(_model().definitions)[FILM_FORCE].diff(q.normal_velocity) * q.stokes / sp.Symbol("film", nonnegative=True)
        - sp.Function("film.resistance", real=True)(q.gap),
    )


def criterion_reach() -> tuple[Check, ...]:
    """`reach` is the largest gap at which the glass criterion is met for a given speed, and grows with the speed."""
    checks = []
    speed = sp.Symbol("approach", positive=True)
    for name, law in LAWS["glass"].items():
        pressure, reach = law["pressure"], law["reach"]
        at = reach(speed, q.glass_number)
        left = sp.simplify(pressure(at, speed) - q.glass_number)
        falls = sp.simplify(-pressure(q.gap, speed).diff(q.gap))
        grows = sp.simplify(at.diff(speed))
        ok = left == 0 and falls.is_positive is True and grows.is_positive is True
        checks.append(
            Check(
                f"reach of the glass criterion, {name}",
                "pressure(reach(u), u) = p_gt; larger for a larger u",
                ok,
                str(at),
            )
        )
    return tuple(checks)


CHECKS = (
    momentum_falls, orbital_momentum_is_bounded, pull_grows, centrifugal_falls, film_stops, criterion_reach,
    *margins.CHECKS, *impulse.CHECKS,
)  # fmt: skip


@cache
def pendulum_certificate() -> tuple[Check, ...]:
    """Every step of the pendulum certificate."""
    return run(CHECKS)
