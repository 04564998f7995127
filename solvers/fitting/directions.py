"""Which way the lines through the scatter of each row go, and where across them its integrand is.

Lines have to cross the changes of outcome: as one that runs along a change moves over it, a part of the integral
appears or vanishes at once. A result that changes over the scatter by more than its noise leaves a narrow band of the
scatter, which lines have to cross as well.
"""

from dataclasses import dataclass

import numpy as np

from ..boundaries.experiment import Experiment, Results
from .measurements import Measurements
from .scatter import REACH, ScatterLines, in_deviations, nearest_normals

_DIRECTIONS = np.pi / 36 * np.arange(36)
_STEEPEST = 0.05  # least cosine between a line and the normal of a change that counts
_BAND = 0.3  # weight of a band as narrow as the scatter that lines run along, beside a change that they cross
_ROOM, _NARROW = 1.3, 0.6  # widening of an integrand, and its width (deviations of the scatter) below which it counts
_PAIRS = ((0, 1), (0, 2), (1, 2))  # outcomes on both sides of the changes of `nearest_normals`


def directions(experiment: Experiment, data: Measurements, measured: tuple[str, ...]) -> np.ndarray:
    """The directions of the lines of each row, as of `ScatterLines.through`.

    Arguments:
        measured: names of the results.
    """
    if not ((data.speed_sd > 0) & (data.angle_sd > 0)).any():
        return np.zeros(data.size)
    distance, normal = nearest_normals(experiment, data)
    every = np.arange(data.size)
    lines = ScatterLines.through(data, 0.0, 1)
    outcome = experiment.outcomes(every, *lines.at(every, np.zeros(data.size)))
    agrees = (outcome >= 0) & data.allowed[every, outcome]
    matters = np.stack([data.allowed[:, pair].any(axis=1) for pair in _PAIRS], axis=1) & np.isfinite(distance)
    squared = np.where(matters, distance**2, np.inf)
    nearest = np.where(agrees | ~matters.any(axis=1), 0.0, squared.min(axis=1))  # a change has to be passed
    weight = np.exp((nearest[:, None] - squared) / 2)
    aim = np.column_stack([np.cos(_DIRECTIONS), np.sin(_DIRECTIONS)])
    crossing = np.maximum(np.abs(np.nan_to_num(normal) @ aim.T), _STEEPEST)
    cost = (weight[:, :, None] / crossing).sum(axis=1)
    row = np.flatnonzero(data.separated & agrees)
    if row.size:
        _, by = _at_centre(experiment, data, measured, row)
        squares = np.zeros((row.size, _DIRECTIONS.size))
        for k, name in enumerate(measured):
            values, sd = (column[row, None] for column in data.observed[name])
            steep = np.where(np.isfinite(values), np.nan_to_num(by[k]) / sd, 0.0)
            squares += (steep @ np.column_stack([-aim[:, 1], aim[:, 0]]).T) ** 2
        cost[row] += _BAND * squares
    return np.asarray(_DIRECTIONS[np.argmin(cost, axis=1)])


def _at_centre(
    experiment: Experiment, data: Measurements, measured: tuple[str, ...], row: np.ndarray
) -> tuple[Results, np.ndarray]:
    """Results of the nominal impacts of rows, and their derivatives per standard deviation (results, rows, 2)."""
    at = ScatterLines.through(data, 0.0, 1).at(row, np.zeros(row.size))
    results = experiment.results(measured, row, *at)
    by = [in_deviations(data, row, *at, *slopes) for slopes in zip(results.speed, results.angle, strict=True)]
    return results, np.array(by)


@dataclass(frozen=True)
class Narrow:
    """Rows whose integrand is much narrower across the lines than the scatter.

    Attributes:
        centre, width: of the integrands of all rows.
        row: those rows, and of them the results' `mean` and `spread` over the scatter.
    """

    centre: np.ndarray
    width: np.ndarray
    row: np.ndarray
    mean: dict[str, np.ndarray]
    spread: dict[str, np.ndarray]


def narrow_rows(experiment: Experiment, data: Measurements, measured: tuple[str, ...], direction: np.ndarray) -> Narrow:
    """Where across the lines what was measured leaves much less than the scatter, to first order."""
    row = np.flatnonzero(data.separated) if len(measured) > 1 else np.zeros(0, int)
    centre, width = np.zeros(data.size), np.ones(data.size)
    if not row.size:
        none = dict.fromkeys(measured, np.zeros(0))
        return Narrow(centre, width, row, none, none)
    at_point, slopes = _at_centre(experiment, data, measured, row)
    precision, pull = np.tile(np.eye(2), (row.size, 1, 1)), np.zeros((row.size, 2))
    for k, name in enumerate(measured):
        values, sd = (column[row] for column in data.observed[name])
        mask = np.isfinite(values - at_point.value[k])
        steep = np.where(mask, 1.0, 0.0)[:, None] * np.nan_to_num(slopes[k]) / sd[:, None]
        precision += steep[:, :, None] * steep[:, None]
        pull += steep * np.where(mask, (values - np.nan_to_num(at_point.value[k])) / sd, 0.0)[:, None]
    across = np.column_stack([-np.sin(direction[row]), np.cos(direction[row])])
    covariance = np.linalg.inv(precision)
    size = _ROOM * np.sqrt(np.einsum("ni,nij,nj->n", across, covariance, across))
    less = np.flatnonzero((size < _NARROW) & (at_point.outcome > 0))
    mean = np.einsum("ni,nij,nj->n", across, covariance, pull)
    centre[row[less]], width[row[less]] = np.clip(mean, -REACH, REACH)[less], size[less]
    spread = {name: np.linalg.norm(slopes[k][less], axis=1) for k, name in enumerate(measured)}
    return Narrow(centre, width, row[less], dict(zip(measured, at_point.value[:, less], strict=True)), spread)
