"""`boundary_sensitivities()`: derivatives of every change of outcome in the scene's parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from ..boundaries.boundary import Boundaries, boundary
from ..boundaries.changes import Change
from ..boundaries.found import STOKES
from ..errors import ComputationError, InputError
from ..host.arguments import check_function
from ..scene.scene import Scene
from ..scene.schema import SPEEDS
from ..settings import RTOL, check_rtol
from .boundary_slope import slope
from .parameters import check_wrt, kind_of, parameter_map, references
from .result import Row

_SHARPEST = 1e-11  # tolerance of the differentiated trajectories, which pass the saddle


@dataclass(frozen=True)
class Moving:
    """A change of outcome and its derivatives; St* is that of the change, Ce* is None without a bridge.

    Attributes:
        gradient: "stokes", "centrifugal" -> parameter -> dSt*/dp, dCe*/dp, SI.
        elasticity: the same as d ln/d ln p; None where either is zero.
        reason: the reason if there are no derivatives; then both are empty.
    """

    change: Change
    gradient: dict[str, Row] = field(default_factory=dict)
    elasticity: dict[str, Row] = field(default_factory=dict)
    reason: str = ""

    def to_dict(self) -> dict[str, Any]:
        """The change as in `boundary --json`, with its "sensitivities", null if there are none."""
        both = {name: {"gradient": dict(self.gradient[name]), "elasticity": dict(self.elasticity[name])}
                for name in self.gradient}  # fmt: skip
        return self.change.to_dict() | {"sensitivities": both or None}


@dataclass(frozen=True)
class BoundarySensitivities:
    """The changes of outcome at each angle (rad), ascending in St, with their derivatives.

    Example:
        >>> from wetdoublet.solvers import boundary_sensitivities
        >>> found = boundary_sensitivities("granulation", angle=0.785, wrt=["liquid.viscosity"])
        >>> found.parameters
        ('liquid.viscosity',)
    """

    boundaries: Boundaries
    changes: tuple[tuple[Moving, ...], ...]
    parameters: tuple[str, ...]

    @property
    def angles(self) -> tuple[float, ...]:
        return self.boundaries.angles

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet boundary --wrt NAMES --json`."""
        changes = [[one.to_dict() for one in line] for line in self.changes]
        scene = self.boundaries.scene
        units = {name: scene.fields[name].unit or "1" for name in self.parameters} if scene else {}
        return {"angles": list(self.angles), "changes": changes} | self.boundaries.origin(angles="rad", **units)

    def __str__(self) -> str:
        return "\n\n".join([str(self.boundaries), *self._tables()])

    def _tables(self) -> list[str]:
        tables = []
        for angle, line in zip(self.angles, self.changes, strict=True):
            for one in line:
                what = "centrifugal" if "centrifugal" in one.elasticity else "stokes"
                symbol = {"centrifugal": "Ce*", "stokes": "St*"}[what]
                title = f"{np.degrees(angle):.6g} deg, {one.change.before} -> {one.change.after}"
                if one.reason:
                    tables.append(f"{title}: {one.reason}")
                    continue
                width = max(len(name) for name in self.parameters)
                rows = []
                for name in self.parameters:
                    elasticity, slope_ = one.elasticity[what][name], one.gradient[what][name]
                    shown = f"* {slope_:.4g}" if elasticity is None else f"{elasticity:.5g}" if elasticity else "none"
                    rows.append(f"  {name.ljust(width)}  {shown:>10}")
                tables.append("\n".join([f"{title}: d ln {symbol}/d ln p (* d{symbol}/dp where p is zero)", *rows]))
        return tables


