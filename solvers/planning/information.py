"""The Fisher information of planned impacts, by the moments of what a fit is told.

An impact is seen as its outcome k and, if it separates, its restitution e with noise. The expectations of functions of
both, q_j(e) where the outcome is k, have exact derivatives m' by the free entries: the lines through the scatter, their
changes of outcome and the results along them are those of the likelihood. With G = E[q_i q_j] the information is
m'^T G^-1 m', the part of the score that such functions tell. Of a stick q is 1 alone: p' p'^T/p. Of other outcomes
they are polynomials of e; the noise in them is integrated exactly. More of them tell more, and none ever more than
there is.
"""

from dataclasses import dataclass

import numpy as np

from ...generated.automaton import OUTCOMES, STICK
from ..changes.experiment import Experiment
from ..engines.settings import RTOL
from ..fitting.likelihood import NEGLIGIBLE, Likelihood
from ..fitting.measurements import Measurements
from ..fitting.scatter import Resolution, ScatterLines, Segments
from ..scene.scene import Scene
from .window import RESTITUTION

_QUADRATURES = Resolution(lines=5, points=32), Resolution(lines=6, points=32)
# with more lines, some would lie where impacts graze; with fewer, degrees are too low to find the best plan
_DEGREE = 12  # of the polynomials of the restitution, where there is one line; else less than the number of lines, up
# to which the rule across them is exact


@dataclass(frozen=True)
class Information:
    """Information of single impacts, by the free entries' values.

    Attributes:
        total: (impacts, free entries, free entries), of outcome and restitution.
        outcome: the same, of the outcome alone.
        probability: (impacts, outcomes).
    """

    total: np.ndarray
    outcome: np.ndarray
    probability: np.ndarray


def information(
    scene: Scene, names: tuple[str, ...], values: np.ndarray, plan: Measurements, rtol: float = RTOL
) -> Information:
    """The Fisher information of each planned impact; InputError for values that no scene may have.

    By two quadratures over the scatter: of each impact the smaller. Where they differ, changes of outcome meet or
    impacts graze, and errors of a quadrature look like information.

    Arguments:
        names, values: the free entries.
        plan: impacts with their scatter, all other entries the scene's; of `observed` the standard deviation of the
            restitution counts, NaN where it is not measured.
    """
    likelihood, scale = Likelihood(scene, names, plan, rtol), values**2
    experiment = likelihood.experiment_at(values)
    likelihood.aim(values)
    first, other = (_integrated(experiment, plan, likelihood.direction, order) for order in _QUADRATURES)
    less = np.einsum("cii,i->c", other.total, scale) < np.einsum("cii,i->c", first.total, scale)
    pairs = zip(vars(first).values(), vars(other).values(), strict=True)
    return Information(*(np.where(less.reshape(-1, *[1] * (a.ndim - 1)), b, a) for a, b in pairs))


def _integrated(
    experiment: Experiment, plan: Measurements, direction: np.ndarray, resolution: Resolution
) -> Information:
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
    outcome = (single / np.maximum(probability, NEGLIGIBLE)[..., None, None]).sum(axis=1)
    total = outcome.copy()
    noise = plan.observed[RESTITUTION][1] if RESTITUTION in plan.observed else np.full(size, np.nan)
    dense = (mass > NEGLIGIBLE) & (segments.outcome != OUTCOMES.index(STICK)) & np.isfinite(noise[segments.row])
    counts = np.bincount(lines.row, minlength=size)
    for row, points in _points(experiment, lines, segments.subset(dense), ends[:, dense], resolution):
        degree = _DEGREE if counts[row] == 1 else min(_DEGREE, int(counts[row]) - 1)
        total[row] += _beyond_outcome(*points, float(noise[row]), degree)
    return Information(total, outcome, probability)


# weights, derivatives of their logarithms, restitutions, derivatives
_Points = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def _points(
    experiment: Experiment, lines: ScatterLines, segments: Segments, ends: np.ndarray, resolution: Resolution
) -> list[tuple[int, _Points]]:
    """Row and points of the scatter, for each of its outcomes; without trajectories that were not completed."""
    parts: dict[tuple[int, int], list[_Points]] = {}
    for which, mapping, value, slope in segments.results(experiment, lines, ends, (RESTITUTION,), resolution):
        g = mapping.at_points
        for j, k in enumerate(which.tolist()):
            if np.isfinite(value[0, j]).all():
                length = max(segments.high[k] - segments.low[k], 1e-12)
                y, (low, high) = segments.low[k] + length * g, ends[:, k]
                density = np.exp(-(y**2) / 2) / np.sqrt(2 * np.pi)
                weight = segments.weight[k] * length * mapping.rate * mapping.weight * density
                moves = np.outer(1 - g, low) + np.outer(g, high)
                points = (
                    weight, (high - low) / length - y[:, None] * moves,
                    mapping.interpolate @ value[0, j], mapping.interpolate @ slope[0, j],
                )  # fmt: skip
                parts.setdefault((int(segments.row[k]), int(segments.outcome[k])), []).append(points)
    return [(row, tuple(map(np.concatenate, zip(*data, strict=True)))) for (row, _), data in parts.items()]  # type: ignore[misc]


def _beyond_outcome(
    weight: np.ndarray, log_slope: np.ndarray, value: np.ndarray, slope: np.ndarray, noise: float, degree: int
) -> np.ndarray:
    """What polynomials of the measured restitution tell if the outcome is known: (free entries, free entries)."""
    t, share = np.polynomial.hermite_e.hermegauss(degree + 1)
    weights = np.outer(weight, share / share.sum()).ravel()
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
