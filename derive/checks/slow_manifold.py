"""Checks of the slow manifold: the form of the rates, the difference of two solutions, and what falls with the gap."""

import sympy as sp

from ..equations.certificates.slow_manifold import admits, coefficients
from ..equations.intermediates import MOMENTUM
from ..equations.model import Model, derive
from ..physics.forces import FILM, SHEAR
from ..physics.law import slot_call
from ..physics.scaling import DISTANCE
from ..physics.structure import structures
from ..vocabulary.quantities import aspect, gap, normal_velocity, orbital_momentum
from .base import Check, Evidence, check, checks

_OPEN = sp.Symbol("beyond_touching", nonnegative=True)  # centre distance over a, above 4


def _models() -> list[tuple[Model, dict[str, sp.Expr]]]:
    models = [derive(structure) for structure in structures() if admits(structure)]
    return [(model, result) for model in models if (result := coefficients(model)) is not None]


@check("slow manifold: rates", "du/dt = c J^2 - A - f u, dJ/dt = -s (J - J_r)")
def rates_have_the_form() -> Evidence:
    """du/dt = c J^2 - A - f u and dJ/dt = -s (J - J_r), with the coefficients that are emitted."""
    for model, result in _models():
        rates = model.by_state("right_hand_side")
        push = result["centrifugal"] * orbital_momentum**2 - result["attractions"] - result["slowing"] * normal_velocity
        turn = -result["relaxation"] * (orbital_momentum - result["rigid"])
        for state, rate in ((normal_velocity, push), (orbital_momentum, turn)):
            yield rates[state].subs({FILM: 1, SHEAR: 1}) - model.expanded(rate)
    yield bool(_models()), "no structure admits it"


@check("slow manifold: difference", "two solutions over the gap differ by the Jacobian at secants")
def secants() -> Evidence:
    """The difference of two solutions over the gap obeys the equations from which the contraction is bounded."""
    c, attractions, f, s, rigid = sp.symbols("c A f s J_r", real=True)
    u1, u2 = sp.symbols("u1 u2", positive=True)
    j1, j2 = sp.symbols("J1 J2", real=True)

    def slopes(u: sp.Expr, j: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        return (c * j**2 - attractions) / u - f, -s * (j - rigid) / u

    (rise1, turn1), (rise2, turn2) = slopes(u1, j1), slopes(u2, j2)
    force, e, j = c * j2**2 - attractions, u1 - u2, j1 - j2
    normal = -force * e / (u1 * u2) + c * (j1 + j2) * j / u1
    tangential = s * (j2 - rigid) * e / (u1 * u2) - s * j / u1
    yield from (rise1 - rise2 - normal, turn1 - turn2 - tangential)


@checks
def coefficients_are_monotonic() -> Check:
    """C falls; s over the logarithm rises, but slower than the distance; |J_r|, a share of |L|, ever more slowly."""
    signs = []
    for model, result in _models():
        lever = sp.cancel(result["relaxation"] / slot_call("shear", "log_factor", gap, aspect))
        share = sp.cancel(result["rigid"] / MOMENTUM)
        signs.append(not share.has(MOMENTUM))
        rising = (-result["centrifugal"], lever, -lever / DISTANCE, share, -share.diff(DISTANCE))
        for slope in (expression.diff(DISTANCE) for expression in rising):
            over, under = sp.fraction(sp.factor(sp.together(model.expanded(slope).subs(DISTANCE, 4 + _OPEN))))
            signs.append(sp.expand(over).is_nonnegative is True and sp.expand(under).is_positive is True)
    return Check(
        "slow manifold: monotonic",
        "c, s/(r ln) and d|J_r|/dx fall with the gap, s/ln and |J_r| rise, for L of any sign",
        bool(signs) and all(signs),
        f"{sum(signs)} of {len(signs)} signs",
    )
