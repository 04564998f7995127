"""`wetdoublet export`: the law of a scene in C, its model as LaTeX, or the model's functions."""

from functools import partial
from typing import Annotated

import click

from ..errors import InputError
from ..host.files import write_all_in
from . import options, texts
from .signature import as_command

KINDS = ("c", "casadi", "latex")


@as_command("The collision law of the scene in C; its model as LaTeX.")
def command(
    to: Annotated[str | None, partial(texts.known, KINDS)], out: options.Folder, request: options.Request
) -> None:
    """Write the law of SCENE, or its model, into DIR.

    c: a folder with the whole collision law as NAME.c and NAME.h, C99 that needs no other library: material and impact
    in, what happens out. With a check, examples in C and Python, and a Makefile. latex: NAME.tex, Table 1
    of this model. casadi: NAME.c and NAME.h, the model's functions without an integrator, for CasADi's calling
    convention.

    \b
    Example:
      wetdoublet export granulation --to c --out law

    Options:
        --to KIND: c, casadi or latex.
        --out DIR: Folder to write into.
    """  # noqa: D301 # click wants the character itself
    scene = request.scene(remark=True)
    if to is None:
        raise InputError("--to", None, "one of " + ", ".join(KINDS))
    if out is None:
        raise InputError("--out", None, "a folder to write into")

    if to == "latex":
        from ..export.equations import texts
    elif to == "c":
        from ..export.law.texts import texts
    else:
        from ..export.functions import texts
    for file in write_all_in(out, texts(scene)):
        click.echo(str(file))
