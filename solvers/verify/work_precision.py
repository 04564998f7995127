"""Run time against achieved error of each engine for one scene on this machine, and recommended settings."""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import takewhile
from typing import TypeVar

import numpy as np

from ..collision.collide import collide
from ..collision.result import Collision
from ..engines.settings import CASADI_ENGINES, ENGINES
from ..errors import ComputationError
from ..host.environment import one_core
from ..host.progress import Progress
from ..many.collide_many import collide_many
from ..results import FAILED
from ..scene.scene import Scene

TOLERANCES = tuple(10.0**-k for k in range(4, 13))
BATCH, SINGLE = 100, 8  # collisions in a call, and number of those also computed one by one
STOKES, ANGLES = (0.01, 10.0), (math.radians(5), math.radians(85))  # ranges if the scene has no impact
_AROUND, _TURNED, _STEEPEST = 2.0, math.radians(5), math.radians(89)  # about an impact: factor in St, change of angle
_TIGHTEST = (1e-13, 1e-12, 1e-11)  # tolerances of a reference; the first that the engine completes is used
_PASSES, _LONG = 10, 0.05  # most passes, and s after which no further one starts; the cheapest counts
_DEAR = 1.0  # s; after a slower batch, an engine gets no batches at smaller tolerances
_GOLDEN = 0.6180339887498949

Result = TypeVar("Result")


@dataclass(frozen=True)
class Impact:
    """Stokes number and angle (rad)."""

    stokes: float
    angle: float


@dataclass(frozen=True)
class Row:
    """One engine at one tolerance.

    Arguments:
        error: largest absolute error of e_n; None where no collision separates.
        time_error: largest relative error of the contact time; None likewise.
        single: mean CPU time (s) of a collision computed alone.
        batch: CPU time (s) of a collision of a batch, which CasADi's engines compute one collision after another, as if
            alone; None where that was too expensive to measure.
        wrong, failed: collisions with another outcome than the reference, and without any.
        handed_over: number of collisions completed by another engine.
    """

    engine: str
    rtol: float
    error: float | None
    time_error: float | None
    single: float
    batch: float | None
    wrong: int
    failed: int
    handed_over: int

    def keeps(self, error: float) -> bool:
        """True if all outcomes are right and no error of e_n exceeds `error`."""
        return not self.wrong and not self.failed and (self.error or 0.0) <= error


@dataclass(frozen=True)
class Recommendation:
    """The cheapest setting for a use; engine and rtol are None, with a reason, if there is none."""

    use: str
    engine: str | None
    rtol: float | None
    reason: str


@dataclass(frozen=True)
class WorkPrecision:
    """Cost and error of the engines on a sample of a scene's collisions.

    Arguments:
        sample: description of the sample.
        batch: number of collisions in a call.
        impacts: impacts on which errors are measured.
        separate: number of these that separate.
        left_out: impacts so near a boundary that the references disagree on the outcome.
        references: engine and tolerance of each reference; an engine is compared with the first other one.
        uncertainty: largest difference in e_n between the references; smaller errors cannot be distinguished from
            theirs.
        time_uncertainty: the same for the contact time, relative.
    """

    scene: Scene
    sample: str
    batch: int
    impacts: tuple[Impact, ...]
    separate: int
    left_out: int
    references: tuple[tuple[str, float], ...]
    uncertainty: float
    time_uncertainty: float
    rows: tuple[Row, ...]

    def recommend(self, error: float) -> tuple[Recommendation, Recommendation]:
        """Return the settings for an absolute error of e_n: for one collision, and for a batch."""
        return (
            self._cheapest("one collision", error, lambda row: row.single),
            self._cheapest(f"a batch of {self.batch}", error, lambda row: row.batch),
        )

    def _cheapest(self, use: str, error: float, cost: Callable[[Row], float | None]) -> Recommendation:
        """The cheapest of the engines, each at the loosest tolerance below which the error is always met."""
        if error < self.uncertainty:
            why = f"the references differ by {self.uncertainty:.1e} in e_n, so that {error:.1e} cannot be verified"
            return Recommendation(use, None, None, why)
        priced = []
        for engine in self.engines:
            rows = sorted((row for row in self.rows if row.engine == engine), key=lambda row: row.rtol)
            first = list(takewhile(lambda row: row.keeps(error), rows))
            if first and (spent := cost(first[-1])) is not None:
                priced.append((spent, first[-1]))
        if not priced:
            reached = [row.error for row in self.rows if row.keeps(math.inf) and row.error is not None]
            least = f"the least error reached is {min(reached):.1e}" if reached else "no setting has all outcomes right"
            why = f"no engine keeps {error:.1e} at a tolerance that was measured; {least}"
            return Recommendation(use, None, None, why)
        priced.sort(key=lambda pair: pair[0])
        spent, best = priced[0]
        why = "all collisions of the sample stick, and all outcomes are right"
        if best.error is not None:
            why = f"largest error {best.error:.1e} in e_n, and none above {error:.1e} at tighter tolerances"
        others = [f"{row.engine} at {row.rtol:.0e} costs {dear / spent:.3g} times as much" for dear, row in priced[1:]]
        return Recommendation(use, best.engine, best.rtol, "; ".join([f"{duration(spent)} each, {why}", *others]))

    @property
    def engines(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(row.engine for row in self.rows))


