"""What is measured: our engines, and the peers that are installed, behind one call a collision or one for all."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from typing import Any

import numpy as np
from wetdoublet.generated.automaton import LOOSEST, OUTCOMES
from wetdoublet.solvers.collision.collide import collide
from wetdoublet.solvers.engines.settings import CASADI_ENGINES
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.many.collide_many import collide_many
from wetdoublet.solvers.scene.scene import Scene

from ..answers import Answer, Impact, dimensionless
from .bulk import Bulk, Collide, Partly
from .scipy_engine import ScipyAutomaton


@dataclass(frozen=True)
class Engine:
    """An engine under test: it has `one` or `many`.

    Arguments:
        one: from scene, impacts and tolerance, the function that computes collision k; it raises ComputationError.
        many: the same for all of them in one call.
        builds: it builds integrators for every tolerance, so that a first pass has to be thrown away for each.
        fast: it is asked at more tolerances, and more often.
        missing: why it cannot be used here; empty if it can.
    """

    name: str
    one: Callable[[Scene, Sequence[Impact], float], Collide] | None = None
    many: Callable[[Scene, Sequence[Impact], float], Bulk] | None = None
    builds: bool = True
    fast: bool = False
    missing: str = ""


KERNEL, HEYOKA = "taylor, kernel alone", "heyoka, batch of 8"
HEYOKA_ALONE = "heyoka, without callbacks"


def engines() -> tuple[Engine, ...]:
    """All engines, those that are missing here included."""
    scipy = _absent("scipy")
    absent = "" if compiler() else "no C compiler (cc, gcc, clang)"
    return (
        *(Engine(name, one=partial(_one, name)) for name in CASADI_ENGINES),
        Engine("taylor", many=_many, fast=True, missing=absent),
        Engine(KERNEL, many=_kernel, fast=True, missing=absent),
        Engine(HEYOKA, many=partial(_heyoka, False), fast=True, missing=_absent("heyoka")),
        Engine(HEYOKA_ALONE, many=partial(_heyoka, True), fast=True, missing=_absent("heyoka")),
        Engine("diffrax Tsit5", many=_diffrax, missing=_absent("diffrax")),
        Engine("scipy LSODA", one=partial(_peer, "LSODA"), builds=False, missing=scipy),
        Engine("scipy Radau", one=partial(_peer, "Radau"), builds=False, missing=scipy),
    )


def _absent(module: str, package: str = "") -> str:
    return "" if find_spec(module) else f"{package or module} is not installed (pip install wetdoublet[bench])"


def _one(plugin: str, scene: Scene, impacts: Sequence[Impact], rtol: float) -> Collide:
    """`collide`, as a user calls it."""

    def one(k: int) -> Answer:
        impact = impacts[k]
        found = collide(scene, stokes=impact.stokes, angle=impact.angle, rtol=rtol, engine=plugin, ledger=False)
        return Answer(found.outcome, found.restitution)

    return one


def _columns(impacts: Sequence[Impact]) -> tuple[np.ndarray, np.ndarray]:
    """Stokes numbers and angles."""
    return tuple(np.array([getattr(each, name) for each in impacts]) for name in ("stokes", "angle"))  # type: ignore[return-value]  # two


def _many(scene: Scene, impacts: Sequence[Impact], rtol: float) -> Bulk:
    """`collide_many` of outcome and restitution, as a user calls it."""
    stokes, angle = _columns(impacts)

    def read(data: Any) -> list[Answer | str]:
        found = zip(data["outcome"].values.tolist(), data["restitution"].values.tolist(), data["reason"].values)
        return [str(why) if outcome < 0 else Answer(OUTCOMES[outcome], e_n) for outcome, e_n, why in found]

    return Bulk(lambda: collide_many(scene, stokes=stokes, angle=angle, rtol=rtol, engine="taylor"), read)


def _kernel(scene: Scene, impacts: Sequence[Impact], rtol: float) -> Bulk:
    """The Taylor kernel without what `collide_many` adds: checks, labels."""
    from wetdoublet.solvers.engines.taylor.call import Impacts, run_kernel

    stokes, angle = _columns(impacts)
    given = Impacts(scene, stokes / scene.stokes_per_speed, angle, {})

    def read(found: Any) -> list[Answer | str]:
        rows = zip(found["status"].tolist(), found["outcome"].tolist(), found["shown"][:, 0].tolist())
        return [
            Answer(OUTCOMES[outcome], e_n if outcome else 0.0) if status <= 1 else f"undecided ({status})"
            for status, outcome, e_n in rows
        ]

    return Bulk(lambda: run_kernel(given, rtol), read)


def _heyoka(alone: bool, scene: Scene, impacts: Sequence[Impact], rtol: float) -> Bulk:
    """All collisions through one queue.

    Arguments:
        alone: the time in Python's callbacks does not count: no more than somebody waits who calls it from C++.
    """
    from .heyoka_callbacks import Inside
    from .heyoka_engine import collisions

    inside = Inside()  # looser than LOOSEST, its energy misses the level of a proof
    batch = collisions(scene, impacts, min(rtol, LOOSEST), watch=inside if alone else None)

    def run() -> None:
        inside.reset()
        batch.run()

    def read(_: None) -> list[Answer | str]:
        pairs = zip(batch.outcomes, batch.restitutions)
        return [Answer(outcome, e_n) if outcome else "not decided" for outcome, e_n in pairs]

    return Bulk(Partly(run, inside.left_out) if alone else run, read)


def _diffrax(scene: Scene, impacts: Sequence[Impact], rtol: float) -> Bulk:
    """All collisions side by side."""
    from .diffrax_engine import collisions

    return collisions(scene, impacts, rtol)


def _peer(method: str, scene: Scene, impacts: Sequence[Impact], rtol: float) -> Collide:
    """The same collision by a method of scipy."""

    def one(k: int) -> Answer:
        return ScipyAutomaton(dimensionless(scene, impacts[k]), rtol, method).run()

    return one
