"""`wetdoublet bench`: run time against achieved error, or all engines against each other."""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path

import click

from ..errors import CheckFailed, InputError
from . import options
from .bar import bar

_SCENES = 20_000


class _Counted(click.Command):
    """A command whose --stress may stand alone: what follows it is its value, unless it is an option."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Judge a negative number here, which click takes for an option."""
        for option, value in pairwise(args):
            if option == "--stress" and value[:1] == "-" and value[1:2].isdigit():
                _count(value)
        return super().parse_args(ctx, args)


@click.command("bench", cls=_Counted, short_help="Run time against error, beside the peers that are installed.")
@click.option("--out", metavar="DIR", help="Folder for records, tables and plots [bench, or stress].")
@click.option(
    "--stress",
    metavar="N",
    is_flag=False,
    flag_value=str(_SCENES),
    help=f"Hold all engines against each other on N scenes [{_SCENES}].",
)
@options.debug
def command(out: str | None, stress: str | None) -> None:
    """Measure our engines and the peers that are installed on the same collisions, with the same stop rule.

    Takes some minutes, the first time longer: integrators are compiled. How busy the machine was is in the record.
    """
    count = None if stress is None else _count(stress)
    folder = options.check_folder(out or ("bench" if count is None else "stress"))
    assert folder is not None  # one of them is a name
    if count is not None:
        _stress(count, folder)
        return

    from ..benchmarks.record import write
    from ..benchmarks.run import bench

    record = bench(tell=_tell if sys.stderr.isatty() else lambda _: None)
    if sys.stderr.isatty():
        _tell("")
    text, files = write(record, folder)
    click.echo(text)
    click.echo("written: " + ", ".join(map(str, files)))


def _count(text: str) -> int:
    """Return the number of scenes; InputError unless it is one."""
    try:
        count = int(text)
    except ValueError:
        raise InputError("--stress", text, "a whole number of scenes, such as 500", "is not a whole number") from None
    if not 0 < count <= 10_000_000:
        raise InputError("--stress", text, "a whole number of scenes, 1 to 10000000", "is out of range")
    return count


def _stress(count: int, folder: Path) -> None:
    """Run, report, and say in one last line what came of it; CheckFailed if engines disagree without a reason.

    An interrupt ends it with a report of what is judged by then.
    """
    from ..verify.stress.report import write
    from ..verify.stress.run import stress

    with bar("scenes") as tell:
        found = stress(count, tell=tell)
    files = write(found, folder)
    for one, issue in found.unexplained:
        click.echo(f"unexplained ({issue.kind}): {one.case.name}: {issue.said}")
    if found.remarks:
        outside = sum(bool(one.remarks) for one in found.verdicts)
        click.echo(f"outside the range that a bridge law was made for: {outside} scenes, counted in stress.md")
    click.echo(f"written: {', '.join(map(str, files[:4]))}" + (f" and {len(files) - 4} scenes" if files[4:] else ""))
    click.echo(found.summary())
    if found.unexplained:
        raise CheckFailed(f"{len(found.unexplained)} unexplained disagreements; see {folder / 'stress.md'}")
    if found.interrupted:
        raise KeyboardInterrupt(f"interrupted: {len(found.verdicts)} of {count} scenes are in {folder / 'stress.md'}")


def _tell(what: str) -> None:
    """Say what goes on, in one line of the terminal."""
    click.echo(f"\r\x1b[K{what}", nl=False, err=True)
