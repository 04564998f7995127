"""Boundaries between outcomes: along lines of constant angle, and as the atlas of a plane."""

from collections.abc import Callable, Sequence
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from ..engines.settings import RTOL, check_rtol
from ..errors import InputError
from ..host.arguments import check_function, check_whole
from ..many.arguments import checked_numbers, checked_span
from ..model.validity import warn
from ..scene.scene import Scene
from .plane import ANGLE, check_plane
from .result import LINES, Atlas, Boundaries
from .trace import trace
from .window import stokes_range

_LARGEST = 1e30  # largest Stokes number; its inverse is the smallest
_MOST = 10_000  # most lines


def boundary(
    scene: Scene | str | FilePath,
    *,
    angle: Any = None,
    stokes: tuple[float, float] | None = None,
    rtol: float = RTOL,
    progress: Callable[[int], None] | None = None,
) -> Boundaries:
    """Every change of outcome along lines of constant angle.

    Arguments:
        scene: a Scene, a path or a preset's name.
        angle: impact angles in rad, a number or 1-D; default the scene's. Traced in ascending order.
        stokes: lowest and highest Stokes number; None for 1e-4 to 100, or more where closed forms ask for it.
        rtol: relative tolerance of the integrations.
        progress: called with the number of angles done.

    Returns:
        Boundaries, in the order of the angles given.

    Raises:
        InputError: an invalid angle or Stokes number. A line that fails raises nothing; it is marked.
        ComputationError: no kernel of the scene can be compiled.

    Example:
        >>> from wetdoublet.solvers import boundary
        >>> [round(one.stokes, 6) for one in boundary("granulation", angle=0.9599310885968813).changes[0]]
        [0.034232, 0.118639]
    """
    loaded = Scene.load(scene)
    angles = checked_numbers("impact.angle", loaded.angle if angle is None else angle).reshape(-1)
    low, high = stokes_range(loaded, {*angles.tolist()}) if stokes is None else checked_span("impact.stokes", stokes)
    if low < 1 / _LARGEST or high > _LARGEST:
        raise InputError("impact.stokes", f"{low}:{high}", f"from {1 / _LARGEST:g} to {_LARGEST:g}", "is too far off")
    rtol, tell = check_rtol(rtol), check_function(progress, "progress") or (lambda _done: None)
    warn(loaded)
    order = np.argsort(angles, kind="stable")
    whole = trace(loaded, angles[order], (low, high), rtol, tell)
    back = np.argsort(order, kind="stable")
    return Boundaries(
        tuple(angles.tolist()),
        tuple(whole.changes[k] for k in back),
        whole.collisions,
        tuple(whole.failures[k] for k in back),
        whole.resolution,
        loaded,
        (low, high),
        rtol,
    )


def atlas(
    scene: Scene | str | FilePath,
    *,
    over: str = ANGLE,
    span: Sequence[Any],
    stokes: tuple[float, float] | None = None,
    lines: int = LINES,
    rtol: float = RTOL,
    progress: Callable[[int, int], None] | None = None,
) -> Atlas:
    """All boundaries between outcomes in the plane of an entry of the scene and the Stokes number.

    Every curve is followed by collisions on both sides: up to the edge of the window, back to its start, or to a point
    where it meets others. The result states the resolution of the search: islands smaller than the lattice spacing and
    narrower on every line than its resolution are not found.

    Arguments:
        scene: a Scene, a path or a preset's name.
        over: dotted name of the entry on the x axis: the impact angle, or a numeric entry at the scene's angle.
        span: its lowest and highest value, SI (rad) or text with a unit.
        stokes: lowest and highest Stokes number; None for 1e-4 to 100, or more where closed forms ask for it.
        lines: number of lines of constant x to trace as well, including both edges.
        rtol: relative tolerance of the integrations.
        progress: called with (lines traced, lines in all).

    Returns:
        Atlas: `curves` (x and St, outcomes below and above), meeting `points`, and the lines.

    Raises:
        InputError: an invalid name, span or number. Unresolved places raise nothing; they are in `unsettled`.
        ComputationError: no kernel of the scene can be compiled.

    Example:
        >>> from wetdoublet.solvers import atlas
        >>> found = atlas("granulation-dry-bridge", span=("20 deg", "30 deg"), stokes=(0.05, 0.3), lines=2)
        >>> [(one.before, one.after) for one in found.curves]
        [('stick-rotate-separate', 'bounce')]
    """
    from .atlas_curves import curves_of  # not needed by `boundary`

    loaded = Scene.load(scene, free=over)
    plane = check_plane(loaded, over, span, stokes, check_rtol(rtol))
    lines = check_whole(lines, "lines", 2, _MOST)
    tell = check_function(progress, "progress") or (lambda *_: None)
    warn(loaded)
    return curves_of(plane, lines, tell)
