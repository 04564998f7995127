"""A collision with its located path and phases, for checks that need more than the result of `collide`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..engines.casadi.integrators import Tolerance, tolerance_for
from ..engines.casadi.locate import EventSequence, locate
from ..engines.casadi.replay import Replay, Stopped, replay
from ..errors import ComputationError
from ..model.dimensionless import DimensionlessGroups, nondimensionalise
from ..model.model import Model, load, select_model
from ..model.phases import Flow, Region
from ..scene.scene import Scene


@dataclass(frozen=True)
class Followed:
    """A located path and its integration by one engine, with spin as a state."""

    n: DimensionlessGroups
    path: EventSequence
    replayed: Replay
    model: Model
    p: np.ndarray
    tolerance: Tolerance


def follow(scene: Scene, stokes: float, angle: float, engine: str, rtol: float) -> Followed:
    """Locate a collision and integrate it.

    Raises:
        ComputationError: the outcome cannot be decided, or the engine stopped.
    """
    n = nondimensionalise(scene, scene.speed_of(stokes), angle)
    path = locate(load(select_model(scene, n.oblique)), n.groups, rtol)
    flow = Flow(select_model(scene, n.oblique, full=True), Region(1, 1, False))
    p, tolerance = flow.model.group_values(n.groups), tolerance_for(rtol, engine, n.groups)
    try:
        replayed = replay(path, engine, tolerance, flow, flow.model.start(p))
    except Stopped as failure:
        raise ComputationError(f"{engine} {failure.why}", phase=str(failure.step.phase)) from None
    return Followed(n, path, replayed, flow.model, p, tolerance)
