"""The paper's scenes with the choices that it leaves open, and their boundaries, each traced once per run."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.optimize import bisect, root_scalar

from ..boundaries.boundary import atlas, boundary
from ..boundaries.changes import Change
from ..boundaries.line import ready
from ..boundaries.result import Atlas
from ..boundaries.scene_sampler import SceneSampler
from ..engines.settings import RTOL
from ..errors import ComputationError
from ..model.dimensionless import nondimensionalise
from ..scene.scene import Scene
from .printed import CURVES, PRINTED

Line = tuple[Change, ...]
BRIDGED, DRY, PENDULUM = "granulation", "granulation-dry-bridge", "pendulum"
PRESSURE = "liquid.glass_transition_pressure"
_SHARED: dict[str, dict[str, Any]] = {
    "preset": {}, "log film": {"model.tangential": "film"}, "glass film-corrected": {"model.glass": "film-corrected"},
}  # fmt: skip
BRIDGE_VARIANTS = _SHARED | {"mikami-log10": {"bridge.law": "mikami-log10"}}
STRING_VARIANTS = _SHARED | {
    **{f"l = {length} m": {"pendulum.length": f"{length} m"} for length in ("0.4", "0.7", "1")},
    "small-angle strings": {"pendulum.law": "small-angle"},
}
_TANGENTIAL = {"immersed": "cut off at the particle radius", "film": "cut off at the film's edge"}
_GLASS = {"literal": "", "film-corrected": " above that at the rim"}
_STEEPEST = math.radians(89.0)  # the highest line of a map
_CLOSE = 1e-6  # relative tolerance in St of a criterion and of a pressure that is fitted
_AROUND = 1.35  # factor in St; nearly a factor of two in Ce


def variants(preset: str, changes: Mapping[str, dict[str, Any]]) -> dict[str, Scene]:
    """A preset with each of some choices changed alone."""
    scenes = {name: Scene.load(preset).with_entries(entries) for name, entries in changes.items()}
    ready(scenes.values())
    return scenes


def described(scene: Scene) -> str:
    """The choices that the paper leaves open: lever arm, lubrication, glass criterion; bridge law or strings."""
    model = scene.model
    text = f"lever arm at mid-gap, tangential lubrication {_TANGENTIAL[model.tangential]}, glass transition where the "
    text += f"film pressure on the axis{_GLASS[model.glass]} reaches p_gt"
    if scene.bridge is not None:
        text += f"; {scene.bridge.law}"
    if scene.pendulum is not None:
        text += f"; {scene.pendulum.law} strings, l = {scene.pendulum.length:g} m"
    return text


@dataclass
class PaperLines:
    """Boundaries of a run, and the resolution of its figures.

    Attributes:
        say: called with the current step.
        starts: lines of constant angle from which the atlas of a regime map starts.
        curve: points of a curve of Fig. 4b on each side of a boundary.
        critical: angles (rad) of the table of Ce*.
        collisions: that were computed.
        failures: lines that could not be traced, and why.
    """

    say: Callable[[str], None] = lambda _: None
    starts: int = 33
    curve: int = 40
    critical: tuple[float, ...] = CURVES[2:]
    collisions: int = 0
    failures: list[str] = field(default_factory=list)
    _known: dict[tuple[Scene, bool, float], Line] = field(default_factory=dict)

    def along(self, scene: Scene, angles: Sequence[float], near: bool = False) -> list[Line]:
        """Changes of outcome at each angle (rad), in order; empty, with an entry in `failures`, where tracing fails.

        Arguments:
            near: only the S/SRS boundary, searched around the printed Ce*.
        """
        new = [angle for angle in dict.fromkeys(angles) if (scene, near, angle) not in self._known]
        for some in [[angle] for angle in new] if near else [new] if new else []:
            middle = math.sqrt(PRINTED["centrifugal"].value / per_stokes_squared(scene, some[0])) if near else 0.0
            traced = boundary(scene, angle=some, stokes=(middle / _AROUND, middle * _AROUND) if near else None)
            self.collisions += traced.collisions
            self._known |= {(scene, near, angle): line for angle, line in zip(traced.angles, traced.changes)}
            self.failures += [f"{scene.name} at {math.degrees(at):.4g} deg: {why}" for at, why in traced.failed]
        return [self._known[scene, near, angle] for angle in angles]

    def map(self, scene: Scene, reach: float, first: float = 0.0) -> Atlas:
        """The atlas of a regime map from an angle (rad) on, up to St = `reach`."""
        regions = atlas(scene, span=(first, _STEEPEST), stokes=(1e-3 * reach, reach), lines=self.starts)
        self.collisions += regions.collisions
        places = regions.unsettled
        self.failures += [f"{scene.name}, map at {x:.4g} rad, St {stokes:.4g}: {why}" for x, stokes, why in places]
        return regions

    def pressure_for(self, scene: Scene, stokes: float) -> str:
        """Text of the p_gt at which head-on collisions bounce from `stokes` on, or of the reason of failure."""

        def apart(log_pressure: float) -> float:
            [line] = self.along(scene.with_entries({PRESSURE: math.exp(log_pressure)}), (0.0,))
            return math.log(sticks_to(line) / stokes)

        start = math.log(printed_pressure(scene))
        try:
            root = root_scalar(apart, x0=start, x1=start + 0.05, method="secant", xtol=_CLOSE).root
        except ComputationError:
            return "a pressure that could not be computed"
        return f"{math.exp(root) / 1e6:.3g} MPa"


def printed_pressure(scene: Scene) -> float:
    """p_gt of a preset of the paper in Pa."""
    return float(scene.entries[PRESSURE])


def outcomes(line: Line) -> tuple[str, ...]:
    """The outcomes along a line of constant angle, in order of St."""
    return (line[0].before, *(change.after for change in line)) if line else ()


def ends(line: Line) -> Change:
    """The change at which sticking ends; ComputationError if there is none."""
    for change in line:
        if change.before == "stick":
            return change
    raise ComputationError("no boundary at which stick ends was found where the paper has one")


def sticks_to(line: Line) -> float:
    """The Stokes number at which a line of constant angle ceases to stick."""
    return ends(line).stokes


def centrifugal(line: Line) -> float:
    """Ce* of a line of constant angle: Ce at the end of sticking."""
    return _bridged(ends(line).centrifugal)


def per_stokes_squared(scene: Scene, angle: float) -> float:
    """Ce over St^2 of a scene at an angle (rad)."""
    return _bridged(nondimensionalise(scene, scene.speed_of(1.0), angle).centrifugal)


def _bridged(centrifugal_number: float | None) -> float:
    if centrifugal_number is None:
        raise ComputationError("without a bridge there is no centrifugal number")
    return centrifugal_number


def criterion_met(scene: Scene, low: float, high: float) -> float:
    """The Stokes number between `low` and `high` from which a rebound criterion is met head-on."""
    sampler = SceneSampler(scene, RTOL)

    def met(stokes: float) -> float:
        return 1.0 if sampler(np.zeros(1), np.array([stokes]))["reversal"][0] >= 0 else -1.0

    if met(low) > 0 or met(high) < 0:
        raise ComputationError(f"no criterion is first met between St {low:g} and {high:g}")
    return float(bisect(met, low, high, xtol=_CLOSE * low))
