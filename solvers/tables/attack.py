"""Attack on a table: its answers against the kernel's, at random impacts and beside boundaries, angles and edges.

An answer holds if the kernel gives the same outcome and results at some impact whose Stokes number and angle differ by
at most 1e-6 relative: beside a boundary either side is right.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...generated.automaton import OUTCOMES
from ..scene.scene import Scene
from .collisions import Signatures, collisions
from .data import Attack, Data
from .read import Place, read, slice_of

WITHIN = 1e-6  # relative distance of the impact at which the kernel has to agree
_STEPS = WITHIN * np.array([1e-3, 1e-2, 0.03, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0])
_BLOCK = 1 << 16
_SURE = 0.3  # of the error: answers that are off by less are not held against collisions beside them
_GIVE_UP_AFTER = 1000  # wrong answers after which the rest need not be asked
_MOST_FAILURES = 40  # failures kept
_SHARES = np.linspace(0, 1, 17)
_NEAREST, _FARTHEST = -9.0, -1.5  # decimal logarithms of distances from a boundary


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


def queries(data: Data, count: int, random: np.random.Generator) -> np.ndarray:
    """Queries (3 x count: third variable, angle, ln St); 40 % random, 40 % beside boundaries, the rest beside cuts."""
    low, high = data.low[:, None], data.high[:, None]
    at = low + random.random((3, count)) * (high - low)
    kind = random.random(count)
    beside = np.flatnonzero(kind > 0.6)
    cut = np.flatnonzero((kind > 0.4) & (kind < 0.7))  # some of them are beside a boundary as well
    edge = np.flatnonzero(kind < 0.02)
    at[1, cut] = _near(random, *_cuts(data, at[0, cut]))
    at[2, beside] = _near(random, *heights(data, at[0, beside], np.clip(at[1, beside], low[1], high[1])))
    axis = random.integers(0, 3, edge.size)
    ends = np.where(random.random(edge.size) < 0.5, data.low[axis], data.high[axis])
    at[axis, edge] = ends
    return np.asarray(np.clip(at, low, high))


def _near(random: np.random.Generator, places: np.ndarray, count: np.ndarray) -> np.ndarray:
    """Values near one of the first `count` of each column of places."""
    size = count.size
    which = (random.random(size) * count).astype(int)
    sign = np.where(random.random(size) < 0.5, -1.0, 1.0)
    return np.asarray(places[which, np.arange(size)] + sign * 10 ** random.uniform(_NEAREST, _FARTHEST, size))


def _cuts(data: Data, third: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Angles between panels (cuts x n, padded with the last), and their number."""
    part, t = slice_of(data, third)
    first, last = data.first_panel[part], data.first_panel[part + 1]
    most, none = int((last - first).max(initial=1)), np.zeros(third.size)
    places = [data.shapes.values(data.cuts[first, 0], t, none, none)[0][:, 0]]
    ends = (data.cuts[np.minimum(first + k, last - 1), 1] for k in range(most))
    places += [data.shapes.values(end, t, none, none)[0][:, 0] for end in ends]
    return np.array(places), last - first + 1


def heights(data: Data, third: np.ndarray, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Boundaries at angles as ln St, and both ends of the range (places x n, padded), and their number."""
    none = np.zeros(angle.size)
    place = Place(data, np.stack([third, angle, none + data.low[2]]), False)
    panel, t, x = place.panel, place.t, place.x
    first, last = data.first_edge[panel], data.first_edge[panel + 1]
    places = [none + data.low[2], none + data.high[2]]
    for k in range(int((last - first).max(initial=0))):
        there = np.flatnonzero(first + k < last)
        top = none + data.high[2]
        top[there] = data.shapes.values(data.edges[first[there] + k], t[there], x[there], none[there])[0][:, 0]
        places.append(top)
    return np.array(places), last - first + 2
