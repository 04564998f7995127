"""What a measured restitution tells of the free entries beyond the outcome of the impact.

Along a line through the scatter of an impact, the restitution is a smooth function of the place between two changes of
outcome: a curve. Curves of neighbouring lines that end in the same way form a sheet, a smooth surface over the scatter.
Sheets are interpolated across the lines, so that the density of the restitution shows no trace of single lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from scipy.signal import oaconvolve
from scipy.special import ndtr, ndtri

from ..fitting.scatter import hermite, segment_map

_REACH = 4.5  # standard deviations of the scatter across the lines
_SPACING = 0.5  # largest distance of neighbouring points in the restitution, in standard deviations of the noise
_CELL = 1 / 16  # of the histogram of restitutions, in the same
_BEYOND = 6.0  # where a density ends, in the same
_MOST_LINES, _MOST_POINTS = 128, 512
_FEWEST_LINES = 16
_ROUGH = 2.0  # largest factor by which interpolation between lines may raise the bound of the information
_RARE = 1e-3  # probability of a sheet that is left out
_TINY = 1e-290


@dataclass(frozen=True)
class Curve:
    """The restitution along a segment of a line.

    Attributes:
        kind, nodes: of the map from 0..1 to the segment.
        line: its number among the lines of the impact.
        ends: (2,), where the segment begins and ends.
        moves: (2, free entries), derivatives of the ends.
        value, slope: (nodes,) and (nodes, free entries), the latter at places that move with the ends.
    """

    kind: int
    nodes: int
    line: int
    ends: np.ndarray
    moves: np.ndarray
    value: np.ndarray
    slope: np.ndarray


@dataclass(frozen=True)
class _Points:
    """Points of the quadrature over sheets: weights, derivatives of their logarithms, restitutions, derivatives."""

    weight: np.ndarray
    log_slope: np.ndarray
    value: np.ndarray
    slope: np.ndarray

    @classmethod
    def joined(cls, parts: Sequence[_Points]) -> _Points:
        return cls(*(np.concatenate(each) for each in zip(*(vars(part).values() for part in parts), strict=True)))

    def bound(self, noise: float) -> np.ndarray:
        """The information on each entry if the point of an impact were known; its density cannot tell more."""
        bound: np.ndarray = self.weight @ (self.log_slope**2 + (self.slope / noise) ** 2)
        return bound


def information_of(curves: Sequence[Curve], lines: int, noise: float, points: int) -> np.ndarray:
    """The information of the restitution, if the outcome is known: (free entries, free entries).

    With f the density of the measured restitution and p its integral, the probability of the outcome, it is the
    integral of f' f'^T/f less p' p'^T/p. It has no negative eigenvalue, whatever the errors of f and f'.

    Arguments:
        curves: of an impact and an outcome.
        lines: number of lines through its scatter.
        noise: standard deviation of the measurement.
        points: least number of points of the quadrature along a segment.
    """
    sheets = _sheets(curves, lines)
    if not sheets:
        return np.zeros((curves[0].slope.shape[1],) * 2)
    noise *= max(1.0, *(each.gap(noise, points) for each in sheets))
    single = _Points.joined([_sheet([each], lines).points(noise, points) for each in curves])
    between = _Points.joined([each.points(noise, points) for each in sheets])
    chosen = between if (between.bound(noise) <= _ROUGH * single.bound(noise)).all() else single
    cell = noise * _CELL
    low = float(chosen.value.min()) - _BEYOND * noise
    size = int((float(chosen.value.max()) + _BEYOND * noise - low) / cell) + 2
    place = (chosen.value - low) / cell
    left = place.astype(int)

    def spread(amount: np.ndarray) -> np.ndarray:
        """Amounts on the edges of the cells, each shared by the two edges around its point."""
        edges = np.bincount(left, amount * (1 - place + left), size)
        edges[1:] += np.bincount(left, amount * (place - left), size)[:-1]
        return edges

    off = np.arange(-int(_BEYOND / _CELL), int(_BEYOND / _CELL) + 1) * _CELL
    normal = np.exp(-(off**2) / 2) / (noise * np.sqrt(2 * np.pi))
    f = oaconvolve(spread(chosen.weight), normal, mode="same")
    f_slopes = [
        oaconvolve(spread(chosen.weight * by_weight), normal, mode="same")
        + oaconvolve(spread(chosen.weight * by_value), normal * off / noise, mode="same")
        for by_weight, by_value in zip(chosen.log_slope.T, chosen.slope.T, strict=True)
    ]
    kept = f > max(_TINY, 1e-13 * float(f.max()))  # what is less is rounding of the convolution
    root = np.sqrt(f[kept])
    score = np.array(f_slopes)[:, kept] / root
    by_outcome = score @ (root / np.linalg.norm(root))  # the part that changes the probability of the outcome
    information: np.ndarray = cell * (score @ score.T - np.outer(by_outcome, by_outcome))
    return information


def _sheets(curves: Sequence[Curve], lines: int) -> list[_Sheet]:
    """Sheets through neighbouring lines that have as many curves of the same kinds; rare ones are left out."""
    on: list[list[Curve]] = [[] for _ in range(lines)]
    for each in curves:
        on[each.line].append(each)
    weight = hermite(lines)[1]
    sheets = []
    for _, group in groupby(on, lambda line: tuple(each.kind for each in line)):
        neighbours = list(zip(*group, strict=True))
        if neighbours and weight[[each.line for each in neighbours[0]]].sum() > _RARE:
            sheets += [_sheet(sheet, lines) for sheet in neighbours]
    return sheets


def _sheet(curves: Sequence[Curve], lines: int) -> _Sheet:
    """The sheet of curves on neighbouring lines, for as much of the scatter as the lines stand for."""
    z, weight = hermite(lines)
    edges = np.clip(ndtri(np.clip(np.concatenate([[0], np.cumsum(weight)]), 0, 1)), -_REACH, _REACH)
    first, last = curves[0].line, curves[-1].line + 1
    arrays = (np.stack([getattr(each, name) for each in curves]) for name in ("ends", "moves", "value", "slope"))
    span = float(edges[first]), float(edges[last])
    return _Sheet(curves[0].kind, curves[0].nodes, z[first:last], span, *arrays)


@dataclass(frozen=True)
class _Sheet:
    """Curves that continue each other from line to line; arrays of those of `Curve`.

    Attributes:
        z: places of the lines, in standard deviations of the scatter.
        span: between which places the sheet lies.
    """

    kind: int
    nodes: int
    z: np.ndarray
    span: tuple[float, float]
    ends: np.ndarray
    moves: np.ndarray
    value: np.ndarray
    slope: np.ndarray

    def _needed(self, noise: float, points: int) -> tuple[float, float, float]:
        """Numbers of points along and across the sheet that leave no gaps, and its least extent along, in spacings."""
        along = segment_map(self.kind, self.nodes, points).interpolate @ self.value.T / (noise * _SPACING)
        apart = float(np.abs(np.diff(along, axis=0)).max())
        steepest = float(np.abs(np.diff(along, axis=1) / np.diff(self.z)).max(initial=0.0))
        return points * apart, (self.span[1] - self.span[0]) * steepest, float(np.ptp(along, axis=0).min())

    def gap(self, noise: float, points: int) -> float:
        """The largest gap that the largest numbers of points leave, in spacings.

        A density with gaps has too much information. With a noise as large as the gaps it has at most what it should.
        """
        along, across, extent = self._needed(noise, points)
        return max(along / _MOST_POINTS, across / _MOST_LINES / max(1.0, extent))

    def points(self, noise: float, points: int) -> _Points:
        """The points of the quadrature over the sheet."""
        along, across, _ = self._needed(noise, points)
        mapping = segment_map(self.kind, self.nodes, _doubled(points, along, _MOST_POINTS))
        low_z, high_z = self.span
        count = _doubled(_FEWEST_LINES if self.z.size > 1 else 1, across, _MOST_LINES)
        z = low_z + (high_z - low_z) * (np.arange(count) + 0.5) / count
        weight = np.exp(-(z**2) / 2)
        weight *= (ndtr(high_z) - ndtr(low_z)) / weight.sum()
        degree, vander = self.z.size - 1, np.polynomial.hermite_e.hermevander
        between = vander(z, degree) @ np.linalg.inv(vander(self.z, degree))  # the polynomial through the lines
        ends, moves, value, slope = (
            np.tensordot(between, each, 1) for each in (self.ends, self.moves, self.value, self.slope)
        )
        low, length = ends[:, :1], np.maximum(ends[:, 1:] - ends[:, :1], 1e-12)
        g = mapping.at_points
        y = low + length * g
        weight = weight[:, None] * length * mapping.rate * mapping.weight * np.exp(-(y**2) / 2) / np.sqrt(2 * np.pi)
        of_y = moves[:, :1] * (1 - g)[:, None] + moves[:, 1:] * g[:, None]
        log_slope = (moves[:, 1:] - moves[:, :1]) / length[..., None] - y[..., None] * of_y
        by_free = np.einsum("qn,znp->zqp", mapping.interpolate, slope)
        free = slope.shape[-1]
        at = value @ mapping.interpolate.T
        return _Points(weight.ravel(), log_slope.reshape(-1, free), at.ravel(), by_free.reshape(-1, free))


def _doubled(least: int, needed: float, most: int) -> int:
    """`least` times the power of two that reaches what is needed, or `most`."""
    while least < min(needed, most):
        least *= 2
    return least
