"""Run time against achieved error of each engine for one scene on this machine, and the setting recommended."""

import math
import time
from collections.abc import Sequence
from itertools import takewhile
from pathlib import Path
from typing import NamedTuple

from ..collision.collide import collide
from ..collision.result import Collision
from ..collision.text import name_of
from ..engines.settings import ENGINES
from ..errors import ComputationError
from ..formatting.tables import table
from ..host.environment import environment, one_core
from ..host.pictures import Drawn
from ..host.progress import Progress
from ..scene.items import cells, item
from ..scene.origin import Record, Result
from ..scene.scene import Scene

TOLERANCES = tuple(10.0**-k for k in range(4, 13))
SAMPLE = 8  # collisions
STOKES, ANGLES = (0.01, 10.0), (math.radians(5), math.radians(85))  # ranges if the scene has no impact
_AROUND, _TURNED, _STEEPEST = 2.0, math.radians(5), math.radians(89)  # about an impact: factor in St, change of angle
_TIGHTEST = (1e-13, 1e-12, 1e-11)  # tolerances of a reference; the first that the engine completes is used
_PASSES, _LONG = 10, 0.05  # most passes, and s after which no further one starts; the cheapest counts
_GOLDEN = 0.6180339887498949


class Impact(NamedTuple):
    """Stokes number and angle (rad)."""

    stokes: float
    angle: float


def _duration(seconds: float) -> str:
    """A time as text in ms or us, with three digits."""
    return f"{seconds * 1e3:.3g} ms" if seconds >= 1e-3 else f"{seconds * 1e6:.3g} us"


class Row(Record):
    """One engine at one tolerance."""

    engine: str = item("its name", head="engine")
    rtol: float = item("relative tolerance", "1", "rtol", "{:.0e}".format)
    error: float | None = item(
        "largest absolute error of e_n; None where no collision separates", "1", "error in e_n",
        lambda error: "-" if error is None else f"{error:.1e}",
    )  # fmt: skip
    seconds: float = item("mean CPU time of a collision computed alone", "s", "CPU time", _duration)
    wrong: int = item("collisions with another outcome than the reference", head="wrong")
    failed: int = item("collisions that the engine does not complete", head="failed")

    def keeps(self, error: float) -> bool:
        """True if all outcomes are right and no error of e_n exceeds `error`."""
        return not self.wrong and not self.failed and (self.error or 0.0) <= error


class Recommendation(NamedTuple):
    """The cheapest setting; engine and rtol are None, with a reason, if there is none."""

    engine: str | None
    rtol: float | None
    reason: str


class WorkPrecision(Result, Drawn):
    """Cost and error of the engines on a sample of a scene's collisions."""

    _picture = "verify.work_precision_plot.draw"
    _keys = "sample impacts separate left_out references uncertainty rows error=wanted recommended environment"

    scene: Scene
    wanted: float = item("the absolute error of e_n for which a setting is recommended")
    sample: str = item("description of the sample")
    impacts: tuple[Impact, ...] = item("impacts on which errors are measured")
    separate: int = item("number of these that separate")
    left_out: int = item("impacts so near a boundary that the references disagree on the outcome")
    references: tuple[tuple[str, float], ...] = item(
        "engine and tolerance of each reference; an engine is compared with the first other one"
    )
    uncertainty: float = item(
        "largest difference in e_n between the references; smaller errors cannot be distinguished from theirs"
    )
    rows: tuple[Row, ...]

    @property
    def engines(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(row.engine for row in self.rows))

    @property
    def environment(self) -> dict[str, object]:
        """The machine and its software."""
        return environment()

    @property
    def recommended(self) -> Recommendation:
        """The cheapest of the engines, each at the loosest tolerance below which the error is always met."""
        error = self.wanted
        if error < self.uncertainty:
            why = f"the references differ by {self.uncertainty:.1e} in e_n, so that {error:.1e} cannot be verified"
            return Recommendation(None, None, why)
        priced: list[Row] = []
        for engine in self.engines:
            rows = sorted((row for row in self.rows if row.engine == engine), key=lambda row: row.rtol)
            priced += list(takewhile(lambda row: row.keeps(error), rows))[-1:]
        if not priced:
            reached = [row.error for row in self.rows if row.keeps(math.inf) and row.error is not None]
            least = f"the least error reached is {min(reached):.1e}" if reached else "no setting has all outcomes right"
            why = f"no engine keeps {error:.1e} at a tolerance that was measured; {least}"
            return Recommendation(None, None, why)
        best, *others = sorted(priced, key=lambda row: row.seconds)
        why = "all collisions of the sample stick, and all outcomes are right"
        if best.error is not None:
            why = f"largest error {best.error:.1e} in e_n, and none above {error:.1e} at tighter tolerances"
        dearer = [
            f"{row.engine} at {row.rtol:.0e} costs {row.seconds / best.seconds:.3g} times as much" for row in others
        ]
        return Recommendation(best.engine, best.rtol, "; ".join([f"{_duration(best.seconds)} each, {why}", *dearer]))

    def __str__(self) -> str:
        counted = f"{len(self.impacts)} of them count, of which {self.separate} separate."
        if self.left_out:
            counted += f" {self.left_out} are left out: the references disagree on the outcome."
        against = ", ".join(f"{engine} at rtol {rtol:.0e}" for engine, rtol in self.references)
        best = self.recommended
        setting = f"{best.engine}, rtol {best.rtol:.0e}" if best.engine else "none"
        return "\n".join([
            f"{name_of(self.scene)}: {self.sample}", counted, "",
            table(*cells(self.rows)), "",
            f"Errors are differences from the first of {against} that is another engine.",
            f"These two differ by at most {self.uncertainty:.1e} in e_n: the error estimate of the references.",
            "CPU time on one core, of a collision by `collide` without ledger.", "",
            f"Recommended for an error of {self.wanted:.1e} in e_n: {setting}", f"  {best.reason}",
        ])  # fmt: skip


