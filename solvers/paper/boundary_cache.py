"""Boundaries shared by several parts and traced once per run, and the resolution of figures."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ..boundaries.boundary import Atlas, atlas, boundary
from ..boundaries.changes import Change
from ..boundaries.line import ready
from ..boundaries.scene_sampler import SceneSampler
from ..engines.settings import RTOL
from ..errors import ComputationError
from ..scene.scene import Scene
from .parts import number
from .printed import CURVES

Line = tuple["Change", ...]
Span = tuple[float, float]  # range of St

_STEEPEST = math.radians(89.0)  # the highest line of a map
_AT_ONCE = 9  # collisions in each round of bracketing a criterion
PRESSURE = "liquid.glass_transition_pressure"
_CLOSE = 1e-6  # relative tolerance in St of a pressure that is fitted


@dataclass(frozen=True)
class Job:
    """A scene, the angles (rad) to trace, and the range of Stokes numbers (None for the default)."""

    scene: Scene
    angles: tuple[float, ...]
    span: Span | None = None


@dataclass(frozen=True)
class Detail:
    """Resolution of the figures.

    Arguments:
        lines: lines of constant angle from which the atlas of a regime map starts.
        curve: points of a curve of Fig. 4b on each side of a boundary.
        critical: angles (rad) of the table of Ce*.
    """

    lines: int = 33
    curve: int = 40
    critical: tuple[float, ...] = CURVES[2:]


class BoundaryCache:
    """Cache of traced lines by scene and angle; `say` is called with the current step."""

    def __init__(self, detail: Detail | None = None, say: Callable[[str], None] | None = None) -> None:
        self.detail = detail or Detail()
        self.say = say or (lambda _: None)
        self.collisions = 0
        self.failures: list[str] = []
        self._known: dict[tuple[Scene, Span | None], dict[float, Line]] = {}

    def lines(self, scene: Scene, angles: Iterable[float]) -> list[Line]:
        """Changes of outcome at each angle (rad), in order; empty, with an entry in `failures`, where tracing fails."""
        return self.many([Job(scene, tuple(angles))])[0]

    def many(self, jobs: Sequence[Job]) -> list[list[Line]]:
        """The lines of several jobs."""
        missing: dict[tuple[Scene, Span | None], dict[float, None]] = {}
        for job in jobs:
            known = self._known.setdefault((job.scene, job.span), {})
            new = dict.fromkeys(angle for angle in job.angles if angle not in known)
            missing.setdefault((job.scene, job.span), {}).update(new)
        ready([scene for (scene, _), angles in missing.items() if angles])
        for (scene, span), angles in missing.items():
            if angles:
                traced = boundary(scene, angle=list(angles), stokes=span)
                self.collisions += traced.collisions
                self._known[scene, span] |= dict(zip(traced.angles, traced.changes))
                failed = traced.failed
                self.failures += [f"{scene.name} at {math.degrees(angle):.4g} deg: {why}" for angle, why in failed]
        return [[self._known[job.scene, job.span][angle] for angle in job.angles] for job in jobs]

    def map(self, scene: Scene, reach: float, first: float = 0.0) -> Atlas:
        """The atlas of a regime map from an angle (rad) on, up to St = `reach`."""
        regions = atlas(scene, span=(first, _STEEPEST), stokes=(1e-3 * reach, reach), lines=self.detail.lines)
        self.collisions += regions.collisions
        places = regions.unsettled
        self.failures += [f"{scene.name}, map at {x:.4g} rad, St {stokes:.4g}: {why}" for x, stokes, why in places]
        return regions

    def pressure_for(self, scene: Scene, stokes: float) -> str:
        """Text of the p_gt at which head-on collisions bounce from `stokes` on, or of the reason of failure."""

        def apart(pressure: float) -> float:
            [line] = self.lines(scene.with_entries({PRESSURE: pressure}), (0.0,))
            return math.log(change_at(line, "stick").stokes / stokes)

        before = math.log(printed_pressure(scene))
        here = before + 0.05
        try:
            was, now = apart(math.exp(before)), apart(math.exp(here))
            while abs(now) > _CLOSE:  # the secant method, in logarithms
                before, here, was = here, here - now * (here - before) / (now - was), now
                now = apart(math.exp(here))
        except ComputationError:
            return "a pressure that could not be computed"
        return f"{math.exp(here) / 1e6:.3g} MPa"


def printed_pressure(scene: Scene) -> float:
    """p_gt of a preset of the paper in Pa."""
    return float(scene.entries[PRESSURE])


def outcomes(line: Line) -> tuple[str, ...]:
    """The outcomes along a line of constant angle, in order of St."""
    return (line[0].before, *(change.after for change in line)) if line else ()


def change_at(line: Line, before: str) -> Change:
    """The change at which an outcome ends; ComputationError if there is none."""
    for change in line:
        if change.before == before:
            return change
    raise ComputationError(f"no boundary at which {before} ends was found where the paper has one")


def sticks_to(line: Line) -> float:
    """The Stokes number at which a line of constant angle ceases to stick."""
    return change_at(line, "stick").stokes


def shown(read: Callable[[], float]) -> str:
    """A number of a table, or `failed` if it cannot be computed, so that the others are still shown."""
    try:
        return number(read())
    except ComputationError:
        return "failed"


def criterion_met(scene: Scene, low: float, high: float, angle: float = 0.0, rtol: float = 1e-6) -> float:
    """The Stokes number between `low` and `high` from which a rebound criterion is met, bracketed to `rtol`."""
    sampler = SceneSampler(scene, RTOL)
    while high - low > rtol * high:
        stokes = np.geomspace(low, high, _AT_ONCE)
        met = sampler(np.full(stokes.size, angle), stokes)["reversal"] >= 0
        if met[0] or not met[-1]:
            raise ComputationError(f"no criterion is first met between St {low:g} and {high:g}")
        first = int(np.argmax(met))
        low, high = float(stokes[first - 1]), float(stokes[first])
    return math.sqrt(low * high)
