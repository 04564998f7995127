"""The density of a measured restitution over the scatter of an impact, and what it tells beyond the outcome.

On a line through the scatter the restitution is a smooth curve between two changes of outcome. From line to line these
curves change smoothly too, and are interpolated, so that the density has no trace of single lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from scipy.signal import oaconvolve
from scipy.special import ndtr, ndtri

from ..fitting.interpolation import segment_map
from ..fitting.lines import hermite

_REACH = 4.5  # standard deviations of the scatter across the lines
_APART = 0.5  # most that neighbouring points may be seen apart, in standard deviations of the noise
_CELL = 1 / 16  # of the histogram of restitutions, in the same
_BEYOND = 6.0  # where a density ends, in the same
_MOST_LINES, _MOST_POINTS = 128, 512
_FEWEST_LINES = 16
_ROUGH = 2.0  # most of the complete information that interpolation may add
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


def information_of(curves: Sequence[Curve], lines: int, noise: float, points: int) -> np.ndarray:
    """What the restitution tells of the free entries if the outcome is known: (free entries, free entries).

    The integral of f' f'^T/f over the measured restitution, less p' p'^T/p with p the integral of f. It has no negative
    eigenvalue, whatever the errors of f and f'.

    Arguments:
        curves: of an impact and an outcome.
        lines: number of lines through its scatter.
        noise: standard deviation of the measurement.
        points: least number of points of the quadrature along a segment.
    """
    sheets = _sheets(curves, lines)
    if not sheets:
        return np.zeros((curves[0].slope.shape[1],) * 2)
    noise *= max(1.0, *(_gap(each, noise, points) for each in sheets))
    own = _joined([_points(each, noise, points) for each in _single(curves, lines)])
    between = _joined([_points(each, noise, points) for each in sheets])
    smooth = (_complete(between, noise) <= _ROUGH * _complete(own, noise)).all()
    weight, slope, value, moves = between if smooth else own
    cell = noise * _CELL
    low = float(value.min()) - _BEYOND * noise
    size = int((float(value.max()) + _BEYOND * noise - low) / cell) + 2
    place = (value - low) / cell
    at = place.astype(int)
    share = place - at

    def spread(amount: np.ndarray) -> np.ndarray:
        """Amounts on the cells' edges, each shared by the two around its point."""
        held = np.bincount(at, amount * (1 - share), size)
        held[1:] += np.bincount(at, amount * share, size)[:-1]
        return held

    off = np.arange(-int(_BEYOND / _CELL), int(_BEYOND / _CELL) + 1) * _CELL
    normal = np.exp(-(off**2) / 2) / (noise * np.sqrt(2 * np.pi))
    f = oaconvolve(spread(weight), normal, mode="same")
    by = [
        oaconvolve(spread(weight * slope[:, k]), normal, mode="same")
        + oaconvolve(spread(weight * moves[:, k]), normal * off / noise, mode="same")
        for k in range(slope.shape[1])
    ]
    kept = f > max(_TINY, 1e-13 * float(f.max()))  # what is less is rounding of the convolution
    root = np.sqrt(f[kept])
    score = np.array(by)[:, kept] / root
    along = score @ (root / np.linalg.norm(root))  # the part that changes the probability of the outcome
    found: np.ndarray = cell * (score @ score.T - np.outer(along, along))
    return found


_Points = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""Weights of points, derivatives of the weights' logarithms, restitutions, and their derivatives."""


def _joined(found: Sequence[_Points]) -> _Points:
    weight, slope, value, moves = (np.concatenate(each) for each in zip(*found, strict=True))
    return weight, slope, value, moves


def _complete(found: _Points, noise: float) -> np.ndarray:
    """The information on each entry if it were seen on which point an impact lies, which the density cannot exceed."""
    weight, slope, _, moves = found
    total: np.ndarray = weight @ (slope**2 + (moves / noise) ** 2)
    return total


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


def _sheets(curves: Sequence[Curve], lines: int) -> list[_Sheet]:
    """Sheets through neighbouring lines that have as many curves of the same kinds."""
    weight = hermite(lines)[1]
    z, edges = _places(lines)
    on: list[list[Curve]] = [[] for _ in range(lines)]
    for each in curves:
        on[each.line].append(each)
    found, first = [], 0
    for _, those in groupby(on, lambda line: tuple(each.kind for each in line)):
        group = list(those)
        last = first + len(group)
        if weight[first:last].sum() > _RARE:
            found += [
                _stacked(sheet, z[first:last], (float(edges[first]), float(edges[last])))
                for sheet in zip(*group, strict=True)
            ]
        first = last
    return found


