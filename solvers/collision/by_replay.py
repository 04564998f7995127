"""One collision by CVODES or Rosenbrock: the phases that the kernel has found, replayed, and the ledger checked."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ..engines.casadi.confirm import confirm
from ..engines.casadi.replay import Replay, Stopped, replayed
from ..engines.casadi.sequence import EventSequence
from ..errors import ComputationError
from ..model.dimensionless import Problem
from ..model.model import Model, load, slip_restitution
from .assemble import assembled
from .by_kernel import collision, followed, sequence_in, sequence_of
from .outcome import Energy
from .result import Collision

if TYPE_CHECKING:
    import xarray

_LEDGER = ("normal_lubrication", "tangential_lubrication", "capillary", "attraction", "dry_friction")


def by_replay(
    problem: Problem, rtol: float, plugin: str, ledger: bool, trajectory: bool, until: float | None = None
) -> Collision:
    """One collision by CVODES or Rosenbrock: they integrate the phases that the kernel has found, and watch its events.

    So near to a separatrix that they cannot repeat it, the kernel's trajectory is the result, confirmed step by step.

    Arguments:
        until: time (s) to which a stick is followed on.

    Raises:
        ComputationError: the replay does not agree with the kernel's record, or the engine gives up.
    """
    choice = problem.key(full=ledger or trajectory)
    model = load(choice)
    p = model.group_values(problem.groups)
    try:
        path, replay = replayed(
            partial(sequence_of, problem, until=until), choice, quadratures(model, ledger), plugin, rtol
        )
    except Stopped as stopped:
        if not _confirmed(problem, rtol, plugin, until):
            raise problem.in_si(stopped.error(plugin, model)) from None
        return collision(problem, rtol, ledger, trajectory, until)
    energy = _energy(model, replay, p, problem) if ledger else None
    if energy is not None and path.separated:
        energy.check(rtol)
    return assembled(
        problem,
        outcome=path.outcome,
        reversal=path.reversal,
        certified=path.certified,
        outputs=model.values("outputs", replay.y, p) if path.separated else {},
        rotation=_rotation(replay, model),
        time=replay.time,
        smallest_gap=replay.smallest_gap,
        final_gap=float(replay.y[0]),
        slip=slip_restitution(model, replay.y, p) if path.separated else math.nan,
        events=replay.events,
        engine=plugin,
        steps=replay.steps,
        decided=path.decided,
        rtol=rtol,
        energy=energy,
        drift=_drift(model, replay, p) if ledger else None,
        trajectory=_trajectory(problem, path, replay, model, plugin, rtol) if trajectory else None,
    )


def _confirmed(problem: Problem, rtol: float, plugin: str, until: float | None) -> bool:
    """True if the kernel's trajectory agrees with the equations step by step."""
    try:
        ran = followed(problem, rtol, until, ledger=True, trajectory=True)
        assert ran.record.steps is not None  # requested
        confirm(sequence_in(problem, ran), ran.record.steps, problem.key(full=True), plugin, rtol)
    except (ComputationError, Stopped):
        return False
    return True


def quadratures(model: Model, ledger: bool) -> tuple[str, ...]:
    """Names of the quadratures: the rotation where it is not a state, and the model's terms of the ledger."""
    rotation = ("rotation",) if model.has("turning_rate") and not model.strings else ()
    return rotation + (tuple(name for name in model.names("energy_rates") if name in _LEDGER) if ledger else ())


def _rotation(replay: Replay, model: Model) -> float:
    if model.strings and model.oblique:
        return float(replay.y[list(model.state).index("rotation")])
    return replay.extra("rotation") if "rotation" in replay.extras else 0.0


def _energy(model: Model, replay: Replay, p: np.ndarray, problem: Problem) -> Energy:
    first, last = (model.values("energies", y, p) for y in (model.start(p), replay.y))
    spent = {name: replay.extra(name) if name in replay.extras else 0.0 for name in _LEDGER}
    terms = spent | {"initial": first["kinetic"], "final": last["kinetic"], "dry_contact": replay.dry_loss}
    terms["strings"] = last["strings"] - first["strings"] if model.strings else 0.0
    terms["dry_friction"] += replay.friction_loss
    terms["own_events"] = replay.own_loss
    absent = {"attraction": "attraction" not in model.works, "dry_friction": not model.friction}
    absent["own_events"] = not model.own_events
    return Energy(**{name: value * problem.energy for name, value in terms.items() if not absent.get(name)})


def _drift(model: Model, replay: Replay, p: np.ndarray) -> float | None:
    """|L/L(0) - 1| at the end; None with strings or a wall, which exert a torque; 0 head-on."""
    if model.strings or model.wall:
        return None
    if not model.oblique:
        return 0.0
    return abs(model.values("angular_momentum", replay.y, p)["angular_momentum"] - 1.0)


def _trajectory(
    problem: Problem, path: EventSequence, replay: Replay, model: Model, plugin: str, rtol: float
) -> xarray.Dataset:
    from ..engines.casadi.trajectory import attributes, dataset, stretch  # imports xarray

    attrs = attributes(problem.scene, path.outcome, plugin, rtol)
    p = model.group_values(problem.groups)
    pieces = [stretch(piece, model, replay, p, plugin) for piece in replay.pieces]
    try:
        return dataset(pieces, model, problem, replay.y, attrs)
    except ComputationError as error:
        raise problem.in_si(error) from None
