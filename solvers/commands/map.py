"""`wetdoublet map`: outcomes over a grid."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..errors import InputError
from ..scene.ranges import MOST, MOST_STORED, check_cells
from ..scene.schema import FIELDS, SPINS
from ..scene.user_model import fields
from ..settings import RTOL, check_engine, check_rtol
from . import options

if TYPE_CHECKING:
    import xarray

    from ..scene.scene import Scene


@click.command("map", short_help="Outcome and restitution over a grid.")
@options.scene_argument
@click.option("--stokes", metavar="RANGE", help="Normal Stokes numbers: LO:HI:N, or log:LO:HI:N.")
@click.option("--speed", metavar="RANGE", help='Normal speeds instead, as "0.1:2 m/s:40".')
@click.option("--relative-speed", metavar="RANGE", help="Magnitudes of the relative velocity instead.")
@click.option("--angle", metavar="RANGE", help="Impact angles, as 0:85:40 (degrees) or 0:1.5 rad:40.")
@click.option(
    "--vary",
    metavar="NAME=RANGE",
    multiple=True,
    help='Another dimension, as liquid.viscosity="1:4 Pa s:3"; repeatable.',
)
@options.changes
@options.model
@options.rtol
@options.engine
@click.option(
    "-o",
    "output",
    metavar="FILE",
    help="Write NetCDF (.nc), a table (.csv), or Zarr chunk by chunk (.zarr); an interrupted run is continued.",
)
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Compute on a Dask cluster: tcp://HOST:PORT, the scheduler's .json file, local, or local:WORKERS.",
)
@options.plot
@options.debug
def command(
    source: str | None,
    stokes: str | None,
    speed: str | None,
    relative_speed: str | None,
    angle: str | None,
    vary: Sequence[str],
    changes: Sequence[str],
    model: str | None,
    rtol: str | None,
    engine: str | None,
    output: str | None,
    scheduler: str | None,
    plot: str | None,
) -> None:
    """Outcomes and restitution of SCENE over impact angle, Stokes number and further varied entries.

    Without -o and --plot a map of characters is printed. Collisions that fail are marked, and counted at the end. The
    picture has the exact boundaries over the cells, and hatches those where the model leaves its range.

    \b
    Example:
      wetdoublet map granulation --stokes log:0.005:0.5:60 --angle 0:85:60 -o map.nc --plot map.png
    """  # noqa: D301 # click wants the character itself
    tolerance = RTOL if rtol is None else check_rtol(rtol, "--rtol")
    chosen = check_engine(engine, "--engine")
    picture = options.check_file(plot, "--plot", options.PICTURES)
    file, cluster = _outputs(output, scheduler)
    check_cells(
        {"--stokes": stokes, "--speed": speed, "--relative-speed": relative_speed, "--angle": angle}
        | {f"--vary {each.partition('=')[0]}": each for each in vary},
        MOST_STORED if _stored(file) and picture is None else MOST,
    )
    axes = _axes(stokes, speed, relative_speed, angle)
    asked = options.SceneRequest.check(source, changes, model=model)
    varied = _varied(vary, asked)
    for name in asked.entries:
        if name.startswith("impact.") and name not in SPINS:
            accepted = "entries that are not of the impact, or " + " and ".join(SPINS)
            raise InputError("--set", name, accepted, "is an axis of the map")
    scene = asked.scene()
    if not {*axes} - {"angle"}:
        raise InputError("--stokes", None, "LO:HI:N or log:LO:HI:N, or --speed, or --relative-speed")
    if "angle" not in axes:
        raise InputError("--angle", None, "LO:HI:N in degrees")

    from ..many.batch import checked_vary

    checked_vary(scene, varied, "--vary")
    data = _computed(scene, axes, varied, tolerance, chosen, file, cluster)
    _show(data, scene, file, picture)


def _outputs(output: str | None, scheduler: str | None) -> tuple[Path | None, str | None]:
    """File and scheduler, checked; a Zarr store is a folder, and not every folder is one."""
    from ..many.cluster import check_scheduler
    from ..many.store import SUFFIX, check_store

    stored = _stored(None if output is None else Path(output))
    file = (
        check_store(output, "-o")
        if stored
        else options.check_file(output, "-o", (".nc", ".csv", SUFFIX), replaced=True)
    )
    return file, None if scheduler is None else check_scheduler(scheduler, "--scheduler")


def _stored(file: Path | None) -> bool:
    return file is not None and file.suffix.lower() == ".zarr"


def _axes(
    stokes: str | None, speed: str | None, relative_speed: str | None, angle: str | None
) -> dict[str, list[float]]:
    """The axes of the impact, SI; InputError for the first wrong one."""
    given = {"stokes": stokes, "speed": speed, "relative-speed": relative_speed, "angle": angle}
    axes = {}
    for name, text in given.items():
        if text is not None:
            key = name.replace("-", "_")
            axes[key] = options.entry_range(FIELDS[f"impact.{key}"], text, f"--{name}")
    first, *more = [name for name in given if given[name] is not None and name != "angle"] or [""]
    if more:
        problem = f"is given together with --{first} = {given[first]}"
        raise InputError(f"--{more[0]}", given[more[0]], "only one of --stokes, --speed, --relative-speed", problem)
    return axes


def _varied(vary: Sequence[str], asked: options.SceneRequest) -> dict[str, list[float] | list[str]]:
    """Axes of --vary by dotted name."""
    from ..many.batch import check_varies

    found: dict[str, list[float] | list[str]] = {}
    for text in vary:
        name, equals, values = text.partition("=")
        name = name.strip()
        if not equals:
            raise InputError("--vary", text, 'NAME=RANGE, such as liquid.viscosity="1 Pa s:4 Pa s:3"', "has no =")
        check_varies(name, values, "--vary", asked.package)
        if name in found or name in asked.entries:
            other = "twice" if name in found else "together with --set"
            raise InputError("--vary", name, "every entry once", f"is given {other}")
        entry = fields(asked.package)[name]
        found[name] = options.varied(entry, values, f"--vary {name}")
    return found


def _computed(
    scene: Scene,
    axes: dict[str, list[float]],
    varied: dict[str, list[float] | list[str]],
    rtol: float,
    engine: str | None,
    file: Path | None,
    scheduler: str | None,
) -> xarray.Dataset:
    """Compute the map and write it; after an interrupt finished collisions stay in the journal."""
    from ..many.cluster import connected
    from ..many.csv_map import write_csv
    from ..many.journal import Journal
    from ..many.regime_map import regime_map, write
    from .bar import bar

    stored = _stored(file)
    journal = None if file is None else Journal(file.with_name(file.name + ".partial"))
    done = (0, 0)
    begun = journal is None or not journal.path.exists()
    try:
        with (
            journal.held("-o", file) if journal else nullcontext(),
            connected(scheduler, "--scheduler") if scheduler is not None else nullcontext() as client,
            bar("collisions") as shown,
        ):

            def progress(*counts: int) -> None:
                nonlocal done
                done = (counts[0], counts[1])
                shown(*done)

            data = regime_map(
                scene,
                stokes=axes.get("stokes"),
                speed=axes.get("speed"),
                relative_speed=axes.get("relative_speed"),
                angle=axes["angle"],
                vary=varied,
                rtol=rtol,
                engine=engine,
                progress=progress,
                slow=lambda left: shown.note(f"the last {left} are slow ones"),
                journal=journal,
                client=client,
                store=file if stored else None,
            )
            if file is not None and journal is not None and not stored:
                (write_csv if file.suffix.lower() == ".csv" else write)(data, file)
                journal.remove()
    except (KeyboardInterrupt, OSError) as error:
        count = 0 if journal is None else journal.count()
        if journal is None or not count:
            if isinstance(error, OSError) and begun and journal is not None:
                journal.path.unlink(missing_ok=True)  # it holds no finished block
            raise
        where = f"{file}.*.unfinished and {journal.path}" if stored else f"{journal.path}"
        kept = f"{count} of {done[1]} collisions are kept in {where}"  # from the file: progress may lag
        if isinstance(error, KeyboardInterrupt):
            raise KeyboardInterrupt(f"interrupted: {kept}; the same command computes the rest") from None
        rest = f"the same command computes {'the rest' if count < done[1] else 'nothing again'}"
        raise OSError(error.errno, f"{error.strerror or error} ({kept}; {rest})", error.filename) from error
    if journal is not None and journal.path.exists():
        collisions, lines = journal.others()
        what = [f"{collisions} finished collisions of another request"] if collisions else []
        what += [f"{lines} lines that are no finished collisions"] if lines else []
        click.echo(f"{journal.path} was there already and stays: it holds {' and '.join(what)}", err=True)
    return data


def _show(data: xarray.Dataset, scene: Scene, file: Path | None, picture: Path | None) -> None:
    from ..many.text_map import failures, table

    if picture is not None:
        from ..boundaries.on_map import map_curves
        from ..host.files import save
        from ..many.plot_map import draw_map

        save(draw_map(data, map_curves(data, scene.package)), picture, dpi=150)
    if file is None and picture is None:
        click.echo(table(data))
    failed = failures(data)
    if failed is not None:
        click.echo(failed, err=True)
