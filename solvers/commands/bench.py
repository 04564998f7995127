"""`wetdoublet bench`: run time against achieved error of the engines for a scene, and a recommendation."""

from __future__ import annotations

import json

import click

from ..scene.schema import Field, Range
from . import options

_PRESET = "granulation"
_ERROR = 1e-6
_WANTED = Field("--error", "an absolute error of e_n", "1e-6", Range("above 0 and below 1", 0.0, 1.0))


@click.command("bench", short_help="Run time against error of the engines for a scene, and a recommendation.")
@click.argument("source", metavar="[SCENE]", required=False)
@options.of_scene
@click.option("--error", metavar="E", help=f"Wanted: largest absolute error of e_n [{_ERROR:g}].")
@options.as_json
@options.plot
@options.output
@click.option("--out", metavar="DIR", help="Folder for bench.txt, bench.json and bench.png.")
@options.debug
def command(
    request: options.SceneRequest,
    error: str | None,
    as_json: bool,
    plot: str | None,
    output: str | None,
    out: str | None,
) -> None:
    """Measure cvodes, rosenbrock and taylor on collisions about the impact of SCENE [granulation], on this machine.

    CPU time of a collision alone and in a batch of 100, and its error against another engine at a tighter tolerance,
    for tolerances 1e-4 to 1e-12; then the recommended engine and tolerance for the error wanted. About ten seconds.

    \b
    Examples:
      wetdoublet bench pendulum --error 1e-8
      wetdoublet bench granulation --set liquid.viscosity="3 Pa s" --plot bench.png
    """  # noqa: D301 # click wants the character itself
    wanted = _ERROR if error is None else _WANTED.number(error, label="--error")
    picture = options.check_file(plot, "--plot", options.PICTURES)
    file = options.check_file(output, "-o")
    options.check_apart(file, "-o", picture, "--plot")
    folder = options.check_folder(out)
    scene = request.optional_scene()

    from ..scene.scene import Scene
    from ..verify.work_precision import work_precision
    from ..verify.work_precision_report import draw, text, to_dict
    from .bar import bar

    with bar("settings") as tell:
        found = work_precision(scene or Scene.load(_PRESET), progress=tell)
    said, record = text(found, wanted), json.dumps(to_dict(found, wanted), indent=2, allow_nan=False)
    if folder is not None:
        from ..host import files

        folder.mkdir(parents=True, exist_ok=True)
        files.write(folder / "bench.txt", said + "\n")
        files.write(folder / "bench.json", record + "\n")
        draw(found, wanted, folder / "bench.png")
    if picture is not None:
        draw(found, wanted, picture)
    options.put(record if as_json else said, file)
