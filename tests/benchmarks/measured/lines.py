"""Boundaries: traced as roots of smooth functions, beside searching for the change of outcome with the same engines."""

import math
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from wetdoublet.generated.automaton import OUTCOMES
from wetdoublet.solvers.boundaries.boundary import boundary
from wetdoublet.solvers.collision.collide import collide
from wetdoublet.solvers.formatting.markdown import ms, table
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.many.collide_many import collide_many
from wetdoublet.solvers.scene.scene import Scene

Record = dict[str, Any]

PRESETS = {"granulation": (30.0, 80.0), "pendulum": (45.0, 80.0)}
ANGLES = 6
STOKES = (0.003, 10.0)
_RTOL, _CLOSE = 1e-9, 1e-9  # tolerance of the integrations; relative width at which a search stops
_SHARPEST, _CLOSEST = 1e-13, 1e-11  # of the points that errors are measured against
_PER_DECADE = 4  # of the scan that a search starts from
_PARTS = 9  # that an interval is cut into where many collisions are as cheap as one: eight trials, a lane each
_ONE_BY_ONE = 2  # angles at which collisions are taken one by one

Outcomes = Callable[[np.ndarray, np.ndarray], np.ndarray]  # of Stokes numbers and angles


def by_one(scene: Scene, rtol: float) -> Outcomes:
    """Outcomes by `collide`, one after the other."""

    def outcomes(stokes: np.ndarray, angle: np.ndarray) -> np.ndarray:
        each = zip(stokes.tolist(), angle.tolist(), strict=True)
        found = [
            collide(scene, stokes=st, angle=theta, rtol=rtol, engine="rosenbrock", ledger=False).outcome
            for st, theta in each
        ]  # cvodes gives up so near a boundary
        return np.array([OUTCOMES.index(each) for each in found], dtype=np.int8)

    return outcomes


def in_bulk(scene: Scene, rtol: float) -> Outcomes:
    """Outcomes by the kernel, all in one call."""

    def outcomes(stokes: np.ndarray, angle: np.ndarray) -> np.ndarray:
        values: np.ndarray = collide_many(scene, stokes=stokes, angle=angle, rtol=rtol, engine="taylor")[
            "outcome"
        ].values
        return values

    return outcomes


def searched(
    outcomes: Outcomes, angles: np.ndarray, parts: int, close: float = _CLOSE, known: Sequence[Sequence[float]] = ()
) -> tuple[list[list[float]], int]:
    """Stokes numbers at which the outcome changes, by angle, and the collisions it took.

    Arguments:
        parts: that an interval is cut into; 2 is bisection. All intervals go in step.
        known: changes to start from instead of a scan, within 1e-4.
    """
    taken = 0
    if known:
        middle = np.concatenate([np.array(each) for each in known])
        theta = np.repeat(angles, [len(each) for each in known])
        low, high = middle * (1 - 1e-4), middle * (1 + 1e-4)
        before, taken = outcomes(low, theta), low.size
    else:
        grid = np.geomspace(*STOKES, 1 + round(_PER_DECADE * math.log10(STOKES[1] / STOKES[0])))
        found = outcomes(np.tile(grid, angles.size), np.repeat(angles, grid.size)).reshape(angles.size, grid.size)
        line, place = np.nonzero(found[:, 1:] != found[:, :-1])
        low, high, before = grid[place], grid[place + 1], found[line, place]
        theta, taken = angles[line], found.size
    inner = np.arange(1, parts) / parts
    while low.size and np.max(np.log(high / low)) > close:
        trials = low[:, None] * (high / low)[:, None] ** inner
        same = outcomes(trials.ravel(), np.repeat(theta, parts - 1)).reshape(trials.shape) == before[:, None]
        first = np.where(same.all(axis=1), parts - 1, np.argmin(same, axis=1))  # trials on the side it starts from
        edges = np.column_stack([low, trials, high])
        low, high = (edges[np.arange(low.size), first + k] for k in (0, 1))
        taken += trials.size
    points = np.sqrt(low * high)
    return [points[theta == angle].tolist() for angle in angles], taken


def lines() -> list[Record]:
    """Collisions, CPU time and error of a point on a boundary, by each way."""
    return [row for preset, degrees in PRESETS.items() for row in _of(preset, *degrees)]


def _of(preset: str, low: float, high: float) -> list[Record]:
    scene, angles = Scene.load(preset), np.radians(np.linspace(low, high, ANGLES))
    boundary(scene, angle=angles[:1], stokes=STOKES, rtol=_RTOL)  # builds
    some = angles[:: ANGLES // _ONE_BY_ONE]
    ways: dict[str, tuple[np.ndarray, Callable[[], tuple[list[list[float]], int]]]] = {
        "traced": (angles, lambda: _traced(scene, angles)),
        "bisected, collide": (some, lambda: searched(by_one(scene, _RTOL), some, 2)),
    }
    if compiler():
        in_bulk(scene, _RTOL)(np.array([1.0]), angles[:1])  # builds
        ways["bisected, kernel"] = (angles, lambda: searched(in_bulk(scene, _RTOL), angles, 2))
        ways["cut in nine, kernel"] = (angles, lambda: searched(in_bulk(scene, _RTOL), angles, _PARTS))
    rows: list[Record] = []
    truth: list[list[float]] = []
    for name, (asked, way) in ways.items():
        wall, cpu = time.perf_counter(), time.process_time()
        points, collisions = way()
        wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
        truth = truth or _truth(scene, angles, points)  # the traced ones come first
        there = [truth[int(np.argmin(abs(angles - angle)))] for angle in asked]
        apart = [
            abs(math.log(one / other)) for ours, right in zip(points, there, strict=True)
            if len(ours) == len(right) for one, other in zip(ours, right, strict=True)
        ]  # fmt: skip
        rows.append(
            {
                "preset": preset, "way": name, "angles": len(asked), "points": sum(map(len, points)),
                "collisions": collisions, "wall": wall, "cpu": cpu, "error": max(apart, default=None),
                "lines_apart": sum(len(ours) != len(right) for ours, right in zip(points, there, strict=True)),
            }
        )  # fmt: skip
    return rows


def _traced(scene: Scene, angles: np.ndarray) -> tuple[list[list[float]], int]:
    found = boundary(scene, angle=angles, stokes=STOKES, rtol=_RTOL)
    return [[change.stokes for change in each] for each in found.changes], found.collisions


def _truth(scene: Scene, angles: np.ndarray, known: Sequence[Sequence[float]]) -> list[list[float]]:
    """The points by search at 1e-13, which no way that is measured does; without a compiler, the traced ones."""
    if not compiler():
        return [list(each) for each in known]
    return searched(in_bulk(scene, _SHARPEST), angles, _PARTS, _CLOSEST, known)[0]


def line_table(found: Sequence[Record]) -> str:
    """Collisions, time and error a point."""
    rows = [
        [
            f"{each['preset']}, {each['angles']} angles",
            each["way"],
            str(each["points"]),
            f"{each['collisions'] / each['points']:.1f}",
            ms(each["cpu"] / each["points"]),
            "-" if each["error"] is None else f"{each['error']:.0e}",
            str(each["lines_apart"]),
        ]
        for each in found
    ]
    head = ["boundary", "way", "points", "collisions a point", "CPU ms a point", "largest error in ln St"]
    return table([*head, "angles where a change was missed"], rows)
