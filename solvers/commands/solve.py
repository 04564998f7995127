"""`wetdoublet solve`: the values of an entry at which a result has a value."""

from typing import Any

from ..errors import InputError
from ..scene import units
from ..scene.user_model import fields
from . import options, texts
from .signature import as_command, passed

_FREE, _FOR = 'NAME=LO:HI, as liquid.viscosity="0.5:5 Pa s"', "RESULT=VALUE, as restitution=0.5"


@as_command("The values of an entry at which a result has a value.")
def command(
    free: str | None, target: str | None, request: options.VariedRequest, rtol: options.Rtol, output: options.Written
) -> None:
    """All values of an entry of SCENE, in a range, at which a result of its collision has the value that is asked for.

    They are found between and beside changes of outcome, each with the derivatives of the value. A change of outcome
    at which the result only jumps over the value is named, and so is a range that has none.

    \b
    Examples:
      wetdoublet solve granulation --free liquid.viscosity="0.5:5 Pa s" --for restitution=0.5 --stokes 0.13 --angle 20
      wetdoublet solve granulation --free impact.stokes=0.01:1 --for contact_time="50 us" --json

    Options:
        --free NAME=LO:HI: The entry and its range, as liquid.viscosity="0.5:5 Pa s".
        --for RESULT=VALUE (target): The result and its value, as restitution=0.5 or contact_time="5 ms".
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    if free is None:
        raise InputError("--free", None, _FREE)
    if target is None:
        raise InputError("--for", None, _FOR)
    name, span = texts.assignment(_FREE, free, "--free")
    of, value = texts.assignment(_FOR, target, "--for")
    scene = request.scene()
    known = fields(request.package)
    is_number = name in known and not (known[name].choices or known[name].flag)
    within = texts.span(known[name], span, "--free") if is_number else (0.0, 1.0)  # `solve` says what may be free
    for end in within if is_number else ():
        scene.si_number(name, end, "--free")

    from ..host.arguments import check_name
    from ..results import DEFINITIONS
    from ..sensitivity.solve import TARGETS, solve

    check_name(of, TARGETS, "--for")  # `free`, `angle`, ... are arguments of `solve`, and no results
    if DEFINITIONS[of].unit == "rad" and units.is_number(value):
        value = f"{value} deg"
    chosen: dict[str, Any] = {**request.impact, **passed(hold=request.hold, rtol=rtol), of: value}
    output.show(solve(scene, free=name, within=within, **chosen))
