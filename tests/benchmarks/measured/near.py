"""What a collision costs near the separatrix between sticking and escaping, where a trajectory lingers at a saddle."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.formatting.markdown import table
from wetdoublet.solvers.scene.scene import Scene

from .peers.engines import HEYOKA, engines
from .tasks import Answer, Impact
from .timing import Call, Engine, Least, Tell

Record = dict[str, Any]

PRESET = "granulation"
SEPARATRIX = {  # degrees: St below which it sticks, by halving with the kernel at rtol 1e-13 to a width of 3e-14
    30.0: 0.08575245746193548,
    50.0: 0.04111769751269967,
    70.0: 0.01765780132932007,
    80.0: 0.008493502839467865,
}
DISTANCES = tuple(10.0**-k for k in range(3, 13))  # relative, in St
RTOLS = (1e-9, 1e-12)
COPIES, FEW = 20, 2  # of the set in one call of taylor and of heyoka, which creeps
PATIENCE = 20_000  # steps of heyoka a collision
REPEATS = 3  # the best of so many calls counts
RESOLVED = 1e2  # times the tolerance: a trajectory nearer than that may end on the other side


@dataclass(frozen=True)
class Side:
    """An impact beside the separatrix, and what it comes to."""

    impact: Impact
    sticks: bool


def beside(distance: float) -> list[Side]:
    """Both sides of each point of the separatrix, at a relative distance."""
    return [
        Side(Impact(stokes * (1 + sign * distance), math.radians(degrees)), sign < 0)
        for degrees, stokes in SEPARATRIX.items()
        for sign in (-1, 1)
    ]


def near(tell: Tell = lambda _: None) -> list[Record]:
    """CPU time (s) of a collision, failures and wrong outcomes, by tolerance, distance and engine."""
    scene = Scene.load(PRESET)
    listed = [each for each in engines() if each.name in ("taylor", HEYOKA) and not each.missing]
    rows: list[Record] = []
    for rtol, distance in product(RTOLS, DISTANCES):
        tell(f"near the separatrix: {rtol:.0e}, {distance:.0e}")
        sides = beside(distance)
        rows += [_row(each.name, rtol, distance, sides, *_in_bulk(each, scene, sides, rtol)) for each in listed]
    return rows


def _in_bulk(engine: Engine, scene: Scene, sides: Sequence[Side], rtol: float) -> tuple[float, list[Answer | str]]:
    """CPU time (s) of a collision, and what they came to; a first call builds."""
    copies, impacts = COPIES if engine.name == "taylor" else FEW, [each.impact for each in sides]
    try:
        call = (_patient if engine.name == HEYOKA else engine.prepare)((scene, impacts), copies, rtol)
    except ComputationError as error:
        said = str(error)
        call = Call(lambda: [said] * len(sides))
    call.run()
    least = Least(call, copies * len(sides))
    for _ in range(REPEATS):
        least.run()
    return least.cpu, least.found[: len(sides)]


def _patient(asked: tuple[Scene, Sequence[Impact]], copies: int, rtol: float) -> Call:
    """As heyoka elsewhere, with more steps, and watching for barriers inside the film."""
    from .peers.heyoka_engine import collisions

    scene, impacts = asked
    batch = collisions(scene, [*impacts] * copies, rtol, inside=True)
    batch.steps = PATIENCE
    return Call(batch.run, lambda _: [Answer(each, math.nan) if each else "not decided" for each in batch.outcomes])


def _row(
    engine: str, rtol: float, distance: float, sides: Sequence[Side], cpu: float, answers: Sequence[Answer | str]
) -> Record:
    told = [(each, answer) for each, answer in zip(sides, answers, strict=True) if isinstance(answer, Answer)]
    wrong = sum((answer.outcome == "stick") != each.sticks for each, answer in told)
    failures = sorted({str(answer)[:120] for answer in answers if not isinstance(answer, Answer)})
    return {
        "engine": engine, "rtol": rtol, "distance": distance, "collisions": len(sides), "cpu": cpu,
        "failed": len(sides) - len(told), "wrong": wrong, "resolved": distance > RESOLVED * rtol, "failures": failures,
    }  # fmt: skip


NOTE = (
    f"Granulation at {', '.join(f'{each:g}' for each in SEPARATRIX)} deg, both sides of the Stokes number at which a "
    "stick becomes something else (by bisection at rtol 1e-13). CPU time of a collision, mean of both sides, one core; "
    f"taylor gets the set {COPIES} times in one call, heyoka {FEW} times with {PATIENCE} steps a collision. "
    f"Where the distance is below {RESOLVED:g} rtol no engine can tell "
    "the side; there a wrong outcome does not count. One that heyoka gives up has lost the level that proves a "
    "stick."
)


def near_text(rows: Sequence[Record]) -> str:
    """A table at the usual tolerance, of every third distance, and what all of them say."""
    parts = [NOTE]
    names = list(dict.fromkeys(row["engine"] for row in rows))
    usual, cells = [row for row in rows if row["rtol"] == rows[0]["rtol"]], []
    for distance in list(dict.fromkeys(row["distance"] for row in usual))[::3]:
        here = {row["engine"]: row for row in usual if row["distance"] == distance}
        cells.append([f"{distance:.0e}", *(_cell(here[name]) for name in names)])
    parts += [f"rtol {usual[0]['rtol']:.0e}, CPU ms a collision:", table(["distance", *names], cells)]
    failed = sum(row["failed"] for row in rows if row["engine"] == "taylor")
    return "\n\n".join([*parts, f"Failures of taylor: {failed or 'none'}."])


def _cell(row: Record) -> str:
    notes = [f"{row['failed']} failed"] if row["failed"] else []
    notes += [f"{row['wrong']} wrong"] if row["wrong"] and row["resolved"] else []
    return f"{row['cpu'] * 1e3:#.3g}".removesuffix(".") + (f" ({', '.join(notes)})" if notes else "")
