"""Measurements drawn from the model with the scatter that the likelihood assumes."""

from dataclasses import replace

import numpy as np
from wetdoublet.generated.automaton import OUTCOMES, STICK
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines.settings import RTOL
from wetdoublet.solvers.fitting.measurements import Measurements, rows_of


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

    experiment = rows_of(scene, (), plan, rtol).unchecked(np.zeros(0))
    speed = np.maximum(plan.speed + plan.speed_sd * noise(), 1e-3 * plan.speed)
    angle = plan.angle + plan.angle_sd * noise()
    impacts = np.arange(plan.size), speed * np.cos(angle) if plan.relative else speed, angle
    outcome = experiment.outcomes(*impacts)
    results = experiment.plain(tuple(plan.observed), *impacts) if plan.observed else []
    observed = {
        name: (np.where(np.isfinite(wanted) & (outcome != OUTCOMES.index(STICK)), values + sd * noise(), np.nan), sd)
        for (name, (wanted, sd)), values in zip(plan.observed.items(), results, strict=True)
    }
    return replace(plan, outcome=outcome, observed=observed)
