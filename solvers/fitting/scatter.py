"""Integrals over the scatter of single impacts: lines through it, and their segments between changes of outcome.

In units of the standard deviations the scatter of an impact in speed and angle is the same in all directions. Lines
cross the changes (`directions`); across the lines a few Gauss-Hermite nodes are enough. Between two changes of outcome
along a line the results are smooth, and are interpolated.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.special import ndtr

from ..boundaries.brackets import Brackets, Changes, locate
from ..boundaries.experiment import Experiment, Results
from ..boundaries.slopes import Lines, normals, outcomes_along, slopes
from ..engines.settings import KERNEL_STEPS
from .interpolation import SegmentMap, extension, segment_map
from .measurements import Measurements

REACH = 5.0  # standard deviations to either side within which an integral is taken
_LOOSER = 30.0  # most by which that grows with the distance from the centre: rare outcomes lie there
AT_ONCE = 200  # samples of a round that take little longer than one
_SLOWEST = 1e-3  # least speed of a scattered impact, over the nominal one
_STEEPEST = np.radians(89.4)
_OUTCOMES = 3
_SHORT = 1000  # steps of a trajectory with derivatives, beyond which others' on the same segment stand for them
_DEGREE = 4  # of the polynomial by which they do


@dataclass(frozen=True)
class Resolution:
    """How finely the scatter is integrated.

    Arguments:
        lines: lines through the scatter of a row.
        nodes: collisions on a segment; half as many more where it ends at a change.
        points: of the quadrature over the interpolated results.
        grid: points of a line at which the outcome is sampled first.
        approximate: derivatives beside slow saddles are approximate: of changes to 1e-4, of results those that their
            neighbours suggest.
        within: error of a probability from the place of a change.
        slopes: derivatives by the free entries are computed, else 0.
    """

    lines: int = 3
    nodes: int = 8
    points: int = 128
    grid: int = 15
    approximate: bool = True
    within: float = 1e-5
    slopes: bool = True

    @property
    def values(self) -> Resolution:
        """The same without derivatives."""
        return replace(self, slopes=False)

    def doubled(self) -> Resolution:
        """The same, twice as fine."""
        sizes = {name: 2 * getattr(self, name) for name in ("nodes", "points", "grid")}
        return replace(self, lines=2 * self.lines + 1, **sizes, within=self.within / 100)


COARSE = Resolution(1, 4, 64, 11, within=1e-3)
EXACT = Resolution(approximate=False, within=1e-10)


@lru_cache(maxsize=16)
def hermite(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of the mean over a standard normal variable."""
    nodes, weights = np.polynomial.hermite_e.hermegauss(count)
    return nodes, weights / weights.sum()


@dataclass(frozen=True)
class ScatterLines(Lines):
    """Lines through the scatter of rows; y is in standard deviations.

    Attributes:
        weight: of each line in the mean over its row, over the probability of a possible impact on it.
        share: the same, as parts of the weights of the row's lines.
    """

    weight: np.ndarray
    share: np.ndarray

    @classmethod
    def through(
        cls, data: Measurements, direction: np.ndarray | float, counts: np.ndarray | int, reach: float = REACH,
        centre: np.ndarray | float = 0.0, width: np.ndarray | float = 1.0,
    ) -> ScatterLines:  # fmt: skip
        """The lines of all rows.

        Arguments:
            direction: angle from the axis of speeds to that of angles, both in standard deviations, for all rows or
                for each.
            counts: number of lines, likewise, 0 to leave a row out; one at most where a row scatters in speed or angle
                alone.
            centre, width: where across the lines most of an integrand is, for each row, in standard deviations.
        """
        alone = (data.speed_sd == 0) | (data.angle_sd == 0)
        direction = np.where(data.speed_sd == 0, np.pi / 2, np.where(data.angle_sd == 0, 0.0, direction))
        counts = np.where(alone, np.minimum(counts, 1), counts)
        row = np.repeat(np.arange(data.size), counts)
        nodes, weights = (np.concatenate([hermite(int(n))[k] for n in counts if n] or [np.zeros(0)]) for k in (0, 1))
        size = np.broadcast_to(width, data.size)[row]
        at_nodes = np.broadcast_to(centre, data.size)[row] + size * nodes
        weights = weights * size * np.exp((nodes**2 - at_nodes**2) / 2)
        nodes = at_nodes
        c, s = np.cos(direction[row]), np.sin(direction[row])
        speed = np.column_stack([data.speed[row] - data.speed_sd[row] * s * nodes, data.speed_sd[row] * c])
        angle = np.column_stack([data.angle[row] + data.angle_sd[row] * c * nodes, data.angle_sd[row] * s])
        low, high = np.full(row.size, -reach), np.full(row.size, reach)
        for at, least, most in ((speed, _SLOWEST * data.speed[row], np.inf), (angle, -_STEEPEST, _STEEPEST)):
            with np.errstate(divide="ignore", invalid="ignore"):
                ends = np.sort([(limit - at[:, 0]) / at[:, 1] for limit in (least, most)], axis=0)
            moves = at[:, 1] != 0
            low, high = np.where(moves, np.fmax(low, ends[0]), low), np.where(moves, np.fmin(high, ends[1]), high)
        low, high = np.minimum(low, 0.0), np.maximum(high, 0.0)
        weights = weights / (ndtr(high) - ndtr(low))
        share = weights / np.bincount(row, weights * (ndtr(high) - ndtr(low)), data.size)[row]
        return cls(row, speed, angle, low, high, data.relative, weights, share)

    def changes(self, experiment: Experiment, resolution: Resolution) -> Changes:
        """The changes of outcome on the lines."""

        def width(brackets: Brackets) -> np.ndarray:
            inside = (brackets.low < 0) & (brackets.high > 0)
            nearest = np.where(inside, 0.0, np.minimum(np.abs(brackets.low), np.abs(brackets.high)))
            return np.asarray(resolution.within * np.minimum(np.exp(nearest**2 / 2), _LOOSER))

        places = self.low[:, None] + (self.high - self.low)[:, None] * np.linspace(0, 1, resolution.grid)
        return locate(outcomes_along(experiment, self), places, width, at_once=AT_ONCE)


