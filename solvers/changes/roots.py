"""Roots in ln St of functions with a sign everywhere and a value where they are smooth."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from ..errors import ComputationError

LOCATED = 1e-9  # relative width or error estimate at which a root counts as located
_TRIES = 60
# Bound of the secant's error over the product of its last two steps, f''/(2 f'); amplitudes are strongly curved.
_CURVED = 1e4
_WIDE = 3e-3  # a wider bracket is halved where the secant converges slowly


@dataclass(frozen=True)
class Sample:
    """A function at ln St = `at`: its sign, and its value where it is smooth."""

    at: float
    positive: bool
    value: float | None


Function = Callable[[float], tuple[bool, float | None]]
"""Stokes number -> (positive, value or None)."""


def sample(function: Function, stokes: float) -> Sample:
    """Sample the function at a Stokes number."""
    return Sample(math.log(stokes), *function(stokes))


def root(function: Function, negative: Sample, positive: Sample) -> float:
    """Stokes number of the root between a negative and a positive sample (the negative one lower).

    Secant steps through the two latest values; bisection where a value is missing, a step leaves the bracket, or the
    bracket is wide and the secant slow. It ends without a last evaluation once the secant's own error, about the
    product of the last two steps, is below LOCATED; where the function jumps, once the bracket is.

    Raises:
        ComputationError: not located within a fixed number of evaluations.
    """
    a, b = negative, positive
    recent = [a, b] if _smaller(b, a) else [b, a]
    older: Sample | None = None
    widths = [b.at - a.at]
    for _ in range(_TRIES):
        width = b.at - a.at
        if width < LOCATED:
            return math.exp(0.5 * (a.at + b.at))
        trial = _secant(*recent)
        if trial is None or not a.at < trial < b.at:
            trial = 0.5 * (a.at + b.at)
        else:
            step, before = abs(trial - recent[1].at), abs(recent[1].at - recent[0].at)
            if step < 1e-5 and _CURVED * step * before < LOCATED and _straight(older, *recent):
                return math.exp(trial)
            if width > _WIDE and len(widths) > 3 and width > 0.3 * widths[-4]:
                trial = 0.5 * (a.at + b.at)
        latest = sample(function, math.exp(trial))
        a, b = (a, latest) if latest.positive else (latest, b)
        widths.append(b.at - a.at)
        if latest.value is not None and recent[1].value is not None:
            older, recent = recent[0], [recent[1], latest]
        else:
            older, recent = None, [a, b]
    raise ComputationError(
        f"a change of outcome between St {math.exp(a.at):.10g} and {math.exp(b.at):.10g} could not be located",
        advice="try another --rtol",
    )


def _straight(older: Sample | None, first: Sample, second: Sample) -> bool:
    """True if three samples have one slope; False at a jump, where the secant's steps estimate no error."""
    if older is None or older.value is None or first.value is None or second.value is None:
        return True  # too few samples to contradict it
    one = (first.value - older.value) * (second.at - first.at)
    other = (second.value - first.value) * (first.at - older.at)
    return one * other > 0 and 0.2 < one / other < 5


def _smaller(one: Sample, other: Sample) -> bool:
    return one.value is not None and other.value is not None and abs(one.value) < abs(other.value)


def _secant(first: Sample, second: Sample) -> float | None:
    if first.value is None or second.value is None or first.value == second.value:
        return None
    return second.at - second.value * (second.at - first.at) / (second.value - first.value)
