"""`wetdoublet boundary`: traces the curves between outcomes."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..errors import CheckFailed, InputError
from ..scene import units
from ..scene.schema import FIELDS, Field
from ..scene.user_model import fields
from ..settings import RTOL, check_rtol
from . import options
from .bar import bar

if TYPE_CHECKING:
    from ..boundaries.boundary import Boundaries
    from ..scene.scene import Scene
    from ..sensitivity.boundaries import BoundarySensitivities

_MOST = 100_000  # lines; about half an hour
_ENTRY = FIELDS["impact.angle"]


@click.command("boundary", short_help="Every Stokes number at which the outcome changes, traced.")
@options.scene_argument
@click.option("--angle", metavar="RANGE", help="Impact angles (degrees): 40, lines 20:65:10, a plane 20:65.")
@click.option("--over", metavar="NAME=LO:HI", help='A plane of this entry, as liquid.viscosity="1:4 Pa s".')
@click.option("--stokes", metavar="LO:HI", help="Stokes numbers to search [1e-4:100, or more by the scene].")
@click.option("--wrt", metavar="NAMES", help="Derivatives as well, in bridge.volume,liquid.viscosity, or all.")
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
    over: str | None,
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

    With --angle LO:HI or --over, all curves in the plane of the angle (or of that entry at the scene's angle) and the
    Stokes number. Each is followed until it leaves the window or meets others; meeting points are listed by kind.

    \b
    Examples:
      wetdoublet boundary granulation --angle 20:70:26 --plot boundary.png
      wetdoublet boundary granulation --angle 0:85 --plot atlas.png
      wetdoublet boundary granulation --over particles.roughness="0.1:6 um" --set impact.angle=60
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..boundaries.boundary import boundary

    tolerance = RTOL if rtol is None else check_rtol(rtol, "--rtol")
    picture = options.check_file(plot, "--plot", options.PICTURES)
    file = options.check_file(output, "-o")
    options.check_apart(file, "-o", picture, "--plot")
    span = None if stokes is None else _span(stokes)
    asked = options.SceneRequest.check(source, changes, model=model)
    plane = _plane(angle, over, wrt, asked)
    angles = None if angle is None or plane else options.entry_range(_ENTRY, angle, "--angle", most=_MOST)
    scene = asked.scene()
    if plane is not None:
        _show_atlas(scene, *plane, span, tolerance, as_json, picture, file)
        return
    if angles is None:
        raise InputError("--angle", None, "an angle, LO:HI:N, or LO:HI, in degrees, as 20:65:10, or --over")

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
        found.plot(picture)
    if found.failed:
        at, reason = found.failed[0]
        raise CheckFailed(
            f"{len(found.failed)} of {len(angles)} angles failed, first {math.degrees(at):.6g} deg: {reason}"
        )


def _plane(
    angle: str | None, over: str | None, wrt: str | None, asked: options.SceneRequest
) -> tuple[str, tuple[float, float] | tuple[str, str]] | None:
    """The entry on the horizontal axis and its span if a plane is requested, else None."""
    if over is not None:
        name, equals, ends = over.partition("=")
        name = name.strip()
        if not equals:
            raise InputError("--over", over, 'NAME=LO:HI, such as liquid.viscosity="1:4 Pa s"', "has no =")
        if angle is not None:
            raise InputError("--angle", angle, "--set impact.angle=ANGLE for a plane of another entry",
                             "is given together with --over")  # fmt: skip
        from ..many.batch import check_varies

        check_varies(name, ends, "--over", asked.package)
        if name in asked.entries:
            raise InputError("--over", name, "every entry once", "is given together with --set")
        entry = fields(asked.package)[name]
        parts = ends.split(":")
        if entry.or_unit and not all(units.is_number(end) for end in parts):
            low, high = _ends(f"--over {name}", ends, entry.measured)
            return name, (f"{low!r} {entry.or_unit}", f"{high!r} {entry.or_unit}")
        found = name, _ends(f"--over {name}", ends, entry)
    elif angle is not None and angle.count(":") == 1 and not angle.strip().startswith("log"):
        found = _ENTRY.name, _ends("--angle", angle, _ENTRY)
    else:
        return None
    if wrt is not None:
        raise InputError("--wrt", wrt, "--angle LO:HI:N", "differentiates lines, not a plane")
    return found


def _ends(label: str, text: str, entry: Field) -> tuple[float, float]:
    """The two ends of LO:HI, SI."""
    parts = text.split(":")
    said = " in degrees, or with a unit" if entry.unit == "rad" else " with a unit at either end" if entry.unit else ""
    accepted = f"LO:HI{said}, with LO below HI"
    if len(parts) != 2:
        raise InputError(label, text, accepted, "is not a range")
    low, high = options.entry_ends(entry, label)(*parts)
    if not low < high:
        raise InputError(label, text, accepted, "is not a range")
    return low, high


def _show_atlas(
    scene: Scene,
    over: str,
    across: tuple[float, float] | tuple[str, str],
    span: tuple[float, float] | None,
    rtol: float,
    as_json: bool,
    picture: Path | None,
    file: Path | None,
) -> None:
    from ..boundaries.boundary import atlas

    with bar("lines") as tell:
        found = atlas(scene, over=over, span=across, stokes=span, rtol=rtol, progress=tell)
    options.put(json.dumps(found.to_dict(), indent=2, allow_nan=False) if as_json else str(found), file)
    if picture is not None:
        found.plot(picture)
    if found.unsettled:
        x, stokes, reason = found.unsettled[0]
        raise CheckFailed(
            f"{len(found.unsettled)} places are not settled, first {over} = {x:.6g} (SI), St {stokes:.6g}: {reason}"
        )


def _names(scene: Scene, wrt: str | None) -> tuple[str, ...] | None:
    """The parameters of --wrt; `all` stands for every numeric entry of the scene and the angle."""
    if wrt is None:
        return None
    from ..sensitivity.boundaries import check_boundary_wrt

    names = options.listed(wrt, "--wrt")
    return check_boundary_wrt(scene, None if names == ["all"] else names, "--wrt")


def _span(text: str) -> tuple[float, float]:
    return _ends("--stokes", text, FIELDS["impact.stokes"])
