"""`wetdoublet sensitivity`: exact derivatives of a collision's results."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from ..errors import InputError
from ..scene.held import NAMES
from ..scene.schema import FIELDS
from ..settings import RTOL, check_engine, check_rtol
from . import options

if TYPE_CHECKING:
    import xarray

    from ..scene.scene import Scene


@click.command("sensitivity", short_help="Exact derivatives of a collision's results, through its events.")
@options.scene_argument
@click.option(
    "--of", "of", metavar="NAMES", help="Results, as restitution,contact_time,energy.capillary [restitution]."
)
@click.option("--wrt", metavar="NAMES", help="Parameters, as liquid.viscosity,impact.angle [all of the scene].")
@click.option("--method", metavar="M", help="forward or adjoint [forward].")
@click.option(
    "--uncertainty",
    "uncertain",
    metavar="NAME=VALUE",
    multiple=True,
    help='A standard deviation, as liquid.viscosity="5 %" or impact.angle="1 deg"; repeatable.',
)
@click.option(
    "--over",
    metavar="NAME=RANGE",
    help="With --uncertainty: the band over stokes, speed or angle, as stokes=log:0.01:0.5:30 or angle=20:80:25.",
)
@click.option("--over-time", is_flag=True, help="Derivatives of the whole trajectory; --plot draws them.")
@click.option("--hessian", is_flag=True, help="Second derivatives as well.")
@options.of_varied_scene
@options.rtol
@options.engine
@options.as_json
@options.plot
@options.output
@options.debug
def command(
    request: options.SceneRequest,
    of: str | None,
    wrt: str | None,
    method: str | None,
    uncertain: Sequence[str],
    over: str | None,
    over_time: bool,
    hessian: bool,
    rtol: str | None,
    engine: str | None,
    as_json: bool,
    plot: str | None,
    output: str | None,
) -> None:
    """Differentiate the results of a collision of SCENE, through its events: gradients and elasticities.

    \b
    Examples:
      wetdoublet sensitivity granulation --of restitution,contact_time --plot tornado.png
      wetdoublet sensitivity granulation --uncertainty liquid.viscosity="5 %" --over angle=40:80:17 --plot band.png
      wetdoublet sensitivity granulation --wrt liquid.viscosity,impact.speed --over-time --plot trajectory.png
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..sensitivity.parameters import check_wrt
    from ..sensitivity.results import check_quantities
    from ..sensitivity.sensitivities import check_method, sensitivities
    from ..sensitivity.uncertainty import deviations, first_order, spoken

    tolerance = RTOL if rtol is None else check_rtol(rtol, "--rtol")
    chosen = check_engine(engine, "--engine")
    how = "forward" if method is None else check_method(method, "--method")
    asked = ("restitution",) if of is None else check_quantities(options.listed(of, "--of"), "--of")
    if hessian and chosen in ("cvodes", "taylor"):
        raise InputError("--engine", chosen, "rosenbrock with --hessian", "has no second derivatives")
    if chosen == "taylor" and how != "forward":
        raise InputError("--method", how, "forward with --engine taylor", "is not the kernel's")
    picture = options.check_file(plot, "--plot", options.PICTURES)
    file = options.check_file(output, "-o")
    options.check_apart(file, "-o", picture, "--plot")
    scene = request.scene()
    if over is not None or over_time:
        given = {"--hessian": "given" * hessian, "--method": method or ""}
        given |= {"--over": over or "", "--of": of or "", "--uncertainty": " ".join(uncertain)} if over_time else {}
        given |= {} if over_time else {"--wrt": wrt or "", "--engine": engine or ""}
        for name, value in given.items():
            if value:
                accepted = f"no {name} with {'--over-time' if over_time else '--over'}"
                raise InputError(name, value, accepted, "is not for this")
        data, text = _trajectory(scene, wrt, tolerance, engine, request.hold) if over_time else _band(
            scene, over or "", uncertain, asked, None if rtol is None else tolerance, request.hold
        )  # fmt: skip
        options.put(json.dumps(_plain(data.to_dict()), indent=2, allow_nan=False) if as_json else text, file)
        if picture is not None:
            data.wetdoublet.plot(picture)
        return
    names = None if wrt is None else check_wrt(scene, options.listed(wrt, "--wrt"), "--wrt")
    scene.need_impact()
    deviation = deviations(scene, _assigned(uncertain), "--uncertainty") if uncertain else {}
    if names is not None:
        names = tuple(dict.fromkeys((*names, *deviation)))

    found = sensitivities(
        scene, asked, names, method=how, rtol=tolerance, engine=chosen, hold=request.hold, hessian=hessian
    )
    spread = first_order(found, deviation) if deviation else {}
    if as_json:
        object_ = found.to_dict() | ({"standard_deviation": spread} if deviation else {})
        text = json.dumps(object_, indent=2, allow_nan=False)
    else:
        text = str(found) + ("\n" + spoken(found, spread) if deviation else "")
    options.put(text, file)
    if picture is not None:
        found.plot(picture)


