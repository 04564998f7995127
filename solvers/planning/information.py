"""The Fisher information of planned impacts: the covariance of the score of the fit's likelihood.

An impact is seen as its outcome and, if it separates, its restitution with noise. With the scatter integrated out, the
probability of outcome k is p_k, and a separated one has the density f_k(e) of the measured restitution; both depend on
the free entries. The outcome tells the sum of p_k' p_k'^T/p_k. If it is known, the restitution tells in addition, for
every separated outcome, the integral of f_k' f_k'^T/f_k over e less p_k' p_k'^T/p_k. Lines, changes of outcome and
interpolation along the lines are those of the likelihood, so f_k is a sum of normal densities at the points of its
quadrature, with exact derivatives.
"""

from dataclasses import dataclass, replace

import numpy as np

from ...generated.automaton import OUTCOMES, STICK
from ..changes.experiment import Experiment
from ..engines.settings import RTOL
from ..fitting.likelihood import NEGLIGIBLE, Likelihood
from ..fitting.measurements import Measurements
from ..fitting.scatter import Resolution, ScatterLines, Segments, nearest_normals
from ..scene.scene import Scene
from .density import Curve, information_of
from .window import RESTITUTION

FINE = Resolution(points=64)
FINEST = Resolution(lines=9, points=128), Resolution(lines=6, points=128)
# with more lines, some would lie where impacts graze
_STICK = OUTCOMES.index(STICK)
_NEAR = 4.0  # standard deviations within which a boundary turns the lines
_TRIED = 36  # directions of the lines


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
    scene: Scene,
    names: tuple[str, ...],
    values: np.ndarray,
    plan: Measurements,
    rtol: float = RTOL,
    resolution: Resolution = FINE,
) -> Information:
    """The Fisher information of each planned impact; InputError for values that no scene may have.

    Arguments:
        names, values: the free entries.
        plan: impacts with their scatter, all other entries the scene's; of `observed` the standard deviation of the
            restitution counts, NaN where it is not measured.
        resolution: of the integrals over the scatter.
    """
    experiment, size = Likelihood(scene, names, plan, rtol).experiment_at(values), plan.size
    lines = ScatterLines.through(plan, _directions(experiment, plan), resolution.lines)
    changes = lines.changes(experiment, resolution)
    segments = Segments.between(lines, changes)
    segments = segments.part(segments.outcome >= 0)
    mass = segments.mass()
    ends = segments.moving_ends(experiment, lines, changes, mass > NEGLIGIBLE, resolution.approximate)
    share = segments.weight * mass
    probability = np.zeros((size, len(OUTCOMES)))
    slopes = np.zeros((*probability.shape, len(names)))
    np.add.at(probability, (segments.row, segments.outcome), share)
    np.add.at(slopes, (segments.row, segments.outcome), share[:, None] * segments.mass_slopes(ends))
    by_restitution = np.zeros((size, len(names), len(names)))
    noise = plan.observed[RESTITUTION][1] if RESTITUTION in plan.observed else np.full(size, np.nan)
    dense = (mass > NEGLIGIBLE) & (segments.outcome != _STICK) & np.isfinite(noise[segments.row])
    counts = np.bincount(lines.row, minlength=size)
    curves = _curves(experiment, lines, segments.part(dense), ends[:, dense], resolution)
    for (row, _), row_curves in curves.items():
        by_restitution[row] += information_of(row_curves, int(counts[row]), float(noise[row]), resolution.points)
    outer = slopes[..., :, None] * slopes[..., None, :]
    single = np.where(probability[..., None, None] > NEGLIGIBLE, outer, 0.0)
    outcome = (single / np.maximum(probability, NEGLIGIBLE)[..., None, None]).sum(axis=1)
    return Information(outcome + by_restitution, outcome, probability)


def reliable_information(
    scene: Scene, names: tuple[str, ...], values: np.ndarray, plan: Measurements, rtol: float = RTOL
) -> Information:
    """The same by two finer quadratures: for each impact the smaller of the two.

    Where they differ, changes of outcome meet or impacts graze, and errors of a quadrature look like information.
    """
    one, other = (information(scene, names, values, plan, rtol, each) for each in FINEST)
    scale = values**2
    less = np.einsum("cii,i->c", other.total, scale) < np.einsum("cii,i->c", one.total, scale)
    pairs = zip(vars(one).values(), vars(other).values(), strict=True)
    return Information(*(np.where(less.reshape(-1, *[1] * (a.ndim - 1)), b, a) for a, b in pairs))


def _directions(experiment: Experiment, plan: Measurements) -> np.ndarray:
    """Of each impact the direction of its lines, from the axis of speeds to that of angles in standard deviations.

    A line that is nearly parallel to a boundary gives its probability badly. Where one boundary is near, the lines go
    across it; where several meet, between their normals.
    """
    if not ((plan.speed_sd > 0) & (plan.angle_sd > 0)).any():
        return np.zeros(plan.size)
    distance, normal = nearest_normals(experiment, plan)
    near = distance < _NEAR
    tried = np.pi * np.arange(_TRIED) / _TRIED
    cosine = np.abs(normal @ np.stack([np.cos(tried), np.sin(tried)]))
    worst = np.where(near[..., None], cosine, 1.0).min(axis=1)
    return np.where(near.any(axis=1), tried[worst.argmax(axis=1)], 0.0)


def _curves(
    experiment: Experiment, lines: ScatterLines, segments: Segments, ends: np.ndarray, resolution: Resolution
) -> dict[tuple[int, int], list[Curve]]:
    """Row and outcome -> the restitution on the segments, line by line; without those that were not completed."""
    number = segments.line - np.searchsorted(lines.row, segments.row)
    every: dict[int, Curve] = {}
    exact = replace(resolution, approximate=False)
    for which, mapping, value, slope in segments.results(experiment, lines, ends, (RESTITUTION,), exact):
        for j, k in enumerate(which.tolist()):
            if np.isfinite(value[0, j]).all():
                span = np.array([segments.low[k], segments.high[k]])
                every[k] = Curve(
                    int(segments.kind[k]), mapping.at_nodes.size, int(number[k]), span, ends[:, k],
                    value[0, j], slope[0, j],
                )  # fmt: skip
    curves: dict[tuple[int, int], list[Curve]] = {}
    for k in sorted(every):
        curves.setdefault((int(segments.row[k]), int(segments.outcome[k])), []).append(every[k])
    return curves
