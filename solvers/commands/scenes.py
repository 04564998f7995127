"""`wetdoublet scenes`: lists or prints the presets."""

from __future__ import annotations

from collections.abc import Sequence

import click

from . import options


@click.command("scenes", short_help="List the presets, or print one as TOML.")
@click.argument("name", metavar="[NAME]", required=False)
@options.impact
@options.changes
@options.model
@options.output
@options.debug
def command(
    name: str | None,
    stokes: str | None,
    speed: str | None,
    angle: str | None,
    changes: Sequence[str],
    model: str | None,
    output: str | None,
) -> None:
    """List the presets, or print the scene NAME as TOML, ready to be saved and edited."""
    file = options.check_file(output, "-o")
    asked = options.Asked.check(name, changes, stokes, speed, angle, model=model)
    scene = asked.optional_scene()
    options.put(_listing() if scene is None else scene.to_toml().rstrip("\n"), file)


def _listing() -> str:
    """One line per preset: its name and description."""
    from ..scene.scenefile import PRESETS, description

    width = max(map(len, PRESETS))
    return "\n".join(f"{name:<{width}}  {description(name)}" for name in PRESETS)
