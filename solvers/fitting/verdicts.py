"""What the data tell of each entry, in one of four verdicts, and of which combination of entries."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .free_entries import FreeEntries
from .objective import Objective
from .profiles import End, slice_closed

IDENTIFIED = "identified"
ONE_SIDE = "bounded on one side"
COMBINED = "only in combination"
NOT_AT_ALL = "not identifiable from these data"
_TIED = 0.95  # correlation from which two identified entries are reported as a combination too
_PART = 0.1  # least exponent that is worth naming, relative to the largest
_POOR = 10.0  # times better must a combination be known than its entries alone


def judged(objective: Objective, best: np.ndarray, k: int, below: End, above: End) -> str:
    """The verdict of entry k, from the ends of its profile interval.

    With both ends open the entry is told in combination if its likelihood falls while the others stay as they are.
    """
    if not (below.open or above.open):
        return IDENTIFIED
    if below.open != above.open:
        return ONE_SIDE
    return COMBINED if objective.free.size > 1 and any(slice_closed(objective, best, k)) else NOT_AT_ALL


def combinations(
    free: FreeEntries, information: np.ndarray, verdicts: Sequence[str], what: str = "The data"
) -> tuple[str, ...]:
    """Sentences on products of powers that the data tell better than their entries.

    Arguments:
        information: matrix in the variables of the search, which are logarithms for the entries named.
        what: the sentences' subject, in the plural.
    """
    sd = _alone(information)
    covariance = np.linalg.pinv(information + np.diag(_vague(free)))
    correlation = covariance / np.sqrt(np.outer(np.diag(covariance), np.diag(covariance)))
    tied = [
        k
        for k, verdict in enumerate(verdicts)
        if free.entries[k].log
        and np.isfinite(sd[k])
        and (verdict == COMBINED or any(abs(correlation[k, j]) > _TIED for j in range(free.size) if j != k))
    ]
    if len(tied) < 2:
        return ()
    own = np.linalg.inv(covariance[np.ix_(tied, tied)])  # of these, whatever the others are
    values, vectors = np.linalg.eigh(own)
    said = []
    for value, vector in zip(values[::-1], vectors.T[::-1], strict=True):
        if value <= 0 or value < _POOR**2 * values[0]:
            break
        said.append(_sentence(what, [free.names[k] for k in tied], vector, 1 / np.sqrt(value)))
    return tuple(said)


def _vague(free: FreeEntries) -> np.ndarray:
    found: np.ndarray = (2.0 / (free.high - free.low)) ** 2
    return found


def _alone(information: np.ndarray) -> np.ndarray:
    """Standard errors if all other entries were known; infinite where the data say nothing."""
    own = np.diag(information)
    return np.where(own > 1e-12, 1 / np.sqrt(np.maximum(own, 1e-12)), np.inf)


def _sentence(what: str, names: Sequence[str], vector: np.ndarray, sd: float) -> str:
    first = int(np.argmax(np.abs(vector)))
    powers = vector / vector[first]
    kept = [k for k in range(len(names)) if abs(powers[k]) >= _PART]
    factors = [names[k] if k == first else f"{names[k]}^{powers[k]:.2g}" for k in kept]
    size = abs(sd / vector[first])
    told = f"to {100 * np.expm1(size):.2g} %" if size < 1 else f"to a factor of {np.exp(size):.2g}"
    return f"{what} tell {' * '.join(factors)} {told} (standard error)."
