"""Derivatives of means by entries of the scene, by Leibniz' rule: of the integrand, and of the angles of the changes.

The integrand's are those of the kernel's tangents. An angle moves by what collisions show when the entry is a little
larger and smaller; `sensitivity.boundaries` has the same derivatives exactly, a hundred times slower.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...generated.automaton import LAST_ANSWER
from ..engines.taylor.call import Impacts
from ..errors import ComputationError
from ..scene.scene import Scene
from ..sensitivity.by_kernel import gradients_by_kernel
from ..sensitivity.parameters import kind_of
from .geometry import COLUMNS, NORMAL
from .lines import RIGHT_ANGLE
from .over_speeds import Batch, Means
from .rule import summed
from .sizes import STEEPEST, UNDECIDED, Pairs, Struck, outcome_of

_OF = ("restitution", "tangential_restitution")
_STEPS = (3e-4, 1e-5, 3e-7)  # relative, of an entry
_LINEAR, _NOISE = 3e-3, 3e-9  # largest part of an angle's motion, and rad, by which it may not be linear
_REACH = (5.0, 100.0)  # half width of the brackets in which moved changes are sought, in steps, as rad
_WIDTH = 1e-7  # to which they are enclosed, in steps
_ROUNDS = 40
_BESIDE = 2e-8  # rad, from a change to the collisions on both sides
_SAME = 1e-6  # a smaller jump is none
_BLOCK = 4096  # collisions in a call of the kernel


def gradients(pairs: Pairs, found: Means, wrt: Sequence[str], rtol: float) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of the means of pairs (pairs, COLUMNS, parameters), SI, and their errors, with the speeds held.

    Raises:
        ComputationError: the kernel has no derivatives of this scene.
    """
    first = np.zeros((3, pairs.size, COLUMNS, len(wrt)))  # by Kronrod's rule, and with Gauss's along either variable
    lost = np.zeros(first.shape[1:])
    _of_integrands(pairs, found, wrt, rtol, first, lost)
    for k, name in enumerate(wrt):
        for batch in found.batches:
            _of_limits(pairs, name, batch, rtol, first[..., k], lost[..., k])
    error: np.ndarray = lost + np.abs(first[0] - first[1]) + np.abs(first[0] - first[2])
    return first[0], error


def _of_integrands(
    pairs: Pairs, found: Means, wrt: Sequence[str], rtol: float, first: np.ndarray, lost: np.ndarray
) -> None:
    """Add the means of the derivatives of e_n and e_t."""
    pair, speed, angle, weights = [], [], [], []
    for batch in found.batches:
        nodes = batch.found.nodes
        line = nodes.line
        pair.append(batch.pair[line])
        speed.append(batch.speed[line])
        angle.append(nodes.angle)
        weights.append(
            np.stack(
                [
                    batch.kronrod[line] * nodes.kronrod,
                    batch.gauss[line] * nodes.kronrod,
                    batch.kronrod[line] * nodes.gauss,
                ]
            )
        )
    of, fast, at, weight = *(np.concatenate(each) for each in (pair, speed, angle)), np.concatenate(weights, axis=1)
    for k, scene in enumerate(pairs.scenes):
        which = np.flatnonzero((of == k) & (weight[0] != 0))
        for part in (which[j : j + _BLOCK] for j in range(0, which.size, _BLOCK)):
            slopes = _slopes(scene, fast[part], at[part], tuple(wrt), rtol)
            first[:, k, NORMAL:] += np.einsum("rc,qcp->rqp", weight[:, part], np.nan_to_num(slopes))
            unknown = weight[0, part] @ np.isnan(slopes[0, :, 0])
            lost[k, NORMAL:] += unknown * np.nanmax(np.abs(slopes), axis=1, initial=0.0)


def _slopes(scene: Scene, speed: np.ndarray, angle: np.ndarray, wrt: tuple[str, ...], rtol: float) -> np.ndarray:
    """Derivatives of e_n and e_t of collisions that separate: (2, collisions, parameters); NaN where there is none."""
    within = np.minimum(angle, STEEPEST)
    impacts = Impacts(scene, speed * np.cos(within), within, {})
    found = gradients_by_kernel(impacts, kind_of(scene, "speed"), wrt, _OF, rtol)
    if found is None:
        raise ComputationError(
            "the kernel does not differentiate collisions of this scene", advice="ask for averages without derivatives"
        )
    slopes: np.ndarray = found.first / found.units
    slopes[0] *= (np.cos(within) / np.cos(angle))[:, None]
    slopes[:, found.run.answers["status"] > LAST_ANSWER] = np.nan
    return slopes


