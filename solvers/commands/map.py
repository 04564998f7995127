"""`wetdoublet map`: outcomes over a grid."""

from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated, Any

import click

from ..errors import InputError
from ..host.outputs import check_file
from ..scene.ranges import MOST, MOST_STORED, check_cells
from ..scene.schema import FIELDS
from ..scene.user_model import fields
from . import options, texts
from .bar import Bar
from .signature import as_command, passed

_SUFFIX = ".zarr"
_CHEAPER = "fewer cells or a looser --rtol take less"


def _file(path: str) -> Path:
    """The file; a Zarr store is a folder, and not every folder is one."""
    if Path(path).suffix.lower() == _SUFFIX:
        from ..many.blocks import check_store

        return check_store(path, "")
    return check_file(path, "", (".nc", ".csv", _SUFFIX), replaced=True)


def _scheduler(address: str) -> Any:
    from ..many.blocks import check_scheduler

    return check_scheduler(address, "")


@as_command("Outcome and restitution over a grid.")
def command(
    stokes: str | None,
    speed: str | None,
    relative_speed: str | None,
    angle: str | None,
    vary: tuple[str, ...],
    request: options.EntriesRequest,
    rtol: options.Rtol,
    engine: options.Engine,
    output: Annotated[Path | None, _file],
    scheduler: Annotated[Any, _scheduler],
    plot: options.Picture,
) -> None:
    """Outcomes and restitution of SCENE over impact angle, Stokes number and further varied entries.

    Without -o and --plot a map of characters is printed. Collisions that fail are marked, and counted at the end. The
    picture has the exact boundaries over the cells, and hatches those where the model leaves its range.

    \b
    Example:
      wetdoublet map granulation --stokes log:0.005:0.5:60 --angle 0:85:60 -o map.nc --plot map.png

    Options:
        --stokes RANGE: Normal Stokes numbers: LO:HI:N, or log:LO:HI:N.
        --speed RANGE: Normal speeds instead, as "0.1:2 m/s:40".
        --relative-speed RANGE: Magnitudes of the relative velocity instead.
        --angle RANGE: Impact angles, as 0:85:40 (degrees) or 0:1.5 rad:40.
        --vary NAME=RANGE: Another dimension, as liquid.viscosity="1:4 Pa s:3"; repeatable.
        -o FILE (output): Write NetCDF (.nc), a table (.csv), or Zarr block by block (.zarr); the same command
            computes what an interrupted one has not.
        --scheduler ADDRESS: Compute on a Dask cluster: tcp://HOST:PORT, the scheduler's .json file, local, or
            local:WORKERS.
        --plot FILE.png: Draw a picture: .png, .pdf or .svg.
    """  # noqa: D301 # click wants the character itself
    stored = output is not None and output.suffix.lower() == _SUFFIX
    impacts = passed(stokes=stokes, speed=speed, relative_speed=relative_speed, angle=angle)
    axes = _axes(impacts, vary, MOST_STORED if stored and plot is None else MOST)
    varied = _varied(vary, request)
    scene = request.scene_without_impact("is an axis of the map")
    if not {*axes} - {"angle"}:
        raise InputError("--stokes", None, "LO:HI:N or log:LO:HI:N, or --speed, or --relative-speed")
    if "angle" not in axes:
        raise InputError("--angle", None, "LO:HI:N in degrees")

    from ..many.arguments import checked_vary
    from ..many.blocks import connected
    from ..many.csv_map import write_csv
    from ..many.regime_map import regime_map, write
    from ..many.text_map import failures, table

    checked_vary(scene, varied, "--vary")
    with (
        Bar("collisions", _CHEAPER) as progress,
        connected(scheduler, "--scheduler") if scheduler is not None else nullcontext() as client,
    ):
        data = regime_map(
            scene, **axes, vary=varied, **passed(rtol=rtol, engine=engine), progress=progress,
            client=client, store=output if stored else None, resume=None if stored else output,
        )  # fmt: skip
    if output is not None and not stored:
        (write_csv if output.suffix.lower() == ".csv" else write)(data, output)
    if plot is not None:
        from ..boundaries.on_map import map_curves
        from ..host.files import save
        from ..many.plot_map import draw_map

        save(draw_map(data, map_curves(data, scene.package)), plot, dpi=150)
    elif output is None:
        click.echo(table(data))
    failed = failures(data)
    if failed is not None:
        click.echo(failed, err=True)


def _axes(impacts: Mapping[str, str], vary: Sequence[str], most: int) -> dict[str, Any]:
    """The axes of the impact, SI; InputError for the first wrong one."""
    flags = {name: f"--{name.replace('_', '-')}" for name in impacts}
    ranges = {flags[name]: text for name, text in impacts.items()}
    check_cells(ranges | {f"--vary {each.partition('=')[0]}": each for each in vary}, most)
    axes = {name: texts.entry_range(FIELDS[f"impact.{name}"], impacts[name], flags[name]) for name in impacts}
    options.check_one_speed(impacts)
    return axes


def _varied(vary: Sequence[str], request: options.SceneRequest) -> dict[str, list[float] | list[str]]:
    """Axes of --vary by dotted name."""
    from ..many.arguments import check_varies

    axes: dict[str, list[float] | list[str]] = {}
    for text in vary:
        name, values = texts.assignment('NAME=RANGE, such as liquid.viscosity="1 Pa s:4 Pa s:3"', text, "--vary")
        check_varies(name, values, "--vary", request.package)
        if name in axes or name in request.entries:
            other = "twice" if name in axes else "together with --set"
            raise InputError("--vary", name, "every entry once", f"is given {other}")
        axes[name] = texts.varied(fields(request.package)[name], values, f"--vary {name}")
    return axes
