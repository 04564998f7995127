"""The e_n > 1 argument as findings: the identity, its ceiling, and the region it leads to, named and tabulated."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import xarray

from ..scene import Scene
from .budget import LOSSES, TERMS, restitution_budget
from .conserved import RESIDUAL
from .report import Finding, bounded
from .sample import own_stokes, place

ANGLES = tuple(range(5, 90, 5))  # deg
_DECADES, _POINTS = (-1.0, 1.6), 27  # of the scene's own Stokes number: ten a decade
_RTOL = 1e-10
_HEADS = ("released", "film", "shear", "bridge", "solids", "strings")
_SHOWN = (30, 60, 75)  # deg: of the table, each with its first, middle and last St that separates


def grid(scene: Scene) -> xarray.Dataset:
    """The budget over the angles and Stokes numbers that matter for a scene."""
    stokes = own_stokes(scene) * np.logspace(*_DECADES, _POINTS)
    return restitution_budget(scene, stokes=stokes.tolist(), angle=np.radians(ANGLES).tolist(), rtol=_RTOL)


def argument(group: str, data: xarray.Dataset) -> Iterator[Finding]:
    """Findings on a budget."""
    parted = np.isfinite(data["excess"].values)
    failed = [text for text in data["reason"].values.ravel() if text]
    if failed:
        yield Finding(group, "e_n^2 - 1: completed", "every point of the grid", f"{len(failed)} are not", "", False,
                      about=tuple(f"  {text}" for text in failed[:3]))  # fmt: skip
    if not parted.any():
        yield Finding(group, "e_n > 1", "the region where e_n > 1", "no doublet separates", "", None)
        return
    size = np.maximum(1.0, np.abs(data["rotation_released"].values))  # the largest of the terms, m v0^2/2 at least
    open_by = np.abs(data["gap"].values + data["residual"].values) / size
    where, worst = _worst(data, open_by)
    statement = "e_n^2 - 1 = rotation released - film - shear - bridge - solids - strings, over the largest of them"
    # the residual of the ledger, which has its own bound in units of all the initial energy, not of v0^2 alone
    energy = 1 + np.tan(data["angle"].values)[:, None] ** 2
    bound = RESIDUAL * float((energy / size).ravel()[np.nanargmax(np.where(parted, open_by, -1))])
    rounding = float(np.nanmax(np.abs(data["gap"].values) / size))
    told = (f"  {int(parted.sum())} points that separate; with the ledger's residual in it: {rounding:.0e}",)
    yield bounded(group, "e_n^2 - 1: identity", statement, worst, bound, where, told)
    yield from _ceiling(group, data)
    yield _region(group, data)


def _worst(data: xarray.Dataset, figure: np.ndarray) -> tuple[str, float]:
    """Where a figure is largest, and how large."""
    j, k = np.unravel_index(int(np.nanargmax(figure)), figure.shape)
    return place(float(data["stokes"][k]), float(data["angle"][j])), float(figure[j, k])


def _ceiling(group: str, data: xarray.Dataset) -> Iterator[Finding]:
    above = (data["restitution"] ** 2 - data["ceiling"]).values
    if not np.isfinite(above).any():
        why = "with strings or the surface arm there is no closed form"
        yield Finding(group, "e_n^2: ceiling", "e_n^2 <= its closed-form ceiling", why, "", None)
        return
    where, worst = _worst(data, above)
    statement = (
        "e_n^2 <= 1 + (r0 tan(theta0)/(4a))^2 (1 - m r0^2/I(x_f)) - 2 W_c/(m v0^2): the largest of left less right"
    )
    energy = 1 + math.tan(float(data["angle"].max())) ** 2
    yield bounded(group, "e_n^2: ceiling", statement, worst, RESIDUAL * energy, where)


def _region(group: str, data: xarray.Dataset) -> Finding:
    """Angles and Stokes numbers with e_n > 1, the largest e_n, and what made it up."""
    e_n = data["restitution"].values
    j, k = np.unravel_index(int(np.nanargmax(e_n)), e_n.shape)
    best = f"{e_n[j, k]:.4g} ({place(float(data['stokes'][k]), float(data['angle'][j]))})"
    rows = [(int(row), int(column)) for row, column in zip(*np.nonzero(e_n > 1))]
    lines: list[str] = []
    if rows:
        angles = sorted({row for row, _ in rows})
        low, high = (math.degrees(float(data["angle"][row])) for row in (angles[0], angles[-1]))
        stokes = [float(data["stokes"][column]) for _, column in rows]
        figure = f"at {low:.0f}..{high:.0f} deg, St {min(stokes):.2g}..{max(stokes):.2g}; largest {best}"
        lines += [f"  {_name(data, row)}" for row in angles]
    else:
        figure = f"nowhere; largest {best}"
    statement = "where more energy of rotation is released than is lost, to the resolution of the grid"
    return Finding(group, "e_n > 1", statement, figure, "", None, about=(*lines, "", *table(data, (int(j), int(k)))))


def intervals(data: xarray.Dataset, row: int) -> list[tuple[float, float]]:
    """Stokes intervals of one angle with e_n > 1; ends between points of the grid by interpolation of ln e_n."""
    e_n, stokes = data["restitution"].values[row], data["stokes"].values
    inside = e_n > 1
    found = []
    edges = np.flatnonzero(np.diff(np.concatenate([[False], inside, [False]]).astype(int)))
    for first, after in zip(edges[::2], edges[1::2]):
        found.append((_end(e_n, stokes, first, first - 1), _end(e_n, stokes, after - 1, after)))
    return found


def _end(e_n: np.ndarray, stokes: np.ndarray, inside: int, outside: int) -> float:
    """St where e_n = 1 between two neighbours; half-way if the outer one does not separate, its own at the rim."""
    if not 0 <= outside < stokes.size:
        return float(stokes[inside])
    part = 0.5
    if e_n[outside] > 0:
        part = math.log(e_n[inside]) / (math.log(e_n[inside]) - math.log(e_n[outside]))
    return float(stokes[inside] * (stokes[outside] / stokes[inside]) ** part)


def _name(data: xarray.Dataset, row: int) -> str:
    """The intervals of an angle in words."""
    last = float(data["stokes"][-1])
    ends = [(low, "on" if high == last else f"to {high:.3g}") for low, high in intervals(data, row)]
    spans = ", ".join(f"from {low:.3g} {high}" for low, high in ends)
    most = float(np.nanmax(data["restitution"].values[row]))
    return f"{math.degrees(float(data['angle'][row])):4.0f} deg: e_n > 1 for St {spans} (up to {most:.3f})"


def table(data: xarray.Dataset, best: tuple[int, int]) -> list[str]:
    """The terms at a few points, in m v0^2/2: at some angles, and where e_n is largest."""
    picked = set()
    for angle in _SHOWN:
        j = int(np.argmin(np.abs(data["angle"].values - math.radians(angle))))
        parted = np.flatnonzero(np.isfinite(data["excess"].values[j]))
        picked |= {(j, int(parted[k])) for k in np.linspace(0, parted.size - 1, min(3, parted.size)).astype(int)}
    names = [name for name in TERMS if name != "strings" or np.nanmax(np.abs(data["strings"].values)) > 0]
    heads = [head for head, name in zip(_HEADS, TERMS) if name in names]
    columns = "".join(f"{head:>8}" for head in heads)
    lines = [f"  {'in m v0^2/2':<15}{columns}{'e_n^2 - 1':>10}{'e_n':>8}{'residual':>9}"]
    for j, k in sorted(picked | {best}):
        row = [float(data[name][j, k]) * (-1 if name in LOSSES else 1) + 0.0 for name in names]
        head = f"{math.degrees(float(data['angle'][j])):.0f} deg, {float(data['stokes'][k]):.3g}"
        excess, e_n = float(data["excess"][j, k]), float(data["restitution"][j, k])
        cells = "".join(f"{value:>8.4f}" if abs(value) < 10 else f"{value:>8.3f}" for value in row)
        lines.append(f"  {head:<15}{cells}{excess:>10.4f}{e_n:>8.4f}{float(data['residual'][j, k]):>9.0e}")
    return lines
