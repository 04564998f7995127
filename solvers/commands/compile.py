"""`wetdoublet compile`: the kernels of scenes, compiled before they are needed."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Annotated

from ..engines.settings import check_rtol
from . import options
from .signature import as_command, passed

if TYPE_CHECKING:
    from ..engines.kernels import CompiledKernel


@as_command("Compile the Taylor kernels of scenes beforehand.")
def command(
    requests: options.SeveralRequests,
    rtol: Annotated[tuple[float, ...], lambda texts: [check_rtol(each) for each in texts]],
    derivatives: bool,
    output: options.Written,
) -> None:
    """Compile the kernels of each SCENE into the cache: for one collision, many, maps and boundaries.

    Without it the first collision of each kind waits some seconds for its kernel. Kernels depend on the terms and laws
    of a scene and not on its numbers.

    \b
    Examples:
      wetdoublet compile granulation pendulum
      wetdoublet compile my-powder.toml --rtol 1e-9 --rtol 1e-12

    Options:
        --rtol R: Relative tolerance, 1e-13..1e-3 [1e-9]; repeatable.
        --derivatives: Those of sensitivities as well, which take some seconds each.
    """  # noqa: D301 # click wants the character itself
    scenes = [each.scene() for each in requests]

    from importlib.metadata import version

    from ..engines.kernels import compile_kernels
    from .bar import Bar

    with Bar("kernels") as progress:
        kernels = compile_kernels(scenes, derivatives=derivatives, progress=progress, **passed(rtol=rtol or None))
    record = {
        "version": version("wetdoublet"),
        "kernels": [each.to_dict() for each in kernels],
        "units": {"seconds": "s", "bytes": "B"},
    }
    output.put(_table(kernels), record)


def _table(kernels: Sequence[CompiledKernel]) -> str:
    """A line for each kernel below the name of its scene, and a sum."""
    lines = []
    for scene, its in groupby(kernels, lambda each: each.scene):
        lines.append(scene or "scene")
        for each in its:
            took = "already compiled" if each.already else f"{each.seconds:.2f} s"
            about = "oblique" if each.oblique else "head-on"
            lines.append(
                f"  {about:7}  order {each.order:2}  {took:>16}  {each.bytes / 1000:4.0f} kB  {', '.join(each.serves)}"
            )
    new = sum(not each.already for each in kernels)
    return "\n".join([*lines, f"{new} compiled, {len(kernels) - new} already compiled"])