def work_precision(
    scene: Scene | str | Path,
    wanted: float = 1e-6,
    tolerances: Sequence[float] = TOLERANCES,
    progress: Progress = lambda _done, _total: None,
    size: int = SAMPLE,
) -> WorkPrecision:
    """Measure the engines on collisions about the scene's impact, on one core.

    Arguments:
        scene: the scene; if it has no impact, a default sample of Stokes numbers and angles is used.
        wanted: largest absolute error of e_n.
        progress: called with (settings measured, settings in all).
        size: number of collisions.

    Example:
        >>> found = work_precision("granulation", 1e-6, [1e-6, 1e-9], size=4)
        >>> found.recommended.engine is not None
        True

    Raises:
        ComputationError: no reference could be computed.
    """
    scene = Scene.load(scene)
    total = len(ENGINES) * len(tolerances) + 1
    impacts, sample = _drawn(scene, size)
    progress(0, total)
    with one_core():
        references, tight = _references(scene, impacts)
        pairs = [pair for pair in zip(*references.values()) if pair[0].outcome == pair[1].outcome]
        if not pairs:
            raise ComputationError("no reference", advice="choose an impact farther from a boundary")
        places = tuple(Impact(collision.stokes, collision.angle) for collision, _ in pairs)
        rows: list[Row] = []
        for engine in ENGINES:
            truths = [pair[[*references].index(engine) == 0] if engine in references else pair[0] for pair in pairs]
            for rtol in sorted(tolerances, reverse=True):
                rows.append(_row(scene, places, truths, engine, rtol))
                progress(1 + len(rows), total)
    uncertainty = max(_errors(pairs), default=0.0)
    separate = sum(collision.outcome != "stick" for collision, _ in pairs)
    left_out = len(impacts) - len(places)
    return WorkPrecision(
        scene, wanted, sample, places, separate, left_out, tuple(tight.items()), uncertainty, tuple(rows)
    )


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


def _references(scene: Scene, impacts: Sequence[Impact]) -> tuple[dict[str, list[Collision]], dict[str, float]]:
    """Results of two engines at the smallest tolerance that each completes, and that tolerance."""
    references: dict[str, list[Collision]] = {}
    tight: dict[str, float] = {}
    for engine in ("taylor", "rosenbrock", "cvodes"):
        for rtol in _TIGHTEST if len(references) < 2 else ():
            collisions = [case for impact in impacts if (case := _collided(scene, impact, engine, rtol))]
            if len(collisions) == len(impacts):
                references[engine], tight[engine] = collisions, rtol
                break
    if len(references) < 2:
        raise ComputationError(
            f"no two engines complete the sample at {max(_TIGHTEST):g} or tighter",
            advice="choose an impact farther from a boundary",
        )
    return references, tight


def _collided(scene: Scene, impact: Impact, engine: str, rtol: float) -> Collision | None:
    """A collision by an engine; None if it fails, or where another engine answers."""
    try:
        done = collide(scene, stokes=impact.stokes, angle=impact.angle, rtol=rtol, engine=engine, ledger=False)
    except ComputationError:
        return None
    return done if done.engine == engine else None


def _row(scene: Scene, impacts: Sequence[Impact], truths: Sequence[Collision], engine: str, rtol: float) -> Row:
    """Time, of the cheapest of some passes over the impacts, and errors."""
    times: list[float] = []
    computed = [_collided(scene, impact, engine, rtol) for impact in impacts]  # builds
    while len(times) < _PASSES and sum(times) <= _LONG:
        start = time.process_time()
        computed = [_collided(scene, impact, engine, rtol) for impact in impacts]
        times.append(time.process_time() - start)
    done = [(collision, truth) for collision, truth in zip(computed, truths) if collision is not None]
    wrong = sum(collision.outcome != truth.outcome for collision, truth in done)
    error = max(_errors(done), default=None)
    return Row(engine, rtol, error, min(times) / len(impacts), wrong, len(computed) - len(done))


def _errors(pairs: Sequence[tuple[Collision, Collision]]) -> list[float]:
    """Absolute errors of e_n, where both separate in the same way."""
    return [
        abs(collision.restitution - truth.restitution)
        for collision, truth in pairs
        if collision.outcome == truth.outcome and truth.contact_time
    ]
