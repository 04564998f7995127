"""The differentiation of one collision: located, checked for nearby boundaries, differentiated in theta."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..engines.casadi.integrators import IntegrationFailed, tolerance_for
from ..engines.casadi.locate import EventLocator, EventSequence
from ..errors import ComputationError
from ..model import dimensionless
from ..model.model import load, select_model, slip_restitution
from ..results import DEFINITIONS
from ..scene.quantities import normal_speed
from ..scene.scene import Scene
from . import boundary_distance as nearness
from .directions import differentiated
from .parameters import RELATIVE, SCALES, Kind, kind_of, parameter_map, references
from .result import Near
from .trajectory_expression import course_of, influential, trajectory_expression

LOCATED = 1e-8  # tolerance of the event location; landings on the events correct the remaining error
NEAR = 1e-2  # at smaller distances to a boundary errors are amplified, so the tolerance is reduced with the distance
SHARPEST = 1e-13
_TILT = 1e-8  # rad: its square is rounding, and states are scaled by it, so that steps follow the tangential motion
_SHARPEST_CVODES = 3e-12  # smallest tolerance of CVODES with sensitivities; below it some integrations fail


@dataclass(frozen=True)
class Slopes:
    """Quantities and their derivatives in theta, SI: y (q,), dy/dtheta (q, n)."""

    value: np.ndarray
    first: np.ndarray


@dataclass(frozen=True)
class Problem:
    """A collision, the parameters to differentiate in, and their reference values."""

    scene: Scene
    n: dimensionless.Problem
    wrt: tuple[str, ...]
    kind: Kind
    reference: np.ndarray

    @classmethod
    def of(cls, scene: Scene, speed: float, angle: float, wrt: tuple[str, ...], hold: str) -> Problem:
        """The problem of a scene's collision at a normal speed (m/s) and angle (rad)."""
        kind = kind_of(scene, hold)
        return cls(
            scene,
            dimensionless.nondimensionalise(scene, speed, angle),
            wrt,
            kind,
            references(scene, kind, speed, angle),
        )

    def located(self, rtol: float) -> tuple[EventSequence, Near | None]:
        """The located trajectory and the nearest boundary found; ComputationError if that is too near."""
        finder = EventLocator(load(select_model(self.scene, self.n.oblique)), self.n.groups, LOCATED)
        try:
            path = finder.run()
        except ComputationError as error:
            raise self.n.in_si(nearness.explained(self.scene, self.n, error, rtol)) from None
        near = nearness.checked(self.scene, self.n, finder, path, rtol)
        return path, near

    def tilted(self) -> tuple[Problem, EventSequence]:
        """The collision at a tiny angle, located: derivatives that a head-on one has by its sideways motion."""
        aside = Problem.of(self.scene, self.n.speed, _TILT, self.wrt, self.kind.hold)
        try:
            return aside, EventLocator(load(select_model(self.scene, True)), aside.n.groups, LOCATED).run()
        except ComputationError as error:
            raise aside.n.in_si(error) from None

    def defined(self, name: str, path: EventSequence) -> bool:
        """True if a quantity is defined for the collision and can vary."""
        if name == "tangential_restitution" and not self.n.angle > 0:
            return False
        if name == "slip_restitution" and not math.isfinite(slip_restitution(path.model, path.y, path.p)):
            return False
        if name == "final_spin_partner" and not (self.scene.pair or self.scene.wall):
            return False
        return path.separated or name == "energy.initial"

    def slopes(
        self, path: EventSequence, of: tuple[str, ...], method: str, plugin: str, rtol: float, near: Near | None = None
    ) -> Slopes:
        """Derivatives of the quantities of a located trajectory; ComputationError if the engine fails."""
        full = "energy.tangential_lubrication" in of
        course = course_of(path, select_model(self.scene, path.model.oblique, full=full))
        rtol = sharpened(rtol, near, path)
        if plugin == "cvodes":
            if near is not None and amplifies(near) and near.boundary == nearness.SADDLE:
                raise ComputationError(
                    f"no derivative by cvodes: its steps do not follow those of a trajectory that lies at the {near}, "
                    f"nearer than {NEAR:g}",
                    advice="--engine rosenbrock",
                )
            rtol = max(rtol, _SHARPEST_CVODES)
        expression = trajectory_expression(course, of, plugin, tolerance_for(rtol, plugin, self.n.groups))
        mapping = parameter_map(self.kind, self.wrt, expression.groups)
        size = len(expression.groups)
        p, scales = np.split(mapping.values(self.reference).full().ravel(), [size])
        slopes = np.asarray(mapping.slopes(self.reference)[0].full())
        active = influential(course, self.n.groups)
        dp, ds = slopes[:size] * np.array(active)[:, None], slopes[size:]
        durations = np.array([step.duration for step in path.steps])
        try:
            z, dz = differentiated(expression, course, p, durations, dp, active, method, amplifies(near))
        except IntegrationFailed as failure:
            raise ComputationError(
                f"{plugin} could not differentiate the trajectory ({failure})",
                phase=str(path.steps[-1].phase),
                advice="try another --rtol, or the other --engine",
            ) from None
        scaled = [DEFINITIONS[name].scale for name in of]
        which = [SCALES.index(name) if name else None for name in scaled]
        scale = np.array([1.0 if k is None else scales[k] for k in which])
        slope = np.array([np.zeros(ds.shape[1]) if k is None else ds[k] for k in which])
        return Slopes(z * scale, dz @ dp * scale[:, None] + z[:, None] * slope)

    def units(self) -> np.ndarray:
        """dp/dtheta of the parameters."""
        return np.asarray(parameter_map(self.kind, self.wrt, ()).slopes(self.reference)[1].full()).ravel()

    def value_of(self, name: str) -> float:
        """The value of a parameter, SI."""
        if name == "impact.speed":
            return self.n.speed
        if name == RELATIVE:
            return self.n.speed / float(normal_speed(1.0, self.n.angle))
        if name == "impact.stokes":
            return self.n.stokes
        return float(self.reference[self.kind.entries.index(name)])


def sharpened(rtol: float, near: Near | None, path: EventSequence) -> float:
    """The tolerance reduced for a trajectory that amplifies errors.

    Near a boundary they grow by one over the distance, where it separates slowly by one over the remaining speed.
    """
    distances = [near.distance] if near is not None else []
    least = min([NEAR, *distances, *([float(path.y[1])] if path.separated else [])])
    return min(rtol, max(rtol * least / NEAR, SHARPEST))


def amplifies(near: Near | None) -> bool:
    """True if a boundary is so near that the trajectory amplifies errors."""
    return near is not None and near.distance < NEAR
