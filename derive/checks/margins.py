"""Emitted margins of the pendulum certificate: they equal the proved bounds at their worst-case arguments."""

from __future__ import annotations

import sympy as sp

from ..equations.certificates.pendulum import outward_at, pull_at, rigid_momentum
from ..equations.events import contact_gap
from ..equations.intermediates import CENTRIFUGAL_FORCE, STRING_PULL
from ..equations.model import derive
from ..equations.rates import rates
from ..physics.laws import LAWS, slot_call
from ..physics.structure import Structure
from ..vocabulary import quantities as q
from .base import Check, Evidence, check, readable

_PENDULUM = Structure(oblique=True, bridge=False, strings=True)


def _bounds() -> dict[str, tuple[sp.Expr, str]]:
    """Each margin with its lemma at the gap, angle and speed of the worst case, and a description."""
    contact, touch = contact_gap, sp.Integer(1)
    largest = sp.Max(
        q.orbital_momentum, rigid_momentum(q.orbital_momentum + sp.Rational(32, 5) * q.spin, 4 + q.aspect * touch)
    )
    fastest = sp.sqrt(sp.Min(q.normal_velocity, 0) ** 2 + 2 * pull_at(touch, sp.pi))
    reach = sp.Max(contact, slot_call("glass", "reach", fastest, q.glass_number))
    closing = sp.Symbol("closing", real=True)
    stopped = q.stokes * q.e_dry * closing - slot_call("film", "stopping", q.gap)
    return {
        "outward": (outward_at(largest, 4 + q.aspect * contact), "J_max^2/r^3, J_max of r_f, r in contact"),
        "pull": (pull_at(contact, q.beta), "S_n in contact at the present beta"),
        "film": (q.stokes * q.normal_velocity - slot_call("film", "stopping", q.gap), "u St/v0 - Lf(x)"),
        "recoil": (
            q.stokes * q.e_dry * fastest - slot_call("film", "stopping", reach),
            "e_dry u_max St/v0 - Lf(x_R), u_max^2 = min(u, 0)^2 + 2 S_n(x0, pi) x0/m, x_R = max(contact, reach(u_max))",
        ),
        "rebound": (stopped.subs(closing, -q.normal_velocity), "e_dry |u| St/v0 - Lf(x)"),
        "beneath": (
            stopped.subs(closing, -q.normal_velocity + sp.sqrt(2 * pull_at(touch, sp.pi) * q.gap)),
            "the same with |u| + sqrt(2 S_n(x0, pi) x/m), the most that closing from x adds",
        ),
    }


def margins_are_the_lemmas() -> tuple[Check, ...]:
    """The emitted margins are the lemmas' bounds: at contact, at initial contact and half a turn, and at present.

    `impulse` has its own checks (`checks.impulse`).
    """
    model = derive(_PENDULUM)
    emitted = {name: model.expanded(value) for name, value in model["pendulum_margins"].outputs if name != "impulse"}
    checks = []
    for name, (bound, words) in _bounds().items():
        rest = sp.expand(emitted[name] - model.expanded(bound))  # same Max and calls: simplification not needed
        checks.append(
            Check(
                f"margin of the stick proof: {name}",
                f"{name} = {words}",
                rest == 0,
                "identity" if rest == 0 else f"emitted is {readable(emitted[name])}",
            )
        )
    return tuple(checks)


@check("closing gains the pull", "d(u^2/2)/dx = -S_n/m + what slows: u_max^2 - u^2 <= 2 S x0/m")
def closing_gains_the_pull() -> Evidence:
    """u_max: while closing, only the strings increase the speed, by their pull over a gap of at most x0."""
    model = derive(_PENDULUM)
    yield from (
        rates(_PENDULUM)[q.normal_velocity].coeff(STRING_PULL) + 1,  # du/dt = u du/dx, over v0^2/x0
        model.expanded(STRING_PULL) - pull_at(q.gap, q.beta),  # the bound of the lemmas is the emitted one
        model.expanded(CENTRIFUGAL_FORCE) - outward_at(q.orbital_momentum, 4 + q.aspect * q.gap),
    )


def stopping_falls() -> Check:
    """Lf decreases with the gap, so a velocity stopped by the film from x_R is stopped from any smaller gap."""
    slope = sp.factor(LAWS["film"]["finite"]["stopping"].result.diff(q.gap))
    falls = sp.factor(-slope).is_nonnegative is True
    return Check("stopping falls", "dLf/dx <= 0: the furthest rebound is the worst", falls, f"dLf/dx = {slope}")


CHECKS = (margins_are_the_lemmas, closing_gains_the_pull, stopping_falls)
