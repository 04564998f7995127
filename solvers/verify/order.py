"""Convergence: the error of e_n must decrease about in proportion to the requested tolerance."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import cache, partial
from itertools import pairwise

import numpy as np

from ...generated.automaton import LOOSEST
from ..collision.collide import collide
from ..collision.result import Collision
from ..errors import WetDoubletError
from ..settings import ENGINES
from .report import Finding
from .sample import REFERENCE, WHOLE, Collide, Sample, place

_TRUTH = 1e-13
SLOPES = (0.6, 1.4)  # bounds of d log error / d log rtol: p/(p + 1) to 1 for error per step, plus scatter
RISE = 10.0  # largest factor by which the error may grow from one decade of rtol to the next
SMALL = 0.05  # in units of rtol; if all errors are smaller, the slope is not tested
_FLOOR = 3e-13  # relative error of rounding and of the reference
_SMALLEST = 0.05  # smallest e_n of a tested trajectory


def convergence(
    group: str, sample: Sample, tolerances: Sequence[float] = WHOLE.tolerances, collide: Collide = collide
) -> Iterator[Finding]:
    """Findings on the slope of every engine, the worse of two trajectories of the sample.

    Arguments:
        tolerances: values of rtol, descending.
        collide: function that computes a collision at a tolerance.
    """
    chosen = _chosen(sample)
    if not chosen:
        yield Finding(
            group,
            "convergence",
            "error of e_n over rtol",
            sample.silent or f"no trajectory that separates with e_n > {_SMALLEST}",
            "",
            None,
        )
        return
    statement = (
        f"error of e_n against rtol {_TRUTH:.0e}, over rtol {tolerances[0]:.0e} to {tolerances[-1]:.0e}: its slope"
        f" is within {SLOPES[0]} to {SLOPES[1]}, and it rises by no more than {RISE:.0f} times on the way;"
        f" or all of it is below {SMALL} rtol"
    )
    both = [(one, cache(partial(_restitution, one, REFERENCE, _TRUTH, collide))) for one in chosen]
    collided = {engine for impact in sample.impacts for engine in impact}
    for engine in (engine for engine in ENGINES if engine in collided):
        own = [rtol for rtol in tolerances if engine != "taylor" or rtol <= LOOSEST]  # the kernel takes no looser one
        judged = [_judged(group, statement, one, engine, own, collide, truth) for one, truth in both]
        yield max(judged, key=lambda found: found[0])[1]


def _judged(
    group: str,
    statement: str,
    one: Collision,
    engine: str,
    tolerances: Sequence[float],
    collide: Collide,
    truth: Callable[[], float],
) -> tuple[float, Finding]:
    """The finding of one trajectory, and its severity."""
    name, at = f"convergence, {engine}", place(one.stokes, one.angle)
    try:
        errors = [abs(_restitution(one, engine, rtol, collide) / truth() - 1) for rtol in tolerances]
    except WetDoubletError as failure:
        return math.inf, Finding(group, name, statement, f"not completed: {failure}", "", False, at)
    slope, rise = fit(tolerances, errors)
    if math.isnan(slope) and all(error <= max(rtol, _FLOOR) for error, rtol in zip(errors, tolerances)):
        return 0.0, Finding(group, name, statement, "all errors at rounding", "", True, at)
    held = SLOPES[0] <= slope <= SLOPES[1] and rise <= RISE
    table = (
        f"  error {' '.join(f'{error:.0e}' for error in errors)} at rtol {tolerances[0]:.0e} ... {tolerances[-1]:.0e}"
    )
    if math.isfinite(rise) and rise > 1:
        table += f"; rises {rise:.1f}x, bound {RISE:.0f}x"
    figure, bound = f"slope {slope:.2f}", f"{SLOPES[0]}..{SLOPES[1]}"
    if not held and all(error <= max(SMALL * rtol, _FLOOR) for error, rtol in zip(errors, tolerances)):
        figure = f"every error below {SMALL} rtol (slope {slope:.2f})"
        return 0.0, Finding(group, name, statement, figure, "", True, at, (table,))
    finding = Finding(group, name, statement, figure, bound, held, at, (table,))
    return abs(slope - 1) if math.isfinite(slope) and held else math.inf, finding


def _restitution(one: Collision, engine: str, rtol: float, collide: Collide) -> float:
    return collide(
        scene=one.scene, stokes=one.stokes, angle=one.angle, ledger=False, rtol=rtol, engine=engine
    ).restitution


def fit(tolerances: Sequence[float], errors: Sequence[float]) -> tuple[float, float]:
    """Least-squares slope of log error over log rtol above rounding, and the largest rise between neighbours."""
    kept = [(math.log10(rtol), math.log10(error)) for rtol, error in zip(tolerances, errors) if error > _FLOOR]
    if not all(map(math.isfinite, errors)) or len(kept) < 3:
        return math.nan, math.inf  # too few points for a fit
    x, y = np.array(kept).T
    slope = float(np.polyfit(x, y, 1)[0])
    raised = [max(after, _FLOOR) / max(before, _FLOOR) for before, after in pairwise(errors)]
    return slope, max(raised)


def _chosen(sample: Sample) -> list[Collision]:
    """The least and the most oblique of the sample's separating trajectories."""
    asked = [one for one in sample.separated if one.restitution > _SMALLEST and (one.contact_time or 0) > 0]
    return [asked[0], asked[-1]] if len(asked) > 1 else asked
