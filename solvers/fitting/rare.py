"""Rows whose observed outcome is rare within the reach of the integral: their likelihood from the nearest change."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr, ndtri

from . import changes as boundaries
from .law import BoundLaw
from .lines import REACH, Lines
from .measurements import Measurements

RARE = 1e-4
"""Probability within REACH below which the observed outcome is looked for beyond."""
_FADED = 1e-6  # probability below which the likelihood from the nearest change counts in full
_FAR = np.array([*np.arange(3.0, 8.0, 0.5), 8.5, 10.0, 12.5, 16.0, 20.0, 25.0, 30.0])  # where the outcome is looked for
_FARTHEST = 30.0
_FADES = 16.0  # distance from which the likelihood falls to that of an outcome that is not found
_TURNS = np.pi / 4 * np.arange(4)  # of lines through the impact, from the row's direction
_BESIDE = 0.05  # beyond a change of outcome, in standard deviations: where its results are taken
_WORST = 1e3  # most that what was measured lowers the logarithm; as much as where the outcome is not found at all


@dataclass(frozen=True)
class RareRows:
    """Log-likelihoods of rare rows and their derivatives by the free entries, (rows,) and (rows, free entries)."""

    log: np.ndarray
    slope: np.ndarray

    @classmethod
    def of(
        cls, law: BoundLaw, data: Measurements, rows: np.ndarray, direction: np.ndarray, of: tuple[str, ...],
        within: float, quick: bool,
    ) -> RareRows:  # fmt: skip
        """The likelihood of a scatter as far as the nearest change to the observed outcome, with the results there.

        It falls with the square of the distance also where the integral would be zero. The change is looked for on
        lines in all directions.

        Arguments:
            rows: the rare ones of the data.
            direction: (rows of the data,), of their lines.
            of: results that were measured.
            within, quick: of the `Resolution`.
        """
        part = data.part(rows)
        both = ((part.speed_sd > 0) & (part.angle_sd > 0)).astype(int)
        fan = [
            Lines.of(part, direction[rows] + turn, both if turn else np.ones(rows.size, int), _FARTHEST)
            for turn in _TURNS
        ]
        own = np.concatenate([each.row for each in fan])
        weight, speed, angle, low, high = (
            np.concatenate([getattr(each, name) for each in fan])
            for name in ("weight", "speed", "angle", "low", "high")
        )
        lines = Lines(rows[own], weight, speed, angle, low, high, part.relative)
        places = np.concatenate([-_FAR[::-1], _FAR])
        found = boundaries.locate(law, lines, np.clip(places, lines.low[:, None], lines.high[:, None]), within, True)
        least = np.where(np.arange(own.size) < rows.size, -ndtri(RARE), REACH)  # no likelier than by the integral
        which = _nearest(found, least, own, part.allowed)
        line = found.line[which]
        at = own[line]
        log = np.full(rows.size, float(log_ndtr(-_FARTHEST))) - np.where(part.separated, _WORST, 0.0)
        slope = np.zeros((rows.size, law.values.size))
        if at.size:
            y = found.y[which]
            sign, distance = np.where(y < 0, -1.0, 1.0), np.maximum(np.abs(y), least[line])
            log[at] = log_ndtr(-distance)
            moves = boundaries.slopes(law, lines, found, which, quick)
            hazard = np.exp(-(distance**2) / 2 - np.log(2 * np.pi) / 2 - log[at])
            slope[at] = -(np.where(distance > least[line], hazard, 0.0) * sign)[:, None] * moves
            misfit, misfit_slope = _misfit(law, data, of, lines, line, y + _BESIDE * sign, moves)
            short = np.where(part.separated[at], np.maximum(_WORST - misfit, 0.0), 0.0)
            way = np.clip((distance - _FADES) / (_FARTHEST - _FADES), 0.0, 1.0)
            share = way**2 * (3 - 2 * way)  # the farther, the nearer to what is not found at all
            rate = 6 * way * (1 - way) / (_FARTHEST - _FADES) * sign
            log[at] -= np.minimum(misfit, _WORST) + share * short
            slope[at] -= (np.where(misfit < _WORST, 1 - share, 0.0))[:, None] * misfit_slope
            slope[at] -= (rate * short)[:, None] * moves
        return cls(log, slope)

    def setting_in(self, probability: np.ndarray, moves: np.ndarray) -> RareRows:
        """The same, rising from nothing as the probability by the integral falls from `RARE` to a hundredth of it.

        Arguments:
            moves: derivatives of the logarithm of the probability.
        """
        span = float(np.log(RARE / _FADED))
        with np.errstate(divide="ignore"):
            part = np.clip(np.log(RARE / probability) / span, 0.0, 1.0)
            log = self.log + np.log(part**2 * (3 - 2 * part))
        rate = np.where((part > 0) & (part < 1), 6 * (1 - part) / np.maximum(part * (3 - 2 * part), 1e-300), 0.0)
        return RareRows(log, self.slope - (rate / span)[:, None] * moves)


def _nearest(found: boundaries.Changes, least: np.ndarray, own: np.ndarray, allowed: np.ndarray) -> np.ndarray:
    """Of each row the change nearest to the centre beyond which the outcome agrees; none for rows without one.

    Arguments:
        least, own: (lines,), least distance and row of each.
        allowed: (rows, outcomes).
    """
    up, row = found.y > 0, own[found.line]
    outward, inward = np.where(up, found.after, found.before), np.where(up, found.before, found.after)

    def agrees(outcome: np.ndarray) -> np.ndarray:
        seen: np.ndarray = (outcome >= 0) & allowed[row, np.maximum(outcome, 0)]
        return seen

    those = np.flatnonzero(agrees(outward) & ~agrees(inward))
    order = those[np.argsort(np.maximum(np.abs(found.y), least[found.line])[those], kind="stable")]
    nearest: np.ndarray = order[np.unique(row[order], return_index=True)[1]]
    return nearest


def _misfit(
    law: BoundLaw, data: Measurements, of: tuple[str, ...], lines: Lines, which: np.ndarray, y: np.ndarray,
    moves: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Half the squared distance of what was measured from the results at places that move, and its slopes."""
    row = lines.row[which]
    half, slope = np.zeros(which.size), np.zeros(moves.shape)
    if not of:
        return half, slope
    there = law.results(of, row, *lines.at(which, y))
    by_speed, by_angle = lines.slopes(which, y)
    for k, name in enumerate(of):
        measured, sd = (each[row] for each in data.observed[name])
        known = np.isfinite(measured) & np.isfinite(there.value[k]) & data.separated[row]
        pull = np.where(known, (measured - np.nan_to_num(there.value[k])) / sd, 0.0)
        by_y = there.speed[k] * by_speed + there.angle[k] * by_angle
        half += pull**2 / 2
        slope[known] -= ((pull / sd)[:, None] * (there.free[k] + by_y[:, None] * moves))[known]
    return half, slope
