"""`wetdoublet fit`: parameters of a scene from measured impacts."""

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
    free: list[str] | None,
    own: tuple[str, ...],
    prior: options.Priors,
    predict: options.Picture,
    write: Annotated[Path | None, partial(check_file, label="", suffixes=(".toml",))],
    measured: options.MeasuredRequests,
    rtol: options.Rtol,
    output: options.Shown,
) -> None:
    """Estimate entries of SCENE from the impacts in DATA.csv; the scene's own values are a first guess.

    Several scenes, each followed by its data, share the entries that are not --own.

    \b
    The first line of DATA.csv names its columns:
      speed [m/s],angle [deg],restitution,restitution_sd,outcome
    \b
    Examples:
      wetdoublet fit granulation impacts.csv --free particles.roughness,liquid.viscosity --plot fit.png
      wetdoublet fit scene.toml impacts.csv --free liquid.viscosity --prior liquid.viscosity="2 Pa s +- 10 %"
      wetdoublet fit oil.toml oil.csv water.toml water.csv --free particles.roughness,liquid.viscosity,noise.restitution
        --own liquid.viscosity

    Options:
        --free NAMES: Entries to estimate, as particles.roughness,liquid.viscosity; noise.restitution is a factor of
            the standard deviations in the data.
        --own NAME: A free entry of which each scene has a value of its own, or NAME=LABEL,LABEL,... with a label for
            each scene, of which equal ones share; repeatable.
        --predict FILE.png: Draw the probability of sticking around the impacts, with the uncertainty of the estimates;
            of several scenes FILE-1.png, FILE-2.png, ...
        --write FILE.toml: Write the fitted scene, intervals as comments; of several FILE-1.toml, FILE-2.toml, ...
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..fitting.fit import fit
    from ..host.pictures import plot

    options.check_apart(output.file, write, "--write")
    if free is None:
        raise InputError("--free", None, "entries to estimate, as --free particles.roughness,liquid.viscosity")
    if any(data is None for _, data in measured):
        raise InputError("DATA.csv", None, "a CSV file with a row for each impact")
    scenes, tables = [request.scene(remark=True) for request, _ in measured], [data for _, data in measured]
    chosen = passed(prior=prior or None, rtol=rtol)
    groups = {
        name: labels.split(",") if labels else labels for name, _, labels in (each.partition("=") for each in own)
    }
    with Bar("evaluations", "fewer free entries or rows take less", factor=3.0) as progress:
        fitted = fit(scenes, tables, free, own=groups, progress=progress, **chosen)
    output.put(str(fitted), fitted.to_dict())
    if fitted.rows.contradicted and (output.as_json or output.file is not None):
        click.echo(fitted.remarks[0], err=True)  # a table on standard output says so itself
    if predict is not None:
        for k in range(len(scenes)):
            file = predict.with_stem(f"{predict.stem}-{k + 1}") if len(scenes) > 1 else predict
            plot(fitted.predict(part=k), file)
    if write is not None:
        fitted.write(write)
    if output.picture is not None:
        with Bar("evaluations", _PICTURE, factor=3.0) as progress:
            fitted.plot(output.picture, progress=progress)
