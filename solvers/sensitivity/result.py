"""Sensitivities of one collision: immutable; prints as a table, converts to the JSON object and to a Dataset."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import STICK
from ..formatting.tables import NotebookTable, numbers_aligned
from ..host.pictures import Drawn
from ..results import DEFINITIONS
from ..scene.held import NAMES
from ..scene.origin import Recorded, provenance
from .parameters import Row, cell

if TYPE_CHECKING:
    import xarray

    from ..scene.scene import Scene

_STICK_NOTES = (
    "a stick: its restitution is 0, and nothing else of it is defined, up to the boundary of sticking;",
    "that boundary and its sensitivities: `wetdoublet boundary SCENE --angle A --wrt NAMES`, `boundary_sensitivities`",
)
_ABOUT = ("outcome", "method", "engine", "hold")
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
class Sensitivities(Recorded, Drawn, NotebookTable):
    """Derivatives of a collision's results; SI and radians; None where undefined.

    `plot` draws a tornado chart of the elasticities.

    Attributes:
        value: each quantity's value.
        gradient: quantity -> parameter -> dy/dp, all others held.
        elasticity: quantity -> parameter -> d ln y/d ln p; None where y or p is zero.
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

    _picture = "sensitivity.plots.draw"
    _keys = "value gradient elasticity outcome method engine hold nearest=near rtol units"

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
    scene: Scene = field(repr=False, compare=False)

    @property
    def parameters(self) -> tuple[str, ...]:
        return tuple(self.reference)

    @property
    def units(self) -> dict[str, str]:
        """Units of the quantities and the parameters."""
        entries = self.scene.fields
        return {y: DEFINITIONS[y].unit for y in self.value} | {p: entries[p].unit or "1" for p in self.parameters}

    def to_dataset(self) -> xarray.Dataset:
        """Dataset of value, gradient and elasticity over `quantity` and `parameter`; NaN for None. Imports xarray."""
        import xarray as xr

        def array(rows: Iterable[Row]) -> np.ndarray:
            return np.array([list(row.values()) for row in rows], dtype=float)  # None is NaN

        over = ("quantity", "parameter")
        variables: dict[str, Any] = {
            "value": ("quantity", array([self.value])[0]),
            "gradient": (over, array(self.gradient.values())),
            "elasticity": (over, array(self.elasticity.values())),
        }
        coordinates: dict[str, Any] = {
            "quantity": list(self.value),
            "parameter": list(self.parameters),
            "units": ("quantity", [DEFINITIONS[name].unit for name in self.value]),
            "reference": ("parameter", list(self.reference.values())),
        }
        return xr.Dataset(
            variables, coordinates, provenance(self.scene, **{name: getattr(self, name) for name in _ABOUT})
        )

    def __str__(self) -> str:
        names = list(self.value)
        blocks = [self._block(names[k : k + _SHOWN]) for k in range(0, len(names), _SHOWN)]
        notes = [f"{self.outcome}; {self.method} derivatives by {self.engine}; {NAMES[self.hold]} held"]
        notes += [f"scene {self.scene.held}"] if self.scene.held else []
        rows = [row.values() for row in self.elasticity.values()]
        if any(value == 0 for row in rows for value in row):
            notes.append("none: the parameter has no influence here")
        if any(self._rounded(y, p) for y in names for p in self.parameters):
            notes.append("~0: contributions cancel but for rounding")
        notes += [f"nearest: {self.near}"] if self.near else []
        notes += [*_STICK_NOTES] if self.outcome == STICK else []
        return "\n\n".join([*blocks, "\n".join(notes)])

    def _block(self, names: list[str]) -> str:
        largest = {p: max((abs(self.elasticity[y][p] or 0.0) for y in names), default=0.0) for p in self.parameters}
        order = sorted(self.parameters, key=lambda p: -largest[p])
        head = ["", *names]
        units = ["value", *(_number(self.value[y], DEFINITIONS[y].unit) for y in names)]
        rows = [[p, *(self._cell(y, p) for y in names)] for p in order]
        title = "elasticities d ln y/d ln p (* dy/dp where y or p is zero)"
        lines = numbers_aligned([head, units, *rows])
        return "\n".join([*lines[:2], "", title, *lines[2:]])

    def _cell(self, y: str, p: str) -> str:
        return "~0" if self._rounded(y, p) else cell(self.elasticity[y][p], self.gradient[y][p])

    def _rounded(self, y: str, p: str) -> bool:
        """True if a nonzero elasticity is only rounding error."""
        largest = max((abs(value or 0.0) for value in self.elasticity[y].values()), default=0.0)
        return 0 < abs(self.elasticity[y][p] or 0.0) < _ROUNDING * largest


def _number(value: float | None, unit: str) -> str:
    if value is None:
        return "-"
    return f"{value:.6g}" + ("" if unit == "1" else f" {unit}")
