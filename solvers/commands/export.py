"""`wetdoublet export`: the law of a scene in C, its model as LaTeX, or the model's functions."""

from __future__ import annotations

import click

from ..errors import InputError, did_you_mean
from ..host.files import write_all_in
from . import options

KINDS = ("c", "casadi", "latex")


@click.command("export", short_help="The collision law of the scene in C; its model as LaTeX and Markdown.")
@options.scene_argument
@click.option("--to", "kind", metavar="KIND", help="c, casadi or latex.")
@click.option("--out", metavar="DIR", help="Folder to write into.")
@options.of_scene
@options.debug
def command(
    request: options.SceneRequest,
    kind: str | None,
    out: str | None,
) -> None:
    """Write the law of SCENE, or its model, into DIR.

    c: a folder with the whole collision law as NAME.c and NAME.h, C99 that needs no other library: material and impact
    in, what happens out. With a check, examples in C, Python and Fortran, and a Makefile. latex: NAME.tex and NAME.md,
    Table 1 of this model. casadi: NAME.c and NAME.h, the model's functions without an integrator, for CasADi's calling
    convention.

    \b
    Example:
      wetdoublet export granulation --to c --out law
    """  # noqa: D301 # click wants the character itself
    if kind is not None and kind not in KINDS:
        raise InputError("--to", kind, ", ".join(KINDS), "is not known" + did_you_mean(kind, KINDS))
    folder = options.check_folder(out)
    scene = request.scene(remark=True)
    if kind is None:
        raise InputError("--to", None, "one of " + ", ".join(KINDS))
    if folder is None:
        raise InputError("--out", None, "a folder to write into")

    if kind == "latex":
        from ..export.equations import texts
    elif kind == "c":
        from ..export.law.texts import texts
    else:
        from ..export.functions import texts
    for file in write_all_in(folder, texts(scene)):
        click.echo(str(file))
