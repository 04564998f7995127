"""`wetdoublet sensitivity`: exact derivatives of a collision's results."""

from __future__ import annotations

import json
from collections.abc import Sequence

import click

from ..errors import InputError
from ..scene.schema import FIELDS
from ..settings import RTOL, check_engine, check_rtol
from . import options


@click.command("sensitivity", short_help="Exact derivatives of a collision's results, through its events.")
@options.scene_argument
@click.option(
    "--of", "of", metavar="NAMES", help="Results, as restitution,contact_time,energy.capillary [restitution]."
)
@click.option("--wrt", metavar="NAMES", help="Parameters, as liquid.viscosity,impact.angle [all of the scene].")
@click.option("--method", metavar="M", help="forward or adjoint [forward].")
@click.option("--hold", metavar="WHAT", help="Quantity to hold: speed, stokes, relative_speed [as given].")
@click.option(
    "--uncertainty",
    "uncertain",
    metavar="NAME=VALUE",
    multiple=True,
    help='A standard deviation, as liquid.viscosity="5 %" or impact.angle="1 deg"; repeatable.',
)
@click.option("--hessian", is_flag=True, help="Second derivatives as well.")
@options.impact
@options.changes
@options.model
@options.rtol
@options.engine
@options.as_json
@options.plot
@options.output
@options.debug
def command(
    source: str | None,
    of: str | None,
    wrt: str | None,
    method: str | None,
    hold: str | None,
    uncertain: Sequence[str],
    hessian: bool,
    stokes: str | None,
    speed: str | None,
    relative_speed: str | None,
    angle: str | None,
    changes: Sequence[str],
    model: str | None,
    rtol: str | None,
    engine: str | None,
    as_json: bool,
    plot: str | None,
    output: str | None,
) -> None:
    """Differentiate the results of a collision of SCENE, through its events: gradients and elasticities.

    \b
    Example:
      wetdoublet sensitivity granulation --of restitution,contact_time --plot tornado.png
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..sensitivity.parameters import check_hold, check_wrt
    from ..sensitivity.results import check_quantities
    from ..sensitivity.sensitivities import check_method, sensitivities
    from ..sensitivity.uncertainty import deviations, first_order, spoken

    tolerance = RTOL if rtol is None else check_rtol(rtol, "--rtol")
    chosen = check_engine(engine, "--engine")
    how = "forward" if method is None else check_method(method, "--method")
    held = None if hold is None else check_hold(hold, "--hold")
    asked = ("restitution",) if of is None else check_quantities(_names(of), "--of")
    if hessian and chosen in ("cvodes", "taylor"):
        raise InputError("--engine", chosen, "rosenbrock with --hessian", "has no second derivatives")
    if chosen == "taylor" and how != "forward":
        raise InputError("--method", how, "forward with --engine taylor", "is not the kernel's")
    picture = options.check_file(plot, "--plot", options.PICTURES)
    file = options.check_file(output, "-o")
    options.check_apart(file, "-o", picture, "--plot")
    scene = options.SceneRequest.check(source, changes, stokes, speed, angle, relative_speed, model).scene()
    names = None if wrt is None else check_wrt(scene, _names(wrt), "--wrt")
    scene.need_impact()
    deviation = deviations(scene, _assigned(uncertain), "--uncertainty") if uncertain else {}
    if names is not None:
        names = tuple(dict.fromkeys((*names, *deviation)))

    found = sensitivities(scene, asked, names, method=how, rtol=tolerance, engine=chosen, hold=held, hessian=hessian)
    spread = first_order(found, deviation) if deviation else {}
    if as_json:
        object_ = found.to_dict() | ({"standard_deviation": spread} if deviation else {})
        text = json.dumps(object_, indent=2, allow_nan=False)
    else:
        text = str(found) + ("\n" + spoken(found, spread) if deviation else "")
    options.put(text, file)
    if picture is not None:
        found.plot(picture)


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


def _assigned(given: Sequence[str]) -> dict[str, str]:
    found = {}
    for text in given:
        name, equals, value = text.partition("=")
        if not equals:
            raise InputError("--uncertainty", text, 'NAME=VALUE, such as liquid.viscosity="5 %"', "has no =")
        name = name.strip()
        found[name] = options.with_degrees(FIELDS[name], value) if name in FIELDS else value
    return found
