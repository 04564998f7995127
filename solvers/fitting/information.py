"""The Fisher information of planned impacts, by the moments of what a fit is told.

An impact is seen as its outcome k and, if it separates, its restitution e with noise. The expectations of functions of
both, q_j(e) where the outcome is k, have exact derivatives m' by the free entries: the lines through the scatter, their
changes of outcome and the results along them are those of the likelihood. With G = E[q_i q_j] the information is
m'^T G^-1 m', the part of the score that such functions tell. Of a stick q is 1 alone: p' p'^T/p. Of other outcomes
they are polynomials of e; the noise in them is integrated exactly. More of them tell more, and none ever more than
there is.
"""

from collections.abc import Iterable, Iterator

import numpy as np

from ...generated.automaton import OUTCOMES, STICK
from ..boundaries.experiment import Experiment
from ..engines.settings import RTOL
from ..scene.scene import Scene
from .design_window import RESTITUTION
from .likelihood import NEGLIGIBLE, Likelihood
from .measurements import Measurements
from .scatter import Resolution, ScatterLines, Segments, hermite

_QUADRATURES = Resolution(lines=5, points=32), Resolution(lines=6, points=32)
# with more lines, some would lie where impacts graze; with fewer, degrees are too low to find the best plan
_DEGREE = 12  # of the polynomials of the restitution, where there is one line; else less than the number of lines, up
# to which the rule across them is exact


def information(
    scene: Scene, names: tuple[str, ...], values: np.ndarray, plan: Measurements, rtol: float = RTOL
) -> tuple[np.ndarray, np.ndarray]:
    """The Fisher information of each planned impact, by the free entries' values, and the probability of each outcome.

    By two quadratures over the scatter: of each impact the smaller. Where they differ, changes of outcome meet or
    impacts graze, and errors of a quadrature look like information.

    Arguments:
        names, values: the free entries.
        plan: impacts with their scatter, all other entries the scene's; of `observed` the standard deviation of the
            restitution counts, without which the outcome alone is seen.

    Returns:
        (impacts, free entries, free entries) and (impacts, outcomes).

    Raises:
        InputError: values that no scene may have.
    """
    likelihood, scale = Likelihood(scene, names, plan, rtol), values**2
    experiment = likelihood.experiment_at(values)
    likelihood.aim(values)
    total, probability = map(
        np.stack, zip(*(_integrated(experiment, plan, likelihood.direction, order) for order in _QUADRATURES))
    )
    first, other = np.einsum("kcii,i->kc", total, scale)
    less = (other < first).astype(int), np.arange(plan.size)
    return total[less], probability[less]


def _integrated(
    experiment: Experiment, plan: Measurements, direction: np.ndarray, resolution: Resolution
) -> tuple[np.ndarray, np.ndarray]:
    size, entries = plan.size, len(experiment.rows.names)
    lines = ScatterLines.through(plan, direction, resolution.lines)
    changes = lines.changes(experiment, resolution)
    segments = Segments.between(lines, changes)
    segments = segments.subset(segments.outcome >= 0)
    mass = segments.mass()
    ends = segments.moving_ends(experiment, lines, changes, mass > NEGLIGIBLE, resolution)
    share = segments.weight * mass
    probability = np.zeros((size, len(OUTCOMES)))
    slopes = np.zeros((*probability.shape, entries))
    np.add.at(probability, (segments.row, segments.outcome), share)
    np.add.at(slopes, (segments.row, segments.outcome), share[:, None] * segments.mass_slopes(ends))
    outer = slopes[..., :, None] * slopes[..., None, :]
    single = np.where(probability[..., None, None] > NEGLIGIBLE, outer, 0.0)
    total = (single / np.maximum(probability, NEGLIGIBLE)[..., None, None]).sum(axis=1)
    if RESTITUTION in plan.observed:
        dense = (mass > NEGLIGIBLE) & (segments.outcome != OUTCOMES.index(STICK))
        noise, counts = plan.observed[RESTITUTION][1], np.bincount(lines.row, minlength=size)
        for row, points in _points(experiment, lines, segments.subset(dense), ends[:, dense], resolution):
            degree = _DEGREE if counts[row] == 1 else min(_DEGREE, int(counts[row]) - 1)
            total[row] += _beyond_outcome(points, float(noise[row]), degree)
    return total, probability


def _points(
    experiment: Experiment, lines: ScatterLines, segments: Segments, ends: np.ndarray, resolution: Resolution
) -> Iterator[tuple[int, Iterable[np.ndarray]]]:
    """Of each row and outcome the points of the scatter: weights, derivatives of their logarithms, restitutions and
    their derivatives; without trajectories that were not completed.
    """
    blocks = []
    for which, mapping, value, slope in segments.results(experiment, lines, ends, (RESTITUTION,), resolution):
        completed = np.isfinite(value[0]).all(axis=1)
        which, value, slope, g = which[completed], value[0, completed], slope[0, completed], mapping.at_points
        low, high = ends[:, which, None]
        length = np.maximum(segments.high - segments.low, 1e-12)[which, None]
        y = segments.low[which, None] + length * g
        density = np.exp(-(y**2) / 2) / np.sqrt(2 * np.pi)
        moves = low * (1 - g)[:, None] + high * g[:, None]
        blocks.append((
            3 * segments.row[which] + segments.outcome[which],
            segments.weight[which, None] * length * mapping.rate * mapping.weight * density,
            (high - low) / length[..., None] - y[..., None] * moves,
            (mapping.interpolate @ value[..., None])[..., 0],
            mapping.interpolate @ slope,
        ))  # fmt: skip
    key, *columns = map(np.concatenate, zip(*blocks, strict=True)) if blocks else [np.zeros(0, int)]
    for of in dict.fromkeys(key.tolist()):
        yield of // 3, (np.concatenate(column[key == of]) for column in columns)


def _beyond_outcome(points: Iterable[np.ndarray], noise: float, degree: int) -> np.ndarray:
    """What polynomials of the measured restitution tell if the outcome is known: (free entries, free entries)."""
    (weight, log_slope, value, slope), (t, share) = points, hermite(degree + 1)
    weights = np.outer(weight, share).ravel()
    measured = (value[:, None] + noise * t).ravel()
    centre = np.average(measured, weights=weights)
    scale = np.sqrt(np.average((measured - centre) ** 2, weights=weights))
    q = np.polynomial.hermite_e.hermevander((measured - centre) / scale, degree)
    rate = np.pad(q[:, :-1] * np.arange(1, degree + 1), ((0, 0), (1, 0))) / scale
    of_weight, of_value = (np.repeat(array, t.size, axis=0) for array in (log_slope, slope))
    moments = (weights[:, None] * q).T @ of_weight + (weights[:, None] * rate).T @ of_value
    factor = np.asarray(np.linalg.qr(np.sqrt(weights)[:, None] * q, mode="r"))
    told = np.linalg.solve(factor.T, moments)[1:]  # without the constant, which is the outcome
    information: np.ndarray = told.T @ told
    return information
