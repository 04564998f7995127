"""Roots, in ln St, of functions whose sign is known everywhere and whose value only in places."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from ..errors import ComputationError

LOCATED = 1e-9  # relative width or error estimate at which a root counts as located
_TRIES = 60
# 1/ln St; bound of f''/(2 f'), the secant's error over the product of its last two steps. Amplitudes curve strongly.
_MOST_CURVATURE = 1e4
_WIDE_BRACKET = 3e-3  # ln St; a wider bracket is halved where the secant converges slowly


@dataclass(frozen=True)
class Evaluation:
    """One evaluation: whether the function is positive, and its value, None where unknown or not smooth."""

    log_stokes: float
    positive: bool
    value: float | None


Function = Callable[[float], tuple[bool, float | None]]
"""Stokes number -> (whether positive, value or None), as in `Evaluation`."""


def evaluate(function: Function, stokes: float) -> Evaluation:
    """Evaluate the function at a Stokes number."""
    return Evaluation(math.log(stokes), *function(stokes))


def root(function: Function, negative: Evaluation, positive: Evaluation) -> float:
    """Stokes number of the root between a negative and a positive evaluation, of which the negative one lies lower.

    Secant steps through the two latest values; bisection where a value is missing, a step leaves the bracket, or the
    bracket is wide and the secant slow. It ends without a last evaluation once the secant's own error is below LOCATED;
    where the function jumps, once the width of the bracket is.

    Raises:
        ComputationError: not located within a fixed number of evaluations.
    """
    a, b = negative, positive
    recent = [a, b] if _smaller(b, a) else [b, a]
    older: Evaluation | None = None
    widths = [b.log_stokes - a.log_stokes]
    for _ in range(_TRIES):
        width = b.log_stokes - a.log_stokes
        if width < LOCATED:
            return math.exp(0.5 * (a.log_stokes + b.log_stokes))
        trial = _secant(*recent)
        if trial is None or not a.log_stokes < trial < b.log_stokes:
            trial = 0.5 * (a.log_stokes + b.log_stokes)
        else:
            step, before = abs(trial - recent[1].log_stokes), abs(recent[1].log_stokes - recent[0].log_stokes)
            if step < 1e-5 and _MOST_CURVATURE * step * before < LOCATED and _straight(older, *recent):
                return math.exp(trial)
            if width > _WIDE_BRACKET and len(widths) > 3 and width > 0.3 * widths[-4]:
                trial = 0.5 * (a.log_stokes + b.log_stokes)
        latest = evaluate(function, math.exp(trial))
        a, b = (a, latest) if latest.positive else (latest, b)
        widths.append(b.log_stokes - a.log_stokes)
        if latest.value is not None and recent[1].value is not None:
            older, recent = recent[0], [recent[1], latest]
        else:
            older, recent = None, [a, b]
    low, high = math.exp(a.log_stokes), math.exp(b.log_stokes)
    raise ComputationError(
        f"a change of outcome between St {low:.10g} and {high:.10g} could not be located", advice="try another --rtol"
    )


def _straight(older: Evaluation | None, first: Evaluation, second: Evaluation) -> bool:
    """False if three evaluations show a jump, where the secant's steps do not estimate its error."""
    if older is None or older.value is None or first.value is None or second.value is None:
        return True  # too few values to show a jump
    one = (first.value - older.value) * (second.log_stokes - first.log_stokes)
    other = (second.value - first.value) * (first.log_stokes - older.log_stokes)
    return one * other > 0 and 0.2 < one / other < 5


def _smaller(one: Evaluation, other: Evaluation) -> bool:
    return one.value is not None and other.value is not None and abs(one.value) < abs(other.value)


def _secant(first: Evaluation, second: Evaluation) -> float | None:
    if first.value is None or second.value is None or first.value == second.value:
        return None
    return second.log_stokes - second.value * (second.log_stokes - first.log_stokes) / (second.value - first.value)