def _trajectory(
    scene: Scene, wrt: str | None, rtol: float, engine: str | None, hold: str | None
) -> tuple[xarray.Dataset, str]:
    """Sensitivities over time, and a table of how the events move."""
    from ..sensitivity.parameters import check_wrt
    from ..sensitivity.trajectory import trajectory_sensitivities

    names = None if wrt is None else check_wrt(scene, options.listed(wrt, "--wrt"), "--wrt")
    found = trajectory_sensitivities(scene, names, rtol=rtol, engine=engine, hold=hold)
    parameters = [str(name) for name in found.parameter.values]
    width = max(map(len, parameters))
    lines = [f"{found.attrs['outcome']}: how the time of each event moves, p dt/dp in s"]
    for k, event in enumerate(found.event.values):
        lines += ["", f"{event} at {float(found.event_time[k]):.6g} s"]
        moved = found.d_event_time.values[k] * found.reference.values
        lines += [f"  {name:<{width}}  {move:>12.5g}" for name, move in zip(parameters, moved, strict=True)]
    return found, "\n".join(lines)


def _band(
    scene: Scene, over: str, uncertain: Sequence[str], of: Sequence[str], rtol: float | None, hold: str | None
) -> tuple[xarray.Dataset, str]:
    """The band of one result, and its table."""
    from ..sensitivity.uncertainty import band

    name, equals, text = over.partition("=")
    name = name.strip().removeprefix("impact.")
    units = {"stokes": "", "speed": " (m/s)", "relative_speed": " (m/s)", "angle": " (deg)"}
    if not equals or name not in units:
        raise InputError("--over", over, ", ".join(f"{each}=RANGE" for each in units))
    if not uncertain:
        raise InputError("--uncertainty", None, 'NAME=VALUE, such as liquid.viscosity="5 %", with --over')
    if len(of) != 1:
        raise InputError("--of", ",".join(of), "one result with --over")
    entry = FIELDS[f"impact.{name}"]
    values = options.entry_range(entry, text, "--over")
    more: Any = {} if rtol is None else {"rtol": rtol}
    found = band(scene, _assigned(uncertain), entry.name, values, of=of[0], hold=hold, **more)
    label = f"{NAMES.get(name, name)}{units[name]}"
    lines = [f"{label:<20} {of[0]:>16} {'± (first order)':>16} {'2.5 %':>12} {'97.5 %':>12}"]
    columns = (found[of[0]], found.first_order, found.low, found.high)
    for k, value in enumerate(values):
        cells = [f"{float(column[k]):.6g}" for column in columns]
        shown = math.degrees(value) if name == "angle" else value
        lines.append(f"{shown:<20.6g} {cells[0]:>16} {cells[1]:>16} {cells[2]:>12} {cells[3]:>12}")
    return found, "\n".join(lines)


def _plain(value: Any) -> Any:
    """What JSON can hold: null for what is not a number."""
    if isinstance(value, dict):
        return {str(name): _plain(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _assigned(given: Sequence[str]) -> dict[str, str]:
    accepted = 'NAME=VALUE, such as liquid.viscosity="5 %"'
    return options.typed(options.assigned(given, "--uncertainty", accepted))
