"""Findings on e_n > 1: the budget identity, the upper limit of e_n, and the region with e_n > 1."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import xarray

from ..collision.collide import collide
from ..many.collide_many import collide_many
from ..results import FAILED
from ..scene.scene import Scene
from .budget import LOSSES, TERMS, budgeted, first_rotation
from .conserved import RESIDUAL, agreement
from .report import Finding, bounded, note
from .sample import WHOLE, Collide, Extent, place, stokes_of

_DECADES = (-1.0, 1.6)  # relative to the scene's Stokes number
_RTOL = 1e-10
_BESIDE = 24  # points of the grid that CVODES collides as well
_HEADS = ("released", "film", "shear", "bridge", "solids", "strings")
_SHOWN = (30, 60, 75)  # angles of the table, deg; each with its first, middle and last separating St
_FINER = 16  # scan steps per grid step with the kernel
_PARTS = 32  # subdivisions of a bracket in a round
_SHARP = 2e-5  # final relative width of a bracket; ends are shown with three digits


def grid(scene: Scene, extent: Extent = WHOLE) -> xarray.Dataset:
    """The budget over the relevant angles and Stokes numbers of a scene, by the kernel where it supports the scene."""
    stokes = stokes_of(scene) * np.logspace(*_DECADES, extent.grid_points)
    return budgeted(scene, stokes.tolist(), np.radians(extent.grid_angles).tolist(), _RTOL, collide)


def beside_cvodes(scene: Scene, data: xarray.Dataset, fast: Collide | None = None) -> Iterator[Finding]:
    """Finding on the engine of a budget's grid: a sample of its points beside CVODES.

    Arguments:
        fast: function that computes a collision of the grid; None for `collide`.
    """
    fast = fast or collide
    done = [(float(data["stokes"][k]), float(data["angle"][j])) for j, k in np.argwhere(data["outcome"].values >= 0)]
    picked = np.unique(np.linspace(0, len(done) - 1, min(_BESIDE, len(done))).round().astype(int))
    pairs = []
    for stokes, angle in (done[k] for k in picked):
        impact = {"stokes": stokes, "angle": angle, "rtol": _RTOL}
        pairs.append((fast(scene, **impact), collide(scene, engine="cvodes", **impact)))
    if pairs:
        yield agreement(f"{pairs[0][0].engine} = cvodes, on the grid", pairs)


def argument(scene: Scene, data: xarray.Dataset) -> Iterator[Finding]:
    """Findings on the budget of a scene."""
    parted = np.isfinite(data["excess"].values)
    failed = [text for text in data["reason"].values.ravel() if text]
    if failed:
        about = tuple(f"  {text}" for text in failed[:3])
        yield Finding(
            "", "e_n^2 - 1: completed", "every point of the grid", f"{len(failed)} are not", "", False, "", about
        )
    if not parted.any():
        yield note("e_n > 1", "the region where e_n > 1", "no doublet separates")
        return
    statement = "e_n^2 - 1 = rotation released - film - shear - bridge - solids - strings, over the largest of them"
    if scene.partner is not None:
        yield note("e_n^2 - 1: identity", statement, "its terms are those of equal spheres")
        return
    size = np.maximum(1.0, np.abs(data["rotation_released"].values))  # the largest term, at least m v0^2/2
    open_by = np.abs(data["gap"].values + data["residual"].values) / size
    where, worst = _worst(data, open_by)
    # the ledger's residual, bounded relative to the whole initial energy, not to v0^2 alone
    speeds = [scene.speed_of(float(stokes)) for stokes in data["stokes"]]
    energy = np.array([[1 + first_rotation(scene, float(angle), v0) for v0 in speeds] for angle in data["angle"]])
    bound = RESIDUAL * float((energy / size).ravel()[np.nanargmax(np.where(parted, open_by, -1))])
    rounding = float(np.nanmax(np.abs(data["gap"].values) / size))
    about_all = f"  {int(parted.sum())} points that separate; with the ledger's residual in it: {rounding:.0e}"
    yield bounded("e_n^2 - 1: identity", statement, worst, bound, where, about_all)
    above = (data["restitution"] ** 2 - data["ceiling"]).values
    if np.isfinite(above).any():
        where, worst = _worst(data, above)
        statement = "e_n^2 <= 1 + [E_rot(0) - L^2/(2 I(x_f)) - W_c]/(m v0^2/2): the largest of left less right"
        yield bounded("e_n^2: ceiling", statement, worst, RESIDUAL * float(energy.max()), where)
    else:
        why = "with strings or an arm of one's own there is no closed form"
        yield note("e_n^2: ceiling", "e_n^2 <= its closed-form ceiling", why)
    yield _region(scene, data)


def _worst(data: xarray.Dataset, figure: np.ndarray) -> tuple[str, float]:
    """Place and value of the maximum of a quantity."""
    j, k = np.unravel_index(int(np.nanargmax(figure)), figure.shape)
    return place(float(data["stokes"][k]), float(data["angle"][j])), float(figure[j, k])


def _region(scene: Scene, data: xarray.Dataset) -> Finding:
    """Finding on angles and Stokes numbers with e_n > 1, the largest e_n, and its terms."""
    e_n, stokes = data["restitution"].values, data["stokes"].values
    j, k = np.unravel_index(int(np.nanargmax(e_n)), e_n.shape)
    lines_above = above_one(scene, data["angle"].values.tolist(), stokes, _RTOL)
    rim = float(stokes[0]), float(stokes[-1])
    most = max(lines_above, key=lambda line: line.most)
    best = f"{most.most:.4g} ({place(most.at, most.angle)})"
    above = [line for line in lines_above if line.spans]
    lines = [f"  {_name(line, rim)}" for line in above]
    if above:
        low, high = math.degrees(above[0].angle), math.degrees(above[-1].angle)
        first, last = min(line.spans[0][0] for line in above), max(line.spans[-1][1] for line in above)
        ends = f"St {first:.3g}..{last:.3g}{' (the last looked at)' * (last == rim[1])}"
        figure = f"at {low:.0f}..{high:.0f} deg, {ends}; largest {best}"
    else:
        figure = f"nowhere; largest {best}"
    failed = sum(line.failed for line in lines_above)
    if failed:
        lines.append(f"  {failed} collisions of the scan were not completed and count as e_n < 1")
    statement = f"where more energy of rotation is released than is lost, looked at for St {rim[0]:.3g}..{rim[1]:.3g}"
    return note("e_n > 1", statement, figure, about=(*lines, "", *table(data, (int(j), int(k)))))


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
    """Stokes intervals with e_n > 1, with ends accurate to a relative 1e-5: a scan, and refinement of each crossing.

    e_n may also jump across 1 where the outcome changes; the crossing is then that change.

    Arguments:
        angles: impact angles, rad.
        stokes: Stokes numbers, ascending; intervals narrower than their steps (with a kernel, a sixteenth of these) may
            be missed.
    """

    def restitution(angle: np.ndarray, stokes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """e_n over angles (rows) and Stokes numbers, and a mask of failures, where e_n is 0 as for a stick."""
        data = collide_many(scene, stokes=stokes, angle=angle[:, None], rtol=rtol, engine="taylor")
        failed = data["outcome"].values == FAILED
        return np.where(failed, 0.0, data["restitution"].values), failed

    steps = (stokes.size - 1) * _FINER
    scan = np.exp(np.interp(np.linspace(0, stokes.size - 1, steps + 1), np.arange(stokes.size), np.log(stokes)))
    scan[0], scan[-1] = stokes[0], stokes[-1]
    e_n, failed = restitution(np.asarray(angles), scan[None, :])
    rows, columns = np.nonzero(np.diff(e_n > 1, axis=1))
    low, high = scan[columns], scan[columns + 1]
    while low.size and np.max(high / low - 1) > _SHARP:  # all crossings together
        cuts = low[:, None] * (high / low)[:, None] ** np.linspace(0, 1, _PARTS + 1)
        beyond = restitution(np.asarray(angles)[rows], cuts)[0] > 1
        first = np.argmax(np.diff(beyond, axis=1), axis=1)  # exists, because the ends differ
        low, high = cuts[np.arange(low.size), first], cuts[np.arange(low.size), first + 1]
    ends, lines = np.sqrt(low * high), []
    for j, angle in enumerate(angles):
        inside, k = e_n[j] > 1, int(np.argmax(e_n[j]))
        edges = [*scan[:1][inside[:1]], *ends[rows == j], *scan[-1:][inside[-1:]]]
        spans = tuple((float(low), float(high)) for low, high in list(pairwise(edges))[::2])
        lines.append(Above(float(angle), spans, float(e_n[j, k]), float(scan[k]), int(failed[j].sum())))
    return lines


def _name(line: Above, rim: tuple[float, float]) -> str:
    """The intervals of an angle in words; open where an interval reaches the end of the scan."""
    spans = []
    for low, high in line.spans:
        ends = ([f"from {low:.3g}"] if low > rim[0] else []) + ([f"to {high:.3g}"] if high < rim[1] else ["on"])
        spans.append(" ".join(ends) if low > rim[0] or high < rim[1] else "throughout")
    return f"{math.degrees(line.angle):4.0f} deg: e_n > 1 for St {', '.join(spans)} (up to {line.most:.3f})"


def table(data: xarray.Dataset, best: tuple[int, int]) -> list[str]:
    """Table of the terms in units of m v0^2/2, at some angles and at the largest e_n."""
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
