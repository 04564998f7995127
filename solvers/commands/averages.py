"""`wetdoublet averages`: outcomes and restitution averaged over impact geometry and speeds."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from typing import TYPE_CHECKING

import click

from ..errors import InputError
from ..scene.ranges import MOST
from ..scene.schema import FIELDS, SPINS
from ..settings import RTOL, check_rtol
from . import options

if TYPE_CHECKING:
    import xarray


@click.command("averages", short_help="Means over impact geometry and speeds, for pairs of sizes.")
@options.scene_argument
@click.option(
    "--speeds", metavar="SPEEDS",
    help='Relative speeds: "1 m/s", "maxwell:0.3 m/s", or a table FILE.csv [impact.relative_speed].',
)  # fmt: skip
@click.option("--radii", metavar="RANGE", help='Radii of both spheres, as "log:20:200 um:16" [the scene\'s pair].')
@click.option("--films", metavar="RULE", help="Film and roughness of other sizes: fixed or proportional [fixed].")
@click.option("--tolerance", metavar="E", help="Error of the quadrature, 1e-9..1e-2 [1e-6].")
@click.option("--wrt", metavar="NAME,...", help="Entries by which the means are differentiated, as liquid.viscosity.")
@options.changes
@options.model
@options.rtol
@click.option("-o", "output", metavar="FILE", help="Write NetCDF (.nc) or a table (.csv); an interrupted run goes on.")
@options.debug
def command(
    source: str | None,
    speeds: str | None,
    radii: str | None,
    films: str | None,
    tolerance: str | None,
    wrt: str | None,
    changes: Sequence[str],
    model: str | None,
    rtol: str | None,
    output: str | None,
) -> None:
    """Sticking probability and mean restitution of SCENE over all impact angles and a distribution of speeds.

    Impact angles have the density sin(2 theta) of isotropic relative velocities. With maxwell:S each component of the
    particles' velocities has the standard deviation S. Without -o the table is printed.

    \b
    Example:
      wetdoublet averages granulation --speeds "maxwell:0.5 m/s" --radii "log:30:300 um:16" -o averages.nc
    """  # noqa: D301 # click wants the character itself
    by = RTOL if rtol is None else check_rtol(rtol, "--rtol")
    names = [] if wrt is None else options.listed(wrt, "--wrt")
    file = options.check_file(output, "-o", (".nc", ".csv"), replaced=True)
    entry = FIELDS["particles.radius"]
    sizes = None if radii is None else options.entry_range(entry, radii, "--radii", most=MOST)
    asked = options.SceneRequest.check(source, changes, model=model)
    for name in asked.entries:
        if name.startswith("impact.") and name not in SPINS:
            accepted = "entries that are not of the impact, or " + " and ".join(SPINS)
            raise InputError("--set", name, accepted, "has no influence on averages")
    scene = asked.scene()

    from ..averages.averages import check_tolerance, collision_averages
    from ..averages.dataset import to_csv, write_csv
    from ..averages.sizes import FILMS, FIXED
    from ..averages.speeds import Speeds
    from ..host.arguments import check_name
    from ..many.journal import beside
    from ..many.regime_map import write
    from .bar import bar

    given = scene.impact.relative_speed if speeds is None else speeds
    distribution = Speeds.of(given, "--speeds")
    rule = FIXED if films is None else check_name(films, FILMS, "--films")
    within = check_tolerance(1e-6 if tolerance is None else tolerance, "--tolerance")
    journal = None if file is None else beside(file)
    done = (0, 0)
    try:
        with journal.held("-o", file) if journal else nullcontext(), bar("pairs") as shown:

            def progress(*counts: int) -> None:
                nonlocal done
                done = (counts[0], counts[1])
                shown(*done)

            data = collision_averages(
                scene, speeds=distribution, radii=sizes, films=rule, tolerance=within, rtol=by, wrt=names,
                progress=progress, journal=journal,
            )  # fmt: skip
            if file is not None and journal is not None:
                (write_csv if file.suffix.lower() == ".csv" else write)(data, file)
                journal.remove()
    except KeyboardInterrupt:
        count = 0 if journal is None else journal.count()
        if journal is None or not count:
            raise
        kept = f"{count} of {done[1]} pairs are kept in {journal.path}"
        raise KeyboardInterrupt(f"interrupted: {kept}; the same command computes the rest") from None
    if file is None:
        click.echo(to_csv(data), nl=False)
    _tell(data)


def _tell(data: xarray.Dataset) -> None:
    """Say on standard error how many pairs failed, and why the first one did."""
    reasons = [str(reason) for reason in data["reason"].values.ravel() if reason]
    if reasons:
        click.echo(f"{len(reasons)} of {data['reason'].size} pairs failed; the first: {reasons[0]}", err=True)
