"""Convergence: the error of e_n must decrease about in proportion to the requested tolerance."""

import math
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import pairwise

import numpy as np

from ...generated.automaton import LOOSEST
from ..collision.collide import collide
from ..engines.settings import ENGINES
from ..errors import WetDoubletError
from .report import Finding, note
from .sample import REFERENCE, WHOLE, Collide, Sample, place

_TRUTH = 1e-13
SLOPES = (0.6, 1.4)  # bounds of d log error / d log rtol: p/(p + 1) to 1 for error per step, plus scatter
RISE = 10.0  # largest factor by which the error may grow from one decade of rtol to the next
SMALL = 0.05  # in units of rtol; if all errors are smaller, the slope is not tested
_FLOOR = 3e-13  # relative error of rounding and of the reference
_SMALLEST = 0.05  # smallest e_n of a tested trajectory
_Judged = tuple[float, bool, str, str, tuple[str, ...]]


def convergence(
    sample: Sample, tolerances: Sequence[float] = WHOLE.tolerances, collide: Collide = collide
) -> Iterator[Finding]:
    """Findings on the slope of every engine: the worse of the least and the most oblique trajectory that separates.

    Arguments:
        tolerances: values of rtol, descending.
        collide: function that computes a collision at a tolerance.
    """
    separating = [case for case in sample.separated if case.restitution > _SMALLEST and (case.contact_time or 0) > 0]
    if not separating:
        figure = sample.silent or f"no trajectory that separates with e_n > {_SMALLEST}"
        yield note("convergence", "error of e_n over rtol", figure)
        return

    @cache
    def restitution(k: int, engine: str, rtol: float) -> float:
        scene, stokes, angle = separating[k].scene, separating[k].stokes, separating[k].angle
        return collide(scene=scene, stokes=stokes, angle=angle, ledger=False, rtol=rtol, engine=engine).restitution

    collided = {engine for impact in sample.impacts for engine in impact}
    for engine in (engine for engine in ENGINES if engine in collided):
        accepted = [rtol for rtol in tolerances if engine != "taylor" or rtol <= LOOSEST]  # the kernel takes no looser
        findings: list[tuple[float, Finding]] = []
        for k in dict.fromkeys((0, len(separating) - 1)):
            try:
                truth = restitution(k, REFERENCE, _TRUTH)
                errors = [abs(restitution(k, engine, rtol) / truth - 1) for rtol in accepted]
            except WetDoubletError as failure:
                judged: _Judged = math.inf, False, f"not completed: {failure}", "", ()
            else:
                judged = _judged(accepted, errors)
            severity, ok, figure, bound, about = judged
            statement = (
                f"error of e_n against rtol {_TRUTH:.0e}, over rtol {tolerances[0]:.0e} to {tolerances[-1]:.0e}: its "
                f"slope is within {SLOPES[0]} to {SLOPES[1]}, and it rises by no more than {RISE:.0f} times on the way;"
                f" or all of it is below {SMALL} rtol"
            )
            at = place(separating[k].stokes, separating[k].angle)
            findings.append((severity, Finding("", f"convergence, {engine}", statement, figure, bound, ok, at, about)))
        yield max(findings, key=lambda entry: entry[0])[1]


def _judged(tolerances: Sequence[float], errors: Sequence[float]) -> _Judged:
    """Severity, success, figure, bound and table of the errors of one trajectory."""

    def below(share: float) -> bool:
        return all(error <= max(share * rtol, _FLOOR) for error, rtol in zip(errors, tolerances))

    slope, rise = fit(tolerances, errors)
    if math.isnan(slope) and below(1.0):
        return 0.0, True, "all errors at rounding", "", ()
    held = SLOPES[0] <= slope <= SLOPES[1] and rise <= RISE
    listed = " ".join(f"{error:.0e}" for error in errors)
    table = f"  error {listed} at rtol {tolerances[0]:.0e} ... {tolerances[-1]:.0e}"
    if math.isfinite(rise) and rise > 1:
        table += f"; rises {rise:.1f}x, bound {RISE:.0f}x"
    if not held and below(SMALL):
        return 0.0, True, f"every error below {SMALL} rtol (slope {slope:.2f})", "", (table,)
    severity = abs(slope - 1) if math.isfinite(slope) and held else math.inf
    return severity, held, f"slope {slope:.2f}", f"{SLOPES[0]}..{SLOPES[1]}", (table,)


def fit(tolerances: Sequence[float], errors: Sequence[float]) -> tuple[float, float]:
    """Least-squares slope of log error over log rtol above rounding, and the largest rise between neighbours."""
    points = [(math.log10(rtol), math.log10(error)) for rtol, error in zip(tolerances, errors) if error > _FLOOR]
    if not all(map(math.isfinite, errors)) or len(points) < 3:
        return math.nan, math.inf  # too few points for a fit
    x, y = np.array(points).T
    return float(np.polyfit(x, y, 1)[0]), max(
        max(after, _FLOOR) / max(before, _FLOOR) for before, after in pairwise(errors)
    )
