"""Derivatives of means by entries of the scene, by Leibniz' rule: of the integrand, and of the angles of changes."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..changes.brackets import Brackets
from ..changes.experiment import STEEPEST, UNDECIDED, Experiment
from ..changes.slopes import Lines, slopes, slopes_by_differences
from .geometry import NORMAL, RIGHT_ANGLE, SLOPES
from .over_speeds import Batch
from .rule import summed
from .sizes import Collided, collide, outcome_of

_RESULTS = ("restitution", "tangential_restitution")
_BESIDE = 2e-8  # rad, from a change to the collisions on both sides
_SAME = 1e-6  # a smaller jump is none
_BLOCK = 4096  # collisions in a call of the kernel


def gradients(experiment: Experiment, pairs: int, batches: Sequence[Batch]) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of the means of pairs (pairs, SLOPES, free entries), SI, and their errors, with the speeds held.

    Arguments:
        batches: the lines that the means are made of.

    Raises:
        ComputationError: the kernel has no derivatives of this scene.
    """
    entries = len(experiment.rows.names)
    total = np.zeros((3, pairs, SLOPES, entries))  # by Kronrod's rule, and with Gauss's along either variable
    lost = np.zeros(total.shape[1:])
    for batch in batches:
        _add_integrands(experiment, batch, total, lost)
        _add_limits(experiment, batch, total, lost)
    error: np.ndarray = lost + np.abs(total[0] - total[1]) + np.abs(total[0] - total[2])
    return total[0], error


def _add_integrands(experiment: Experiment, batch: Batch, total: np.ndarray, lost: np.ndarray) -> None:
    """Add the means of the derivatives of e_n and e_t."""
    nodes = batch.over_angles
    rules = (batch.kronrod, nodes.kronrod), (batch.gauss, nodes.kronrod), (batch.kronrod, nodes.gauss)
    weights = np.stack([of_line[nodes.line] * of_angle for of_line, of_angle in rules])
    used = np.flatnonzero(weights[0])
    for k in range(0, used.size, _BLOCK):
        part = used[k : k + _BLOCK]
        line, angle, weight = nodes.line[part], nodes.angle[part], weights[:, part]
        within = np.minimum(angle, STEEPEST)
        pair = batch.pair[line]
        results = experiment.results(_RESULTS, pair, batch.speed[line] * np.cos(within), within)
        by_free = results.free * np.stack([np.cos(within) / np.cos(angle), np.ones(angle.size)])[:, :, None]
        known = results.outcome != UNDECIDED
        steepest = np.abs(by_free[:, known]).max(axis=1, initial=0.0)
        for row, column in np.ndindex(3, 2):
            each = weight[row, :, None] * np.where(known[:, None], by_free[column], 0.0)
            total[row, :, NORMAL + column] += summed(pair, each, len(lost))
        unknown = np.bincount(pair[~known], weight[0, ~known], len(lost))
        lost[:, NORMAL:] += unknown[:, None, None] * steepest


def _add_limits(experiment: Experiment, batch: Batch, total: np.ndarray, lost: np.ndarray) -> None:
    """Add what the changes contribute by their motion; to `lost` the contributions of those that are not followed."""
    parts = batch.over_angles.segments
    k = np.flatnonzero((parts.low > 0) & (batch.kronrod[parts.line] != 0))
    line, angle, width = parts.line[k], parts.low[k], parts.width[k]
    if not k.size:
        return
    sides = (np.clip(angle + side * (_BESIDE + width), 0, RIGHT_ANGLE) for side in (-1, 1))
    below, above = (collide(experiment, batch.pair[line], batch.speed[line], at) for at in sides)
    jump = _integrands(below) - _integrands(above)
    use = np.abs(jump).max(axis=1) > _SAME
    line, jump = line[use], jump[use]
    pair, count = batch.pair[line], line.size
    ones = np.ones(count)
    lines = Lines(
        pair, np.stack([batch.speed[line], 0 * ones], axis=1), np.stack([0 * ones, ones], axis=1), 1e-9 * ones,
        (RIGHT_ANGLE - 1e-6) * ones, True,
    )  # fmt: skip
    changes = Brackets(
        np.arange(count), angle[use] - width[use] / 2, angle[use] + width[use] / 2, below.label[use], above.label[use]
    )
    by_free = _slopes(experiment, lines, changes)
    known, weight = ~np.isnan(by_free), np.sin(2 * changes.place)[:, None]
    steepest = np.abs(np.nan_to_num(by_free)).max(axis=0, initial=0.0)
    for column in range(SLOPES):
        each = weight * np.nan_to_num(by_free) * jump[:, [column]]
        for row, of_line in enumerate((batch.kronrod, batch.gauss, batch.kronrod)):
            total[row, :, column] += summed(pair, of_line[line, None] * each, len(lost))
        unknown = batch.kronrod[line, None] * weight * ~known * steepest * np.abs(jump[:, [column]])
        lost[:, column] += summed(pair, unknown, len(lost))


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
        by_free[differ] = slopes(experiment, lines, outcomes.part(differ))
    if not differ.all():  # bounces by other events, or none
        by_free[~differ] = slopes_by_differences(experiment, lines, changes.part(~differ), labels=_labels)
    return by_free


def _labels(experiment: Experiment, pair: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> np.ndarray:
    return collide(experiment, pair, speed / np.cos(angle), angle, locating=True).label
