"""Boundaries as data: changes on lines of constant angle, and curves and points in a plane."""

from __future__ import annotations

import math
from dataclasses import field, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated import scaling
from ...generated.automaton import OUTCOMES
from ..host.pictures import Drawn
from ..scene.items import OUTCOME, columns, item
from ..scene.origin import Record, Result, origin, provenance
from ..scene.quantities import quantities
from ..scene.scene import Scene
from ..scene.schema import MEETING
from .arcs import CHORD, Arc
from .changes import MERGED, Change
from .plane import ANGLE, unit_points
from .regions import Slab, labelled, slabs

if TYPE_CHECKING:
    import xarray

LINES = 33  # default number of seed lines of an atlas
_EDGE = 1e-6  # height in the window up to which a curve ends on its lower edge
LATTICE = (65, 193)  # columns and rows of the search lattice


class Boundaries(Result, Drawn):
    """Changes of outcome for each angle (rad), ascending in St, as `boundary` returns them.

    `plot` draws the regions of each outcome, the curves and where they meet.

    Example:
        >>> from wetdoublet.solvers import boundary
        >>> found = boundary("granulation", angle=0.7, stokes=(0.05, 0.2))
        >>> found.to_dataset().stokes.sizes
        Frozen({'line': 1, 'change': 2})
    """

    _picture = "boundaries.plot.draw"

    angles: tuple[float, ...]
    changes: tuple[tuple[Change, ...], ...]
    collisions: int = item("number of integrated collisions")
    failures: tuple[str, ...] = item('why each line could not be traced (its changes are then empty), else ""')
    resolution: float = item(
        "relative spacing of the sampled Stokes numbers of every line. Wider strips of an outcome are found; narrower "
        "ones only where a margin (of a rebound criterion, of the escape) shows them"
    )
    scene: Scene = field(repr=False)
    window: tuple[float, float] = item("range of Stokes numbers of the search")
    rtol: float = item("relative tolerance of the integrations")

    @property
    def failed(self) -> tuple[tuple[float, str], ...]:
        """Angle (rad) and reason of the lines that could not be traced."""
        return tuple(pair for pair in zip(self.angles, self.failures, strict=True) if pair[1])

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet boundary --json`."""
        lines = zip(self.angles, self.changes, strict=True)
        changes = [[self.change_dict(change, angle) for change in line] for angle, line in lines]
        return {"angles": list(self.angles), "changes": changes} | self.origin(angles="rad")

    def change_dict(self, change: Change, angle: float) -> dict[str, Any]:
        """A change on the line of an angle (rad) as in the JSON objects, with its speeds."""
        speed = self.scene.speed_of(change.stokes)
        return change.to_dict() | {"angle": angle, "speed": speed, "relative_speed": speed / math.cos(angle)}

    @property
    def range_text(self) -> str:
        """The range of the search in words: Stokes numbers, and normal speeds where these are the same on all lines."""
        low, high = self.window
        numbers = f"St {low:g} to {high:g}"
        if self._scale_varies:
            return numbers
        return f"{numbers} (normal speed {self.scene.speed_of(low):.4g} to {self.scene.speed_of(high):.4g} m/s)"

    @property
    def _scale_varies(self) -> bool:
        """True if the speed of a Stokes number differs from line to line."""
        return False

    def origin(self, **units: str) -> dict[str, Any]:
        """Provenance for the JSON objects; `units` by key, in addition to those of changes."""
        always = {"stokes": "1", "centrifugal": "1", "speed": "m/s", "relative_speed": "m/s", "angle": "rad"}
        search = {"rtol": self.rtol, "searched": list(self.window), "units": {**units, **always}}
        return search | origin(self.scene)

    def __str__(self) -> str:
        lines = [f"angle (deg)   St              Ce          {self.speed_heading:<18} change"]
        for angle, changes, failure in zip(self.angles, self.changes, self.failures, strict=True):
            degrees = f"{math.degrees(angle):<13.6g}"
            for change in changes:
                ce = "-" if change.centrifugal is None else f"{change.centrifugal:.6g}"
                speed = self.speed_at(change.stokes, angle)
                cells = f"{change.stokes:<15.10g} {ce:<11} {speed:<18.6g} {change.before} -> {change.after}"
                lines.append(f"{degrees} {cells}")
            lines += [] if changes else [f"{degrees} {failure or f'no change for {self.range_text}'}"]
        points = sum(len(changes) for changes in self.changes)
        merged = sum(change.merged for line in self.changes for change in line)
        lines += [f"{merged} of the changes stand for several closer than {MERGED:g}"] if merged else []
        text = f"{points} change{'s' * (points != 1)} from " + (
            f"{self.collisions} collisions" if self.collisions else "proofs at initial contact, without a collision"
        )
        lines.append(f"{text} for {self.range_text}; strips narrower than {self.resolution:.1%} in St may be missed")
        return "\n".join(lines)

    def to_dataset(self) -> xarray.Dataset:
        """Dataset over `line` and `change`, with units in attributes, padded with NaN, -1 and ""."""
        import xarray as xr

        over = ("line", "change")
        failures = np.array(self.failures, dtype=str), {"long_name": "why a line could not be traced"}
        variables = columns(Change, self.changes, ("stokes", "centrifugal", "kind"), *over)
        variables |= {"failure": (("line",), *failures), **columns(Change, self.changes, ("before", "after"), *over)}
        angle = "line", np.array(self.angles), {"units": "rad", "long_name": "impact angle"}
        attributes = provenance(
            self.scene, resolution=self.resolution, collisions=self.collisions, searched=self.range_text
        )
        return xr.Dataset(variables, {"angle": angle}, attributes)

    @property
    def speed_heading(self) -> str:
        """Name of the speed that `speed_at` returns."""
        return "rel. speed (m/s)" if self._relative else "normal speed (m/s)"

    def speed_at(self, stokes: float, angle: float) -> float:
        """Speed in m/s of a Stokes number at an angle (rad).

        The magnitude of the relative velocity if the scene's impact has a `relative_speed`, else the normal speed.
        """
        speed = self.scene.speed_of(stokes)
        return speed / math.cos(angle) if self._relative else speed

    @property
    def _relative(self) -> bool:
        return self.scene.impact.relative_speed is not None


class Curve(Record):
    """A boundary between outcomes, x ascending."""

    _keys = "from=before to=after kind x stokes"

    before: str = item("outcome below the curve", OUTCOME)
    after: str = item("outcome above the curve", OUTCOME)
    kind: str = item("kind of change: as in `Change`")
    x: tuple[float, ...] = item("x of its points, rad or SI", "SI")
    stokes: tuple[float, ...] = item("Stokes number", "1")


class Point(Record):
    """A point where curves meet, have a fold, or change in kind."""

    kind: str = item("what happens there")
    x: float = item("rad or SI", "SI")
    stokes: float = item("Stokes number", "1")


class Atlas(Boundaries):
    """All boundaries in a plane, as `atlas` returns them: the seed lines, the curves and their meeting points.

    Example:
        >>> from wetdoublet.solvers import atlas
        >>> found = atlas("granulation-dry-bridge", span=("20 deg", "30 deg"), stokes=(0.05, 0.3), lines=2)
        >>> found.region([0.5, 0.5], [0.06, 0.29])  # a doublet that rotates and separates, and a bounce
        array([1, 2], dtype=int8)
    """

    over: str = item("dotted name of the entry x", default=ANGLE)
    span: tuple[float, float] = item("range of x, rad or SI", default=(0.0, 1.0))
    at: tuple[float, ...] = item("x of the lines; `angles` are their impact angles", default=())
    curves: tuple[Curve, ...] = ()
    points: tuple[Point, ...] = ()
    unsettled: tuple[tuple[float, float, str], ...] = item(
        "places (x, St) where collisions and curves disagree, with the reason", default=()
    )
    background: str = OUTCOMES[0]

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet boundary --angle LO:HI --json`."""
        result = {
            "curves": [curve.to_dict() | self._speeds(curve.x, curve.stokes) for curve in self.curves],
            "points": [point.to_dict() | self._speeds(point.x, point.stokes) for point in self.points],
            "resolution": self.sought,
        }
        if self.unsettled:
            result["unsettled"] = [{"x": x, "stokes": stokes, "reason": why} for x, stokes, why in self.unsettled]
        return result | self.origin(x=self._unit or "1")

    @property
    def _unit(self) -> str:
        """Unit of x in SI; empty for a number."""
        return self.scene.fields[self.over].unit or ""

    def _speeds(self, x: Any, stokes: Any) -> dict[str, Any]:
        """Normal and relative speeds (m/s) of points of the plane, for JSON."""
        entries: dict[str, Any] = {name: value for name, value in self.scene.si if name not in MEETING}
        angle = np.asarray(x if self.over == ANGLE else self.scene.angle)
        of = quantities(entries | ({} if self.over == ANGLE else {self.over: np.asarray(x)}), self.scene.ways)
        speed = np.asarray(stokes) / scaling.stokes(of["reduced_radius"], of["reduced_mass"], of["viscosity"], 1.0)
        return {"speed": speed.tolist(), "relative_speed": (speed / np.cos(angle)).tolist()}

    @property
    def _scale_varies(self) -> bool:
        return self.over != ANGLE

    @property
    def sought(self) -> dict[str, float | str]:
        """Resolution of the search, as distances in x and relative distances in St, and precision of the curves."""
        log_height = math.log(self.window[1] / self.window[0])
        across = self.span[1] - self.span[0]
        return {
            "over": self.over,
            "lines": len(self.at),
            "line_spacing": across / max(len(self.at) - 1, 1),
            "line_stokes": self.resolution,
            "lattice_spacing": across / (LATTICE[0] - 1),
            "lattice_stokes": math.expm1(log_height / (LATTICE[1] - 1)),
            "chord_stokes": math.expm1(CHORD * log_height),
        }

    def region(self, x: Any, stokes: Any) -> np.ndarray:
        """Outcomes (0 stick, 1 stick-rotate-separate, 2 bounce) of the regions that contain points of the plane.

        Arguments:
            x, stokes: arrays of one shape; x in rad or SI. Points outside the window have -1.
        """
        x, stokes = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(stokes, dtype=float))
        inside = (x >= self.span[0]) & (x <= self.span[1]) & (stokes >= self.window[0]) & (stokes <= self.window[1])
        outcomes = np.full(x.shape, -1, dtype=np.int8)
        outcomes[inside] = labelled(self.slabs(), unit_points(self.span, self.window, x[inside], stokes[inside]))
        return outcomes

    def slabs(self) -> list[Slab]:
        """The window divided into slabs in x, with one outcome between neighbouring curves."""
        arcs = [
            Arc(
                unit_points(self.span, self.window, curve.x, curve.stokes),
                OUTCOMES.index(curve.before),
                OUTCOMES.index(curve.after),
            )
            for curve in self.curves
        ]
        parts = slabs(arcs, np.array([0.5]), np.array([OUTCOMES.index(self.background)]))
        for order in (1, -1):  # beyond the last curve only the region goes on that no curve has closed
            for before, k in pairwise(range(len(parts))[::order]):
                if parts[before].arcs and not parts[k].arcs:
                    below = sum(arc.points[-1 if order > 0 else 0, 1] < _EDGE for arc in parts[before].arcs)
                    parts[k] = replace(parts[k], labels=(parts[before].labels[below],))
        return parts

    def __str__(self) -> str:
        angle = self.over == ANGLE
        unit, value = ("deg", math.degrees) if angle else (self._unit, float)
        name = "angle" if angle else self.over
        name += f" ({unit})" * bool(unit)
        lines = [f"{'curve':<42} {'kind':<16} {name} and St, from ... to"]
        for curve in self.curves:
            ends = " ... ".join(f"{value(curve.x[k]):.6g}, {curve.stokes[k]:.6g}" for k in (0, -1))
            lines.append(f"{curve.before + ' -> ' + curve.after:<42} {curve.kind:<16} {ends}")
        lines += [] if self.curves else [f"none: {self.background} everywhere, for {self.range_text}"]
        if self.points:
            lines += ["", f"{'point':<24} {name:<18} St"]
            lines += [f"{point.kind:<24} {value(point.x):<18.10g} {point.stokes:.10g}" for point in self.points]
        lines += [f"not settled at {value(x):.6g}, St {stokes:.6g}: {why}" for x, stokes, why in self.unsettled]
        sought, spacing = self.sought, self.sought["line_spacing"]
        assert isinstance(spacing, float)
        apart = f"{value(spacing):.3g} {unit}".rstrip()
        text = (
            f"{self.range_text}; from {len(self.at)} lines, {apart} apart, sampled every {self.resolution:.2%} in St; "
            f"{self.collisions} collisions; straight lines between the points of a curve are within "
            f"{sought['chord_stokes']:.1e} of St, relative"
        )
        return "\n".join([*lines, "", text])

    def to_dataset(self) -> xarray.Dataset:
        """The Dataset of the lines, with curves over (curve, vertex), points over point, and x of the lines."""
        data = super().to_dataset()
        x: dict[str, Any] = {"units": self._unit or "1", "long_name": self.over}
        curves = columns(Curve, self.curves, ("x", "stokes"), "curve", "vertex")
        curves |= columns(Curve, self.curves, ("before", "after", "kind"), "curve")
        points = columns(Point, self.points, ("kind", "x", "stokes"), "point")
        for word, of in (("curve", curves), ("point", points)):
            of["x"] = *of["x"][:2], x
            data = data.assign({f"{word}_{name}": column for name, column in of.items()})
        more = {"over": self.over} | {f"sought_{name}": value for name, value in self.sought.items()}
        return data.assign_coords(x=("line", np.array(self.at), x)).assign_attrs(more)
