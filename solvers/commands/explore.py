"""`wetdoublet explore`: the page of a scene."""

import click

from ..errors import InputError
from . import options
from .signature import as_command


@as_command("A page for the browser: turn the scene's knobs, see the doublet.")
def command(output: str | None, others: tuple[str, ...], request: options.Request) -> None:
    """Write a page with the law of SCENE, which opens from disk in any browser and loads nothing.

    Presets with the same law may be chosen in it, and the scenes of --with.

    Knobs for the scene's numbers, a map of outcomes over two of them, the moving doublet and its curves.

    \b
    Example:
      wetdoublet explore granulation -o explorer.html

    Options:
        -o FILE (output): File to write, .html.
        --with SCENE (others): Another scene to choose from; may be repeated.
    """  # noqa: D301 # click wants the character itself
    scene = request.scene(remark=True)
    if output is None:
        raise InputError("-o", None, "a file to write, such as explorer.html")

    from ..explorer.page_of_scene import explore

    explore(scene, *others).write(output)
    click.echo(output)
