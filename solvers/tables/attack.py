"""Attack on a table: its answers against the kernel's, at random impacts and beside boundaries.

An answer holds if the kernel gives the same outcome and results at some impact whose Stokes number and angle differ by
at most 1e-6 relative: beside a boundary either side is right.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ...generated.automaton import OUTCOMES
from ..scene.scene import Scene
from .collisions import Signatures, collisions
from .data import Data
from .queries import queries
from .read import read

WITHIN = 1e-6  # relative distance of the impact at which the kernel has to agree
_STEPS = WITHIN * np.array([1e-3, 1e-2, 0.03, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0])
_BLOCK = 1 << 16
_SURE = 0.3  # of the error: answers that are off by less are not held against collisions beside them
_GIVE_UP_AFTER = 1000  # wrong answers after which the rest need not be asked
_MOST_FAILURES = 40  # failures kept
_SHARES = np.linspace(0, 1, 17)


@dataclass
class Attack:
    """What an attack has found.

    Attributes:
        queries: number of queries.
        largest: largest error of an answer that holds; of all answers if some do not.
        at: where it is: third variable, angle (rad), St.
        direct: number of queries that agree with the collision at their own impact; the others beside it.
        failures: impacts (third variable, angle, St) at which the table is wrong, with what it says and what is right.
    """

    queries: int = 0
    largest: float = 0.0
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    direct: int = 0
    failures: list[tuple[np.ndarray, str]] = field(default_factory=list)
    failed: int = 0


def attack(
    data: Data,
    scene: Scene,
    third: str | None,
    of: tuple[str, ...],
    error: float,
    rtol: float,
    count: int,
    seed: int = 1,
    tell: Callable[[int], None] = lambda _done: None,
) -> Attack:
    """Hold `count` answers of a table against collisions.

    Arguments:
        third: dotted name of the third variable, if there is one.
        error: that the table states.
        seed: of the random numbers.
        tell: called with the number of queries of every block.
    """
    result, known = Attack(), Signatures()
    random = np.random.default_rng(seed)
    run = _Kernel(scene, third, data.logarithmic, of, rtol, known)
    while result.queries < count:
        at = queries(data, min(_BLOCK, count - result.queries), random)
        answers = read(data, *at)
        labels, values = run(at)
        wrong = _error(answers.outcome, answers.values, known.of(labels), values)
        doubtful = np.flatnonzero(~(wrong <= _SURE * error))
        result.direct += at.shape[1] - doubtful.size
        for first in range(0, doubtful.size, _BLOCK // 32):
            part = doubtful[first : first + _BLOCK // 32]
            beside = _beside(run, known, at[:, part], answers.outcome[part], answers.values[part], _SURE * error)
            wrong[part] = np.fmin(wrong[part], beside)
        _enter(result, data, at, wrong, error, answers.outcome, known.of(labels))
        result.queries += at.shape[1]
        tell(at.shape[1])
        if result.failed > _GIVE_UP_AFTER:
            break
    return result


def _enter(
    attack: Attack, data: Data, at: np.ndarray, wrong: np.ndarray, error: float, answers: np.ndarray, right: np.ndarray
) -> None:
    """Enter the errors of a block."""

    def impact(k: int) -> np.ndarray:
        third = np.exp(at[0, k]) if data.logarithmic else at[0, k]
        return np.array([third, at[1, k], np.exp(at[2, k])])

    row = int(np.argmax(np.where(np.isnan(wrong), np.inf, wrong)))
    if not wrong[row] <= attack.largest:
        attack.largest, attack.at = float(wrong[row]), tuple(impact(row).tolist())
    failed = np.flatnonzero(~(wrong <= error))
    attack.failed += failed.size
    for k in failed[: max(0, _MOST_FAILURES - len(attack.failures))].tolist():
        names = [OUTCOMES[one] if one >= 0 else "no answer" for one in (int(answers[k]), int(right[k]))]
        text = f"off by {wrong[k]:.2g}" if names[0] == names[1] else f"{names[0]}, where collisions give {names[1]}"
        attack.failures.append((impact(k), text))


def _error(outcome: np.ndarray, values: np.ndarray, right: np.ndarray, exact: np.ndarray) -> np.ndarray:
    """Largest error of each answer over its results, relative for magnitudes above 1; infinite for another outcome."""
    error = np.abs(values - exact) / np.maximum(1.0, np.abs(exact))
    error = np.where(np.isnan(exact), 0.0, error)  # no value to compare with: a stick, or head-on
    error = error.max(axis=-1, initial=0.0)
    return np.where((outcome == right) & ~np.isnan(error), error, np.inf)


def _beside(
    run: _Kernel, known: Signatures, at: np.ndarray, outcome: np.ndarray, values: np.ndarray, sufficient: float
) -> np.ndarray:
    """Smallest error of answers against collisions at most WITHIN away; between two of them results are continuous."""
    best = np.full(outcome.size, np.inf)
    steps = np.concatenate([-_STEPS[::-1], [0.0], _STEPS])
    for ways in ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 1.0, 1.0), (0.0, 1.0, -1.0)):
        some = np.flatnonzero(~(best <= sufficient))
        if not some.size:
            break
        moved = np.repeat(at[:, some, None], steps.size, axis=2)
        moved[1] *= 1 + ways[1] * steps
        moved[2] += ways[2] * steps
        labels, exact = run(moved.reshape(3, -1))
        labels, exact = labels.reshape(some.size, -1), exact.reshape(some.size, steps.size, -1)
        outcomes, answers = outcome[some, None], values[some, None, :]
        best[some] = np.fmin(best[some], _error(outcomes, answers, known.of(labels), exact).min(axis=1))
        joined = labels[:, 1:] == labels[:, :-1]
        for share in _SHARES[1:-1]:
            between = (1 - share) * exact[:, :-1] + share * exact[:, 1:]
            error = np.where(joined, _error(outcomes, answers, known.of(labels[:, 1:]), between), np.inf)
            best[some] = np.fmin(best[some], error.min(axis=1))
    return best


@dataclass
class _Kernel:
    """Collisions at queries."""

    scene: Scene
    third: str | None
    logarithmic: bool
    of: tuple[str, ...]
    rtol: float
    known: Signatures

    def __call__(self, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        vary = {} if self.third is None else {self.third: np.exp(at[0]) if self.logarithmic else at[0]}
        return collisions(self.scene, at[1], np.exp(at[2]), self.rtol, self.of, self.known, vary)