def boundary_sensitivities(
    scene: Scene | str | FilePath,
    *,
    angle: Any = None,
    stokes: tuple[float, float] = STOKES,
    wrt: Sequence[str] | str | None = None,
    rtol: float = RTOL,
    traced: Boundaries | None = None,
    progress: Callable[[int], None] | None = None,
) -> BoundarySensitivities:
    """Derivatives of the Stokes and centrifugal numbers of every change of outcome in the scene's parameters.

    They are exact, by the implicit function theorem for functions that are smooth through the change. Each parameter
    varies alone; the speed follows the boundary.

    Arguments:
        scene: a Scene, a path or a preset's name.
        angle: impact angles in rad, a number or 1-D; default the scene's.
        stokes: lowest and highest Stokes number of the search.
        wrt: parameters by dotted name; None for every numeric entry of the scene, and the impact's angle.
        rtol: relative tolerance of the tracing.
        traced: the boundaries, if already computed.
        progress: called with the number of angles done, once they are traced.

    Returns:
        BoundarySensitivities: gradients (SI) and elasticities, change by change.

    Raises:
        InputError: an invalid angle, Stokes number or name. A change without a smooth function, or that cannot be
            followed, raises nothing; see its `reason`.

    Example:
        >>> from wetdoublet.solvers import boundary_sensitivities
        >>> [line] = boundary_sensitivities("granulation", angle=0.785, wrt=["particles.reduced_radius"]).changes
        >>> line[0].elasticity["centrifugal"]["particles.reduced_radius"] > 0
        True
    """
    loaded = Scene.load(scene)
    names = check_boundary_wrt(loaded, wrt)
    rtol = check_rtol(rtol)
    check_function(progress, "progress")
    if traced is not None and not isinstance(traced, Boundaries):
        raise InputError("traced", traced, "what boundary() has returned, or None", "is neither")
    found = boundary(loaded, angle=angle, stokes=stokes, rtol=rtol) if traced is None else traced
    lines: list[tuple[Moving, ...]] = []
    for at, line in zip(found.angles, found.changes, strict=True):
        lines.append(tuple(moving(loaded, at, change, names, rtol) for change in line))
        if progress:
            progress(len(lines))
    return BoundarySensitivities(found, tuple(lines), names)


def check_boundary_wrt(scene: Scene, wrt: Sequence[str] | str | None, label: str = "wrt") -> tuple[str, ...]:
    """The requested parameters; InputError for one that the scene does not have, and for speed and Stokes number."""
    names = check_wrt(scene, wrt, label)
    for name in names:
        if wrt is not None and name in SPEEDS:
            accepted = ", ".join(one for one in check_wrt(scene, None) if one not in SPEEDS)
            raise InputError(label, name, accepted, "is what a boundary is followed in")
    return tuple(name for name in names if name not in SPEEDS)


def moving(scene: Scene, angle: float, change: Change, names: tuple[str, ...], rtol: float = RTOL) -> Moving:
    """Derivatives of one change at an angle (rad) in the named parameters."""
    try:
        found = slope(scene, angle, change, min(rtol, _SHARPEST))
    except ComputationError as error:
        return Moving(change, reason=str(error))
    if found is None:
        return Moving(change, reason="no smooth function of its own: not differentiated")
    kind = kind_of(scene, "stokes")
    everything = (*names, "impact.stokes")
    via = parameter_map(kind, everything, found.groups)
    reference = references(scene, kind, scene.speed_of(change.stokes), angle)
    slopes, units = (np.asarray(each.full()) for each in via.slopes(reference))
    in_theta = found.gradient @ slopes[: len(found.groups)]
    if in_theta[-1] == 0:
        return Moving(change, reason="it does not depend on the Stokes number")
    along = -in_theta[:-1] / in_theta[-1]  # d ln St*/dtheta
    rows = {"stokes": along * change.stokes}
    values = {"stokes": change.stokes, "centrifugal": change.centrifugal}
    if change.centrifugal is not None:
        own = np.asarray(parameter_map(kind, everything, ("centrifugal",)).slopes(reference)[0].full())[0]
        rows["centrifugal"] = own[:-1] + own[-1] * along
    at = dict(zip(kind.entries, reference.tolist(), strict=True))
    return Moving(
        change,
        gradient={
            of: {name: float(row[k] / units[k].item()) + 0.0 for k, name in enumerate(names)}
            for of, row in rows.items()
        },
        elasticity={
            of: {name: float(row[k]) / value + 0.0 if at[name] and value else None for k, name in enumerate(names)}
            for of, row in rows.items()
            if (value := values[of]) is not None
        },
    )
