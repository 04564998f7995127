"""`wetdoublet diff`: differences between two models, in their equations and in a few collisions."""

from __future__ import annotations

from collections.abc import Sequence

import click

from ..errors import InputError
from . import options

_KINDS = "library, a preset or scene file, a folder of `generate`, or MODEL.py"


@click.command("diff", short_help="The terms in which two models differ, and their effect.")
@click.argument("one", metavar="A", required=False)
@click.argument("other", metavar="B", required=False)
@click.option("--scene", "probe", metavar="SCENE", default="granulation", help="Scene of the comparison [granulation].")
@options.changes
@click.option("--latex", is_flag=True, help="A LaTeX document.")
@click.option("--markdown", is_flag=True, help="Markdown.")
@options.output
@options.debug
def command(
    one: str | None,
    other: str | None,
    probe: str,
    changes: Sequence[str],
    latex: bool,
    markdown: bool,
    output: str | None,
) -> None:
    """Compare A and B: `library`, presets, scene files, models, or two folders of `generate`.

    --set changes entries of B. Models are put into the scene of --scene; so is `library`. A MODEL.py is run as Python.

    \b
    Example:
      wetdoublet diff library mine.py
      wetdoublet diff granulation granulation --set bridge.law=willett
    """  # noqa: D301 # click wants the character itself
    file = options.check_file(output, "-o")
    if latex and markdown:
        raise InputError("--markdown", None, "only one of --latex, --markdown", "is given together with --latex")
    for label, given in (("A", one), ("B", other)):
        if given is None:
            raise InputError(label, None, _KINDS)
    assert one is not None
    assert other is not None

    from ..export.differences import differences

    found = differences(one, other, probe, options.entries(changes))

    from ..export.text import as_latex, as_markdown, as_text

    options.put((as_latex if latex else as_markdown if markdown else as_text)(found), file)
