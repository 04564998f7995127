"""A plane of collisions mapped to the unit square: a scene entry as x, ln St as y."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...generated.automaton import LAST_ANSWER, Purpose
from ..engines.taylor.call import run_kernel
from ..engines.taylor.record import run_recorded
from ..errors import ComputationError, InputError
from ..host.workers import usable_cores
from ..many.arguments import ascending, checked_numbers, checked_vary
from ..many.by_kernel import impacts_of
from ..many.impacts import Impacts
from ..scene.scene import Scene
from .samples import SAMPLE_BUDGET
from .window import STOKES, stokes_range

ANGLE = "impact.angle"
# rad; lower limit for a plane that starts head-on, so that collisions stay oblique; St* depends on the square of the
# angle. Without attraction, the time to separation grows as the obliquity decreases.
LEAST_ANGLE, LEAST_UNBOUND = 1e-5, 1e-3
_THREADED = 20_000  # fewest collisions for which several cores pay


@dataclass
class Plane:
    """The window of (x, St) in which outcomes are computed. Points are in the unit square, an n x 2 array.

    Arguments:
        over: dotted name of the entry x, which may be the impact's angle.
        span: range of x, rad or SI.
        stokes: lowest and highest Stokes number.

    Attributes:
        edge: the lowest x that was requested; if that is head-on, `span` starts at a small angle.
        collisions: number of computed collisions.
        undecided: number of these that the kernel did not decide.
        patience: most undecided collisions, each of which takes as long as thousands of others.
    """

    scene: Scene
    over: str
    span: tuple[float, float]
    stokes: tuple[float, float]
    rtol: float
    edge: float = field(init=False)
    collisions: int = field(default=0, init=False)
    undecided: int = field(default=0, init=False)
    patience: float = field(default=math.inf, init=False)

    def __post_init__(self) -> None:
        """Start where collisions are oblique."""
        self.edge = self.span[0]
        if self.over == ANGLE:
            scene = self.scene
            bound = scene.bridge is not None or scene.pendulum is not None or scene.attraction is not None
            least = LEAST_ANGLE if bound else LEAST_UNBOUND
            self.span = max(self.edge, min(least, 0.5 * self.span[1])), self.span[1]

    def x(self, points: np.ndarray) -> np.ndarray:
        """Values of the entry at points, rad or SI."""
        low, high = self.span
        across = points[..., 0]
        return np.where(across >= 1, high, low + across * (high - low))

    def values(self, points: np.ndarray) -> np.ndarray:
        """Values of the entry at points, for results: on the lower edge of the window, `edge`."""
        return np.where(points[..., 0] <= 0, self.edge, self.x(points))

    def stokes_at(self, points: np.ndarray) -> np.ndarray:
        """Stokes numbers at points."""
        low, high = self.stokes
        up = points[..., 1]
        return np.where(up >= 1, high, low * np.exp(up * math.log(high / low)))

    def points(self, x: np.ndarray, stokes: np.ndarray) -> np.ndarray:
        """Points of the square at values of the entry and Stokes numbers."""
        return unit_points(self.span, self.stokes, x, stokes)

    def scene_at(self, x: float) -> tuple[Scene, float]:
        if self.over == ANGLE:
            return self.scene, x
        return self.scene.with_si({self.over: x}), float(self.scene.angle or 0.0)

    def labels(self, points: np.ndarray) -> np.ndarray:
        """Outcomes by index in OUTCOMES; -1 where unknown."""
        return self.seen(points)[0]

    def seen(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Outcomes (-1 where unknown), and the first rebound criterion met (-1 for none), at points."""
        impacts, sound = impacts_of(self._request(points))
        self.collisions += sound.size
        threads = usable_cores() if sound.size > _THREADED else 1
        answers = run_kernel(impacts, self.rtol, threads=threads, budget=SAMPLE_BUDGET)
        outcome, reversal = np.full(sound.size, -1), np.full(sound.size, -1)
        outcome[sound] = np.where(answers["status"] <= LAST_ANSWER, answers["outcome"], -1)
        reversal[sound] = answers["reversal"]
        self.undecided += int((outcome < 0).sum())
        if self.undecided > self.patience:
            message = f"the kernel does not decide {self.undecided} collisions beside them"
            raise ComputationError(message, advice="`boundary` traces them one by one, which may take minutes")
        return outcome, reversal

    def first_criterion(self, points: np.ndarray) -> np.ndarray:
        """The rebound criterion that the first approach meets (-1 for none; -2: not known), at points.

        The whole collision does not show it, because a stick may meet a criterion later.
        """
        criteria = np.full(points.shape[0], -2)
        impacts, sound = impacts_of(self._request(points))
        oblique = bool(impacts.angle[0] > 0)
        answers = run_recorded(impacts, oblique, self.rtol, trajectory=True, purpose=Purpose.ESCAPE, keep=False,
                               fold=False, events=False).answers  # fmt: skip
        criteria[sound] = np.where(answers["status"] <= LAST_ANSWER, answers["reversal"], -2)
        return criteria

    def _request(self, points: np.ndarray) -> Impacts:
        x, size = self.x(points), points.shape[0]
        angle = x if self.over == ANGLE else np.full(size, float(self.scene.angle or 0.0))
        columns = {"impact.stokes": self.stokes_at(points), "impact.angle": angle, self.over: x}
        return Impacts.listed(self.scene, columns, self.rtol)


def unit_points(span: tuple[float, float], window: tuple[float, float], x: Any, stokes: Any) -> np.ndarray:
    """Points of the unit square, n x 2, for values of x in a span and Stokes numbers in a window."""
    across = (np.asarray(x) - span[0]) / (span[1] - span[0])
    return np.column_stack([across, np.log(np.asarray(stokes) / window[0]) / math.log(window[1] / window[0])])


def check_plane(scene: Scene, over: str, span: Any, stokes: Any, rtol: float) -> Plane:
    """The validated plane of a scene; InputError for invalid arguments.

    Arguments:
        stokes: lowest and highest Stokes number; None for what the scenes at both ends of the span may meet.
    """
    if not isinstance(over, str):
        raise InputError("over", over, "the dotted name of an entry", "is not a name")
    ends = STOKES if stokes is None else ascending("stokes", checked_numbers("impact.stokes", stokes))
    if scene.package is not None and scene.package.bends:  # kinds of curves are unknown with these
        accepted = "boundaries at so many angles, as 30:75:10, or a model that declares laws alone"
        raise InputError("over", over, accepted, "spans no atlas of a model that declares events, terms or criteria")
    if over == ANGLE:
        plane = Plane(scene, over, ascending("span", checked_numbers(ANGLE, span)), ends, rtol)
    else:
        scene, varied = checked_vary(scene, {over: span}, "over")
        plane = Plane(scene, over, ascending("span", varied[over]), ends, rtol)
        if scene.angle is None:
            raise InputError("impact.angle", None, 'an angle, as angle = "60 deg" in [impact] or --set impact.angle')
        for x in plane.span:
            plane.scene_at(x)  # the scene validates the values
    if stokes is None:
        low, high = zip(*(stokes_range(at, [angle]) for at, angle in map(plane.scene_at, plane.span)))
        plane.stokes = min(low), max(high)
    return plane
