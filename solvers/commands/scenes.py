"""`wetdoublet scenes`: lists or prints the presets."""

from __future__ import annotations

from pathlib import Path

import click

from ..errors import InputError
from ..host import bounded, files
from ..scene.scenefile import PRESETS, description, read_text, template
from . import options


@click.command("scenes", short_help="List the presets, or print one as TOML.")
@click.argument("source", metavar="[NAME]", required=False)
@click.option("--new", "new", metavar="NAME", help="Write NAME.toml, a commented scene to be filled in.")
@options.of_scene
@options.output
@options.debug
def command(
    request: options.SceneRequest,
    new: str | None,
    output: str | None,
) -> None:
    """List the presets, or print the scene NAME as TOML, ready to be saved and edited.

    With --new NAME a scene file to be filled in is written, which runs as it is.
    """
    file = options.check_file(output, "-o")
    begun = None if new is None else _new(new)
    if begun is not None:
        for option, text in {"NAME": request.source, **request.options, "-o": output}.items():
            if text is not None:
                raise InputError("--new", new, "--new NAME alone", f"is given together with {option}")
        files.write(begun, template(begun.stem))
        click.echo(str(begun))
        return
    scene = request.optional_scene()
    if scene is None:
        options.put(_listing(), file)
    elif request.source in PRESETS and not request.options:
        options.put(read_text(str(request.source))[0].rstrip("\n"), file)
    else:
        options.put(scene.to_toml().rstrip("\n"), file)


def _new(name: str) -> Path:
    """The file to begin, which must not be there."""
    if not name.strip():
        raise InputError("--new", name, "a name for the file NAME.toml", "is empty")
    file = options.check_file(name if name.endswith(".toml") else f"{name}.toml", "--new")
    assert file is not None
    accepted = "a name NAME for a file NAME.toml that is not there"
    if file.stem in PRESETS:
        raise InputError("--new", name, accepted, "is the name of a preset")
    if bounded.exists(file):
        raise InputError("--new", name, accepted, f"would overwrite {file}")
    return file


def _listing() -> str:
    """One line per preset: its name and description."""
    width = max(map(len, PRESETS))
    return "\n".join(f"{name:<{width}}  {description(name)}" for name in PRESETS)
