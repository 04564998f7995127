"""`wetdoublet table`: a collision law as a table with a tested error."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import click

from ..errors import InputError, did_you_mean
from ..host.outputs import check_file
from ..scene.user_model import fields
from . import options, texts
from .bar import Bar
from .signature import as_command, passed

_SHORT = {"stokes": "impact.stokes", "angle": "impact.angle"}
_ACCEPTED = "stokes=LO:HI,angle=LO:HI[,NAME=LO:HI]"
_SUFFIXES = (".nc", ".h")


@as_command("The collision law as a table with a tested error: NetCDF or C.")
def command(
    over: str | None,
    error: Annotated[float | None, partial(texts.number, "a number such as 1e-4")],
    of: list[str] | None,
    attack: Annotated[int | None, lambda text: int(texts.number("a whole number such as 1e6", text))],
    request: options.EntriesRequest,
    rtol: options.Rtol,
    plot: options.Picture,
    output: Annotated[Path | None, partial(check_file, label="", suffixes=_SUFFIXES)],
) -> None:
    """Tabulate the collision law of SCENE over the Stokes number, the impact angle and perhaps one more entry.

    Chebyshev series between traced boundaries. Before the file is written, random and boundary-hugging queries are held
    against collisions; the largest error found stands in the file. A law that cannot be tabulated is refused, with the
    place.

    \b
    Examples:
      wetdoublet table granulation --over stokes=0.01:1,angle=0:80 -o law.nc
      wetdoublet table granulation --over stokes=0.01:1,angle=0:80,liquid.viscosity="1:4 Pa s" --error 1e-3 -o law.h

    Options:
        --over RANGES: stokes=LO:HI,angle=LO:HI[,NAME=LO:HI]; angles in degrees.
        --error E: Largest error of a result [1e-4].
        --of NAMES: Results [restitution,tangential_restitution]; also rotation.
        --attack N: Queries that are held against collisions [1000000].
        --plot FILE.png: Draw a picture: .png, .pdf or .svg.
        -o FILE (output): File to write: .nc (NetCDF) or .h (C99, data and reader).
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..tables.table import RESULTS, table

    options.check_apart(output, plot, "--plot")
    for name in of or ():
        texts.known(RESULTS, name, "--of")
    ranges = _ranges(over, request)
    scene = request.scene()
    if output is None:
        raise InputError("-o", None, "a file to write, ending in " + ", ".join(_SUFFIXES))
    with Bar("queries", "fewer are asked by --attack") as progress:
        law = table(scene, over=ranges, progress=progress, **passed(error=error, of=of, rtol=rtol, attack=attack))
    law.save(output)
    if plot is not None:
        law.plot(plot)
    click.echo(f"{law}\n{output}")


def _ranges(over: str | None, request: options.SceneRequest) -> dict[str, texts.Range]:
    """The ranges of --over by name, SI; a table chooses its points itself, whatever log: and a count say."""
    if over is None:
        raise InputError("--over", None, _ACCEPTED)
    known = fields(request.package)
    ranges: dict[str, texts.Range] = {}
    for part in over.split(","):
        name, ends = texts.assignment(_ACCEPTED, part, "--over")
        entry = known.get(_SHORT.get(name, name))
        if entry is None:
            raise InputError("--over", name, _ACCEPTED, "is not known" + did_you_mean(name, [*_SHORT, *known]))
        if name in ranges:
            raise InputError("--over", name, _ACCEPTED, "is given twice")
        if entry.name in request.entries:
            raise InputError("--over", name, "every entry once", "is given together with --set")
        low, *others = ends.strip().removeprefix("log:").split(":")
        number = len(others) == 2 and others[1].strip().isdigit()
        ranges[name] = texts.span(entry, ":".join([low, *others[: 1 if number else None]]), f"--over {name}")
    return ranges
