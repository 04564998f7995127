"""Where outcomes change: maps, boundaries and critical speeds of a scene."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import click

from ..engines.settings import MOST, MOST_STORED
from ..errors import CheckFailed, ComputationError, InputError
from ..host.files import check_file
from ..scene.schema import FIELDS
from . import texts
from .bar import Bar
from .options import Entries, Impact, SceneRequest, Shown, dataset_text, refuse
from .signature import command, passed

_MOST = 100_000  # lines of a boundary; about half an hour
_ANGLE = FIELDS["impact.angle"]
_Angles = Annotated[list[float] | None, partial(texts.entry_range, _ANGLE, most=10_000)]
_SUFFIX = ".zarr"


def _file(path: str) -> Path:
    """The file of a map; a Zarr store is a folder, and not every folder is one."""
    if Path(path).suffix.lower() == _SUFFIX:
        from ..many.blocks import check_store

        return check_store(path, "")
    return check_file(path, "", (".nc", ".csv", _SUFFIX), replaced=True)


_File = Annotated[Path | None, _file]


@command()
def map_(
    impacts: Impact, vary: tuple[str, ...], request: Entries, output: _File, plot: Any, as_json: bool, **chosen: Any
) -> None:
    """Outcome and restitution of SCENE over a grid of impact angles, Stokes numbers and further varied entries.

    Without -o and --plot a map of characters is printed. Collisions that fail are marked, and counted at the end; exit
    status 1 if all do. The picture has the exact boundaries over the cells, and dots those where the model leaves
    its range.

    Example:
      wetdoublet map granulation --stokes log:0.005:0.5:60 --angle 0:85:60 -o map.nc --plot map.png

    Options:
        --stokes RANGE: Normal Stokes numbers: LO:HI:N, or log:LO:HI:N.
        --speed RANGE: Normal speeds instead, as "0.1:2 m/s:40".
        --relative-speed RANGE: Magnitudes of the relative velocity instead.
        --angle RANGE: Impact angles, as 0:85:40 (degrees) or 0:1.5 rad:40.
        --vary NAME=RANGE: Another dimension, as liquid.viscosity="1:4 Pa s:3"; repeatable.
        --rtol
        --engine
        -o FILE (output): Write NetCDF (.nc), a table (.csv), or Zarr block by block (.zarr); the same command
            computes what an interrupted one has not.
        --scheduler ADDRESS (client): Compute on a Dask cluster: tcp://HOST:PORT, the scheduler's .json file, local, or
            local:WORKERS.
        --plot
        --json
    """
    stored = output is not None and output.suffix.lower() == _SUFFIX
    axes = _axes(impacts, vary, MOST_STORED if stored and plot is None else MOST)
    varied = _varied(vary, request)
    scene = request.scene_without_impact("is an axis of the map")
    if not {*axes} - {"angle"}:
        raise InputError("--stokes", None, "LO:HI:N or log:LO:HI:N, or --speed, or --relative-speed")
    if "angle" not in axes:
        raise InputError("--angle", None, "LO:HI:N in degrees")

    from ..many.regime_map import regime_map, write
    from ..many.text_map import failures, table
    from ..results import FAILED

    file: dict[str, Any] = {"store" if stored else "resume": output}
    with Bar("collisions") as progress:
        data = regime_map(scene, **axes, vary=varied, **file, **chosen, progress=progress)
    if output is not None and not stored:
        write(data, output)
    if plot is not None:
        from ..boundaries.on_map import map_curves
        from ..host.files import save
        from ..many.plot_map import draw_map

        save(draw_map(data, map_curves(data, scene.package)), plot, dpi=150)
    if as_json:
        click.echo(dataset_text(data))
    elif output is None and plot is None:
        click.echo(table(data))
    failed = failures(data)
    if failed is not None and bool((data["outcome"] == FAILED).all()):
        raise ComputationError(failed)
    if failed is not None:
        click.echo(failed, err=True)


def _axes(impacts: Mapping[str, str], vary: Sequence[str], most: int) -> dict[str, Any]:
    """The axes of the impact, SI; InputError for the first wrong one."""
    ranges = {texts.flag(name): text for name, text in impacts.items()}
    texts.check_cells(ranges | {f"--vary {text.partition('=')[0]}": text for text in vary}, most)
    return texts.axes(impacts)


def _varied(vary: Sequence[str], request: SceneRequest) -> dict[str, list[float] | list[str]]:
    """Axes of --vary by dotted name."""
    axes: dict[str, list[float] | list[str]] = {}
    for text in vary:
        name, values = texts.assignment('NAME=RANGE, such as liquid.viscosity="1 Pa s:4 Pa s:3"', text, "--vary")
        entry = request.varying(name, values, "--vary", axes)
        axes[name] = texts.varied(entry, values, f"--vary {name}")
    return axes


@command()
def boundary(
    angle: str | None, over: str | None, wrt: Any, request: Entries, output: Shown, rtol: Any, **search: Any
) -> None:
    """Every Stokes number at which the outcome of SCENE changes, traced.

    Along lines of constant angle: Stokes number, Ce, and the outcomes on either side. With --angle LO:HI or --over, all
    curves in the plane of the angle (or of that entry at the scene's angle) and the Stokes number. Each is followed
    until it leaves the window or meets others; meeting points are listed by kind.

    Examples:
      wetdoublet boundary granulation --angle 20:70:26 --plot boundary.png
      wetdoublet boundary granulation --angle 0:85 --plot atlas.png
      wetdoublet boundary granulation --over particles.roughness="0.1:6 um" --set impact.angle=60

    Options:
        --angle RANGE: Impact angles (degrees): 40, lines 20:65:10, a plane 20:65.
        --over NAME=LO:HI: A plane of this entry, as liquid.viscosity="1:4 Pa s".
        --stokes LO:HI: Stokes numbers to search [1e-4:100, or more by the scene].
        --wrt NAMES: Derivatives as well, in bridge.volume,liquid.viscosity, or all.
        --rtol
    """
    from ..boundaries.boundary import atlas, boundary

    plane = _plane(angle, over, request)
    refuse({"--wrt": plane and wrt}, "--angle LO:HI:N", "differentiates lines, not a plane")
    angles = None if angle is None or plane else texts.entry_range(_ANGLE, angle, "--angle", most=_MOST)
    scene = request.scene(whole=False)
    shared = passed(rtol=rtol)
    if plane is not None:
        name, across = plane
        with Bar("lines") as progress:
            curves = atlas(scene, over=name, span=across, progress=progress, **search, **shared)
        output.show(curves)
        if curves.unsettled:
            x, at_stokes, reason = curves.unsettled[0]
            where = f"first {name} = {x:.6g} (SI), St {at_stokes:.6g}"
            raise CheckFailed(f"{len(curves.unsettled)} places are not settled, {where}: {reason}")
        return
    if angles is None:
        raise InputError("--angle", None, "an angle, LO:HI:N, or LO:HI, in degrees, as 20:65:10, or --over")
    if wrt is not None:
        from ..sensitivity.boundaries import boundary_sensitivities, check_boundary_wrt

        names = check_boundary_wrt(scene, None if wrt == ["all"] else wrt)
    with Bar("angles") as progress:
        lines = boundary(scene, angle=angles, progress=lambda k: progress(k, len(angles)), **search, **shared)
    if wrt is None:
        output.show(lines)
    else:
        with Bar("angles differentiated") as progress:
            moving = boundary_sensitivities(
                scene, wrt=names, traced=lines, progress=lambda k: progress(k, len(angles)), **shared
            )
        output.show(moving, drawn=lines)
    if lines.failed:
        at, reason = lines.failed[0]
        where = f"first {math.degrees(at):.6g} deg"
        raise CheckFailed(f"{len(lines.failed)} of {len(angles)} angles failed, {where}: {reason}")


def _plane(angle: str | None, over: str | None, request: SceneRequest) -> tuple[str, texts.Range] | None:
    """The entry on the horizontal axis and its span if a plane is requested, else None."""
    if over is not None:
        name, ends = texts.assignment('NAME=LO:HI, such as liquid.viscosity="1:4 Pa s"', over, "--over")
        if angle is not None:
            accepted = "--set impact.angle=ANGLE for a plane of another entry"
            raise InputError("--angle", angle, accepted, "is given together with --over")
        return name, texts.span(request.varying(name, ends, "--over"), ends, f"--over {name}")
    if angle is not None and angle.count(":") == 1 and not angle.strip().startswith("log"):
        return _ANGLE.name, texts.span(_ANGLE, angle, "--angle")
    return None


@command()
def critical(angle: _Angles, wrt: Any, request: Entries, output: Shown, **chosen: Any) -> None:
    """The speed up to which particles of SCENE stick, and that above which they bounce, with interval and derivatives.

    SCENE may be a CSV file of materials, one a row; its columns are entries, as `particles.diameter [um]`.
    With -o FILE.csv the speeds are written as a table.

    Examples:
      wetdoublet critical lactose-pvp
      wetdoublet critical granulation --angle 0:80:9 --uncertainty liquid.viscosity="10 %" --plot critical.png
      wetdoublet critical materials.csv -o speeds.csv

    Options:
        --angle RANGE: Impact angles (degrees): 40, or 20:65:10 [the scene's, or 0].
        --stokes LO:HI: Stokes numbers to search [1e-4:100, or more by the scene].
        --uncertainty
        --wrt NAMES: Derivatives as well, and extremes, in bridge.volume,liquid.viscosity; or all (derivatives).
        --samples N: Draws of the uncertain entries, a power of two [256].
        --rtol
    """
    from ..sensitivity.critical import critical
    from ..sensitivity.materials import materials_of

    source = request.source or ""
    is_table = source.lower().endswith(".csv")
    materials = materials_of(source, request.entries, request.package) if is_table else request.scene()
    chosen |= passed(angle=angle, wrt="all" if wrt == ["all"] else wrt)
    with Bar("materials") as progress:
        result = critical(materials, progress=progress, **chosen)
    output.show(result)
    failed = [row for row in result.rows if row.failed]
    if failed:
        raise CheckFailed(f"{len(failed)} of {len(result.rows)} rows have no answer, first: {failed[0].sentences[0]}")
