"""`wetdoublet collide`: one collision."""

from typing import Annotated

from ..engines.settings import UNTIL
from . import options
from .signature import as_command, passed


@as_command("One collision, from initial contact to its outcome.")
def command(
    request: options.Request,
    rtol: options.Rtol,
    engine: options.Engine,
    until: Annotated[float | None, UNTIL.number],
    proof: bool,
    why: bool,
    output: options.Shown,
) -> None:
    """Compute one collision of the two particles of SCENE.

    Options:
        --until TIME: Follow a stick on after its proof, as "5 ms" after initial contact.
        --proof: Enclose the collision as well, so that its outcome is proved, or it is said why not.
        --why: Which terms make up e_n^2 - 1; --plot then draws them, and the angular momentum, over time.
    """
    scene = request.scene()
    scene.need_impact()

    from ..collision.collide import collide

    trajectory = output.picture is not None
    one = collide(scene, trajectory=trajectory, proof=proof, **passed(rtol=rtol, engine=engine, until=until))
    if not why:
        output.show(one)
        return
    budget = one.budget
    assert budget is not None  # the ledger is integrated
    output.put(f"{one}\n\n{budget}", one.to_dict() | {"budget": [*map(list, budget)] or None})
    if output.picture is not None:
        budget.plot(output.picture)
