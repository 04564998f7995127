"""Collisions of a scene: one, its derivatives, the entries that give it a value, its proof, and means of many."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import click

from ..errors import CheckFailed, InputError
from ..host import files
from ..host.files import check_file
from ..scene import units
from ..scene.schema import FIELDS
from . import texts
from .bar import Bar
from .options import Entries, Impact, Request, SceneRequest, Shown, Varied, Written, dataset_text, refuse
from .signature import command, passed

_Radii = Annotated[list[float] | None, partial(texts.entry_range, FIELDS["particles.radius"])]
_Table = Annotated[Path | None, partial(check_file, label="", suffixes=(".nc", ".csv"), replaced=True)]
_FREE, _FOR = 'NAME=LO:HI, as liquid.viscosity="0.5:5 Pa s"', "RESULT=VALUE, as restitution=0.5"
_ENDS = 'LO:HI, such as liquid.viscosity="1.9:2.1 Pa s"'


@command()
def collide(why: bool, request: Request, output: Shown, **chosen: Any) -> None:
    """One collision of the two particles of SCENE, from initial contact to its outcome.

    Options:
        --rtol
        --engine
        --until TIME: Follow a stick on after its proof, as "5 ms" after initial contact.
        --why: Which terms make up e_n^2 - 1; --plot then draws them, and the angular momentum, over time.
    """
    scene = request.scene()
    scene.need_impact()

    from ..collision.collide import collide

    result = collide(scene, trajectory=output.picture is not None, **chosen)
    if not why:
        output.show(result)
        return
    budget = result.budget
    assert budget is not None  # the ledger is integrated
    output.put(f"{result}\n\n{budget}", result.to_dict() | {"budget": [*map(list, budget)] or None}, drawn=budget)


@command("sensitivity.sensitivities:sensitivities")
def sensitivity(wrt: Any, uncertainty: Any, request: Varied, output: Shown, **chosen: Any) -> None:
    """Exact derivatives of the results of a collision of SCENE, through its events: gradients and elasticities.

    Examples:
      wetdoublet sensitivity granulation --of restitution,contact_time --plot tornado.png
      wetdoublet sensitivity granulation --uncertainty liquid.viscosity="5 %"

    Options:
        --of NAMES: Results, as restitution,contact_time,energy.capillary [restitution].
        --wrt NAMES: Parameters, as liquid.viscosity,impact.angle [all of the scene].
        --method M
        --uncertainty
        --rtol
        --engine
    """
    from ..sensitivity.sensitivities import sensitivities
    from ..sensitivity.uncertainty import deviations, first_order, in_words

    scene = request.scene()
    deviation = deviations(scene, uncertainty) if uncertainty else {}
    names = wrt and [*dict.fromkeys([*wrt, *deviation])]
    gradients = sensitivities(scene, wrt=names, **passed(hold=request.hold), **chosen)
    if not deviation:
        output.show(gradients)
        return
    spread = first_order(gradients, deviation)
    record = gradients.to_dict() | {"standard_deviation": spread}
    output.put(f"{gradients}\n{in_words(gradients, spread)}", record, drawn=gradients)


@command(free=_FREE, target=_FOR)
def solve(free: str, target: str, request: Varied, output: Written, **chosen: Any) -> None:
    """All values of an entry of SCENE, in a range, at which a result of its collision has the value that is asked for.

    They are found between and beside changes of outcome, each with the derivatives of the value. A change of outcome
    at which the result only jumps over the value is named, and so is a range that has none.

    Examples:
      wetdoublet solve granulation --free liquid.viscosity="0.5:5 Pa s" --for restitution=0.5 --stokes 0.13 --angle 20
      wetdoublet solve granulation --free impact.stokes=0.01:1 --for contact_time="50 us" --json

    Options:
        --free NAME=LO:HI: The entry and its range, as liquid.viscosity="0.5:5 Pa s".
        --for RESULT=VALUE (target): The result and its value, as restitution=0.5 or contact_time="5 ms".
        --rtol
    """
    name, ends = texts.assignment(_FREE, free, "--free")
    of, value = texts.assignment(_FOR, target, "--for")
    scene = request.scene(whole=False)
    entry = request.numeric(name)
    within = (0.0, 1.0) if entry is None else texts.span(entry, ends, "--free")  # `solve` says what may be free
    for end in () if entry is None else within:
        scene.si_number(name, end, "--free")

    from ..host.arguments import check_name
    from ..results import DEFINITIONS
    from ..sensitivity.solve import TARGETS, solve

    check_name(of, TARGETS, "--for")  # `free`, `angle`, ... are arguments of `solve`, and no results
    if DEFINITIONS[of].unit == "rad" and units.is_number(value):
        value = f"{value} deg"
    chosen |= {**request.impact, **passed(hold=request.hold), of: value}
    output.show(solve(scene, free=name, within=within, **chosen))


@command()
def prove(
    impact: Impact,
    within: tuple[str, ...],
    cells: bool,
    boundary: bool,
    depth: int | None,
    request: Entries,
    output: Shown,
) -> None:
    """Outcomes proved by interval arithmetic: that of the collision of SCENE from its initial data on.

    It is said why that is not possible where it is not. A proof is about the model's equations and the stored numbers.
    The exit status is 1 if nothing is proved.

    Examples:
      wetdoublet prove granulation --stokes 0.02 --angle 75
      wetdoublet prove granulation --stokes 0.3 --angle 20 --within liquid.viscosity="1.9:2.1 Pa s"
      wetdoublet prove granulation --map --stokes log:0.1:0.5:9 --angle 10:40:7 --plot proved.png
      wetdoublet prove granulation --boundary --stokes 0.05:0.5 --angle 10

    Options:
        --stokes VALUE: Stokes number; edges of the cells of a map, LO:HI:N or log:LO:HI:N; LO:HI of a boundary.
        --speed VALUE: Normal speed instead, as "0.4 m/s", or edges of the cells; not of a boundary.
        --relative-speed VALUE: Magnitude of the relative velocity instead, or edges of the cells; not of a boundary.
        --angle VALUE: Impact angle in degrees; edges of the cells of a map, LO:HI:N, from 0 on.
        --within REL|NAME=RANGE: Prove it for a box: a relative uncertainty of the impact, or of an entry NAME=REL, or
            both its ends NAME=LO:HI, as the scene gives it; repeatable.
        --map (cells): Prove a map cell by cell; --plot draws it.
        --boundary: Find two Stokes numbers of opposite proved outcomes, as near as they get.
        --depth N: Halvings of a cell of the map that is not proved [12]; more leave less undecided.
    """
    refuse({"--boundary": "--map" * (cells and boundary)}, "one of the two", "is asked for, too")
    refuse({"--within": (cells or boundary) and within}, "a single proof", "is given together with a map or a boundary")
    refuse({"--depth": not cells and depth}, "--depth with --map")
    if cells:
        edges: Any = {"angle": (), **texts.axes(impact)}  # the library says what is missing
        for name in (name for name, values in edges.items() if len(values) == 1):
            raise InputError(texts.flag(name), impact[name], "at least two rising edges of cells, as LO:HI:N")

        from ..boundaries.proved_map import prove_map

        with Bar("cells") as progress:
            output.show(prove_map(request.scene(), **edges, **passed(depth=depth), progress=progress))
        return
    if boundary:
        refuse({texts.flag(name): impact.get(name) for name in ("speed", "relative_speed")}, "Stokes numbers, --stokes")
        for name, accepted in (("stokes", "LO:HI"), ("angle", "an angle in degrees")):
            if name not in impact:
                raise InputError(texts.flag(name), None, accepted)
        stokes: Any = texts.span(FIELDS["impact.stokes"], impact["stokes"], "--stokes")
        angle = texts.with_degrees(FIELDS["impact.angle"], impact["angle"])

        from ..boundaries.proved_boundary import prove_boundary

        output.show(prove_boundary(request.scene(), angle=angle, stokes=stokes))
        return
    box = _box(within, request)
    scene = request.scene().with_impact(**texts.numbers(impact))
    scene.need_impact()

    from ..engines.interval.prove import prove

    proof = prove(scene, within=box)
    output.show(proof)
    if not proof:
        raise CheckFailed(f"nothing is proved: {proof.reason}")


def _box(within: tuple[str, ...], request: SceneRequest) -> Any:
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
        entry, label = request.numeric(name), f"--within {name}"
        if ":" not in text:
            box[name] = texts.share(f"a relative uncertainty, such as 1e-4 or 1 %, or both ends, {_ENDS}", text, label)
        else:
            box[name] = tuple(text.split(":", 1)) if entry is None else texts.span(entry, text, label)
    return box


@command("averages.averages:collision_averages")
def averages(radii: _Radii, request: Entries, output: _Table, as_json: bool, **chosen: Any) -> None:
    """Sticking probability and mean restitution of SCENE over all impact angles and speeds, for each pair of radii.

    Impact angles have the density sin(2 theta) of isotropic relative velocities. With maxwell:S speeds are those of a
    gas whose velocity components have the standard deviation S, weighted by flux. Without -o a table is
    printed, into a pipe as CSV.

    Example:
      wetdoublet averages granulation --speeds "maxwell:0.5 m/s" --radii "log:30:300 um:16" -o averages.nc

    Options:
        --speeds SPEEDS: Relative speeds: "1 m/s", "maxwell:0.3 m/s", or a FILE.csv of relative_speed,density.
        --radii RANGE: Radii, such as "log:20:200 um:16"; every pair of them is computed, beside a wall each one [the
            scene's pair].
        --films RULE
        --tolerance E
        --rtol
        -o FILE (output): Write NetCDF (.nc) or a table (.csv); the same command continues an interrupted run.
        --json
    """
    scene = request.scene_without_impact("has no influence on averages")

    from ..averages.averages import collision_averages
    from ..averages.dataset import table, to_csv
    from ..many.regime_map import write

    with Bar("pairs") as progress:
        data = collision_averages(scene, progress=progress, resume=output, **passed(radii=radii), **chosen)
    if as_json:
        click.echo(dataset_text(data))
    elif output is None:
        click.echo(table(data) if sys.stdout.isatty() else to_csv(data), nl=False)
    if output is not None and output.suffix.lower() == ".csv":
        files.write(output, to_csv(data))
    elif output is not None:
        write(data, output)
    reasons = [str(reason) for reason in data["reason"].values.ravel() if reason]
    if reasons:
        click.echo(f"{len(reasons)} of {data['reason'].size} pairs failed; the first: {reasons[0]}", err=True)
