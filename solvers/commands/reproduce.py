"""`wetdoublet reproduce`: the paper's figures and numbers compared with ours."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from ..errors import InputError, did_you_mean
from . import options

FOLDER = "paper"


@click.command("reproduce", short_help="The paper's figures and numbers beside ours, as pictures and one report.")
@click.argument("part", metavar="[all|table1|fig1|fig3|fig4a|fig4b|factors]", required=False)
@click.option("--out", metavar="DIR", help=f"Write there [{FOLDER}, in the current folder]; it may hold other files.")
@options.debug
def command(part: str | None, out: str | None) -> None:
    """Reproduce the figures, Table 1 and the critical numbers of Donahue et al. (2012), or one PART of them.

    Writes pictures (PNG), report.md and report.html; all numbers are computed in the run.
    """
    folder = options.check_folder(out) or Path(FOLDER)

    from ..paper import PARTS, reproduce

    if part is not None and part != "all" and part not in PARTS:
        known = ("all", *PARTS)
        raise InputError("PART", part, ", ".join(known), "is not known" + did_you_mean(part, known))

    from ..paper.desk import progress

    say = progress()
    try:
        files = reproduce(PARTS if part in (None, "all") else (str(part),), folder, say=say)
    finally:
        if sys.stderr.isatty():
            say("")
    click.echo("\n".join(map(str, files)))
