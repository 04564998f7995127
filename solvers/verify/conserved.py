"""Conservation checks of every trajectory (energy ledger, angular momentum) and agreement of the engines."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ..collision.collide import collide
from ..collision.result import Collision
from ..errors import WetDoubletError
from ..settings import ENGINES
from .report import Finding, bounded
from .sample import REFERENCE, RTOL, Sample, where

# In units of the sample's rtol. A linear invariant is conserved by every step up to rounding and Newton's residual;
# the ledger is a sum of quadratures with the integrator's error; between engines both errors add.
DRIFT, RESIDUAL, AGREEMENT = 10 * RTOL, 100 * RTOL, 1000 * RTOL
_NUDGE, _WORST_CONDITION = 1e-5, 1e4


def conserved(group: str, sample: Sample) -> Iterator[Finding]:
    """Findings on completed trajectories, ledger, drift and agreement of the engines, each with its worst case."""
    statement = "every collision of the sample is completed"
    figure = f"{len(sample.all)} of {len(sample.failures) + len(sample.all)} collisions"
    told = tuple(f"  {text}" for text in sample.failures[:5])
    yield Finding(group, "completed", statement, figure, "", not sample.failures, about=told)
    if not sample.all:
        return
    worst = max(sample.all, key=_residual)
    yield bounded(
        group, "energy ledger", "T(0) = T(end) + losses + works: residual over T(0)",
        _residual(worst), RESIDUAL, where(worst),
    )  # fmt: skip
    drifting = [one for one in sample.all if one.angular_momentum_drift is not None]
    statement = "L is conserved: |L/L(0) - 1| where the spin is integrated, not eliminated"
    if sample.scene.pendulum is not None and any(one.angle for one in sample.all):
        why = "the strings exert a torque: L is not conserved"
        yield Finding(group, "angular momentum", statement, why, "", None)
    elif drifting and sample.scene.model.arm != "surface":
        worst = max(drifting, key=_drift)
        yield bounded(group, "angular momentum", statement, _drift(worst), DRIFT, where(worst))
    yield from _agreement(group, sample)


def _agreement(group: str, sample: Sample) -> Iterator[Finding]:
    """Comparison of the engines in outcome and e_n: with the one that locates events, and the kernel with CVODES."""
    for engine, reference in (*((each, REFERENCE) for each in ENGINES if each != REFERENCE), ("taylor", "cvodes")):
        pairs = [
            (impact[engine], impact[reference])
            for impact in sample.impacts
            if engine in impact and reference in impact and impact[engine].engine == engine
        ]
        if pairs:
            yield agreement(group, f"{engine} = {reference}", pairs)


def agreement(group: str, name: str, pairs: Sequence[tuple[Collision, Collision]]) -> Finding:
    """Finding on collisions by one engine, each beside the same by another: the worst in outcome and e_n."""
    judged = [(_apart(one, other), _allowed(one, other), one) for one, other in pairs]
    figure, bound, one = max(judged, key=lambda found: found[0] / found[1])
    statement = f"same outcome, and e_n apart by no more than {AGREEMENT:.0e} times its condition d ln e_n/d ln St"
    return bounded(group, name, statement, figure, bound, where(one))


def _residual(one: Collision) -> float:
    """Residual over the initial energy; inf for NaN."""
    if one.energy is None:
        return math.inf
    figure = abs(one.energy.residual) / one.energy.initial
    return figure if math.isfinite(figure) else math.inf


def _drift(one: Collision) -> float:
    assert one.angular_momentum_drift is not None
    return one.angular_momentum_drift if math.isfinite(one.angular_momentum_drift) else math.inf


def _apart(one: Collision, other: Collision) -> float:
    if one.outcome != other.outcome:
        return math.inf
    return abs(one.restitution - other.restitution) / (abs(other.restitution) or 1.0)


def _allowed(one: Collision, other: Collision) -> float:
    """The bound AGREEMENT; where exceeded, multiplied by the conditioning of e_n, which diverges towards a boundary."""
    if not AGREEMENT < _apart(one, other) < math.inf:
        return AGREEMENT
    try:
        near = [
            collide(
                other.scene, stokes=other.stokes * (1 + side * _NUDGE), angle=other.angle, rtol=RTOL, engine=REFERENCE
            ).restitution
            for side in (-1, 1)
        ]
    except WetDoubletError:
        return AGREEMENT
    condition = abs(near[1] - near[0]) / (2 * _NUDGE * other.restitution)
    return AGREEMENT * min(max(condition, 1.0), _WORST_CONDITION)
