"""`wetdoublet verify --stress N`: all engines against each other on N scenes."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path

import click

from ..errors import CheckFailed, InputError
from .bar import bar

SCENES = 20_000  # scenes if --stress has no value


class Counted(click.Command):
    """A command whose --stress takes an optional value."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Check a negative number before click, which would read it as an option."""
        for option, value in pairwise(args):
            if option == "--stress" and value[:1] == "-" and value[1:2].isdigit():
                count_of(value)
        return super().parse_args(ctx, args)


def count_of(text: str) -> int:
    """Return the number of scenes; InputError unless it is a whole number in range."""
    try:
        count = int(text)
    except ValueError:
        raise InputError("--stress", text, "a whole number of scenes, such as 500", "is not a whole number") from None
    if not 0 < count <= 10_000_000:
        raise InputError("--stress", text, "a whole number of scenes, 1 to 10000000", "is out of range")
    return count


def check_alone(stress: str | None, out: str | None, others: Mapping[str, str | None]) -> None:
    """Raise InputError for --out without --stress, and for arguments that do not apply with --stress."""
    if stress is None:
        if out is not None:
            raise InputError("--out", out, "--stress N with --out", "needs --stress")
        return
    for name, value in others.items():
        if value:
            said = "is given together with --stress, which draws its own scenes"
            raise InputError(name, value, "--stress N and --out DIR alone", said)


def stress_test(count: int, folder: Path) -> None:
    """Run the stress test, write the report and print one line of summary.

    An interrupt ends the run with a report of the scenes judged so far.

    Raises:
        CheckFailed: engines disagree without an explanation.
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
