"""`wetdoublet scenes`: what there is to begin with."""

from __future__ import annotations

from collections.abc import Sequence

import click

from . import options


@click.command("scenes", short_help="List the presets, or print one as TOML.")
@click.argument("name", metavar="[NAME]", required=False)
@options.impact
@options.changes
@options.output
@options.debug
def command(
    name: str | None,
    stokes: str | None,
    speed: str | None,
    angle: str | None,
    changes: Sequence[str],
    output: str | None,
) -> None:
    """List the presets, or print the scene NAME as TOML, ready to be saved and edited."""
    from ..scenefile import PRESETS

    file = options.check_file(output, "-o")
    asked = options.Asked.check(name, changes, stokes, speed, angle)
    text = "\n".join(PRESETS) if asked.is_none else asked.scene().to_toml().rstrip("\n")
    options.put(text, file)
