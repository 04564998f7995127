"""Conservation of energy and angular momentum along every trajectory, and agreement of the engines."""

import math
from collections.abc import Callable, Iterator, Sequence

from ..collision.collide import collide
from ..collision.result import Collision
from ..engines.settings import ENGINES
from ..errors import WetDoubletError
from .report import Finding, bounded, note
from .sample import REFERENCE, RTOL, Sample, where

# In units of the sample's rtol. A linear invariant is conserved by every step up to rounding and Newton's residual;
# the ledger is a sum of quadratures with the integrator's error; between engines both errors add.
DRIFT, RESIDUAL, AGREEMENT = 10 * RTOL, 100 * RTOL, 1000 * RTOL
_NUDGE, _WORST_CONDITION = 1e-5, 1e4


def conserved(sample: Sample) -> Iterator[Finding]:
    """Findings on completed trajectories, ledger, drift and agreement of the engines, each with its worst case."""
    completed = f"{len(sample.all)} of {len(sample.failures) + len(sample.all)} collisions"
    failures = tuple(f"  {text}" for text in sample.failures[:5])
    statement = "every collision of the sample is completed"
    yield Finding("", "completed", statement, completed, "", not sample.failures, about=failures)
    if not sample.all:
        return
    figure, worst = worst_of(
        sample.all, lambda case: abs(case.energy.residual) / case.energy.initial if case.energy else None
    )
    statement = "T(0) = T(end) + losses + works: residual over T(0)"
    yield bounded("energy ledger", statement, figure, RESIDUAL, where(worst))
    statement = "L is conserved: |L/L(0) - 1| where the spin is integrated, not eliminated"
    drifting = [collision for collision in sample.all if collision.angular_momentum_drift is not None]
    if sample.scene.pendulum is not None and any(collision.angle for collision in sample.all):
        yield note("angular momentum", statement, "the strings exert a torque: L is not conserved")
    elif drifting:
        figure, worst = worst_of(drifting, lambda case: case.angular_momentum_drift)
        if sample.scene.law_has("arm", "balanced"):
            yield bounded("angular momentum", statement, figure, DRIFT, where(worst))
        else:
            yield note("angular momentum", statement, f"drift {figure:.1e}: the arm of the model file", where(worst))
    for engine, reference in (*((name, REFERENCE) for name in ENGINES if name != REFERENCE), ("taylor", "cvodes")):
        pairs = [
            (impact[engine], impact[reference])
            for impact in sample.impacts
            if engine in impact and reference in impact and impact[engine].engine == engine
        ]
        if pairs:
            yield agreement(f"{engine} = {reference}", pairs)


def worst_of(collisions: Sequence[Collision], figure: Callable[[Collision], float | None]) -> tuple[float, Collision]:
    """The largest figure, infinite where it is missing or not finite, and its collision."""
    figures = [value if (value := figure(run)) is not None and math.isfinite(value) else math.inf for run in collisions]
    largest = max(figures)
    return largest, collisions[figures.index(largest)]


def agreement(name: str, pairs: Sequence[tuple[Collision, Collision]]) -> Finding:
    """Finding on collisions by one engine, each beside the same by another: the worst in outcome and e_n."""
    judged = [(_apart(first, other), _allowed(first, other), first) for first, other in pairs]
    figure, bound, worst = max(judged, key=lambda entry: entry[0] / entry[1])
    statement = f"same outcome, and e_n apart by no more than {AGREEMENT:.0e} times its condition d ln e_n/d ln St"
    return bounded(name, statement, figure, bound, where(worst))


def _apart(collision: Collision, other: Collision) -> float:
    if collision.outcome != other.outcome:
        return math.inf
    return abs(collision.restitution - other.restitution) / (abs(other.restitution) or 1.0)


def _allowed(collision: Collision, other: Collision) -> float:
    """The bound AGREEMENT; where exceeded, multiplied by the conditioning of e_n, which diverges towards a boundary."""
    if not AGREEMENT < _apart(collision, other) < math.inf:
        return AGREEMENT
    nudged = [other.stokes * (1 + side * _NUDGE) for side in (-1, 1)]
    try:
        below, above = (
            collide(other.scene, stokes=stokes, angle=other.angle, rtol=RTOL, engine=REFERENCE).restitution
            for stokes in nudged
        )
    except WetDoubletError:
        return AGREEMENT
    condition = abs(above - below) / (2 * _NUDGE * other.restitution)
    return AGREEMENT * min(max(condition, 1.0), _WORST_CONDITION)
