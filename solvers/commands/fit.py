"""`wetdoublet fit`: parameters of a scene from measured impacts."""

from __future__ import annotations

import json
from collections.abc import Sequence

import click

from ..errors import InputError
from ..settings import check_rtol
from . import options

_OPTIONS = {"free": "--free", "prior": "--prior", "over": "--compare"}
"""Argument of `fit` or `compare_models` -> its option."""


@click.command("fit", short_help="Entries of a scene from measured impacts, with what the data cannot tell.")
@options.scene_argument
@click.argument("data", metavar="DATA.csv", required=False)
@click.option("--free", metavar="NAMES", help="Entries to estimate, as particles.roughness,liquid.viscosity.")
@options.priors
@click.option(
    "--compare",
    metavar="NAMES",
    help="Also fit every other bridge.law, model.film or model.glass, and compare them by AIC and cross-validation.",
)
@click.option("--write", "written", metavar="FILE.toml", help="Write the fitted scene, intervals as comments.")
@click.option("--report", "folder", metavar="DIR", help="Write report.md, report.html and their picture.")
@options.changes
@options.hold
@options.model
@options.rtol
@options.as_json
@options.plot
@options.output
@options.debug
def command(
    source: str | None,
    data: str | None,
    free: str | None,
    priors: Sequence[str],
    compare: str | None,
    written: str | None,
    folder: str | None,
    changes: Sequence[str],
    hold: str | None,
    model: str | None,
    rtol: str | None,
    as_json: bool,
    plot: str | None,
    output: str | None,
) -> None:
    """Estimate entries of SCENE from the impacts in DATA.csv; the scene's own values are a first guess.

    \b
    The first line of DATA.csv names its columns:
      speed [m/s],angle [deg],restitution,restitution_sd,outcome
    \b
    Examples:
      wetdoublet fit granulation impacts.csv --free particles.roughness,liquid.viscosity --plot fit.png
      wetdoublet fit scene.toml impacts.csv --free liquid.viscosity --prior liquid.viscosity="2 Pa s +- 10 %"
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..fitting.compare import check_choices, compare_models
    from ..fitting.fit import RTOL, fit

    tolerance = RTOL if rtol is None else check_rtol(rtol, "--rtol")
    picture = options.check_file(plot, "--plot", options.PICTURES)
    scene_file = options.check_file(written, "--write", (".toml",))
    file = options.check_file(output, "-o")
    into = options.check_folder(folder, "--report")
    for first, one, second, other in ((file, "-o", picture, "--plot"), (file, "-o", scene_file, "--write")):
        options.check_apart(first, one, second, other)
    given = options.assigned(priors, "--prior", 'NAME=PRIOR, such as particles.roughness="2 um +- 20 %"')
    if free is None:
        accepted = "entries to estimate, as --free particles.roughness,liquid.viscosity"
        raise InputError("--free", None, accepted)
    names = options.listed(free, "--free")
    asked = options.SceneRequest.check(source, changes, model=model, hold=hold)
    if data is None:
        raise InputError("DATA.csv", None, "a CSV file with a row for each impact")
    scene = asked.scene(remark=True)
    table = None
    with options.arguments_as_options(_OPTIONS):
        over = None if compare is None else check_choices(scene, options.listed(compare, "--compare"))
        found = fit(scene, data, names, prior=given or None, rtol=tolerance)
        if over is not None:
            table = compare_models(scene, data, names, over=over, prior=given or None, rtol=tolerance)
    if as_json:
        object_ = found.to_dict() | ({} if table is None else {"comparison": table.to_dict()})
        text = json.dumps(object_, indent=2, allow_nan=False)
    else:
        text = str(found) if table is None else f"{found}\n\n{table}"
    options.put(text, file)
    if found.rows.contradicted and (as_json or file is not None):
        click.echo(found.remarks[0], err=True)  # what is on standard output says so itself
    if scene_file is not None:
        found.write(scene_file)
    if into is not None:
        found.report(into)
    if picture is not None:
        found.plot(picture)
