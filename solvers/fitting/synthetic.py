"""Measurements drawn from the model with the scatter that the likelihood assumes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...generated.automaton import OUTCOMES, STICK
from ..scene.scene import Scene
from ..settings import RTOL
from .law import Law
from .measurements import Measurements


def drawn(scene: Scene, plan: Measurements, seed: int | None, rtol: float = RTOL) -> Measurements:
    """The plan with outcomes and results as the scene gives them.

    Arguments:
        plan: impacts with their scatter; of `observed` the standard deviations count, and NaN where a result is not
            measured.
        seed: of the random numbers; None for impacts without scatter and results without noise.
    """
    random = None if seed is None else np.random.default_rng(seed)

    def noise() -> np.ndarray:
        return np.zeros(plan.size) if random is None else random.standard_normal(plan.size)

    law = Law(scene, (), plan, rtol).at(np.zeros(0))
    assert law is not None  # a scene holds
    speed = np.maximum(plan.speed + plan.speed_sd * noise(), 1e-3 * plan.speed)
    angle = plan.angle + plan.angle_sd * noise()
    normal = speed * np.cos(angle) if plan.relative else speed
    of, row = tuple(plan.observed), np.arange(plan.size)
    outcome = law.outcomes(row, normal, angle)
    observed = {}
    found = law.results(of, row, normal, angle) if of else None
    for k, name in enumerate(of):
        wanted, sd = plan.observed[name]
        assert found is not None
        seen = np.isfinite(wanted) & (outcome != OUTCOMES.index(STICK))
        observed[name] = np.where(seen, found.value[k] + sd * noise(), np.nan), sd
    return replace(plan, outcome=outcome, observed=observed)