def _of_limits(pairs: Pairs, name: str, batch: Batch, rtol: float, first: np.ndarray, lost: np.ndarray) -> None:
    """Add what the changes of outcome contribute by their motion with one entry; `lost` by those not followed."""
    cut = batch.found.segments
    k = np.flatnonzero((cut.low > 0) & (batch.kronrod[cut.line] != 0))
    if not k.size:
        return
    line, angle = cut.line[k], cut.low[k]
    beside = [
        pairs.collide(
            batch.pair[line],
            batch.speed[line],
            np.clip(angle + side * (_BESIDE + cut.width[k]), 0, RIGHT_ANGLE),
            rtol,
        )
        for side in (-1, 1)
    ]
    jump = _values(beside[0]) - _values(beside[1])
    use = np.abs(jump).max(axis=1) > _SAME
    line, angle, jump = line[use], angle[use], jump[use]
    pair, speed = batch.pair[line], batch.speed[line]
    below, above = (one.label[use] for one in beside)
    slope = _slopes_of_angles(pairs, name, Changes(pair, speed, angle, below, above), rtol)
    known, weight = ~np.isnan(slope), np.sin(2 * angle)
    change = np.where(known, weight * np.nan_to_num(slope), 0.0)[:, None] * jump
    for row, own in enumerate((batch.kronrod, batch.gauss, batch.kronrod)):
        first[row] += summed(pair, own[line, None] * change, pairs.size)
    steepest = np.abs(slope[known]).max(initial=0.0)
    lost += summed(pair, (batch.kronrod[line] * weight * ~known * steepest)[:, None] * np.abs(jump), pairs.size)


def _values(struck: Struck) -> np.ndarray:
    """The integrands of the means, (collisions, COLUMNS)."""
    shares = [_outcomes(struck.label) == k for k in range(NORMAL)]
    return np.stack([*shares, struck.restitution, struck.tangential], axis=1).astype(float)


@dataclass(frozen=True)
class Changes:
    """Changes of pairs at relative speeds: their angles, and the labels below and above."""

    pair: np.ndarray
    speed: np.ndarray
    angle: np.ndarray
    below: np.ndarray
    above: np.ndarray

    def where(self, which: np.ndarray) -> Changes:
        return Changes(self.pair[which], self.speed[which], self.angle[which], self.below[which], self.above[which])


def _slopes_of_angles(pairs: Pairs, name: str, changes: Changes, rtol: float) -> np.ndarray:
    """d(angle)/d(entry) of changes, rad and SI; NaN where a change cannot be followed.

    Near a fold or a meeting point an angle moves fast, or ends: the step is reduced until the motion is linear.
    """
    found = np.full(changes.angle.size, np.nan)
    left = np.arange(changes.angle.size)
    for relative in _STEPS:
        own = changes.where(left)
        both = []
        for sign in (-1, 1):
            moved, step = _moved(pairs, name, sign * relative)
            both.append((_moved_angles(moved, own, relative, rtol), step[own.pair]))
        (low, less), (high, more) = both
        slope = (high - low) / (more - less)
        bend = np.abs((high + low) / 2 - own.angle)
        good = bend <= np.maximum(_LINEAR * np.abs(high - low), _NOISE)
        if relative == _STEPS[-1]:
            good = ~np.isnan(slope)
        found[left[good]] = slope[good]
        left = left[~good]
        if not left.size:
            break
    return found


def _moved(pairs: Pairs, name: str, relative: float) -> tuple[Pairs, np.ndarray]:
    """The pairs with an entry a little larger or smaller, and by how much."""
    values = np.array([float(one.entries[name]) for one in pairs.scenes])
    steps = relative * np.where(values == 0, 1.0, np.abs(values))
    scenes = [one.with_si({name: value + step}) for one, value, step in zip(pairs.scenes, values, steps, strict=True)]
    own = Pairs.of([*pairs.scenes, *scenes])  # together, so that the same quantities are columns
    return own.part(slice(pairs.size, None)), steps


def _moved_angles(pairs: Pairs, changes: Changes, relative: float, rtol: float) -> np.ndarray:
    """The angles of changes of other pairs, near those given; NaN where there is no such change nearby."""
    below, above = (_outcomes(each) for each in (changes.below, changes.above))
    apart = below != above

    def is_below(which: np.ndarray, at: np.ndarray) -> np.ndarray:
        label = pairs.collide(changes.pair[which], changes.speed[which], at, rtol, locating=True).label
        found: np.ndarray = np.where(apart[which], _outcomes(label) == below[which], label == changes.below[which])
        return found

    found = np.full(changes.angle.size, np.nan)
    left = np.arange(changes.angle.size)
    for reach in _REACH:
        low, high = (
            np.clip(changes.angle[left] + side * reach * relative, 1e-9, RIGHT_ANGLE - 1e-6) for side in (-1, 1)
        )
        good = is_below(left, low) & ~is_below(left, high)
        which, low, high = left[good], low[good], high[good]
        for _ in range(_ROUNDS):
            if not which.size or (high - low).max() <= _WIDTH * relative:
                break
            middle = (low + high) / 2
            under = is_below(which, middle)
            low, high = np.where(under, middle, low), np.where(under, high, middle)
        found[which] = (low + high) / 2
        left = left[~good]
    return found


def _outcomes(label: np.ndarray) -> np.ndarray:
    return np.where(label == UNDECIDED, UNDECIDED, outcome_of(np.maximum(label, 0)))
