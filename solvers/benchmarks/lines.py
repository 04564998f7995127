"""Boundaries: traced as roots of smooth functions, beside bisection on the outcome."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np

from ..bounds import boundary
from ..many import collide_many
from ..scene import Scene

Record = dict[str, Any]

PRESETS = {"granulation": (30.0, 80.0), "pendulum": (45.0, 80.0)}
ANGLES = 6
STOKES = (0.003, 10.0)
_RTOL, _CLOSE = 1e-9, 1e-9  # tolerance of the integrations; relative width at which bisection stops
_PER_DECADE = 4  # of the scan that bisection starts from


def lines() -> list[Record]:
    """Collisions and wall time of a point on a boundary, traced and bisected, and how far the two are apart."""
    return [_of(preset, *degrees) for preset, degrees in PRESETS.items()]


def _of(preset: str, low: float, high: float) -> Record:
    scene, angles = Scene.load(preset), np.radians(np.linspace(low, high, ANGLES))
    boundary(scene, angle=angles[:1], stokes=STOKES, rtol=_RTOL)  # builds
    start = time.perf_counter()
    traced = boundary(scene, angle=angles, stokes=STOKES, rtol=_RTOL)
    wall = time.perf_counter() - start
    points = sum(len(each) for each in traced.changes)
    start, taken, apart, missed = time.perf_counter(), 0, [0.0], 0
    for angle, changes in zip(angles, traced.changes, strict=True):
        found, collisions = bisected(scene, float(angle))
        taken += collisions
        missed += len(found) != len(changes)
        if len(found) == len(changes):
            apart += [abs(math.log(one / other.stokes)) for one, other in zip(found, changes)]
    other = time.perf_counter() - start
    return {
        "preset": preset, "angles": ANGLES, "points": points, "apart": max(apart), "lines_apart": missed,
        "traced": {"collisions": traced.collisions, "wall": wall},
        "bisected": {"collisions": taken, "wall": other},
    }  # fmt: skip


def bisected(scene: Scene, angle: float) -> tuple[list[float], int]:
    """Stokes numbers at which the outcome changes, and the collisions it took: a scan, then all intervals in step."""
    count = 1 + round(_PER_DECADE * math.log10(STOKES[1] / STOKES[0]))
    grid = np.geomspace(*STOKES, count)
    outcomes = _outcomes(scene, grid, angle)
    changes = np.flatnonzero(outcomes[1:] != outcomes[:-1])
    low, high, before, taken = grid[changes], grid[changes + 1], outcomes[changes], count
    while low.size and np.max(np.log(high / low)) > _CLOSE:
        middle = np.sqrt(low * high)
        same = _outcomes(scene, middle, angle) == before
        low, high, taken = np.where(same, middle, low), np.where(same, high, middle), taken + low.size
    return [float(each) for each in np.sqrt(low * high)], taken


def _outcomes(scene: Scene, stokes: np.ndarray, angle: float) -> np.ndarray:
    values: np.ndarray = collide_many(scene, stokes=stokes, angle=angle, rtol=_RTOL)["outcome"].values
    return values
