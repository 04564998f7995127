"""What a fit predicts: probabilities of the outcomes over speed and angle, with the uncertainty of the fitted entries.

Entries are drawn from a normal distribution about the estimates and weighted by likelihood times prior over its density
(importance sampling). The distribution is adapted once to the first draws. What is free is taken as equally likely
everywhere in the variables of the search, which are logarithms for positive entries.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.stats import norm, qmc

from ...generated.automaton import OUTCOMES
from ..errors import ComputationError, InputError
from ..host.pictures import register
from ..many.arguments import checked_numbers
from ..many.collide_many import collide_many
from ..results import attributes
from ..scene.origin import provenance
from ..scene.ranges import MOST
from ..scene.schema import FIELDS
from .joint import Part
from .optimise import Objective, whitening

if TYPE_CHECKING:
    import xarray

_WIDER = 1.3  # standard deviations of the draws over those of the estimates: tails must not be left out
_MARGIN, _BESIDE, _STEEPEST = 1.2, 0.1, 1.55  # of the window around the impacts: factor of the speed, angle (rad)
_GRID = 48
_LEAST = 8.0  # draws that the weights leave


def draws(objective: Objective, best: np.ndarray, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Quasi-random values of the free entries, (draws, entries), and their weights, which add up to 1.

    Raises:
        ComputationError: the weights leave next to none, as where the data do not tell an entry.
    """
    free = objective.free
    centre, spread = best, whitening(objective, best)
    count = 1 << (count - 1).bit_length()  # a power of two, as Sobol points want
    for number in (max(count // 4, 32), count):
        z = norm.ppf(qmc.Sobol(free.size, seed=seed).random(number) * (1 - 1e-9) + 5e-10)
        inner = centre + _WIDER * z @ spread.T
        inside = ((inner >= free.low) & (inner <= free.high)).all(axis=1)
        height = np.full(number, -np.inf)
        height[inside] = [objective.value(point) for point in inner[inside]]
        log = height + (z**2).sum(axis=1) / 2
        weight = np.exp(log - log.max()) if np.isfinite(log).any() else np.zeros(number)
        weight /= max(weight.sum(), 1e-300)
        if not weight.any() or 1 / (weight**2).sum() < _LEAST:
            advice = "give priors, or free fewer entries"
            raise ComputationError("too few draws of the entries have a likelihood", advice=advice)
        centre = weight @ inner
        covariance = (weight[:, None] * (inner - centre)).T @ (inner - centre)
        values, vectors = np.linalg.eigh(covariance + 1e-6 * free.size * np.diag(np.diag(covariance)))
        spread = vectors * np.sqrt(np.maximum(values, 1e-30))
    positive = weight > 0
    return np.array([free.values(point) for point in inner[positive]]), weight[positive]


def predicted(
    member: Part,
    names: tuple[str, ...],
    values: np.ndarray,
    weight: np.ndarray,
    speed: Any,
    relative_speed: Any,
    angle: Any,
) -> xarray.Dataset:
    """The probabilities of the outcomes of one scene's impacts; `names` are those of the columns of `values`."""
    import xarray

    data = member.data
    given: dict[str, Any] = {
        name: value for name, value in (("speed", speed), ("relative_speed", relative_speed)) if value is not None
    }
    if len(given) > 1:
        raise InputError("speed", speed, "one of speed and relative_speed", "is given with relative_speed")
    given = given or {data.speed_name: np.geomspace(data.speed.min() / _MARGIN, data.speed.max() * _MARGIN, _GRID)}
    if angle is None:
        low, high = data.angle.min() - _BESIDE, data.angle.max() + _BESIDE
        angle = np.linspace(max(low, 0.0), min(high, _STEEPEST), _GRID)
    [kind] = given
    along, across = (
        np.atleast_1d(checked_numbers(name, value, FIELDS[f"impact.{name}"])).ravel()
        for name, value in ((kind, given[kind]), ("angle", angle))
    )
    cells = along.size * across.size
    if cells * weight.size > MOST:
        raise InputError(
            kind, None, f"at most {MOST // weight.size} cells with {weight.size} draws", f"makes {cells} cells"
        )
    v, a = (np.tile(grid.ravel(), weight.size) for grid in np.meshgrid(along, across))
    own = {name: values[:, names.index(member.entries[name])] for name in member.names}
    vary = {name: member.scene.as_given(name, np.repeat(column, cells)) for name, column in own.items()}
    given = {kind: v, "angle": a}
    outcomes = collide_many(member.scene, vary=vary, of=("outcome",), **given).outcome.values
    outcome = outcomes.reshape(weight.size, across.size, along.size)
    share = np.stack([np.tensordot(weight, outcome == code, 1) for code in range(len(OUTCOMES))])
    columns = {"probability": (("outcome", "angle", kind), share, {"units": "1", "long_name": "probability"})}
    axes = {"angle": (("angle",), across, attributes("angle")), kind: ((kind,), along, attributes(kind))}
    attrs = provenance(
        member.scene, title=member.scene.name, draws=int(weight.size), effective_draws=float(1 / (weight**2).sum())
    )
    register()
    return xarray.Dataset(columns, axes | {"outcome": list(OUTCOMES)}, attrs)
