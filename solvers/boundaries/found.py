"""What is found of boundaries, as data: changes on lines of constant angle, and curves and points in a plane."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..scene.scene import Scene
from .arcs import CHORD, Arc
from .changes import MERGED, Change
from .plane import ANGLE
from .regions import Slab, labelled, slabs

STOKES = (1e-4, 100.0)  # between which changes are looked for, unless something else is asked
LATTICE = (65, 193)  # columns and rows from which curves are sought, where there is a kernel


@dataclass(frozen=True)
class Lines:
    """Changes of outcome for each angle (rad), ascending in St.

    Attributes:
        collisions: how many had to be integrated.
        failures: the reason of each line that could not be traced (its changes are then empty), else "".
        resolution: relative spacing of the Stokes numbers at which every line was looked at. A strip of an outcome that
            is wider is seen; a narrower one is where a margin (of a rebound criterion, of the escape) shows it.
        scene, window: whose boundaries they are, and the Stokes numbers between which they were looked for.
    """

    angles: tuple[float, ...]
    changes: tuple[tuple[Change, ...], ...]
    collisions: int
    failures: tuple[str, ...] = ()
    resolution: float = 0.0
    scene: Scene | None = field(default=None, repr=False)
    window: tuple[float, float] = STOKES

    @property
    def failed(self) -> tuple[tuple[float, str], ...]:
        """Angle and reason of the lines that could not be traced."""
        return tuple(pair for pair in zip(self.angles, self.failures, strict=True) if pair[1])

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet boundary --json`."""
        return {"angles": list(self.angles), "changes": [[one.to_dict() for one in line] for line in self.changes]}

    def __str__(self) -> str:
        lines = ["angle (deg)   St              Ce          change"]
        for angle, changes in zip(self.angles, self.changes, strict=True):
            for one in changes:
                ce = "-" if one.centrifugal is None else f"{one.centrifugal:.6g}"
                lines.append(f"{math.degrees(angle):<13.6g} {one.stokes:<15.10g} {ce:<11} {one.before} -> {one.after}")
            if not changes:
                failure = next((reason for at, reason in self.failed if at == angle), "no change")
                lines.append(f"{math.degrees(angle):<13.6g} {failure}")
        points = sum(len(changes) for changes in self.changes)
        merged = sum(one.merged for line in self.changes for one in line)
        lines += [f"{merged} of the changes stand for several closer than {MERGED:g}"] if merged else []
        looked = f"; strips narrower than {self.resolution:.1%} of St are seen where a margin shows them"
        return "\n".join([*lines, f"{points} changes from {self.collisions} collisions{looked}"])


@dataclass(frozen=True)
class Curve:
    """A boundary between outcomes, x ascending: `before` is below it, `after` above.

    Arguments:
        kind: as of a `Change`.
        x, stokes: points of it; x in rad, or SI.
    """

    before: str
    after: str
    kind: str
    x: tuple[float, ...]
    stokes: tuple[float, ...]

    def to_dict(self) -> dict[str, Any]:
        """As in the JSON object of `wetdoublet boundary --angle LO:HI`."""
        return {
            "from": self.before,
            "to": self.after,
            "kind": self.kind,
            "x": list(self.x),
            "stokes": list(self.stokes),
        }


@dataclass(frozen=True)
class Point:
    """A place where curves meet, turn, or change in kind."""

    kind: str
    x: float
    stokes: float

    def to_dict(self) -> dict[str, Any]:
        """As in the JSON object of `wetdoublet boundary --angle LO:HI`."""
        return {"kind": self.kind, "x": self.x, "stokes": self.stokes}


