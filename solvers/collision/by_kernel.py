"""One collision by the Taylor kernel, with its ledger and trajectory."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...generated.automaton import CLOSING, KINDS, LAST_ANSWER, OPENING, OUTCOMES, Status
from ..engines.settings import KERNEL_STEPS, spent_by_kernel
from ..engines.taylor.call import Impacts
from ..engines.taylor.record import Recorded, Steps, run_recorded
from ..model.dimensionless import DimensionlessGroups
from ..model.model import load, select_model
from ..results import TERMS
from ..scene.scene import Scene
from .assemble import assembled
from .outcome import Energy, absent_terms
from .result import Collision

if TYPE_CHECKING:
    import xarray

    from ..engines.casadi.trajectory import Stretch


class Undecided(NamedTuple):
    """Why the kernel has not decided a collision, and the steps that are then spent of those for all engines."""

    reason: str
    spent: int = 0


def words_of(scene: Scene) -> tuple[str, ...]:
    """Words of events by the kernel's numbers: the library's, then those of declared events."""
    return KINDS if scene.package is None else (*KINDS, *scene.package.words)


def collision(
    scene: Scene,
    n: DimensionlessGroups,
    rtol: float,
    ledger: bool = False,
    trajectory: bool = False,
    budget: int = KERNEL_STEPS,
) -> Collision | Undecided:
    """The collision by one call of the kernel; the reason if the kernel cannot complete it or is not available.

    Arguments:
        ledger: include the energy ledger and the drift of angular momentum.
        trajectory: include the trajectory, sampled from the Taylor series of the steps.
    """
    impacts = Impacts(scene, np.array([n.speed]), np.array([n.angle]), {})
    recorded = run_recorded(impacts, n.oblique, rtol, ledger, trajectory, budget)
    if recorded is None:
        return Undecided("no Taylor kernel can be compiled for this scene here")  # a remark has said why
    answer, books = _row(recorded.answers), None if recorded.ledger is None else _row(recorded.ledger)
    steps = answer["steps"]
    if answer["status"] > LAST_ANSWER:
        status = Status(answer["status"]).name.lower().replace("_", " ")
        return Undecided(f"the Taylor kernel gave up: {status}", spent_by_kernel(steps, answer["events"]))
    energy = None if books is None else _energy(scene, n, books)
    separated = answer["outcome"] > 0
    if energy is not None and separated and energy.is_open(rtol):
        return Undecided("the Taylor kernel gave up: its energy ledger is open", steps)  # so the trajectory is wrong
    names, words = load(select_model(scene, n.oblique, fold=True)).names("outputs"), words_of(scene)
    return assembled(
        scene,
        n,
        outcome=OUTCOMES[answer["outcome"]],
        reversal=KINDS[answer["reversal"]] if answer["reversal"] >= 0 else None,
        certified=bool(answer["certified"]),
        outputs=dict(zip(names, answer["shown"].tolist())) if separated else {},
        rotation=answer["turned"],
        time=answer["time"],
        smallest_gap=answer["smallest_gap"],
        slip=answer["slip"],
        events=[(words[int(kind)], time) for kind, time in recorded.events[0, : answer["events"]].tolist()],
        engine="taylor",
        steps=steps,
        rtol=rtol,
        energy=energy,
        drift=None if books is None else _drift(scene, n, books),
        trajectory=_trajectory(scene, n, rtol, recorded, ledger) if trajectory else None,
    )


def _row(rows: np.ndarray) -> dict[str, Any]:
    """The only row of a structured array, as Python's numbers (arithmetic with numpy's scalars is slow)."""
    return dict(zip(rows.dtype.names or (), rows[0].tolist(), strict=True))


def _energy(scene: Scene, n: DimensionlessGroups, books: Mapping[str, float]) -> Energy:
    terms = {name: books[field] * n.energy for name, field in TERMS.items()}
    terms |= {"own_events": books["own_events"] * n.energy} if "own_events" in books else {}
    absent = absent_terms(scene) | (set() if n.oblique else {"dry_friction"})
    return Energy(**{"strings": 0.0} | {name: value for name, value in terms.items() if name not in absent})


def _drift(scene: Scene, n: DimensionlessGroups, books: Mapping[str, float]) -> float | None:
    """|L/L(0) - 1| at the end; None with strings or a wall, which exert a torque; 0 head-on."""
    if scene.pendulum is not None or (scene.wall and n.oblique):
        return None
    return abs(books["momentum"] - 1.0) if n.oblique else 0.0


def _trajectory(scene: Scene, n: DimensionlessGroups, rtol: float, recorded: Recorded, full: bool) -> xarray.Dataset:
    from ..engines.casadi.trajectory import attributes, dataset  # imports xarray
    from ..model.rebound import rebounded

    assert recorded.steps is not None
    model = load(select_model(scene, n.oblique, full=full, fold=True))
    attrs = attributes(scene, OUTCOMES[recorded.answers["outcome"][0]], "taylor", rtol)
    p = model.group_values(n.groups)
    first, reversal = model.start(p), int(recorded.answers["reversal"][0])
    if reversal >= 0:  # where initial contact decides, the state after it
        first = rebounded(model, KINDS[reversal], first, p).after
    return dataset([*_stretches(recorded.steps, len(model.state))], model, n, first, attrs)


def _stretches(steps: Steps, states: int) -> Iterator[Stretch]:
    """The phases of one collision, each with a sampler of its states; none where initial contact decides the outcome.

    Arguments:
        states: number of series that are states of the model; the angle turned may follow them.
    """
    from ..engines.casadi.trajectory import Stretch
    from ..model.phases import Phase

    rows, turned = steps.rows, steps.turned
    firsts = np.flatnonzero(np.diff(rows["phase"], prepend=-1)) if rows.size else np.zeros(0, int)
    for first, end in zip(firsts, np.append(firsts[1:], rows.size)):
        part, row = Steps(rows[first:end], turned), rows[first]
        start = float(row["time"])
        duration = float(rows[end - 1]["time"] + rows[end - 1]["length"]) - start

        def sample(
            parts: np.ndarray, part: Steps = part, start: float = start, duration: float = duration
        ) -> tuple[np.ndarray, np.ndarray | None]:
            y = part.states(start + parts * duration)
            return y[:states], None if turned is None else y[turned]

        if duration > 0.0:
            phase = Phase(int(row["film"]), 0, CLOSING if row["closing"] else OPENING, bool(row["resting"]))
            yield Stretch(str(phase), start, duration, sample)
