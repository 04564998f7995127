"""Stokes numbers at which e_n crosses 1 along lines of constant angle, by a scan and refinement of each crossing.

e_n may also jump across 1 where the outcome changes; the crossing is then that change.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..engines.choice import collision_engine
from ..many.collide_many import collide_many
from ..many.results import FAILED
from ..scene.scene import Scene

_FINER = 16  # scan steps per grid step with the kernel
_PARTS = 32  # subdivisions of a bracket in a round
_SHARP = 2e-5  # final relative width of a bracket; edges are shown with three digits


@dataclass(frozen=True)
class Above:
    """Where e_n > 1 at one angle.

    Attributes:
        spans: Stokes intervals, ascending; limited by the scan where e_n > 1 at its end.
        most, at: largest e_n of the scan, and its Stokes number.
        failed: number of collisions of the scan that failed.
    """

    angle: float
    spans: tuple[tuple[float, float], ...]
    most: float
    at: float
    failed: int


def above_one(scene: Scene, angles: Sequence[float], stokes: np.ndarray, rtol: float) -> list[Above]:
    """Stokes intervals with e_n > 1, with ends accurate to a relative 1e-5.

    Arguments:
        angles: impact angles, rad.
        stokes: Stokes numbers, ascending; intervals narrower than their steps (with a kernel, a sixteenth of these) may
            be missed.
    """
    steps = (stokes.size - 1) * (_FINER if collision_engine(scene) == "taylor" else 1)
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
    """Refine all brackets of crossings of e_n = 1 together."""
    while low.size and np.max(high / low - 1) > _SHARP:
        cuts = low[:, None] * (high / low)[:, None] ** np.linspace(0, 1, _PARTS + 1)
        e_n, _ = _restitution(scene, np.repeat(angles, cuts.shape[1]), cuts.ravel(), rtol)
        first = np.argmax(np.diff(e_n.reshape(cuts.shape) > 1, axis=1), axis=1)  # exists, because the ends differ
        row = np.arange(low.size)
        low, high = cuts[row, first], cuts[row, first + 1]
    return np.asarray(np.sqrt(low * high))


def _restitution(scene: Scene, angles: np.ndarray, stokes: np.ndarray, rtol: float) -> tuple[np.ndarray, np.ndarray]:
    """e_n of many collisions, and a mask of failures, where e_n is 0 as for a stick."""
    found = collide_many(scene, stokes=stokes, angle=angles, rtol=rtol, engine="taylor")
    failed = found["outcome"].values == FAILED
    return np.where(failed, 0.0, found["restitution"].values), failed
