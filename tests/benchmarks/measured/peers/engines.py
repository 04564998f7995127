"""What is measured: our engines, and the peers that are installed, each behind one call for a set of collisions."""

from collections.abc import Callable, Sequence
from functools import partial
from importlib.util import find_spec
from typing import Any

from wetdoublet.generated.automaton import LOOSEST, OUTCOMES
from wetdoublet.solvers.collision.collide import collide
from wetdoublet.solvers.engines.settings import CASADI_ENGINES
from wetdoublet.solvers.engines.taylor.call import KernelImpacts, run_kernel
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.many.collide_many import collide_many
from wetdoublet.solvers.scene.scene import Scene

from ..tasks import Answer, Impact, columns, dimensionless
from ..timing import Call, Engine
from .scipy_engine import ScipyAutomaton

Asked = tuple[Scene, Sequence[Impact]]

COARSE = (1e-5, 1e-7, 1e-9, 1e-11, 1e-13)
FINE = tuple(10 ** (-0.5 * k) for k in range(12, 27))
KERNEL, HEYOKA = "taylor, kernel alone", "heyoka, batch of 8"
HEYOKA_ALONE = "heyoka, without callbacks"


def engines() -> tuple[Engine, ...]:
    """All engines, those that are missing here included."""
    scipy, heyoka = _absent("scipy"), _absent("heyoka")
    absent = "" if compiler() else "no C compiler (cc, gcc, clang)"
    return (
        *(Engine(name, partial(_singly, partial(_own, name)), COARSE, many=False) for name in CASADI_ENGINES),
        Engine("taylor", _many, FINE, missing=absent),
        Engine(KERNEL, _kernel, FINE, missing=absent),
        Engine(HEYOKA, partial(_heyoka, False), FINE, missing=heyoka),
        Engine(HEYOKA_ALONE, partial(_heyoka, True), FINE, missing=heyoka),
        Engine("scipy LSODA", partial(_singly, partial(_peer, "LSODA")), COARSE, many=False, missing=scipy),
        Engine("scipy Radau", partial(_singly, partial(_peer, "Radau")), COARSE, many=False, missing=scipy),
    )


def _absent(module: str) -> str:
    return "" if find_spec(module) else f"{module} is not installed (pip install wetdoublet[bench])"


def _singly(one: Callable[[Scene, Impact, float], Answer], asked: Asked, _: int, rtol: float) -> Call:
    """One collision after the other."""
    scene, impacts = asked

    def tried(impact: Impact) -> Answer | str:
        try:
            return one(scene, impact, rtol)
        except ComputationError as error:
            return str(error)

    return Call(lambda: [tried(impact) for impact in impacts])


def _own(plugin: str, scene: Scene, impact: Impact, rtol: float) -> Answer:
    """`collide`, as a user calls it."""
    found = collide(scene, stokes=impact.stokes, angle=impact.angle, rtol=rtol, engine=plugin, ledger=False)
    return Answer(found.outcome, found.restitution)


def _peer(method: str, scene: Scene, impact: Impact, rtol: float) -> Answer:
    """The same collision by a method of scipy."""
    return ScipyAutomaton(dimensionless(scene, impact), rtol, method).run()


def _many(asked: Asked, copies: int, rtol: float) -> Call:
    """`collide_many` of outcome and restitution, as a user calls it."""
    scene, (stokes, angle) = asked[0], columns(asked[1], copies)

    def read(data: Any) -> list[Answer | str]:
        found = zip(data["outcome"].values.tolist(), data["restitution"].values.tolist(), data["reason"].values)
        return [str(why) if outcome < 0 else Answer(OUTCOMES[outcome], e_n) for outcome, e_n, why in found]

    return Call(lambda: collide_many(scene, stokes=stokes, angle=angle, rtol=rtol, engine="taylor"), read)


def _kernel(asked: Asked, copies: int, rtol: float) -> Call:
    """The Taylor kernel without what `collide_many` adds: checks, labels."""
    scene, (stokes, angle) = asked[0], columns(asked[1], copies)
    given = KernelImpacts(scene, stokes / scene.stokes_per_speed, angle, {})

    def read(found: Any) -> list[Answer | str]:
        rows = zip(found["status"].tolist(), found["outcome"].tolist(), found["shown"][:, 0].tolist())
        return [
            Answer(OUTCOMES[outcome], e_n if outcome else 0.0) if status <= 1 else f"undecided ({status})"
            for status, outcome, e_n in rows
        ]

    return Call(lambda: run_kernel(given, rtol), read)


def _heyoka(alone: bool, asked: Asked, copies: int, rtol: float) -> Call:
    """All collisions through one queue.

    Arguments:
        alone: the time in Python's callbacks does not count: no more than somebody waits who calls it from C++.
    """
    from .heyoka_callbacks import Inside
    from .heyoka_engine import collisions

    inside = Inside()  # looser than LOOSEST, its energy misses the level of a proof
    batch = collisions(asked[0], [*asked[1]] * copies, min(rtol, LOOSEST), watch=inside if alone else None)

    def run() -> None:
        inside.reset()
        batch.run()

    def read(_: None) -> list[Answer | str]:
        pairs = zip(batch.outcomes, batch.restitutions)
        return [Answer(outcome, e_n) if outcome else "not decided" for outcome, e_n in pairs]

    return Call(run, read, inside.left_out) if alone else Call(run, read)
