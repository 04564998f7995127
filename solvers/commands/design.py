"""`wetdoublet design`: where the next impacts should be."""

from __future__ import annotations

import json
from collections.abc import Sequence

import click

from ..errors import InputError
from ..scene.schema import FIELDS
from ..settings import check_rtol
from . import options

_OPTIONS = {
    "free": "--free", "over": "--over", "n": "-n", "target": "--for", "data": "--data", "prior": "--prior",
    "draws": "--draws", "speed_sd": "--speed-sd", "angle_sd": "--angle-sd", "restitution_sd": "--restitution-sd",
}  # fmt: skip
"""Argument of `design` -> its option."""


@click.command("design", short_help="Where the next impacts should be to learn most about entries of a scene.")
@options.scene_argument
@click.option(
    "--free", metavar="NAMES", help="Entries that will be estimated, as liquid.viscosity,particles.roughness."
)
@click.option(
    "--over",
    metavar="WINDOW",
    help="Impacts that can be made: stokes=LO:HI,angle=LO:HI (degrees); also speed or relative_speed, with a unit.",
)
@click.option("-n", "size", metavar="N", help="Number of impacts [9].")
@click.option("--for", "target", metavar="NAME", help="The entry that matters [all of --free alike].")
@click.option("--data", metavar="DATA.csv", help="Impacts measured before; they are fitted first.")
@options.priors
@click.option("--draws", metavar="N", help="Best on average over N draws from priors and data [0: for one value].")
@click.option("--speed-sd", metavar="S", help="Scatter of the speed [2 %, or that of the data].")
@click.option("--angle-sd", metavar="S", help="Scatter of the angle, degrees [1, or that of the data].")
@click.option("--restitution-sd", metavar="S", help="Noise of a measured restitution [0.02]; none: outcomes only.")
@options.changes
@options.model
@options.rtol
@options.as_json
@options.plot
@options.output
@options.debug
def command(
    source: str | None,
    free: str | None,
    over: str | None,
    size: str | None,
    target: str | None,
    data: str | None,
    priors: Sequence[str],
    draws: str | None,
    speed_sd: str | None,
    angle_sd: str | None,
    restitution_sd: str | None,
    changes: Sequence[str],
    model: str | None,
    rtol: str | None,
    as_json: bool,
    plot: str | None,
    output: str | None,
) -> None:
    """Choose the impacts from whose outcomes and restitutions `fit` will learn most about entries of SCENE.

    With -o FILE.csv they are also written as the table that `fit` reads, to be filled in.

    \b
    Examples:
      wetdoublet design granulation --free liquid.viscosity,liquid.film_thickness --over stokes=0.02:0.5,angle=0:80
      wetdoublet design granulation --free liquid.viscosity --over stokes=0.05:0.3,angle=0 -n 4 --restitution-sd none
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..fitting.fit import RTOL
    from ..host import files
    from ..planning.design import design

    tolerance = RTOL if rtol is None else check_rtol(rtol, "--rtol")
    picture = options.check_file(plot, "--plot", options.PICTURES)
    file = options.check_file(output, "-o")
    options.check_apart(file, "-o", picture, "--plot")
    given = options.assigned(priors, "--prior", 'NAME=PRIOR, such as particles.roughness="2 um +- 20 %"')
    if free is None:
        raise InputError("--free", None, "entries to estimate, as --free particles.roughness,liquid.viscosity")
    if over is None:
        raise InputError("--over", None, "the impacts that can be made, as --over stokes=0.02:0.5,angle=0:80")
    names = options.listed(free, "--free")
    window = _window(over)
    angle_sd = None if angle_sd is None else options.with_degrees(FIELDS["impact.angle"], angle_sd)
    asked = options.SceneRequest.check(source, changes, model=model)
    number, sample = _whole(size, "-n", 9), _whole(draws, "--draws", 0)
    with options.arguments_as_options(_OPTIONS):
        found = design(
            asked.scene(), names, window, number, target=target, data=data, prior=given or None, draws=sample,
            speed_sd=speed_sd, angle_sd=angle_sd, restitution_sd=restitution_sd, rtol=tolerance,
        )  # fmt: skip
    if file is not None and file.suffix == ".csv":
        files.write(file, found.to_csv())
        file = None
    options.put(json.dumps(found.to_dict(), indent=2, allow_nan=False) if as_json else str(found), file)
    if picture is not None:
        found.plot(picture)


def _window(text: str) -> dict[str, object]:
    """The window of --over: names with LO:HI or one value; bare angles in degrees, a unit at either end."""
    found: dict[str, object] = {}
    for part in text.split(","):
        name, equals, ends = part.partition("=")
        name = name.strip()
        if not equals or name in found:
            problem = "is given twice" if equals else "has no ="
            raise InputError("--over", text, "stokes=LO:HI,angle=LO:HI", problem)
        entry = FIELDS.get(f"impact.{name}")
        values = ends.split(":")
        if entry is not None and len(values) == 2:
            found[name] = options.entry_ends(entry, f"--over {name}")(*values)
        elif entry is not None and len(values) == 1:
            found[name] = options.with_degrees(entry, ends)
        else:
            found[name] = values
    return found


def _whole(text: str | None, label: str, default: int) -> int:
    if text is None:
        return default
    try:
        return int(text)
    except ValueError:
        raise InputError(label, text, "a whole number") from None
