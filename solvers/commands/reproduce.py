"""`wetdoublet reproduce`: the paper's figures and numbers compared with ours."""

from pathlib import Path

import click

from . import options, texts
from .bar import Bar
from .signature import as_command


@as_command("The paper's figures and numbers beside ours, as pictures and one report.")
def command(part: str | None, out: options.Folder) -> None:
    """Reproduce the figures, Table 1 and the critical numbers of Donahue et al. (2012), or one PART of them.

    Writes pictures (PNG) and report.md; all numbers are computed in the run.

    Options:
        [all|table1|fig1|fig3|fig4a|fig4b|factors] (part):
        --out DIR: Write there [paper, in the current folder]; it may hold other files.
    """
    from ..paper.reproduce import PARTS, reproduce

    if part is not None:
        texts.known(("all", *PARTS), part, "PART")

    with Bar("parts", "a single PART takes less") as progress:
        parts = tuple(PARTS) if part in (None, "all") else (part,)
        written = reproduce(parts, out or Path("paper"), progress=progress)
    click.echo("\n".join(map(str, written)))
