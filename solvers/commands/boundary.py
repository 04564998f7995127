"""`wetdoublet boundary`: the curves between outcomes, traced."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from ..errors import CheckFailed, InputError
from ..ranges import parse_range
from ..schema import FIELDS
from ..settings import RTOL, check_rtol
from . import options
from .bar import bar

if TYPE_CHECKING:
    from ..bounds import Boundaries
    from ..scene import Scene
    from ..sensitivity.boundaries import BoundarySensitivities

_MOST = 100_000  # lines: half an hour
_ENTRY = FIELDS["impact.angle"]


@click.command("boundary", short_help="Every Stokes number at which the outcome changes, traced.")
@options.scene_argument
@click.option("--angle", metavar="RANGE", help="Impact angles in degrees, as 20:65:10.")
@click.option("--stokes", metavar="LO:HI", help="Stokes numbers to look between [1e-4:100].")
@click.option("--wrt", metavar="NAMES", help="Also how each moves, as with bridge.volume,liquid.viscosity, or all.")
@options.changes
@options.model
@options.rtol
@options.as_json
@options.plot
@options.output
@options.debug
def command(
    source: str | None,
    angle: str | None,
    stokes: str | None,
    wrt: str | None,
    changes: Sequence[str],
    model: str | None,
    rtol: str | None,
    as_json: bool,
    plot: str | None,
    output: str | None,
) -> None:
    """Changes of outcome of SCENE along lines of constant angle: Stokes number, Ce, and the outcomes on either side.

    \b
    Example:
      wetdoublet boundary granulation --angle 20:70:26 --plot boundary.png
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..bounds import STOKES, boundary

    tolerance = RTOL if rtol is None else check_rtol(rtol, "--rtol")
    picture = options.check_file(plot, "--plot", options.PICTURES)
    file = options.check_file(output, "-o")
    options.check_apart(file, "-o", picture, "--plot")
    span = STOKES if stokes is None else _span(stokes)
    angles = None if angle is None else parse_range(angle, "--angle", _degrees, unit="in degrees", most=_MOST)
    scene = options.Asked.check(source, changes, model=model).scene()
    if angles is None:
        raise InputError("--angle", None, "LO:HI:N in degrees, as 20:65:10")

    names = _names(scene, wrt)
    with bar("angles") as tell:
        found = boundary(scene, angle=angles, stokes=span, rtol=tolerance, progress=lambda k: tell(k, len(angles)))
    shown: Boundaries | BoundarySensitivities = found
    if names is not None:
        from ..sensitivity.boundaries import boundary_sensitivities

        with bar("angles differentiated") as tell:
            shown = boundary_sensitivities(
                scene, wrt=names, rtol=tolerance, traced=found, progress=lambda k: tell(k, len(angles))
            )
    options.put(json.dumps(shown.to_dict(), indent=2, allow_nan=False) if as_json else str(shown), file)
    if picture is not None:
        from ..boundary_plot import draw
        from ..files import save

        save(draw(scene, found), picture, dpi=150)
    if found.failed:
        at, reason = found.failed[0]
        raise CheckFailed(
            f"{len(found.failed)} of {len(angles)} angles failed, first {math.degrees(at):.6g} deg: {reason}"
        )


def _names(scene: Scene, wrt: str | None) -> tuple[str, ...] | None:
    """The parameters of --wrt; `all` stands for every number of the scene, and the angle."""
    if wrt is None:
        return None
    from ..sensitivity.boundaries import check_boundary_wrt

    names = [name.strip() for name in wrt.split(",") if name.strip()]
    return check_boundary_wrt(scene, None if names == ["all"] else names, "--wrt")


def _degrees(text: str) -> float:
    """An end of the range, degrees unless it says otherwise."""
    try:
        float(text)
    except ValueError:
        return _ENTRY.number(text, label="--angle")
    return _ENTRY.number(f"{text} deg", label="--angle")


def _span(text: str) -> tuple[float, float]:
    accepted = "LO:HI, as 0.01:10, with 0 < LO < HI"
    parts = text.split(":")
    if len(parts) != 2:
        raise InputError("--stokes", text, accepted, "is not a range")
    low, high = (FIELDS["impact.stokes"].number(part, label="--stokes") for part in parts)
    if not low < high:
        raise InputError("--stokes", text, accepted, "is not a range")
    return low, high