def nearest_normals(experiment: Experiment, data: Measurements) -> tuple[np.ndarray, np.ndarray]:
    """Of each row and pair of outcomes the nearest boundary between them, in standard deviations.

    Returns:
        Distances (rows, 3), infinite without such a boundary, along the speed or the angle; and unit normals
        (rows, 3, 2).
    """
    normal = np.full((data.size, _OUTCOMES, 2), np.nan)  # by the pair of outcomes, which their sum names
    distance = np.full((data.size, _OUTCOMES), np.inf)
    for across in (0.0, np.pi / 2):
        lines = ScatterLines.through(data, across, 1)
        changes = lines.changes(experiment, Resolution(within=1e-3))
        changes_row, pair, away = lines.row[changes.line], changes.before + changes.after - 1, np.abs(changes.place)
        closer = (changes.before >= 0) & (changes.after >= 0) & (away < distance[changes_row, pair])
        order = np.flatnonzero(closer)[np.argsort(away[closer])]
        which = order[np.unique(changes_row[order] * _OUTCOMES + pair[order], return_index=True)[1]]
        if not which.size:
            continue
        normal_of = normals(experiment, lines, changes.subset(which), approximate=True)
        row, line, place = changes_row[which], changes.line[which], changes.place[which]
        unit = in_deviations(data, row, *lines.at(line, place), normal_of.speed, normal_of.angle)
        with np.errstate(invalid="ignore", divide="ignore"):
            unit /= np.linalg.norm(unit, axis=1, keepdims=True)
        unit[~np.isfinite(unit).all(axis=1)] = np.cos(across), np.sin(across)
        distance[row, pair[which]], normal[row, pair[which]] = away[which], unit
    return distance, normal


def in_deviations(
    data: Measurements,
    row: np.ndarray,
    speed: np.ndarray,
    angle: np.ndarray,
    by_speed: np.ndarray,
    by_angle: np.ndarray,
) -> np.ndarray:
    """Derivatives by normal speed and angle at impacts on rows, per standard deviation of the measured ones: (n, 2)."""
    if data.relative:
        by_angle = by_angle - by_speed * speed * np.tan(angle)
        by_speed = by_speed * np.cos(angle)
    return np.column_stack([by_speed * data.speed_sd[row], by_angle * data.angle_sd[row]])