@dataclass(frozen=True)
class Curves(Lines):
    """Boundaries in a plane: the seed lines, the curves, and where they meet.

    Attributes:
        over: dotted name of x.
        span: of x, rad or SI.
        at: x of the lines; `angles` are their impact angles.
        curves, points: boundaries, and where they meet, turn or change in kind.
        unsettled: places (x, St) that could not be brought into agreement, and why.
        sought: what the curves were sought with: lattice and lines.
        lattice: its columns and rows; fewer where there is no kernel for the scene.
    """

    over: str = ANGLE
    span: tuple[float, float] = (0.0, 1.0)
    at: tuple[float, ...] = ()
    curves: tuple[Curve, ...] = ()
    points: tuple[Point, ...] = ()
    unsettled: tuple[tuple[float, float, str], ...] = ()
    background: str = OUTCOMES[0]
    lattice: tuple[int, int] = LATTICE

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet boundary --angle LO:HI --json`."""
        found = {
            "curves": [one.to_dict() for one in self.curves],
            "points": [one.to_dict() for one in self.points],
            "resolution": self.sought,
        }
        if self.unsettled:
            found["unsettled"] = [{"x": x, "stokes": stokes, "reason": why} for x, stokes, why in self.unsettled]
        return found

    @property
    def sought(self) -> dict[str, float | str]:
        """Distances in x and relative distances in St within which the curves were sought, and their precision."""
        decades = math.log(self.window[1] / self.window[0])
        across = self.span[1] - self.span[0]
        return {
            "over": self.over,
            "lines": len(self.at),
            "line_spacing": across / max(len(self.at) - 1, 1),
            "line_stokes": self.resolution,
            "lattice_spacing": across / (self.lattice[0] - 1),
            "lattice_stokes": math.expm1(decades / (self.lattice[1] - 1)),
            "chord_stokes": math.expm1(CHORD * decades),
        }

    def region(self, x: Any, stokes: Any) -> np.ndarray:
        """Outcomes (0 stick, 1 stick-rotate-separate, 2 bounce) of the regions that points of the plane lie in.

        Arguments:
            x, stokes: arrays of one shape; x in rad, or SI. Points that are not in the window have -1.
        """
        x, stokes = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(stokes, dtype=float))
        inside = (x >= self.span[0]) & (x <= self.span[1]) & (stokes >= self.window[0]) & (stokes <= self.window[1])
        found = np.full(x.shape, -1, dtype=np.int8)
        found[inside] = labelled(self.slabs(), self.unit(x[inside], stokes[inside]))[0]
        return found

    def unit(self, x: Any, stokes: Any) -> np.ndarray:
        """Points of the unit square, n x 2, at values of x and Stokes numbers."""
        across = (np.asarray(x) - self.span[0]) / (self.span[1] - self.span[0])
        up = np.log(np.asarray(stokes) / self.window[0]) / math.log(self.window[1] / self.window[0])
        return np.column_stack([across, up])

    def slabs(self) -> list[Slab]:
        """The window cut into parts between whose curves lies one outcome each."""
        arcs = [
            Arc(self.unit(one.x, one.stokes), OUTCOMES.index(one.before), OUTCOMES.index(one.after))
            for one in self.curves
        ]
        return slabs(arcs, np.array([0.5]), np.array([OUTCOMES.index(self.background)]))

    def __str__(self) -> str:
        angle = self.over == ANGLE
        name, shown = ("angle (deg)", math.degrees) if angle else (self.over, float)
        lines = [f"{'curve':<42} {'kind':<16} {name} and St, from ... to"]
        for one in self.curves:
            ends = " ... ".join(f"{shown(one.x[k]):.6g}, {one.stokes[k]:.6g}" for k in (0, -1))
            lines.append(f"{one.before + ' -> ' + one.after:<42} {one.kind:<16} {ends}")
        lines += [] if self.curves else [f"none: {self.background} everywhere"]
        if self.points:
            lines += ["", f"{'point':<24} {name:<18} St"]
            lines += [f"{one.kind:<24} {shown(one.x):<18.10g} {one.stokes:.10g}" for one in self.points]
        lines += [f"not settled at {shown(x):.6g}, St {stokes:.6g}: {why}" for x, stokes, why in self.unsettled]
        sought, spacing = self.sought, self.sought["line_spacing"]
        assert isinstance(spacing, float)
        told = (
            f"sought with {len(self.at)} lines, {shown(spacing):.3g} apart, and strips of {self.resolution:.2%} in St "
            f"on them; {self.collisions} collisions; straight lines between the points of a curve are within "
            f"{sought['chord_stokes']:.1e} of St"
        )
        if self.lattice != LATTICE:
            told += (
                f"; without the compiled kernel, from a lattice of {self.lattice[0]} by {self.lattice[1]} collisions"
            )
        return "\n".join([*lines, "", told])
