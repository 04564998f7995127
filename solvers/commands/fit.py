"""`wetdoublet fit`: parameters of a scene from measured impacts."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import click

from ..errors import InputError
from ..host.outputs import check_file
from . import options
from .bar import Bar
from .signature import as_command, passed

_PICTURE = "-o FILE.json keeps the estimates without their picture"


@as_command("Entries of a scene from measured impacts, with what the data cannot tell.")
def command(
    data: str | None,
    free: list[str] | None,
    prior: options.Priors,
    over: list[str] | None,
    write: Annotated[Path | None, partial(check_file, label="", suffixes=(".toml",))],
    report: options.Folder,
    request: options.HeldRequest,
    rtol: options.Rtol,
    output: options.Shown,
) -> None:
    """Estimate entries of SCENE from the impacts in DATA.csv; the scene's own values are a first guess.

    \b
    The first line of DATA.csv names its columns:
      speed [m/s],angle [deg],restitution,restitution_sd,outcome
    \b
    Examples:
      wetdoublet fit granulation impacts.csv --free particles.roughness,liquid.viscosity --plot fit.png
      wetdoublet fit scene.toml impacts.csv --free liquid.viscosity --prior liquid.viscosity="2 Pa s +- 10 %"

    Options:
        DATA.csv (data):
        --free NAMES: Entries to estimate, as particles.roughness,liquid.viscosity.
        --compare NAMES (over): Also fit every other bridge.law, model.film or model.glass, and compare them by AIC and
            cross-validation.
        --write FILE.toml: Write the fitted scene, intervals as comments.
        --report DIR: Write report.md, report.html and their picture.
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..fitting.compare import check_choices, compare_models
    from ..fitting.fit import fit

    options.check_apart(output.file, write, "--write")
    if free is None:
        raise InputError("--free", None, "entries to estimate, as --free particles.roughness,liquid.viscosity")
    if data is None:
        raise InputError("DATA.csv", None, "a CSV file with a row for each impact")
    scene = request.scene(remark=True)
    choices = None if over is None else check_choices(scene, over)
    chosen = passed(prior=prior or None, rtol=rtol)
    with Bar("evaluations", "fewer free entries or rows take less", factor=3.0) as progress:
        fitted = fit(scene, data, free, progress=progress, **chosen)
    text, record = str(fitted), fitted.to_dict()
    if choices is not None:
        with Bar("models", "fewer free entries, rows or choices take less") as progress:
            comparison = compare_models(scene, data, free, over=choices, progress=progress, **chosen)
        text, record = f"{text}\n\n{comparison}", record | {"comparison": comparison.to_dict()}
    output.put(text, record)
    if fitted.rows.contradicted and (output.as_json or output.file is not None):
        click.echo(fitted.remarks[0], err=True)  # a table on standard output says so itself
    if write is not None:
        fitted.write(write)
    if report is not None:
        with Bar("evaluations", _PICTURE, factor=3.0) as progress:
            fitted.report(report, progress=progress)
    if output.picture is not None:
        with Bar("evaluations", _PICTURE, factor=3.0) as progress:
            fitted.plot(output.picture, progress=progress)
