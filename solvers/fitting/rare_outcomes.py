"""The likelihood of rows whose observed outcome is rare: from the nearest impact that would have that outcome.

The integral over the scatter ends at `REACH` standard deviations. Where the observed outcome lies beyond, the integral
is zero and says nothing of how far beyond. Then the likelihood is the tail of the normal distribution from the nearest
change to the observed outcome on, times the density of what was measured about the results there.
"""

from dataclasses import replace

import numpy as np
from scipy.special import log_ndtr, ndtri

from ..boundaries.brackets import Changes, locate
from ..boundaries.experiment import Experiment
from ..boundaries.slopes import Lines, outcomes_along, slopes
from .measurements import Measurements
from .scatter import AT_ONCE, REACH, Resolution, ScatterLines

RARE = 1e-4
"""Probability within REACH below which the observed outcome is looked for beyond."""
_FADED = 1e-6  # probability below which the likelihood from the nearest change counts in full
_FARTHEST = 30.0
_PLACES = np.array([*np.arange(3.0, 8.0, 0.5), 8.5, 10.0, 12.5, 16.0, 20.0, 25.0, _FARTHEST])  # sampled along a line
_FADES = 16.0  # distance from which the likelihood falls to that of an outcome that is not found
_TURNS = np.pi / 4 * np.arange(4)  # of lines through the impact, from the row's direction
_BESIDE = 0.05  # beyond a change of outcome, in standard deviations: where its results are taken
_WORST = 1e3  # most that what was measured lowers the logarithm; as much as where the outcome is not found at all


def beyond_reach(
    experiment: Experiment, data: Measurements, rows: np.ndarray, direction: np.ndarray, measured: tuple[str, ...],
    resolution: Resolution, probability: np.ndarray, moves: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Log-likelihoods of rare rows, and their derivatives by the free entries.

    They fade in, from nothing to their full value, as the probability by the integral falls from RARE to a hundredth.

    Arguments:
        rows: the rare rows.
        direction: (rows of the data,), of their lines; the change is looked for in three other directions too.
        measured: names of the results.
        probability: of the rows, by the integral.
        moves: derivatives of its logarithm.
    """
    log, slope = _from_nearest_change(experiment, data, rows, direction, measured, resolution)
    span = float(np.log(RARE / _FADED))
    with np.errstate(divide="ignore"):
        step = np.clip(np.log(RARE / probability) / span, 0.0, 1.0)
        faded = log + np.log(step**2 * (3 - 2 * step))
    rate = np.where((step > 0) & (step < 1), 6 * (1 - step) / np.maximum(step * (3 - 2 * step), 1e-300), 0.0)
    return faded, slope - (rate / span)[:, None] * moves


def _from_nearest_change(
    experiment: Experiment, data: Measurements, rows: np.ndarray, direction: np.ndarray, measured: tuple[str, ...],
    resolution: Resolution,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """The likelihoods in full, as functions of the distance of the nearest change and of the results beyond it."""
    subset = data.subset(rows)
    both = ((subset.speed_sd > 0) & (subset.angle_sd > 0)).astype(int)
    fan = [ScatterLines.through(subset, direction[rows] + turn, both if turn else 1, _FARTHEST) for turn in _TURNS]
    columns = {
        name: np.concatenate([getattr(block, name) for block in fan]) for name in vars(fan[0]) if name != "relative"
    }
    of_part = columns["row"]
    lines = replace(fan[0], **columns | {"row": rows[of_part]})
    places = np.clip(np.concatenate([-_PLACES[::-1], _PLACES]), lines.low[:, None], lines.high[:, None])
    changes = locate(outcomes_along(experiment, lines), places, resolution.within, at_once=AT_ONCE)
    least = np.where(np.arange(of_part.size) < rows.size, -ndtri(RARE), REACH)  # no likelier than by the integral
    which = _nearest(changes, least, of_part, subset.allowed)
    line, y, at = changes.line[which], changes.place[which], of_part[changes.line[which]]
    log = np.full(rows.size, float(log_ndtr(-_FARTHEST))) - np.where(subset.separated, _WORST, 0.0)
    slope = np.zeros((rows.size, len(experiment.rows.names)))
    if not at.size:
        return log, slope
    sign, distance = np.where(y < 0, -1.0, 1.0), np.maximum(np.abs(y), least[line])
    log[at] = log_ndtr(-distance)
    moves = np.zeros((at.size, slope.shape[1]))
    if resolution.slopes:
        moves = np.nan_to_num(slopes(experiment, lines, changes.subset(which), resolution.approximate))
    hazard = np.exp(-(distance**2) / 2 - np.log(2 * np.pi) / 2 - log[at])
    slope[at] = -(np.where(distance > least[line], hazard, 0.0) * sign)[:, None] * moves
    misfit, by_free = _misfit(experiment, data, measured, lines, line, y + _BESIDE * sign, moves)
    # from _FADES on, the lack from the measured result grows to _WORST, as where the outcome is not found at all
    short = np.where(subset.separated[at], np.maximum(_WORST - misfit, 0.0), 0.0)
    way = np.clip((distance - _FADES) / (_FARTHEST - _FADES), 0.0, 1.0)
    share, rate = way**2 * (3 - 2 * way), 6 * way * (1 - way) / (_FARTHEST - _FADES) * sign
    log[at] -= np.minimum(misfit, _WORST) + share * short
    slope[at] -= np.where(misfit < _WORST, 1 - share, 0.0)[:, None] * by_free + (rate * short)[:, None] * moves
    return log, slope


def _nearest(changes: Changes, least: np.ndarray, rows: np.ndarray, allowed: np.ndarray) -> np.ndarray:
    """Of each row the change nearest to the centre beyond which the outcome agrees; none for rows without one.

    Arguments:
        least, rows: (lines,), least distance and row of each.
        allowed: (rows, outcomes).
    """
    up, row = changes.place > 0, rows[changes.line]
    outward, inward = np.where(up, changes.after, changes.before), np.where(up, changes.before, changes.after)
    agrees, agreed = ((outcome >= 0) & allowed[row, outcome] for outcome in (outward, inward))
    gained = np.flatnonzero(agrees & ~agreed)
    order = gained[np.argsort(np.maximum(np.abs(changes.place), least[changes.line])[gained], kind="stable")]
    return order[np.unique(row[order], return_index=True)[1]]


def _misfit(
    experiment: Experiment, data: Measurements, measured: tuple[str, ...], lines: Lines, line: np.ndarray,
    y: np.ndarray, moves: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Half the squared distance of what was measured from the results at places that move, and its slopes."""
    row = lines.row[line]
    half, slope = np.zeros(line.size), np.zeros(moves.shape)
    if not measured:
        return half, slope
    at_point = experiment.results(measured, row, *lines.at(line, y))
    by_speed, by_angle = lines.slopes(line, y)
    for k, name in enumerate(measured):
        values, sd = (column[row] for column in data.observed[name])
        mask = np.isfinite(values) & np.isfinite(at_point.value[k]) & data.separated[row]
        pull = np.where(mask, (values - np.nan_to_num(at_point.value[k])) / sd, 0.0)
        by_y = at_point.speed[k] * by_speed + at_point.angle[k] * by_angle
        half += pull**2 / 2
        slope[mask] -= ((pull / sd)[:, None] * (at_point.free[k] + by_y[:, None] * moves))[mask]
    return half, slope