@dataclass(frozen=True)
class Segments:
    """Parts of lines with one outcome.

    Attributes:
        outcome: -1 where it is not decided.
        low, high: the ends, within the errors of the changes so that the outcome is certain.
        first, last: the changes at their ends; -1 at the end of a line.
    """

    line: np.ndarray
    row: np.ndarray
    weight: np.ndarray
    share: np.ndarray
    outcome: np.ndarray
    low: np.ndarray
    high: np.ndarray
    first: np.ndarray
    last: np.ndarray

    @classmethod
    def between(cls, lines: ScatterLines, changes: Changes) -> Segments:
        """All segments of the lines."""
        line, outcome, first, last = changes.pieces()
        upper, lower = np.append(changes.high, 0.0), np.append(changes.low, 0.0)
        low = np.where(first < 0, lines.low[line], upper[first])
        high = np.where(last < 0, lines.high[line], lower[last])
        segments = cls(line, lines.row[line], lines.weight[line], lines.share[line], outcome, low, high, first, last)
        return segments.subset(high > low)

    def subset(self, which: np.ndarray) -> Segments:
        return Segments(*(values[which] for values in vars(self).values()))

    @property
    def kind(self) -> np.ndarray:
        """Of the `segment_map`: 1 if the lower end is a change, 2 if the upper end is, 3 if both are."""
        return np.asarray((self.first >= 0) + 2 * (self.last >= 0))

    def mass(self) -> np.ndarray:
        """Probability of the scatter within each."""
        flip = self.low > 0  # the difference of two small numbers, not of two near one
        return np.asarray(np.where(flip, ndtr(-self.low) - ndtr(-self.high), ndtr(self.high) - ndtr(self.low)))

    def mass_slopes(self, ends: np.ndarray) -> np.ndarray:
        """Derivatives of the logarithm of `mass`, from those of the ends."""
        mass = np.maximum(self.mass(), 1e-300)
        density = [np.exp(-(end**2) / 2) / np.sqrt(2 * np.pi) / mass for end in (self.low, self.high)]
        return np.asarray(density[1][:, None] * ends[1] - density[0][:, None] * ends[0])

    def moving_ends(
        self, experiment: Experiment, lines: Lines, changes: Changes, which: np.ndarray, resolution: Resolution
    ) -> np.ndarray:
        """Derivatives of the ends by the free entries, (2, segments, free entries).

        Arguments:
            which: mask of the segments whose ends are needed.
        """
        needed = np.unique(np.concatenate([self.first[which], self.last[which]]))
        needed = needed[needed >= 0]
        by_free = np.zeros((changes.size + 1, len(experiment.rows.names)))  # the last for ends that stay
        if needed.size and resolution.slopes:
            by_free[needed] = np.nan_to_num(slopes(experiment, lines, changes.subset(needed), resolution.approximate))
        return np.asarray(by_free[np.stack([self.first, self.last])])

    def results(
        self, experiment: Experiment, lines: Lines, ends: np.ndarray, names: tuple[str, ...], resolution: Resolution
    ) -> Iterator[tuple[np.ndarray, SegmentMap, np.ndarray, np.ndarray]]:
        """Results along the segments, for those of each `kind`; `ends` are those of `moving_ends`.

        Yields:
            Indices of the segments, their map, the results at its nodes (results, segments, nodes), and their
            derivatives by the free entries where the nodes move with the ends (results, segments, nodes, free entries).
        """
        kinds = [(kind, np.flatnonzero(self.kind == kind)) for kind in range(4)]
        nodes, points = resolution.nodes, resolution.points
        maps = [(which, segment_map(k, nodes * 3 // 2 if k else nodes, points)) for k, which in kinds if which.size]
        if not maps:
            return
        at = [self.low[w, None] + (self.high - self.low)[w, None] * mapping.at_nodes for w, mapping in maps]
        y = np.concatenate([places.ravel() for places in at])
        line = np.concatenate([np.repeat(self.line[w], mapping.at_nodes.size) for w, mapping in maps])
        row, impacts = lines.row[line], lines.at(line, y)
        at_nodes = _at_nodes(experiment, names, row, impacts, resolution)
        by_speed, by_angle = lines.slopes(line, y)
        by_y = at_nodes.speed * by_speed + at_nodes.angle * by_angle
        first = 0
        for which, mapping in maps:
            span, g = slice(first, first + which.size * mapping.at_nodes.size), mapping.at_nodes[:, None]
            first, shape = span.stop, (len(names), which.size, mapping.at_nodes.size)
            moves = ends[0, which][:, None] * (1 - g) + ends[1, which][:, None] * g
            slope = (
                at_nodes.free[:, span].reshape(*shape, moves.shape[-1])
                + by_y[:, span].reshape(shape)[..., None] * moves
            )
            mask = at_nodes.outcome[span].reshape(shape[1:]) >= 0
            for k in np.flatnonzero(~mask.all(axis=1) & mask.any(axis=1)).tolist():
                slope[:, k] = np.einsum("mn,rnp->rmp", extension(tuple(mask[k].tolist()), _DEGREE), slope[:, k])
            yield which, mapping, at_nodes.value[:, span].reshape(shape), slope


def _at_nodes(
    experiment: Experiment, names: tuple[str, ...], row: np.ndarray, impacts: tuple[np.ndarray, np.ndarray],
    resolution: Resolution,
) -> Results:  # fmt: skip
    """Results of impacts; those whose derivatives take too long, or are not asked for, have values alone."""
    if not resolution.slopes:
        values = experiment.plain(names, row, *impacts)
        return replace(Results.empty(values.shape, len(experiment.rows.names)), value=values)
    budget = _SHORT if resolution.approximate else KERNEL_STEPS
    at_nodes = experiment.results(names, row, *impacts, budget=budget)
    failures = np.flatnonzero(at_nodes.outcome < 0)
    if failures.size:
        at_nodes.value[:, failures] = experiment.plain(names, row[failures], impacts[0][failures], impacts[1][failures])
    return at_nodes