def _single(curves: Sequence[Curve], lines: int) -> list[_Sheet]:
    """Every curve by itself, for as much of the scatter as its line stands for."""
    z, edges = _places(lines)
    return [
        _stacked([each], z[each.line : each.line + 1], (float(edges[each.line]), float(edges[each.line + 1])))
        for each in curves
    ]


def _places(lines: int) -> tuple[np.ndarray, np.ndarray]:
    """Where lines lie across the scatter, and (lines + 1,) the ends of what they stand for."""
    z, weight = hermite(lines)
    return z, np.clip(ndtri(np.clip(np.concatenate([[0], np.cumsum(weight)]), 0, 1)), -_REACH, _REACH)


def _stacked(those: Sequence[Curve], z: np.ndarray, span: tuple[float, float]) -> _Sheet:
    arrays = (np.stack([getattr(each, name) for each in those]) for name in ("ends", "moves", "value", "slope"))
    return _Sheet(those[0].kind, those[0].nodes, z, span, *arrays)


def _wanted(sheet: _Sheet, noise: float, points: int) -> tuple[float, float, float]:
    """Numbers of points along and across a sheet that leave no gaps, and how far it reaches along, in `_APART`."""
    along = segment_map(sheet.kind, sheet.nodes, points).interpolate @ sheet.value.T / (noise * _APART)
    apart = float(np.abs(np.diff(along, axis=0)).max())
    steepest = float(np.abs(np.diff(along, axis=1) / np.diff(sheet.z)).max(initial=0.0))
    return points * apart, (sheet.span[1] - sheet.span[0]) * steepest, float(np.ptp(along, axis=0).min())


def _gap(sheet: _Sheet, noise: float, points: int) -> float:
    """The gaps between the most points that are made, over those that may be.

    A density with gaps tells too much. With a noise as large as they are it tells at most what it should.
    """
    along, across, reach = _wanted(sheet, noise, points)
    return max(along / _MOST_POINTS, across / _MOST_LINES / max(1.0, reach))


def _points(sheet: _Sheet, noise: float, points: int) -> _Points:
    """The points of a sheet."""
    along, steps, _ = _wanted(sheet, noise, points)
    mapping = segment_map(sheet.kind, sheet.nodes, _power(along, points, _MOST_POINTS))
    low_z, high_z = sheet.span
    count = _power(steps, _FEWEST_LINES if sheet.z.size > 1 else 1, _MOST_LINES)
    z = low_z + (high_z - low_z) * (np.arange(count) + 0.5) / count
    weight = np.exp(-(z**2) / 2)
    weight *= (ndtr(high_z) - ndtr(low_z)) / weight.sum()
    across = _across(sheet.z, z)
    ends, moves, value, slope = (
        np.tensordot(across, each, 1) for each in (sheet.ends, sheet.moves, sheet.value, sheet.slope)
    )
    low, length = ends[:, :1], np.maximum(ends[:, 1:] - ends[:, :1], 1e-12)
    g = mapping.at_points
    y = low + length * g
    weight = weight[:, None] * length * mapping.rate * mapping.weight * np.exp(-(y**2) / 2) / np.sqrt(2 * np.pi)
    between = moves[:, :1] * (1 - g)[:, None] + moves[:, 1:] * g[:, None]
    by = (moves[:, 1:] - moves[:, :1]) / length[..., None] - y[..., None] * between
    at = value @ mapping.interpolate.T
    by_free = np.einsum("qn,znp->zqp", mapping.interpolate, slope)
    free = slope.shape[-1]
    return weight.ravel(), by.reshape(-1, free), at.ravel(), by_free.reshape(-1, free)


def _across(given: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """(wanted, given): the polynomial through values at given places."""
    degree = given.size - 1
    vander = np.polynomial.hermite_e.hermevander
    found: np.ndarray = vander(wanted, degree) @ np.linalg.inv(vander(given, degree))
    return found


def _power(wanted: float, least: int, most: int) -> int:
    """The least number `least` times a power of two that is `wanted`, or at most `most`."""
    while least < min(wanted, most):
        least *= 2
    return least
