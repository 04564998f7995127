"""Where e_n crosses 1 along lines of constant angle: many collisions scanned, then every crossing closed in on.

e_n may also jump over 1, where the outcome changes; the crossing is then that change.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..engines.taylor.build import supported
from ..many.collide_many import FAILED, collide_many
from ..scene.scene import Scene

_FINER = 16  # steps of the scan to one of the grid where a collision takes microseconds
_PARTS = 32  # that a bracket is cut into at a time
_SHARP = 2e-5  # relative width of a bracket that is left: an edge is shown with three digits


@dataclass(frozen=True)
class Above:
    """Where e_n > 1 at one angle.

    Attributes:
        spans: Stokes intervals, ascending; an end of the scan where e_n > 1 there.
        most, at: largest e_n of the scan, and its Stokes number.
        failed: collisions of the scan that were not completed.
    """

    angle: float
    spans: tuple[tuple[float, float], ...]
    most: float
    at: float
    failed: int


def above_one(scene: Scene, angles: Sequence[float], stokes: np.ndarray, rtol: float) -> list[Above]:
    """Stokes intervals with e_n > 1, their ends within 1e-5.

    Arguments:
        angles: rad.
        stokes: Stokes numbers, ascending; narrower intervals than their steps, or a sixteenth of them where there is
            a kernel, may be missed.
    """
    steps = (stokes.size - 1) * (_FINER if supported(scene) else 1)
    scan = np.exp(np.interp(np.linspace(0, stokes.size - 1, steps + 1), np.arange(stokes.size), np.log(stokes)))
    scan[0], scan[-1] = stokes[0], stokes[-1]
    e_n, failed = _restitution(scene, np.repeat(angles, scan.size), np.tile(scan, len(angles)), rtol)
    e_n, failed = e_n.reshape(len(angles), -1), failed.reshape(len(angles), -1)
    rows, columns = np.nonzero(np.diff(e_n > 1, axis=1))
    ends = _closed_in(scene, np.asarray(angles)[rows], scan[columns], scan[columns + 1], rtol)
    found = []
    for j, angle in enumerate(angles):
        inside = e_n[j] > 1
        edges = [*scan[:1][inside[:1]], *ends[rows == j], *scan[-1:][inside[-1:]]]
        k = int(np.argmax(e_n[j]))
        spans = tuple((float(low), float(high)) for low, high in list(pairwise(edges))[::2])
        found.append(Above(float(angle), spans, float(e_n[j, k]), float(scan[k]), int(failed[j].sum())))
    return found


def _closed_in(scene: Scene, angles: np.ndarray, low: np.ndarray, high: np.ndarray, rtol: float) -> np.ndarray:
    """Where e_n crosses 1 between two Stokes numbers, all brackets in step."""
    while low.size and np.max(high / low - 1) > _SHARP:
        cuts = low[:, None] * (high / low)[:, None] ** np.linspace(0, 1, _PARTS + 1)
        e_n, _ = _restitution(scene, np.repeat(angles, cuts.shape[1]), cuts.ravel(), rtol)
        first = np.argmax(np.diff(e_n.reshape(cuts.shape) > 1, axis=1), axis=1)  # the ends differ: there is one
        row = np.arange(low.size)
        low, high = cuts[row, first], cuts[row, first + 1]
    return np.asarray(np.sqrt(low * high))


def _restitution(scene: Scene, angles: np.ndarray, stokes: np.ndarray, rtol: float) -> tuple[np.ndarray, np.ndarray]:
    """e_n of many collisions, and which failed: 0 there, as for a stick."""
    found = collide_many(scene, stokes=stokes, angle=angles, rtol=rtol, engine="taylor")
    failed = found["outcome"].values == FAILED
    return np.where(failed, 0.0, found["restitution"].values), failed
