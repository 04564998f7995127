"""`wetdoublet sensitivity`: exact derivatives of a collision's results."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..errors import InputError
from ..scene.held import NAMES
from ..scene.schema import FIELDS
from . import options, texts
from .bar import Bar
from .signature import as_command, passed

if TYPE_CHECKING:
    import xarray

    from ..scene.scene import Scene


@as_command("Exact derivatives of a collision's results, through its events.")
def command(
    of: list[str] | None,
    wrt: list[str] | None,
    method: str | None,
    uncertainty: options.Uncertainty,
    over: str | None,
    request: options.VariedRequest,
    rtol: options.Rtol,
    engine: options.Engine,
    output: options.Shown,
) -> None:
    """Differentiate the results of a collision of SCENE, through its events: gradients and elasticities.

    \b
    Examples:
      wetdoublet sensitivity granulation --of restitution,contact_time --plot tornado.png
      wetdoublet sensitivity granulation --uncertainty liquid.viscosity="5 %" --over angle=40:80:17 --plot band.png

    Options:
        --of NAMES: Results, as restitution,contact_time,energy.capillary [restitution].
        --wrt NAMES: Parameters, as liquid.viscosity,impact.angle [all of the scene].
        --method M: forward or adjoint [forward].
        --over NAME=RANGE: With --uncertainty: the band over stokes, speed or angle, as stokes=log:0.01:0.5:30 or
            angle=20:80:25.
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..results import check_differentiated
    from ..sensitivity.parameters import check_wrt
    from ..sensitivity.sensitivities import check_method, sensitivities
    from ..sensitivity.uncertainty import deviations, first_order, in_words

    if method is not None:
        check_method(method)
    if of is not None:
        check_differentiated(of)
    if engine == "taylor" and method not in (None, "forward"):
        raise InputError("--method", method, "forward with --engine taylor", "is not the kernel's")
    scene = request.scene()
    if over is not None:
        unused: dict[str, str | list[str] | None] = {"--method": method, "--wrt": wrt, "--engine": engine}
        for option, value in unused.items():
            if value:
                text = ",".join(value) if isinstance(value, list) else value
                raise InputError(option, text, f"no {option} with --over", "is not for this")
        shared = passed(rtol=rtol, hold=request.hold)
        data, table = _band(scene, over, uncertainty, of or ["restitution"], shared)
        output.put(table, _plain(data.to_dict()) if output.as_json else None)
        if output.picture is not None:
            data.wetdoublet.plot(output.picture)
        return
    names = None if wrt is None else check_wrt(scene, wrt)
    scene.need_impact()
    deviation = deviations(scene, uncertainty) if uncertainty else {}
    if names is not None:
        names = tuple(dict.fromkeys((*names, *deviation)))
    chosen = passed(of=of, method=method, rtol=rtol, engine=engine, hold=request.hold)
    gradients = sensitivities(scene, wrt=names, **chosen)
    spread = first_order(gradients, deviation) if deviation else {}
    record = gradients.to_dict() | ({"standard_deviation": spread} if deviation else {})
    output.put(str(gradients) + ("\n" + in_words(gradients, spread) if deviation else ""), record)
    if output.picture is not None:
        gradients.plot(output.picture)


def _band(
    scene: Scene, over: str, uncertainty: dict[str, str], of: Sequence[str], chosen: dict[str, Any]
) -> tuple[xarray.Dataset, str]:
    """The band of one result, and its table."""
    from ..sensitivity.uncertainty import band

    name, equals, text = over.partition("=")
    name = name.strip().removeprefix("impact.")
    units = {"stokes": "", "speed": " (m/s)", "relative_speed": " (m/s)", "angle": " (deg)"}
    if not equals or name not in units:
        raise InputError("--over", over, ", ".join(f"{each}=RANGE" for each in units))
    if not uncertainty:
        raise InputError("--uncertainty", None, 'NAME=VALUE, such as liquid.viscosity="5 %", with --over')
    if len(of) != 1:
        raise InputError("--of", ",".join(of), "one result with --over")
    entry = FIELDS[f"impact.{name}"]
    values = texts.entry_range(entry, text, "--over")
    with Bar("values", "fewer values take less") as progress:
        data = band(scene, uncertainty, entry.name, values, of=of[0], progress=progress, **chosen)
    label = f"{NAMES.get(name, name)}{units[name]}"
    lines = [f"{label:<20} {of[0]:>16} {'± (first order)':>16} {'2.5 %':>12} {'97.5 %':>12}"]
    columns = (data[of[0]], data.first_order, data.low, data.high)
    for k, value in enumerate(values):
        cells = [f"{float(column[k]):.6g}" for column in columns]
        number = math.degrees(value) if name == "angle" else value
        lines.append(f"{number:<20.6g} {cells[0]:>16} {cells[1]:>16} {cells[2]:>12} {cells[3]:>12}")
    return data, "\n".join(lines)


def _plain(value: Any) -> Any:
    """A value as JSON can hold it: null in place of NaN and infinities."""
    if isinstance(value, dict):
        return {str(name): _plain(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
