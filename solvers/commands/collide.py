"""`wetdoublet collide`: one collision."""

from __future__ import annotations

import json

import click

from ..settings import RTOL, UNTIL, check_engine, check_rtol
from . import options


@click.command("collide", short_help="One collision, from initial contact to its outcome.")
@options.scene_argument
@options.of_scene
@options.rtol
@options.engine
@click.option("--until", metavar="TIME", help='Follow a stick on after its proof, as "5 ms" after initial contact.')
@options.as_json
@options.plot
@options.output
@options.debug
def command(
    request: options.SceneRequest,
    rtol: str | None,
    engine: str | None,
    until: str | None,
    as_json: bool,
    plot: str | None,
    output: str | None,
) -> None:
    """Compute one collision of the two particles of SCENE."""
    tolerance = RTOL if rtol is None else check_rtol(rtol, "--rtol")
    chosen = check_engine(engine, "--engine")
    last = None if until is None else UNTIL.number(until, label="--until")
    picture = options.check_file(plot, "--plot", options.PICTURES)
    file = options.check_file(output, "-o")
    options.check_apart(file, "-o", picture, "--plot")
    scene = request.scene()
    scene.need_impact()

    from ..collision.collide import collide

    result = collide(scene, rtol=tolerance, engine=chosen, trajectory=picture is not None, until=last)
    if as_json:
        text = json.dumps(result.to_dict(), indent=2, allow_nan=False)
    else:
        text = str(result)
    if picture is not None:
        result.plot(picture)
    options.put(text, file)
