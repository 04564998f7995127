"""`wetdoublet compile`: the kernels of scenes, compiled before they are needed."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from ..settings import RTOL, check_rtol
from . import options

if TYPE_CHECKING:
    from ..engines.kernels import CompiledKernel


@click.command("compile", short_help="Compile the Taylor kernels of scenes beforehand.")
@click.argument("sources", metavar="SCENE...", nargs=-1)
@options.impact
@options.changes
@options.model
@click.option("--rtol", "rtols", metavar="R", multiple=True, help="Relative tolerance, 1e-13..1e-3 [1e-9]; repeatable.")
@click.option("--derivatives", is_flag=True, help="Those of sensitivities as well, which take some seconds each.")
@options.as_json
@options.output
@options.debug
def command(
    sources: Sequence[str],
    stokes: str | None,
    speed: str | None,
    relative_speed: str | None,
    angle: str | None,
    changes: Sequence[str],
    model: str | None,
    rtols: Sequence[str],
    derivatives: bool,
    as_json: bool,
    output: str | None,
) -> None:
    """Compile the kernels of each SCENE into the cache: for one collision, many, maps and boundaries.

    Without it the first collision of each kind waits some seconds for its kernel. Kernels depend on the terms and laws
    of a scene and not on its numbers.

    \b
    Examples:
      wetdoublet compile granulation pendulum
      wetdoublet compile my-powder.toml --rtol 1e-9 --rtol 1e-12
    """  # noqa: D301 # click wants the character itself
    tolerances = [check_rtol(each, "--rtol") for each in rtols] or [RTOL]
    file = options.check_file(output, "-o")
    asked = [
        options.SceneRequest.check(source, changes, stokes, speed, angle, relative_speed, model)
        for source in sources or (None,)
    ]
    scenes = [each.scene() for each in asked]

    from ..engines.kernels import compile_kernels
    from .bar import bar

    with bar("kernels") as tell:
        found = compile_kernels(scenes, rtol=tolerances, derivatives=derivatives, progress=tell)
    options.put(_as_json(found) if as_json else _table(found), file)


def _as_json(found: Sequence[CompiledKernel]) -> str:
    from importlib.metadata import version

    kernels = [each.to_dict() for each in found]
    said = {"version": version("wetdoublet"), "kernels": kernels, "units": {"seconds": "s", "bytes": "B"}}
    return json.dumps(said, indent=2, allow_nan=False)


def _table(found: Sequence[CompiledKernel]) -> str:
    """A line for each kernel below the name of its scene, and a sum."""
    lines, scene = [], None
    for each in found:
        if each.scene != scene:
            scene = each.scene
            lines.append(scene or "scene")
        took = "already compiled" if each.already else f"{each.seconds:.2f} s"
        about = "oblique" if each.oblique else "head-on"
        lines.append(
            f"  {about:7}  order {each.order:2}  {took:>16}  {each.bytes / 1000:4.0f} kB  {', '.join(each.serves)}"
        )
    new = sum(not each.already for each in found)
    return "\n".join([*lines, f"{new} compiled, {len(found) - new} already compiled"])
