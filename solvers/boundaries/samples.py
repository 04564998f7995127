"""Collisions along lines of constant angle, sampled over the Stokes number until their margins are resolved.

More collisions are sampled between two neighbours that differ in outcome, criterion or number of events, and where a
margin may have an extremum towards zero between them.
"""

import math
from collections.abc import Callable

import numpy as np

SAMPLE = np.dtype(
    [
        ("stokes", "f8"),
        ("outcome", "i1"),  # index in OUTCOMES; -1 if it failed
        ("reversal", "i1"),  # the first rebound criterion met, -1 for none
        ("events", "i4"),  # number of events
        ("restitution", "f8"),
        ("time", "f8"),  # contact time, x0/v0; NaN for a stick
        ("criterion", "f8"),  # margin of the rebound criteria, positive if one is met; NaN if unknown
        ("reach", "f8"),  # gap at which a stick falls back, x0; NaN if unknown
    ]
)
SAMPLE_BUDGET = 20_000  # steps of a sampled collision; limits how close to a separatrix collisions are sampled
BRACKET = 1e-4  # width in ln St to which samples bracket a change of outcome
FINEST = 1e-5  # smallest spacing in ln St of other samples
_INSIDE = 7  # new samples between two
_ROUNDS = 9
_MOST = 150  # most pairs with equal outcomes (the widest) that are refined in a round
_NOISE = 1e-6  # relative; a smaller change of a margin may be numerical error
Sampler = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Angles (rad), Stokes numbers -> SAMPLE, an element a collision."""


def sampled(angles: np.ndarray, first: np.ndarray, sampler: Sampler) -> list[np.ndarray]:
    """Samples of each line, ascending in the Stokes number; failed collisions have outcome -1.

    Arguments:
        angles: angles of the lines, rad.
        first: initial samples, a row for each line, ascending.
    """
    lines = list(first)
    unsettled = list(range(angles.size))
    for _ in range(_ROUNDS):
        more = {k: fresh for k in unsettled if (fresh := _between(lines[k])).size}
        if not more:
            break
        unsettled = list(more)  # a line without new samples needs none in later rounds either
        counts = [fresh.size for fresh in more.values()]
        seen = sampler(np.repeat(angles[unsettled], counts), np.concatenate(list(more.values())))
        for k, piece in zip(unsettled, np.split(seen, np.cumsum(counts)[:-1]), strict=True):
            lines[k] = merged(lines[k], piece)
    return lines


def first_grid(span: tuple[float, float], per_decade: int) -> np.ndarray:
    """Initial Stokes numbers, evenly spaced in the logarithm, including both ends."""
    count = max(3, 1 + math.ceil(math.log10(span[1] / span[0]) * per_decade))
    grid = np.geomspace(*span, count)
    grid[[0, -1]] = span
    return grid


def merged(line: np.ndarray, fresh: np.ndarray) -> np.ndarray:
    """A line with additional samples, ascending."""
    both = np.concatenate([line, fresh])
    return both[np.argsort(both["stokes"], kind="stable")]


def answers(line: np.ndarray) -> np.ndarray:
    """The samples that did not fail."""
    return line[line["outcome"] >= 0]


def _between(line: np.ndarray) -> np.ndarray:
    """Stokes numbers of the next samples of a line."""
    failed = np.cumsum(line["outcome"] < 0)[line["outcome"] >= 0]
    line = answers(line)
    if line.size < 2:
        return np.zeros(0)
    at = np.log(line["stokes"])
    width = np.diff(at)
    changes = line["outcome"][1:] != line["outcome"][:-1]
    wanted = changes & (width > BRACKET) & (np.diff(failed) < _INSIDE)  # do not refine further where all fail
    others = (_another_way(line) | _towards_zero(line)) & ~changes & (width > FINEST)
    widest = np.argsort(np.where(others, -width, 0.0), kind="stable")[:_MOST]
    wanted[widest] |= others[widest]
    first = at[:-1][wanted]
    parts = np.arange(1, _INSIDE + 1) / (_INSIDE + 1)
    return np.asarray(np.exp(first[:, None] + width[wanted][:, None] * parts).ravel())


def _another_way(line: np.ndarray) -> np.ndarray:
    """Mask of neighbours with one outcome but different events, between which margins may jump."""
    criteria = line["reversal"][1:] != line["reversal"][:-1]
    events = line["events"][1:] != line["events"][:-1]
    return np.asarray(criteria | (events & (line["outcome"][1:] > 0)))


def _towards_zero(line: np.ndarray) -> np.ndarray:
    """Mask of neighbours between which a margin may reach zero: it has an extremum and changes by more than its value.

    Times and fall-back gaps have no zero at a separatrix, so any maximum counts.
    """
    separates = line["outcome"] > 0
    margins = (
        (np.where(separates, -np.abs(line["criterion"]), np.nan), False),
        (np.where(separates, -(line["restitution"] ** 2), np.nan), False),
        (line["time"], True),
        (line["reach"], True),
    )
    mask = np.zeros(line.size - 1, dtype=bool)
    same = line["outcome"][1:] == line["outcome"][:-1]
    for values, any_turn in margins:
        here, before, after = values[1:-1], values[:-2], values[2:]
        with np.errstate(invalid="ignore"):
            turns = same[:-1] & same[1:] & (here > before) & (here >= after)
            rise = 2 * np.maximum(here - before, here - after)
            turns &= rise > (_NOISE * np.abs(here) if any_turn else np.abs(here))
        mask[:-1] |= turns
        mask[1:] |= turns
    return mask
