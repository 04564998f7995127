"""`wetdoublet verify --stress N`: all engines against each other on N scenes."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path

import click

from ..errors import CheckFailed, InputError
from .bar import bar

SCENES = 20_000  # where --stress stands alone


class Counted(click.Command):
    """A command whose --stress may stand alone: what follows it is its value, unless it is an option."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Judge a negative number here, which click takes for an option."""
        for option, value in pairwise(args):
            if option == "--stress" and value[:1] == "-" and value[1:2].isdigit():
                count_of(value)
        return super().parse_args(ctx, args)


def count_of(text: str) -> int:
    """Return the number of scenes; InputError unless it is one."""
    try:
        count = int(text)
    except ValueError:
        raise InputError("--stress", text, "a whole number of scenes, such as 500", "is not a whole number") from None
    if not 0 < count <= 10_000_000:
        raise InputError("--stress", text, "a whole number of scenes, 1 to 10000000", "is out of range")
    return count


def check_alone(stress: str | None, out: str | None, others: Mapping[str, str | None]) -> None:
    """InputError for --out without --stress, and for what --stress, which draws its own scenes, does not take."""
    if stress is None:
        if out is not None:
            raise InputError("--out", out, "--stress N with --out", "needs --stress")
        return
    for name, value in others.items():
        if value:
            said = "is given together with --stress, which draws its own scenes"
            raise InputError(name, value, "--stress N and --out DIR alone", said)


def stress_test(count: int, folder: Path) -> None:
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