def work_precision(
    scene: Scene,
    tolerances: Sequence[float] = TOLERANCES,
    progress: Progress = lambda _done, _total: None,
    single: int = SINGLE,
    batch: int = BATCH,
) -> WorkPrecision:
    """Measure the engines on collisions about the scene's impact, on one core.

    Arguments:
        scene: the scene; if it has no impact, a default sample of Stokes numbers and angles is used.
        progress: called with (settings measured, settings in all).
        single: number of collisions computed one by one, from which errors are computed.
        batch: number of collisions in one call.

    Example:
        >>> from wetdoublet.solvers import Scene
        >>> found = work_precision(Scene.load("granulation"), [1e-6, 1e-9], single=4, batch=20)
        >>> found.recommend(1e-6)[0].engine is not None
        True

    Raises:
        ComputationError: no reference could be computed.
    """
    engines = list(ENGINES)
    total = len(engines) * len(tolerances) + 1
    impacts, sample = _drawn(scene, batch)
    progress(0, total)
    with one_core():
        some = impacts[batch // (2 * single) :: batch // single][:single]
        references, tight = _references(scene, some, engines)
        pairs = [pair for pair in zip(*references.values()) if pair[0].outcome == pair[1].outcome]
        if not pairs:
            raise ComputationError("no reference", advice="choose an impact farther from a boundary")
        places = [Impact(collision.stokes, collision.angle) for collision, _ in pairs]
        rows: list[Row] = []
        for engine in engines:
            expected = [
                pair[list(references).index(engine) == 0] if engine in references else pair[0] for pair in pairs
            ]
            expensive = False
            for rtol in sorted(tolerances, reverse=True):
                cost = None if expensive or engine in CASADI_ENGINES else _batch(scene, impacts, engine, rtol)
                expensive = expensive or (cost is not None and cost * batch > _DEAR)
                rows.append(_row(scene, places, expected, engine, rtol, cost))
                progress(1 + len(rows), total)
    differences = _errors(pairs)
    separate = sum(collision.outcome != "stick" for collision, _ in pairs)
    uncertainty, time_uncertainty = (max((pair[k] for pair in differences), default=0.0) for k in (0, 1))
    return WorkPrecision(
        scene, sample, batch, tuple(places), separate, len(some) - len(places), tuple(tight.items()), uncertainty,
        time_uncertainty, tuple(rows),
    )  # fmt: skip


def _drawn(scene: Scene, count: int) -> tuple[list[Impact], str]:
    """Impacts spread evenly over a rectangle of St and angle, and its description."""
    stokes, angle = scene.stokes, scene.angle
    if stokes is None or angle is None:
        spans, why = (STOKES, ANGLES), "the default, as the scene has no impact"
    else:
        turned = (max(angle - _TURNED, 0.0), max(angle, min(angle + _TURNED, _STEEPEST))) if angle else (0.0, 0.0)
        spans, why = ((stokes / _AROUND, stokes * _AROUND), turned), "about the scene's impact"
    (low, high), (flat, steep) = spans
    impacts = [
        Impact(low * (high / low) ** ((k + 0.5) / count), flat + (steep - flat) * (k * _GOLDEN % 1.0))
        for k in range(count)
    ]
    degrees = f"{math.degrees(flat):.4g} to {math.degrees(steep):.4g} deg" if angle != 0.0 else "0 deg"
    return impacts, f"{count} impacts, St {low:.4g} to {high:.4g}, angle {degrees} ({why})"


def _references(
    scene: Scene, impacts: Sequence[Impact], engines: Sequence[str]
) -> tuple[dict[str, list[Collision]], dict[str, float]]:
    """Results of two engines at the smallest tolerance that each completes, and that tolerance."""
    references: dict[str, list[Collision]] = {}
    tight: dict[str, float] = {}
    for engine in ("taylor", "rosenbrock", "cvodes"):
        for rtol in _TIGHTEST if engine in engines and len(references) < 2 else ():
            collisions = [
                case for impact in impacts if (case := _one(scene, impact, engine, rtol)) and case.engine == engine
            ]
            if len(collisions) == len(impacts):
                references[engine], tight[engine] = collisions, rtol
                break
    if len(references) < 2:
        raise ComputationError(
            f"no two engines complete the sample at {max(_TIGHTEST):g} or tighter",
            advice="choose an impact farther from a boundary",
        )
    return references, tight


def _one(scene: Scene, impact: Impact, engine: str, rtol: float) -> Collision | None:
    """A collision as computed by `collide`, perhaps by another engine; None if it fails."""
    try:
        return collide(scene, stokes=impact.stokes, angle=impact.angle, rtol=rtol, engine=engine, ledger=False)
    except ComputationError:
        return None


def _row(
    scene: Scene, impacts: Sequence[Impact], truths: Sequence[Collision], engine: str, rtol: float, batch: float | None
) -> Row:
    """Time and errors of the collisions computed one by one."""

    def collided() -> list[Collision | None]:
        return [_one(scene, impact, engine, rtol) for impact in impacts]

    collided()  # builds
    taken, computed = _cheapest(collided)
    alone = taken / len(impacts)
    done = [(collision, truth) for collision, truth in zip(computed, truths) if collision is not None]
    error, time_error = (max((errors[k] for errors in _errors(done)), default=None) for k in (0, 1))
    wrong = sum(collision.outcome != truth.outcome for collision, truth in done)
    handed_over = sum(collision.engine != engine for collision, _ in done)
    failed = len(computed) - len(done)
    together = alone if engine in CASADI_ENGINES else batch
    return Row(engine, rtol, error, time_error, alone, together, wrong, failed, handed_over)


def _errors(pairs: Sequence[tuple[Collision, Collision]]) -> list[tuple[float, float]]:
    """Absolute error of e_n and relative error of the contact time, where both separate in the same way."""
    return [
        (abs(collision.restitution - truth.restitution), abs(collision.contact_time / truth.contact_time - 1))
        for collision, truth in pairs
        if collision.outcome == truth.outcome and collision.contact_time and truth.contact_time
    ]


def _batch(scene: Scene, impacts: Sequence[Impact], engine: str, rtol: float) -> float | None:
    """CPU time (s) per impact of one call for all; None if one fails."""
    stokes, angle = (np.array([getattr(impact, name) for impact in impacts]) for name in ("stokes", "angle"))
    collide_many(scene, stokes=stokes[:1], angle=angle[:1], rtol=rtol, engine=engine)  # builds
    taken, data = _cheapest(lambda: collide_many(scene, stokes=stokes, angle=angle, rtol=rtol, engine=engine))
    return None if (data["outcome"].values == FAILED).any() else taken / len(impacts)


def _cheapest(run: Callable[[], Result]) -> tuple[float, Result]:
    """CPU time (s) of the cheapest of some calls, and the result of the last."""
    times: list[float] = []
    while len(times) < _PASSES and sum(times) <= _LONG:
        start = time.process_time()
        result = run()
        times.append(time.process_time() - start)
    return min(times), result


def duration(seconds: float) -> str:
    """A time as text in ms or us, with three digits."""
    return f"{seconds * 1e3:.3g} ms" if seconds >= 1e-3 else f"{seconds * 1e6:.3g} us"
