"""`wetdoublet averages`: outcomes and restitution averaged over impact geometry and speeds."""

import sys
from functools import partial
from pathlib import Path
from typing import Annotated

import click

from ..host import files
from ..host.outputs import check_file
from ..scene.schema import FIELDS
from . import options, texts
from .signature import as_command, passed


@as_command("Means over impact geometry and speeds, for pairs of sizes.")
def command(
    speeds: str | None,
    radii: Annotated[list[float] | None, partial(texts.entry_range, FIELDS["particles.radius"])],
    films: str | None,
    tolerance: str | None,
    wrt: list[str] | None,
    request: options.EntriesRequest,
    rtol: options.Rtol,
    output: Annotated[Path | None, partial(check_file, label="", suffixes=(".nc", ".csv"), replaced=True)],
) -> None:
    """Sticking probability and mean restitution of SCENE over all impact angles and speeds, for each pair of radii.

    Impact angles have the density sin(2 theta) of isotropic relative velocities. With maxwell:S speeds are those of a
    gas whose velocity components have the standard deviation S, weighted by flux. Without -o a table is
    printed, into a pipe as CSV.

    \b
    Example:
      wetdoublet averages granulation --speeds "maxwell:0.5 m/s" --radii "log:30:300 um:16" -o averages.nc

    Options:
        --speeds SPEEDS: Relative speeds: "1 m/s", "maxwell:0.3 m/s", or a table FILE.csv [impact.relative_speed].
        --radii RANGE: Radii, such as "log:20:200 um:16"; every pair of them is computed, beside a wall each one [the
            scene's pair].
        --films RULE: How film and roughness change with the radii: fixed, or proportional to their sum [fixed].
        --tolerance E: Absolute error of the quadrature, 1e-9..1e-2 [1e-6].
        --wrt NAME,...: Entries by which the means are differentiated, such as liquid.viscosity.
        -o FILE (output): Write NetCDF (.nc) or a table (.csv); the same command continues an interrupted run.
    """  # noqa: D301 # click wants the character itself
    scene = request.scene_without_impact("has no influence on averages")

    from ..averages.averages import collision_averages
    from ..averages.dataset import table, to_csv
    from ..many.regime_map import write
    from .resumable import resumable

    chosen = passed(speeds=speeds, radii=radii, films=films, tolerance=tolerance, rtol=rtol, wrt=wrt)
    with resumable(output, "pairs", cheaper="a larger --tolerance or fewer --radii take less") as (journal, progress):
        data = collision_averages(scene, progress=progress, journal=journal, **chosen)
        if output is not None and journal is not None:
            if output.suffix.lower() == ".csv":
                files.write(output, to_csv(data))
            else:
                write(data, output)
            journal.remove()
    if output is None:
        click.echo(table(data) if sys.stdout.isatty() else to_csv(data), nl=False)
    reasons = [str(reason) for reason in data["reason"].values.ravel() if reason]
    if reasons:
        click.echo(f"{len(reasons)} of {data['reason'].size} pairs failed; the first: {reasons[0]}", err=True)
