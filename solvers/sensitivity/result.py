"""Sensitivities of one collision: immutable; prints as a table, converts to the JSON object and to a Dataset."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..scene.origin import origin
from .results import QUANTITIES

if TYPE_CHECKING:
    import xarray

    from ..scene.scene import Scene

Row = Mapping[str, float | None]
_SHOWN = 5  # most quantities side by side
_ROUNDING = 1e-13  # relative to the largest elasticity; smaller ones are rounding errors of cancelling contributions


@dataclass(frozen=True)
class Near:
    """The nearest known boundary, and the collision's distance from it relative to the quantity `of`."""

    boundary: str
    distance: float
    of: str

    def __str__(self) -> str:
        return f"{self.boundary} at a relative distance of {self.distance:.2g} in {self.of}"


@dataclass(frozen=True, kw_only=True)
class Sensitivities:
    """Derivatives of a collision's results; SI and radians; None where undefined.

    Attributes:
        value: each quantity's value.
        gradient: quantity -> parameter -> dy/dp, all others held.
        elasticity: quantity -> parameter -> d ln y/d ln p; None where y or p is zero.
        hessian: quantity -> parameter -> parameter -> d2y/dp dq, if requested.
        hessian_times: quantity -> parameter -> the Hessian times the requested vector.
        outcome: outcome of the collision.
        reference: values of the parameters.
        near: the nearest boundary found from the trajectory, None if there is none.
        rtol: relative tolerance that was asked for.

    Example:
        >>> from wetdoublet.solvers import sensitivities
        >>> found = sensitivities("granulation", wrt=["liquid.viscosity"], stokes=0.02, angle="75 deg")
        >>> round(found.elasticity["restitution"]["liquid.viscosity"], 3)
        -0.003
    """

    value: Mapping[str, float | None]
    gradient: Mapping[str, Row]
    elasticity: Mapping[str, Row]
    reference: Mapping[str, float]
    outcome: str
    method: str
    engine: str
    hold: str
    rtol: float
    near: Near | None = None
    hessian: Mapping[str, Mapping[str, Row]] | None = None
    hessian_times: Mapping[str, Row] | None = None
    scene: Scene = field(repr=False, compare=False)

    @property
    def parameters(self) -> tuple[str, ...]:
        return tuple(self.reference)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet sensitivity --json`."""
        found: dict[str, Any] = {
            "value": dict(self.value),
            "gradient": {name: dict(row) for name, row in self.gradient.items()},
            "elasticity": {name: dict(row) for name, row in self.elasticity.items()},
        }
        if self.hessian is not None:
            found["hessian"] = {
                name: {one: dict(row) for one, row in rows.items()} for name, rows in self.hessian.items()
            }
        if self.hessian_times is not None:
            found["hessian_times"] = {name: dict(row) for name, row in self.hessian_times.items()}
        near = self.near and {"boundary": self.near.boundary, "distance": self.near.distance, "of": self.near.of}
        return found | {
            "outcome": self.outcome,
            "method": self.method,
            "engine": self.engine,
            "hold": self.hold,
            "nearest": near,
            "rtol": self.rtol,
            "units": {name: QUANTITIES[name].unit for name in self.value}
            | {name: self.scene.fields[name].unit or "1" for name in self.parameters},
            **origin(self.scene),
        }

    def to_dataset(self) -> xarray.Dataset:
        """Dataset of value, gradient and elasticity over `quantity` and `parameter`; NaN for None. Imports xarray."""
        import numpy as np
        import xarray as xr

        def array(rows: Mapping[str, Row]) -> np.ndarray:
            return np.array([[np.nan if v is None else v for v in row.values()] for row in rows.values()], dtype=float)

        value = np.array([np.nan if v is None else v for v in self.value.values()], dtype=float)
        variables: dict[str, Any] = {
            "value": ("quantity", value),
            "gradient": (("quantity", "parameter"), array(self.gradient)),
            "elasticity": (("quantity", "parameter"), array(self.elasticity)),
        }
        if self.hessian is not None:
            bent = np.stack([array(rows) for rows in self.hessian.values()])
            variables["hessian"] = (("quantity", "parameter", "with_respect_to"), bent)
        coordinates: dict[str, Any] = {
            "quantity": list(self.value),
            "parameter": list(self.parameters),
            "units": ("quantity", [QUANTITIES[name].unit for name in self.value]),
            "reference": ("parameter", list(self.reference.values())),
        }
        if self.hessian is not None:
            coordinates["with_respect_to"] = list(self.parameters)
        attributes = {"outcome": self.outcome, "method": self.method, "engine": self.engine, "hold": self.hold}
        return xr.Dataset(variables, coordinates, attributes)

    def __str__(self) -> str:
        names = list(self.value)
        blocks = [self._block(names[k : k + _SHOWN]) for k in range(0, len(names), _SHOWN)]
        held = {
            "speed": "the impact's speed",
            "stokes": "the Stokes number",
            "relative_speed": "the relative speed",
        }[self.hold]
        notes = [f"{self.outcome}; {self.method} derivatives by {self.engine}; {held} held"]
        rows = [row.values() for row in self.elasticity.values()]
        if any(value == 0 for row in rows for value in row):
            notes.append("none: it has no influence here")
        if any(self._rounded(y, p) for y in names for p in self.parameters):
            notes.append("~0: what rounding leaves of contributions that cancel")
        notes += [f"nearest: {self.near}"] if self.near else []
        return "\n\n".join([*blocks, *self._bent(), "\n".join(notes)])

    def _block(self, names: list[str]) -> str:
        largest = {p: max((abs(self.elasticity[y][p] or 0.0) for y in names), default=0.0) for p in self.parameters}
        order = sorted(self.parameters, key=lambda p: -largest[p])
        head = ["", *names]
        units = ["value", *(_number(self.value[y], QUANTITIES[y].unit) for y in names)]
        rows = [[p, *(self._cell(y, p) for y in names)] for p in order]
        widths = [max(len(row[k]) for row in (head, units, *rows)) for k in range(len(head))]

        title = "elasticities d ln y/d ln p (* dy/dp where y or p is zero)"
        return "\n".join([*_aligned([head, units], widths), "", title, *_aligned(rows, widths)])

    def _bent(self) -> list[str]:
        """Tables of second derivatives, one per quantity, and of the Hessian times a vector, if requested."""
        names, tables = self.parameters, []
        for y, rows in (self.hessian or {}).items():
            for k in range(0, len(names), _SHOWN):
                some = names[k : k + _SHOWN]
                cells = [["", *some], *([p, *(_number(rows[p][q], "1") for q in some)] for p in names)]
                tables.append("\n".join([f"d2y/dp dq of y = {y} (SI units, rad)", *_aligned(cells)]))
        if self.hessian_times is not None:
            of = list(self.hessian_times)
            cells = [["", *of], *([p, *(_number(self.hessian_times[y][p], "1") for y in of)] for p in names)]
            tables.append("\n".join(["Hessian times the vector (SI units, rad)", *_aligned(cells)]))
        return tables

    def _cell(self, y: str, p: str) -> str:
        elasticity, gradient = self.elasticity[y][p], self.gradient[y][p]
        if elasticity is None:
            return "-" if gradient is None else f"* {gradient:.4g}"
        if elasticity == 0:
            return "none"
        return "~0" if self._rounded(y, p) else f"{elasticity:.5g}"

    def _rounded(self, y: str, p: str) -> bool:
        """True if a nonzero elasticity is only rounding error."""
        largest = max((abs(value or 0.0) for value in self.elasticity[y].values()), default=0.0)
        return 0 < abs(self.elasticity[y][p] or 0.0) < _ROUNDING * largest

    def plot(self, path: str | Path | None = None) -> Any:
        """A tornado chart of the elasticities; returns the matplotlib Figure.

        Arguments:
            path: file to write (.png, .pdf or .svg); None only draws.
        """
        from ..host.files import save
        from ..host.outputs import PICTURES, check_file
        from .tornado import draw

        file = None if path is None else check_file(path, "path", PICTURES)
        figure = draw(self)
        if file is not None:
            save(figure, file, dpi=150)
        return figure


def _aligned(rows: list[list[str]], widths: list[int] | None = None) -> list[str]:
    """Lines of aligned cells, the first column left-aligned; column widths as needed or as in `widths`."""
    widths = widths or [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return ["  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]).rstrip() for row in rows]


def _number(value: float | None, unit: str) -> str:
    if value is None:
        return "-"
    return f"{value:.6g}" + ("" if unit == "1" else f" {unit}")
