"""`wetdoublet bench`: run time against achieved error of the engines for a scene, and a recommendation."""

from typing import Annotated

from ..scene.schema import Field, Range
from . import options
from .signature import as_command

_WANTED = Field("--error", "an absolute error of e_n", "1e-6", Range("above 0 and below 1", 0.0, 1.0))


@as_command("Run time against error of the engines for a scene, and a recommendation.")
def command(
    request: options.OptionalRequest,
    error: Annotated[float | None, _WANTED.number],
    output: options.Shown,
    out: options.Folder,
) -> None:
    """Measure cvodes, rosenbrock and taylor on collisions about the impact of SCENE [granulation], on this machine.

    CPU time of a collision alone and in a batch of 100, and its error against another engine at a tighter tolerance,
    for tolerances 1e-4 to 1e-12; then the recommended engine and tolerance for the error wanted. About ten seconds.

    \b
    Examples:
      wetdoublet bench pendulum --error 1e-8
      wetdoublet bench granulation --set liquid.viscosity="3 Pa s" --plot bench.png

    Options:
        --error E: Wanted: largest absolute error of e_n [1e-06].
        --out DIR: Folder for bench.txt, bench.json and bench.png.
    """  # noqa: D301 # click wants the character itself
    scene = request.optional_scene()

    from ..scene.scene import Scene
    from ..verify.work_precision import work_precision
    from ..verify.work_precision_report import draw, text, to_dict
    from .bar import Bar

    wanted = error or 1e-6
    with Bar("settings") as progress:
        measured = work_precision(scene or Scene.load("granulation"), progress=progress)
    table, record = text(measured, wanted), to_dict(measured, wanted)
    if out is not None:
        from ..host.files import write_all_in

        write_all_in(out, {"bench.txt": table + "\n", "bench.json": options.json_text(record) + "\n"})
        draw(measured, wanted, out / "bench.png")
    if output.picture is not None:
        draw(measured, wanted, output.picture)
    output.put(table, record)
