"""`wetdoublet boundary`: traces the curves between outcomes."""

import math
from functools import partial
from typing import Annotated

from ..errors import CheckFailed, InputError
from ..scene.schema import FIELDS
from ..scene.user_model import fields
from . import options, texts
from .bar import Bar
from .signature import as_command, passed

_MOST = 100_000  # lines; about half an hour
_ANGLE = FIELDS["impact.angle"]


@as_command("Every Stokes number at which the outcome changes, traced.")
def command(
    angle: str | None,
    over: str | None,
    stokes: Annotated[texts.Range | None, partial(texts.span, FIELDS["impact.stokes"])],
    wrt: list[str] | None,
    request: options.EntriesRequest,
    rtol: options.Rtol,
    output: options.Shown,
) -> None:
    """Changes of outcome of SCENE along lines of constant angle: Stokes number, Ce, and the outcomes on either side.

    With --angle LO:HI or --over, all curves in the plane of the angle (or of that entry at the scene's angle) and the
    Stokes number. Each is followed until it leaves the window or meets others; meeting points are listed by kind.

    \b
    Examples:
      wetdoublet boundary granulation --angle 20:70:26 --plot boundary.png
      wetdoublet boundary granulation --angle 0:85 --plot atlas.png
      wetdoublet boundary granulation --over particles.roughness="0.1:6 um" --set impact.angle=60

    Options:
        --angle RANGE: Impact angles (degrees): 40, lines 20:65:10, a plane 20:65.
        --over NAME=LO:HI: A plane of this entry, as liquid.viscosity="1:4 Pa s".
        --stokes LO:HI: Stokes numbers to search [1e-4:100, or more by the scene].
        --wrt NAMES: Derivatives as well, in bridge.volume,liquid.viscosity, or all.
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..boundaries.boundary import atlas, boundary

    plane = _plane(angle, over, request)
    if plane is not None and wrt is not None:
        raise InputError("--wrt", ",".join(wrt), "--angle LO:HI:N", "differentiates lines, not a plane")
    angles = None if angle is None or plane else texts.entry_range(_ANGLE, angle, "--angle", most=_MOST)
    scene = request.scene()
    search = passed(stokes=stokes, rtol=rtol)
    if plane is not None:
        name, across = plane
        cheaper = "lines alone, --angle LO:HI:N, take less" if name == _ANGLE.name else ""
        with Bar("lines", cheaper, at_least=True) as progress:
            curves = atlas(scene, over=name, span=across, progress=progress, **search)
        output.show(curves)
        if curves.unsettled:
            x, at_stokes, reason = curves.unsettled[0]
            where = f"first {name} = {x:.6g} (SI), St {at_stokes:.6g}"
            raise CheckFailed(f"{len(curves.unsettled)} places are not settled, {where}: {reason}")
        return
    if angles is None:
        raise InputError("--angle", None, "an angle, LO:HI:N, or LO:HI, in degrees, as 20:65:10, or --over")
    if wrt is None:
        names = None
    else:
        from ..sensitivity.boundaries import boundary_sensitivities, check_boundary_wrt

        names = check_boundary_wrt(scene, None if wrt == ["all"] else wrt)
    with Bar("angles", "fewer angles take less", at_least=wrt is not None) as progress:
        lines = boundary(scene, angle=angles, progress=lambda k: progress(k, len(angles)), **search)
    if names is None:
        output.show(lines)
    else:
        with Bar("angles differentiated") as progress:
            moving = boundary_sensitivities(
                scene, wrt=names, traced=lines, progress=lambda k: progress(k, len(angles)), **passed(rtol=rtol)
            )
        output.show(moving, drawn=lines)
    if lines.failed:
        at, reason = lines.failed[0]
        where = f"first {math.degrees(at):.6g} deg"
        raise CheckFailed(f"{len(lines.failed)} of {len(angles)} angles failed, {where}: {reason}")


def _plane(angle: str | None, over: str | None, request: options.SceneRequest) -> tuple[str, texts.Range] | None:
    """The entry on the horizontal axis and its span if a plane is requested, else None."""
    if over is not None:
        name, ends = texts.assignment('NAME=LO:HI, such as liquid.viscosity="1:4 Pa s"', over, "--over")
        if angle is not None:
            accepted = "--set impact.angle=ANGLE for a plane of another entry"
            raise InputError("--angle", angle, accepted, "is given together with --over")
        from ..many.arguments import check_varies

        check_varies(name, ends, "--over", request.package)
        if name in request.entries:
            raise InputError("--over", name, "every entry once", "is given together with --set")
        return name, texts.span(fields(request.package)[name], ends, f"--over {name}")
    if angle is not None and angle.count(":") == 1 and not angle.strip().startswith("log"):
        return _ANGLE.name, texts.span(_ANGLE, angle, "--angle")
    return None
