"""`wetdoublet table`: a collision law as a table whose error was looked for."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count as count_from

import click

from ..errors import InputError, did_you_mean
from ..scene import units
from ..scene.schema import Field
from ..scene.user_model import fields
from ..settings import RTOL, check_rtol
from . import options
from .bar import bar

_SHORT = {"stokes": "impact.stokes", "angle": "impact.angle"}
_ACCEPTED = "stokes=LO:HI,angle=LO:HI[,NAME=LO:HI]"
_SUFFIXES = (".nc", ".h")


@click.command("table", short_help="The collision law as a table with a tested error: NetCDF or C.")
@options.scene_argument
@click.option("--over", metavar="RANGES", help=f"{_ACCEPTED}; angles in degrees.")
@click.option("--error", metavar="E", help="Largest error of a result [1e-4].")
@click.option("--of", "of", metavar="NAMES", help="Results [restitution,tangential_restitution]; also rotation.")
@click.option("--attack", metavar="N", help="Queries that are held against collisions [1000000].")
@options.changes
@options.model
@options.rtol
@options.plot
@click.option("-o", "output", metavar="FILE", help="File to write: .nc (NetCDF) or .h (C99, data and reader).")
@options.debug
def command(
    source: str | None,
    over: str | None,
    error: str | None,
    of: str | None,
    attack: str | None,
    changes: Sequence[str],
    model: str | None,
    rtol: str | None,
    plot: str | None,
    output: str | None,
) -> None:
    """Tabulate the collision law of SCENE over the Stokes number, the impact angle and perhaps one more entry.

    Chebyshev series between traced boundaries. Before the file is written, random and boundary-hugging queries are held
    against collisions; the largest error found stands in the file. A law that cannot be tabulated is refused, with the
    place.

    \b
    Examples:
      wetdoublet table granulation --over stokes=0.01:1,angle=0:80 -o law.nc
      wetdoublet table granulation --over stokes=0.01:1,angle=0:80,liquid.viscosity="1:4 Pa s" --error 1e-3 -o law.h
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..tables.table import ATTACK, RESULTS, table

    tolerance = RTOL if rtol is None else check_rtol(rtol, "--rtol")
    picture = options.check_file(plot, "--plot", options.PICTURES)
    file = options.check_file(output, "-o", _SUFFIXES)
    options.check_apart(file, "-o", picture, "--plot")
    names = _names(of, RESULTS)
    largest = 1e-4 if error is None else _number(error, "--error", "a number such as 1e-4")
    count = ATTACK if attack is None else int(_number(attack, "--attack", "a whole number such as 1e6"))
    asked = options.SceneRequest.check(source, changes, model=model)
    ranges = _ranges(over, asked)
    scene = asked.scene()
    if file is None:
        raise InputError("-o", None, "a file to write, ending in " + ", ".join(_SUFFIXES))
    with bar("steps") as shown:
        steps = count_from(1)

        def tell(said: str) -> None:
            shown(next(steps), None)
            shown.note(said)

        found = table(scene, over=ranges, error=largest, of=names, rtol=tolerance, attack=count, progress=tell)
    found.save(file)
    if picture is not None:
        found.plot(picture)
    click.echo(str(found))
    click.echo(str(file))


def _names(of: str | None, known: tuple[str, ...]) -> tuple[str, ...]:
    names = known[:2] if of is None else tuple(options.listed(of, "--of"))
    for name in names:
        if name not in known:
            raise InputError("--of", name, ", ".join(known), "is not known" + did_you_mean(name, known))
    return names


def _number(text: str, label: str, accepted: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(label, text, accepted, "is no number") from None


def _ranges(over: str | None, asked: options.SceneRequest) -> dict[str, tuple[float, float] | tuple[str, str]]:
    """The ranges of --over by name, SI."""
    if over is None:
        raise InputError("--over", None, _ACCEPTED)
    known = fields(asked.package)
    found: dict[str, tuple[float, float] | tuple[str, str]] = {}
    for part in over.split(","):
        name, equals, ends = part.partition("=")
        name = name.strip()
        if not equals:
            raise InputError("--over", part, _ACCEPTED, "has no =")
        entry = known.get(_SHORT.get(name, name))
        if entry is None:
            raise InputError("--over", name, _ACCEPTED, "is not known" + did_you_mean(name, [*_SHORT, *known]))
        if name in found:
            raise InputError("--over", name, _ACCEPTED, "is given twice")
        if entry.name in asked.entries:
            raise InputError("--over", name, "every entry once", "is given together with --set")
        found[name] = _ends(f"--over {name}", ends, entry)
    return found


def _ends(label: str, text: str, entry: Field) -> tuple[float, float] | tuple[str, str]:
    """The ends of LO:HI, SI; of log:LO:HI and LO:HI:N too, as a table chooses its points itself."""
    parts = text.strip().removeprefix("log:").split(":")
    accepted = "LO:HI with LO below HI" + (", in degrees or with a unit" if entry.unit == "rad" else "")
    if len(parts) == 3 and parts[2].strip().isdigit():
        parts = parts[:2]
    if len(parts) != 2:
        raise InputError(label, text, accepted, "is not a range")
    if entry.or_unit and not all(units.is_number(end) for end in parts):
        low, high = options.entry_ends(entry.measured, label)(*parts)
        return f"{low!r} {entry.or_unit}", f"{high!r} {entry.or_unit}"
    low, high = options.entry_ends(entry, label)(*parts)
    if not low < high:
        raise InputError(label, text, accepted, "is not a range")
    return low, high
