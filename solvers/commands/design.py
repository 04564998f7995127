"""`wetdoublet design`: where the next impacts should be."""

from collections.abc import Mapping
from functools import partial
from typing import Annotated

from ..errors import InputError
from ..scene.schema import FIELDS
from . import options, texts
from .bar import Bar
from .signature import as_command, passed


def _window(text: str) -> dict[str, object]:
    """The window of --over: names with LO:HI or one value; bare angles in degrees, a unit at either end."""
    window: dict[str, object] = {}
    for part in text.split(","):
        name, equals, value = part.partition("=")
        name = name.strip()
        if not equals or name in window:
            problem = "is given twice" if equals else "has no ="
            raise InputError("--over", text, "stokes=LO:HI,angle=LO:HI", problem)
        entry, ends = FIELDS.get(f"impact.{name}"), value.split(":")
        if entry is not None and len(ends) == 2:
            window[name] = texts.entry_ends(entry, f"--over {name}")(*ends)
        else:
            window[name] = ends if entry is None or len(ends) > 2 else texts.with_degrees(entry, value)
    return window


@as_command("Where the next impacts should be to learn most about entries of a scene.")
def command(
    free: list[str] | None,
    over: Annotated[Mapping[str, object] | None, _window],
    n: int | None,
    target: str | None,
    data: str | None,
    prior: options.Priors,
    speed_sd: str | None,
    angle_sd: Annotated[str | None, partial(texts.with_degrees, FIELDS["impact.angle"])],
    restitution_sd: str | None,
    request: options.EntriesRequest,
    rtol: options.Rtol,
    output: options.Shown,
) -> None:
    """Choose the impacts from whose outcomes and restitutions `fit` will learn most about entries of SCENE.

    With -o FILE.csv they are also written as the table that `fit` reads, to be filled in.

    \b
    Examples:
      wetdoublet design granulation --free liquid.viscosity,liquid.film_thickness --over stokes=0.02:0.5,angle=0:80
      wetdoublet design granulation --free liquid.viscosity --over stokes=0.05:0.3,angle=0 -n 4 --restitution-sd none

    Options:
        --free NAMES: Entries that will be estimated, as liquid.viscosity,particles.roughness.
        --over WINDOW: Impacts that can be made: stokes=LO:HI,angle=LO:HI (degrees); also speed or relative_speed,
            with a unit.
        -n N: Number of impacts [9].
        --for NAME (target): The entry that matters [all of --free alike].
        --data DATA.csv: Impacts measured before; they are fitted first.
        --speed-sd S: Scatter of the speed [2 %, or that of the data].
        --angle-sd S: Scatter of the angle, degrees [1, or that of the data].
        --restitution-sd S: Noise of a measured restitution [0.02]; none: outcomes only.
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..planning.design import design

    if free is None:
        raise InputError("--free", None, "entries to estimate, as --free particles.roughness,liquid.viscosity")
    if over is None:
        raise InputError("--over", None, "the impacts that can be made, as --over stokes=0.02:0.5,angle=0:80")
    chosen = passed(
        n=n, target=target, data=data, prior=prior or None, speed_sd=speed_sd, angle_sd=angle_sd,
        restitution_sd=restitution_sd, rtol=rtol,
    )  # fmt: skip
    with Bar("impacts", "a smaller window or fewer impacts take less", factor=3.0) as progress:
        plan = design(request.scene(), free, over, progress=progress, **chosen)
    output.show(plan)
