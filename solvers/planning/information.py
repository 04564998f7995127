"""The Fisher information of planned impacts: the covariance of the score of the fit's likelihood.

An impact is seen as its outcome and, if it separates, its restitution with noise. With the scatter integrated out, the
probability of outcome k is p_k, and a separated one has the density f_k(e) of the measured restitution; both depend on
the free entries. The outcome tells the sum of p_k' p_k'^T/p_k. If it is known, the restitution tells in addition, for
every separated outcome, the integral of f_k' f_k'^T/f_k over e less p_k' p_k'^T/p_k. Lines, changes of outcome and
interpolation along the lines are those of the likelihood, so f_k is a sum of normal densities at the points of its
quadrature, with exact derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...generated.automaton import OUTCOMES, STICK
from ..fitting import changes as boundaries
from ..fitting.interpolation import segment_map
from ..fitting.law import BoundLaw
from ..fitting.likelihood import NEGLIGIBLE, Likelihood, Resolution
from ..fitting.lines import Lines
from ..fitting.measurements import Measurements
from ..fitting.segments import Segments, moving_ends
from ..scene.scene import Scene
from ..settings import RTOL
from .density import Curve, information_of
from .directions import directions

FINE = Resolution(points=64)
FINEST = Resolution(lines=9, points=128), Resolution(lines=6, points=128)
# with more lines, some would lie where impacts graze
_STICK = OUTCOMES.index(STICK)
_NOISE = "restitution"


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
    """The Fisher information of each planned impact.

    Arguments:
        names, values: the free entries.
        plan: impacts with their scatter, all other entries the scene's; of `observed` the standard deviation of the
            restitution counts, NaN where it is not measured.
        resolution: of the integrals over the scatter.

    Raises:
        InputError: values that no scene may have.
    """
    law = Likelihood(scene, names, plan, rtol).bound(values)
    lines = Lines.of(plan, directions(law, plan), np.full(plan.size, resolution.lines))
    found = boundaries.locate(law, lines, resolution.grid, resolution.within)
    size = plan.size
    noise = plan.observed[_NOISE][1] if _NOISE in plan.observed else np.full(size, np.nan)
    segments, _ = Segments.of(lines, found, np.ones((size, len(OUTCOMES)), bool))
    kind = np.where(segments.from_change, np.append(found.after, 0)[segments.first], found.first[segments.line])
    mass = segments.mass()
    ends = moving_ends(law, lines, found, segments, mass > NEGLIGIBLE, resolution.quick)
    share = segments.weight * mass
    probability = np.zeros((size, len(OUTCOMES)))
    slopes = np.zeros((*probability.shape, len(names)))
    np.add.at(probability, (segments.row, kind), share)
    np.add.at(slopes, (segments.row, kind), share[:, None] * segments.mass_slopes(ends))
    given_outcome = np.zeros((size, len(names), len(names)))
    dense = np.flatnonzero((mass > NEGLIGIBLE) & (kind != _STICK) & np.isfinite(noise[segments.row]))
    counts = np.bincount(lines.row, minlength=size)
    for (row, _), curves in _curves(law, lines, segments, kind, ends, dense, resolution).items():
        given_outcome[row] += information_of(curves, int(counts[row]), float(noise[row]), resolution.points)
    outer = slopes[..., :, None] * slopes[..., None, :]
    single = np.where(probability[..., None, None] > NEGLIGIBLE, outer, 0.0)
    single /= np.maximum(probability, NEGLIGIBLE)[..., None, None]
    outcome = single.sum(axis=1)
    return Information(outcome + given_outcome, outcome, probability)


def sure_information(
    scene: Scene, names: tuple[str, ...], values: np.ndarray, plan: Measurements, rtol: float = RTOL
) -> Information:
    """The same by two finer quadratures, of which the one counts that finds less in an impact.

    Where they differ, changes of outcome meet or impacts graze, and errors of a quadrature look like information.
    """
    one, other = (information(scene, names, values, plan, rtol, each) for each in FINEST)
    scale = values**2
    less = (np.einsum("cii,i->c", other.total, scale) < np.einsum("cii,i->c", one.total, scale))[:, None]
    return Information(
        np.where(less[..., None], other.total, one.total),
        np.where(less[..., None], other.outcome, one.outcome),
        np.where(less, other.probability, one.probability),
    )


def _curves(
    law: BoundLaw,
    lines: Lines,
    segments: Segments,
    outcome: np.ndarray,
    ends: tuple[np.ndarray, np.ndarray],
    which: np.ndarray,
    resolution: Resolution,
) -> dict[tuple[int, int], list[Curve]]:
    """Row and outcome -> the restitution on those of their segments that are among `which`."""
    kinds = (segments.from_change[which] + 2 * segments.to_change[which]).tolist()
    counts = [resolution.nodes * 3 // 2 if kind else resolution.nodes for kind in kinds]
    if not counts:
        return {}
    nodes = [segment_map(kind, count, resolution.points).at_nodes for kind, count in zip(kinds, counts, strict=True)]
    g, segment = np.concatenate(nodes), np.repeat(which, counts)
    line, y = segments.line[segment], segments.low[segment] + (segments.high - segments.low)[segment] * g
    found = law.results((_NOISE,), lines.row[line], *lines.at(line, y))
    by_speed, by_angle = lines.slopes(line, y)
    by_y = found.speed[0] * by_speed + found.angle[0] * by_angle
    slope = found.free[0] + by_y[:, None] * (ends[0][segment] * (1 - g)[:, None] + ends[1][segment] * g[:, None])
    curves: dict[tuple[int, int], list[Curve]] = {}
    first_line = np.searchsorted(lines.row, segments.row)
    first = 0
    for k, kind, count in zip(which.tolist(), kinds, counts, strict=True):
        own = slice(first, first + count)
        first += count
        if np.isfinite(found.value[0, own]).all():  # every trajectory on the way was completed
            span = np.array([segments.low[k], segments.high[k]]), np.stack([ends[0][k], ends[1][k]])
            number = int(segments.line[k] - first_line[k])
            curve = Curve(kind, count, number, *span, found.value[0, own], slope[own])
            curves.setdefault((int(segments.row[k]), int(outcome[k])), []).append(curve)
    return curves
