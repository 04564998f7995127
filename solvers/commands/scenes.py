"""`wetdoublet scenes`: lists, prints and begins scene files."""

import click

from ..errors import InputError
from ..host import bounded, files
from ..host.outputs import check_file
from ..scene.scenefile import PRESETS, description, read_text, template
from . import options
from .signature import as_command, passed


@as_command("List the presets, or print one as TOML.")
def command(new: str | None, request: options.NamedRequest, output: options.WrittenText) -> None:
    """List the presets, or print the scene NAME as TOML, ready to be saved and edited.

    With --new NAME a scene file to be filled in is written, which runs as it is.

    Options:
        --new NAME: Write NAME.toml, a commented scene to be filled in.
    """
    if new is not None:
        _begin(new, {"NAME": request.source, **request.options, "-o": output.file})
        return
    scene = request.optional_scene()
    if scene is None:
        width = max(map(len, PRESETS))
        output.put("\n".join(f"{name:<{width}}  {description(name)}" for name in PRESETS))
    elif request.source in PRESETS and not request.options:
        output.put(read_text(str(request.source))[0].rstrip("\n"))
    else:
        output.put(scene.to_toml().rstrip("\n"))


def _begin(name: str, others: dict[str, object]) -> None:
    """Write a scene file to be filled in, which must not be there."""
    if not name.strip():
        raise InputError("--new", name, "a name for the file NAME.toml", "is empty")
    file = check_file(name if name.endswith(".toml") else f"{name}.toml", "--new")
    accepted = "a name NAME for a file NAME.toml that is not there"
    if file.stem in PRESETS:
        raise InputError("--new", name, accepted, "is the name of a preset")
    if bounded.exists(file):
        raise InputError("--new", name, accepted, f"would overwrite {file}")
    for option in passed(**others):
        raise InputError("--new", name, "--new NAME alone", f"is given together with {option}")
    files.write(file, template(file.stem))
    click.echo(str(file))
