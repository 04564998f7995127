"""`wetdoublet critical`: the speed up to which they stick."""

from functools import partial
from typing import Annotated

from ..errors import CheckFailed
from ..scene.schema import FIELDS
from . import options, texts
from .bar import Bar
from .signature import as_command, passed

_ANGLE = FIELDS["impact.angle"]
_MOST = 10_000  # angles


@as_command("The speed up to which they stick, with its interval and derivatives.")
def command(
    angle: str | None,
    stokes: Annotated[texts.Range | None, partial(texts.span, FIELDS["impact.stokes"])],
    uncertainty: options.Uncertainty,
    wrt: list[str] | None,
    samples: int | None,
    request: options.EntriesRequest,
    rtol: options.Rtol,
    output: options.Shown,
) -> None:
    """The speed up to which particles of SCENE stick, and the speed above which they bounce.

    SCENE may be a CSV file of materials, one a row; its columns are entries, as `particles.diameter [um]`.
    With -o FILE.csv the speeds are written as a table.

    \b
    Examples:
      wetdoublet critical lactose-pvp
      wetdoublet critical granulation --angle 0:80:9 --uncertainty liquid.viscosity="10 %" --plot critical.png
      wetdoublet critical materials.csv -o speeds.csv

    Options:
        --angle RANGE: Impact angles (degrees): 40, or 20:65:10 [the scene's, or 0].
        --stokes LO:HI: Stokes numbers to search [1e-4:100, or more by the scene].
        --wrt NAMES: Derivatives as well, and extremes, in bridge.volume,liquid.viscosity; or all (derivatives).
        --samples N: Draws of the uncertain entries, a power of two [256].
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..sensitivity.critical import critical
    from ..sensitivity.materials import materials_of

    angles = None if angle is None else texts.entry_range(_ANGLE, angle, "--angle", most=_MOST)
    source = request.source or ""
    materials = materials_of(source, request.entries) if source.lower().endswith(".csv") else request.scene()
    chosen = passed(angle=angles, stokes=stokes, uncertainty=uncertainty or None, samples=samples, rtol=rtol)
    if wrt is not None:
        chosen["wrt"] = "all" if wrt == ["all"] else wrt
    with Bar("materials", "fewer materials or angles take less") as progress:
        result = critical(materials, progress=progress, **chosen)
    output.show(result)
    failed = [one for one in result.rows if one.failed]
    if failed:
        raise CheckFailed(f"{len(failed)} of {len(result.rows)} rows have no answer, first: {failed[0].sentences[0]}")
