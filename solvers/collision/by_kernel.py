"""One collision by the Taylor kernel, with its ledger and trajectory."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import CLOSING, KINDS, LAST_ANSWER, OPENING, OUTCOMES, Status
from ..engines.taylor.call import Impacts
from ..engines.taylor.record import Recorded, Steps, run_recorded
from ..model.dimensionless import DimensionlessGroups
from ..model.model import load, select_model
from ..model.phases import Phase
from ..model.rebound import rebounded
from ..scene.scene import Scene
from ..settings import KERNEL_STEPS
from .assemble import Finding, assembled
from .outcome import Energy
from .result import Collision

if TYPE_CHECKING:
    import xarray

    from ..engines.casadi.trajectory import Stretch


_MOST_EVENTS = 1000  # of a result; chatter that lasts longer is followed by CasADi, whose certificates end it sooner


def kind_of(answer: np.void) -> tuple[str, str | None]:
    """Outcome of a kernel record, and the first rebound criterion met (None if none)."""
    return OUTCOMES[answer["outcome"]], KINDS[answer["reversal"]] if answer["reversal"] >= 0 else None


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
) -> Collision | str:
    """The collision by one call of the kernel; the reason if the kernel cannot complete it or is not available.

    Arguments:
        ledger: include the energy ledger and the drift of angular momentum.
        trajectory: include the trajectory, sampled from the Taylor series of the steps.
    """
    impacts = Impacts(scene, np.array([n.speed]), np.array([n.angle]), {})
    recorded = run_recorded(impacts, n.oblique, rtol, ledger, trajectory, budget)
    if recorded is None:
        return "no Taylor kernel can be compiled for this scene here"  # a remark has said why
    found = recorded.answers[0]
    if found["status"] > LAST_ANSWER:
        return f"the Taylor kernel gave up: {Status(found['status']).name.lower().replace('_', ' ')}"
    if found["events"] > _MOST_EVENTS:
        return f"the Taylor kernel gave up: more than {_MOST_EVENTS} events"
    energy = None if recorded.ledger is None else _energy(scene, n, recorded.ledger[0])
    outcome, reversal = kind_of(found)
    separated = bool(found["outcome"])
    if energy is not None and separated and energy.is_open(rtol):
        return "the Taylor kernel gave up: its energy ledger is open"  # so the trajectory is wrong
    happened = recorded.events[0, : found["events"]]
    model = load(select_model(scene, n.oblique, fold=True))
    words = words_of(scene)
    finding = Finding(
        outcome=outcome,
        reversal=reversal,
        certified=bool(found["certified"]),
        outputs=dict(zip(model.names("outputs"), found["shown"].tolist())) if separated else {},
        rotation=float(found["turned"]),
        time=float(found["time"]),
        smallest_gap=float(found["smallest_gap"]),
        slip=float(found["slip"]),
        events=[(words[int(each["kind"])], float(each["time"])) for each in happened],
        engine="taylor",
        steps=int(found["steps"]),
        rtol=rtol,
        energy=energy,
        drift=None if recorded.ledger is None else _drift(scene, n, recorded.ledger[0]),
        trajectory=_trajectory(scene, n, rtol, recorded, ledger) if trajectory else None,
    )
    return assembled(scene, n, finding)


def _energy(scene: Scene, n: DimensionlessGroups, book: np.void) -> Energy:
    own: dict[str, float] = {name: float(book[name]) * n.energy for name in book.dtype.names or ()}
    return Energy(
        initial=own["initial"],
        final=own["final"],
        normal_lubrication=own["normal"],
        tangential_lubrication=own["tangential"],
        capillary=own["capillary"],
        attraction=own["attraction"] if scene.attraction is not None else None,
        dry_contact=own["dry"],
        dry_friction=own["friction"] if scene.particles.friction is not None and n.oblique else None,
        own_events=own.get("own_events"),
        strings=own["lifted"] if scene.pendulum is not None else 0.0,
    )


def _drift(scene: Scene, n: DimensionlessGroups, book: np.void) -> float | None:
    """|L/L(0) - 1| at the end; None with strings or a wall, which exert a torque; 0 head-on."""
    if scene.pendulum is not None or (scene.wall and n.oblique):
        return None
    return abs(float(book["momentum"]) - 1.0) if n.oblique else 0.0


def _trajectory(scene: Scene, n: DimensionlessGroups, rtol: float, recorded: Recorded, full: bool) -> xarray.Dataset:
    from ..engines.casadi.trajectory import attributes, dataset  # imports xarray

    assert recorded.steps is not None
    model = load(select_model(scene, n.oblique, full=full, fold=True))
    attrs = attributes(scene, OUTCOMES[recorded.answers["outcome"][0]], "taylor", rtol)
    p = model.group_values(n.groups)
    first, reversal = model.start(p), int(recorded.answers["reversal"][0])
    if reversal >= 0:  # where initial contact decides, the state after it
        first = rebounded(model, KINDS[reversal], first, p).after
    return dataset(stretches(recorded.steps, len(model.state)), model, n, first, attrs)


def stretches(steps: Steps, states: int) -> list[Stretch]:
    """The phases of one collision, each with a sampler of its states; empty where initial contact decides the outcome.

    Arguments:
        states: number of series that are states of the model; the angle turned may follow them.
    """
    from ..engines.casadi.trajectory import Stretch

    rows, found = steps.rows, []
    if not rows.size:
        return []  # decided at initial contact
    firsts = np.flatnonzero(np.diff(rows["phase"], prepend=-1))
    for first, end in zip(firsts, np.append(firsts[1:], rows.size), strict=True):
        own, row = Steps(rows[first:end], steps.turned), rows[first]
        start = float(row["time"])
        duration = float(rows[end - 1]["time"] + rows[end - 1]["length"]) - start
        if duration == 0.0:
            continue
        phase = Phase(int(row["film"]), 0, CLOSING if row["closing"] else OPENING, bool(row["resting"]))
        found.append(Stretch(str(phase), start, duration, _sampler(own, start, duration, states)))
    return found


def _sampler(steps: Steps, start: float, duration: float, states: int) -> Any:
    def sample(parts: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
        y = steps.states(start + parts * duration)
        return y[:states], None if steps.turned is None else y[steps.turned]

    return sample
