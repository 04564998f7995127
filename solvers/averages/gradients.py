"""Derivatives of means by entries of the scene, by Leibniz' rule: of the integrand, and of the angles of changes."""

from dataclasses import replace

import numpy as np

from ..changes.brackets import Brackets
from ..changes.experiment import STEEPEST, UNDECIDED, Experiment
from ..changes.slopes import Lines, slopes, slopes_by_differences
from .geometry import NORMAL, RIGHT_ANGLE, SLOPES, WIDTH, Segments, integrals, segments
from .sizes import Collided, collide, outcome_of

_RESULTS = ("restitution", "tangential_restitution")
_BESIDE = 2e-8  # rad, from a change to the collisions on both sides
_SAME = 1e-6  # a smaller jump is none
_WIDTH = 1e-11  # rad, to which changes are enclosed: derivatives lack its root where e_n begins as a square root


def gradients(
    experiment: Experiment, pair: np.ndarray, speed: np.ndarray, hints: np.ndarray | None, tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of the means along lines by the free entries, over `scales`, and errors: (lines, SLOPES * entries).

    Arguments: as of `geometry.over_angles`.

    Raises:
        ComputationError: the kernel has no derivatives of this scene.
    """
    parts = segments(experiment, pair, speed, hints, _WIDTH)
    wide = parts.subset((parts.high - parts.low > WIDTH) & (outcome_of(parts.label) != 0))
    entries = len(experiment.rows.names)

    def columns(which: np.ndarray, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of e_n and e_t."""
        line, within = wide.line[which], np.minimum(angle, STEEPEST)
        row = pair[line]
        results = experiment.results(_RESULTS, row, speed[line] * np.cos(within), within)
        by_free = results.free * scales(experiment, row)
        by_free[0] *= (np.cos(within) / np.cos(angle))[:, None]
        mask = (results.outcome != UNDECIDED)[:, None]
        steepest = np.abs(by_free * mask).max(axis=1, initial=0.0)[:, None]
        weight = np.sin(2 * angle)[:, None]
        return weight * np.hstack(by_free * mask), weight * np.hstack(~mask * steepest)

    total, error = np.zeros((2, pair.size, SLOPES, entries))
    ends = np.column_stack([wide.low, wide.high])
    both = integrals(columns, wide.line, ends, True, tolerance, pair.size)
    total[:, NORMAL:], error[:, NORMAL:] = (block.reshape(pair.size, -1, entries) for block in both)
    _add_limits(experiment, pair, speed, parts, total, error)
    return total.reshape(pair.size, -1), error.reshape(pair.size, -1)


def scales(experiment: Experiment, pair: np.ndarray) -> np.ndarray:
    """What derivatives are multiplied with, to be of one unit: (pairs, entries)."""
    sizes = experiment.scales
    return sizes[:, pair].T if sizes.ndim == 2 else np.tile(sizes, (pair.size, 1))


def _add_limits(
    experiment: Experiment, pair: np.ndarray, speed: np.ndarray, parts: Segments, total: np.ndarray, error: np.ndarray
) -> None:
    """Add what the changes contribute by their motion; to the error the contributions of those not followed."""
    k = np.flatnonzero(parts.low > 0)
    line, angle, width = parts.line[k], parts.low[k], parts.width[k]
    below, above, below_far, above_far = (
        collide(experiment, pair[line], speed[line], np.clip(angle + side * far * (_BESIDE + width), 0, RIGHT_ANGLE))
        for far in (1, 4)
        for side in (-1, 1)
    )
    jump = _limit(below, below_far) - _limit(above, above_far)
    use = np.abs(jump).max(axis=1, initial=0.0) > _SAME
    if not use.any():
        return
    line, angle, width, jump = line[use], angle[use], width[use], jump[use]
    ones = np.ones(line.size)
    lines = Lines(
        pair[line], np.stack([speed[line], 0 * ones], axis=1), np.stack([0 * ones, ones], axis=1), 1e-9 * ones,
        (RIGHT_ANGLE - 1e-6) * ones, True,
    )  # fmt: skip
    changes = Brackets(np.arange(line.size), angle - width / 2, angle + width / 2, below.label[use], above.label[use])
    by_free = _slopes(experiment, lines, changes) * scales(experiment, pair[line])
    steepest = np.abs(np.nan_to_num(by_free)).max(axis=0, initial=0.0)
    moved = np.sin(2 * angle)[:, None] * jump
    np.add.at(total, line, moved[:, :, None] * np.nan_to_num(by_free)[:, None])
    np.add.at(error, line, np.abs(moved)[:, :, None] * (np.isnan(by_free) * steepest)[:, None])


def _limit(near: Collided, far: Collided) -> np.ndarray:
    """The integrands at a change, from two distances to it, one four times the other: results begin as a square root.

    At the nearer distance alone they would be off by 1e-4 of what they change by within a rad.
    """
    at, alike = _integrands(near), (near.label == far.label)[:, None]
    return np.where(alike, 2 * at - _integrands(far), at)


def _integrands(collided: Collided) -> np.ndarray:
    """The integrands of the means, (collisions, SLOPES)."""
    shares = [collided.outcome == k for k in range(NORMAL)]
    return np.stack([*shares, *collided.results[:2]], axis=1).astype(float)


def _slopes(experiment: Experiment, lines: Lines, changes: Brackets) -> np.ndarray:
    """Derivatives of the angles of changes by the free entries; NaN where a change cannot be followed."""
    outcomes = replace(changes, before=outcome_of(changes.before), after=outcome_of(changes.after))
    by_free = np.zeros((changes.size, len(experiment.rows.names)))
    differ = outcomes.before != outcomes.after
    if differ.any():
        by_free[differ] = slopes(experiment, lines, outcomes.subset(differ))
    if not differ.all():  # bounces by other events, or none
        by_free[~differ] = slopes_by_differences(experiment, lines, changes.subset(~differ), labels=_labels)
    return by_free


def _labels(experiment: Experiment, pair: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> np.ndarray:
    return collide(experiment, pair, speed / np.cos(angle), angle, locating=True).label
