"""What is measured: our engines, and the peers that are installed, behind one call a collision."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec

import numpy as np

from ..compiled import compiler
from ..errors import ComputationError
from ..locate import Path
from ..many import FAILED, OUTCOMES, run
from ..model import choose, load
from ..numbers import Numbers, numbers
from ..requests import requested
from ..scene import Scene
from ..simulate import collide
from .peers import fly
from .tasks import Impact


@dataclass(frozen=True)
class Answer:
    """What a collision came to."""

    outcome: str
    restitution: float


Collide = Callable[[int], Answer]


@dataclass(frozen=True)
class Engine:
    """An engine under test.

    Arguments:
        prepare: from scene, impacts and tolerance, the function that computes collision k; it raises ComputationError.
        builds: it builds integrators for every tolerance, so that a first pass has to be thrown away for each.
        missing: why it cannot be used here; empty if it can.
    """

    name: str
    prepare: Callable[[Scene, Sequence[Impact], float], Collide]
    builds: bool = True
    missing: str = ""


def engines() -> tuple[Engine, ...]:
    """All engines, those that are missing here included."""
    scipy = "" if find_spec("scipy") else "scipy is not installed (pip install wetdoublet[bench])"
    return (
        Engine("cvodes", partial(_chained, "cvodes")),
        Engine("rosenbrock", partial(_chained, "rosenbrock")),
        Engine("rosenbrock, compiled", _compiled, missing="" if compiler() else "no C compiler (cc, gcc, clang)"),
        Engine("scipy LSODA", partial(_peer, "LSODA"), builds=False, missing=scipy),
        Engine("scipy Radau", partial(_peer, "Radau"), builds=False, missing=scipy),
    )


def dimensionless(scene: Scene, impact: Impact) -> Numbers:
    """The numbers of a scene's collision."""
    return numbers(scene, scene.speed_of(impact.stokes), impact.angle)


def answer(path: Path) -> Answer:
    """What a located flight came to."""
    outputs = path.model.values("outputs", path.y, path.p) if path.separated else {}
    return Answer(path.outcome, outputs.get("restitution", 0.0))


def _chained(plugin: str, scene: Scene, impacts: Sequence[Impact], rtol: float) -> Collide:
    """`collide`, as a user calls it."""

    def one(k: int) -> Answer:
        impact = impacts[k]
        found = collide(scene, stokes=impact.stokes, angle=impact.angle, rtol=rtol, engine=plugin, ledger=False)
        return Answer(found.outcome, found.restitution)

    return one


def _compiled(scene: Scene, impacts: Sequence[Impact], rtol: float) -> Collide:
    """What `collide_many` does with a block, one collision at a time."""
    stokes, angle = (np.array([getattr(impact, name) for impact in impacts]) for name in ("stokes", "angle"))
    request = requested(scene, stokes, None, angle, {}, rtol, "rosenbrock", ("outcome", "restitution"))
    parts = [request.part(np.array([k])) for k in range(len(impacts))]

    def one(k: int) -> Answer:
        block = run(parts[k], True)
        outcome = int(block["outcome"][0])
        if outcome == FAILED:
            raise ComputationError(str(block["reason"][0]))
        return Answer(OUTCOMES[outcome], float(block["restitution"][0]))

    return one


def _peer(method: str, scene: Scene, impacts: Sequence[Impact], rtol: float) -> Collide:
    """The same collision by a method of scipy."""

    def one(k: int) -> Answer:
        n = dimensionless(scene, impacts[k])
        return answer(fly(load(choose(scene, n.oblique)), n.groups, rtol, method))

    return one
