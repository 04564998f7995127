"""`wetdoublet prove`: outcomes proved by enclosure."""

from typing import Any

from ..errors import CheckFailed, InputError
from ..scene.schema import FIELDS
from ..scene.user_model import fields
from . import options, texts
from .bar import Bar
from .signature import as_command, passed

_ENDS = 'LO:HI, such as liquid.viscosity="1.9:2.1 Pa s"'
_STOKES, _ANGLE = FIELDS["impact.stokes"], FIELDS["impact.angle"]


@as_command("Outcomes proved by interval arithmetic.")
def command(
    stokes: str | None,
    speed: str | None,
    relative_speed: str | None,
    angle: str | None,
    within: tuple[str, ...],
    cells: bool,
    boundary: bool,
    depth: int | None,
    request: options.EntriesRequest,
    output: options.Shown,
) -> None:
    """Prove the outcome of the collision of SCENE from its initial data on, or say why that is not possible here.

    A proof is about the model's equations and the stored numbers. The exit status is 1 if nothing is proved.

    \b
    Examples:
      wetdoublet prove granulation --stokes 0.02 --angle 75
      wetdoublet prove granulation --stokes 0.3 --angle 20 --within liquid.viscosity="1.9:2.1 Pa s"
      wetdoublet prove granulation --map --stokes log:0.1:0.5:9 --angle 10:40:7 --plot proved.png
      wetdoublet prove granulation --boundary --stokes 0.05:0.5 --angle 10

    Options:
        --stokes VALUE: Stokes number; edges of the cells of a map, LO:HI:N or log:LO:HI:N; LO:HI of a boundary.
        --speed VALUE: Normal speed instead, as "0.4 m/s", of a single proof.
        --relative-speed VALUE: Magnitude of the relative velocity instead, of a single proof.
        --angle VALUE: Impact angle in degrees; edges of the cells of a map, LO:HI:N, from 0 on.
        --within REL|NAME=RANGE: Prove it for a box: a relative uncertainty of the impact, or of an entry NAME=REL, or
            both its ends NAME=LO:HI, as the scene gives it; repeatable.
        --map (cells): Prove a map cell by cell; --plot draws it.
        --boundary: Find two Stokes numbers of opposite proved outcomes, as near as they get.
        --depth N: Halvings of a cell of the map that is not proved [12].
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    if cells and boundary:
        raise InputError("--boundary", "--map", "one of the two", "is given together with --map")
    if within and (cells or boundary):
        raise InputError("--within", within[0], "a single proof", "is given together with a map or a boundary")
    if depth is not None and not cells:
        raise InputError("--depth", depth, "--depth with --map")
    if cells or boundary:
        for option, given in (("--speed", speed), ("--relative-speed", relative_speed)):
            if given is not None:
                raise InputError(option, given, "Stokes numbers, --stokes")
        if stokes is None:
            raise InputError("--stokes", None, "LO:HI:N or log:LO:HI:N" if cells else "LO:HI")
        if angle is None:
            raise InputError("--angle", None, "LO:HI:N in degrees" if cells else "an angle in degrees")
    if cells:
        assert stokes is not None
        assert angle is not None
        rows = texts.entry_range(_STOKES, stokes, "--stokes")
        columns = texts.entry_range(_ANGLE, angle, "--angle")
        scene = request.scene()

        from ..proofs.proved_map import prove_map

        with Bar("cells", "fewer cells or a smaller --depth take less") as progress:
            output.show(prove_map(scene, stokes=rows, angle=columns, **passed(depth=depth), progress=progress))
        return
    if boundary:
        assert stokes is not None
        assert angle is not None
        low, high = texts.span(_STOKES, stokes, "--stokes")
        scene = request.scene()

        from ..proofs.proved_boundary import prove_boundary

        output.show(prove_boundary(scene, angle=texts.with_degrees(_ANGLE, angle), stokes=(float(low), float(high))))
        return
    box = _box(within, request)
    impact = passed(
        stokes=stokes,
        speed=speed,
        relative_speed=relative_speed,
        angle=None if angle is None else texts.with_degrees(_ANGLE, angle),
    )
    scene = request.scene().with_impact(**{name: _number(name, text) for name, text in impact.items()})
    scene.need_impact()

    from ..engines.interval.prove import prove

    proof = prove(scene, within=box)
    output.show(proof)
    if not proof:
        raise CheckFailed(f"nothing is proved: {proof.reason}")


def _number(name: str, text: str) -> float | str:
    return FIELDS[f"impact.{name}"].number(text, label=f"--{name}")


def _box(within: tuple[str, ...], request: options.SceneRequest) -> Any:
    """The uncertainties of --within: a number for the impact, or by entry."""
    if not within:
        return None
    plain = [text for text in within if "=" not in text]
    if plain and len(within) > 1:
        raise InputError("--within", plain[0], "an uncertainty of the impact alone, or entries NAME=RANGE")
    if plain:
        return texts.share("a relative uncertainty, such as 1e-4, or NAME=LO:HI", plain[0], "--within")
    box: dict[str, Any] = {}
    for name, text in texts.assigned(f"NAME={_ENDS}", within, "--within").items():
        known = fields(request.package)
        if name in known and ":" in text and not (known[name].choices or known[name].flag):
            box[name] = texts.span(known[name], text, f"--within {name}")
        elif ":" in text:
            box[name] = tuple(text.split(":", 1))
        else:
            accepted = f"a relative uncertainty, such as 1e-4 or 1 %, or both ends, {_ENDS}"
            box[name] = texts.share(accepted, text, f"--within {name}")
    return box
