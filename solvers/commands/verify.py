"""`wetdoublet verify`: the laws, each with its figure."""

from __future__ import annotations

from collections.abc import Sequence

import click

from ..errors import CheckFailed
from . import options


@click.command("verify", short_help="Check the laws: symbolic identities and numbers.")
@click.argument("source", metavar="[SCENE]", required=False)
@options.impact
@options.changes
@options.model
@click.option("-o", "output", metavar="FILE", help="Write the report as Markdown to FILE as well.")
@options.debug
def command(
    source: str | None,
    stokes: str | None,
    speed: str | None,
    angle: str | None,
    changes: Sequence[str],
    model: str | None,
    output: str | None,
) -> None:
    """Check the laws on SCENE, or on all presets; the report goes to standard output."""
    file = options.check_file(output, "-o")
    asked = options.Asked.check(source, changes, stokes, speed, angle, model=model)
    scene = asked.optional_scene()

    from ..verify import verify

    report = verify(scene)
    click.echo(str(report).rstrip("\n"))
    if file is not None:
        options.put(report.to_markdown().rstrip("\n"), file)
    if not report.ok:
        raise CheckFailed("verify: a check failed, see the report")
