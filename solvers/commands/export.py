"""`wetdoublet export`: the model of a scene as LaTeX or as C."""

from __future__ import annotations

from collections.abc import Sequence

import click

from ..errors import InputError, did_you_mean
from ..host.files import write_all_in
from . import options

KINDS = ("c", "latex")


@click.command("export", short_help="The scene's model as LaTeX and Markdown, or as C functions.")
@options.scene_argument
@click.option("--to", "kind", metavar="KIND", help="c or latex.")
@click.option("--out", metavar="DIR", help="Folder to write into.")
@options.impact
@options.changes
@options.model
@options.debug
def command(
    source: str | None,
    kind: str | None,
    out: str | None,
    stokes: str | None,
    speed: str | None,
    relative_speed: str | None,
    angle: str | None,
    changes: Sequence[str],
    model: str | None,
) -> None:
    """Write the model of SCENE, with its laws, into DIR.

    latex: NAME.tex and NAME.md, Table 1 of this model. c: NAME.c and NAME.h, its functions, self-contained.

    \b
    Example:
      wetdoublet export granulation --to c --out build
    """  # noqa: D301 # click wants the character itself
    if kind is not None and kind not in KINDS:
        raise InputError("--to", kind, ", ".join(KINDS), "is not known" + did_you_mean(kind, KINDS))
    folder = options.check_folder(out)
    scene = options.SceneRequest.check(source, changes, stokes, speed, angle, relative_speed, model).scene()
    if kind is None:
        raise InputError("--to", None, "one of " + ", ".join(KINDS))
    if folder is None:
        raise InputError("--out", None, "a folder to write into")

    if kind == "latex":
        from ..export.equations import texts
    else:
        from ..export.c import texts
    for file in write_all_in(folder, texts(scene)):
        click.echo(str(file))
