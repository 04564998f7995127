"""One collision by CVODES or Rosenbrock: the phases that the kernel has found, replayed, and the ledger checked."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ..engines.casadi.confirm import Confirmation
from ..engines.casadi.replay import PHASES, Replay, Stopped, replayed
from ..engines.casadi.sequence import EventSequence
from ..errors import ComputationError
from ..model.dimensionless import Problem
from ..model.model import Model, load, slip_restitution
from ..results import TERMS
from .assemble import assembled
from .by_kernel import collision, followed, sequence_in, sequence_of
from .result import Collision

if TYPE_CHECKING:
    import xarray


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
        if not confirmed(problem, rtol, plugin, until):
            raise problem.in_si(stopped.error(plugin, model)) from None
        return collision(problem, rtol, ledger, trajectory, until)
    conserved = ledger and model.oblique and not (model.strings or model.wall)
    results = {"rotation": _rotation(replay, model), "smallest_gap": replay.smallest_gap}
    if path.separated:
        results |= model.values("outputs", replay.y, p) | {"slip_restitution": slip_restitution(model, replay.y, p)}
    return assembled(
        problem,
        results,
        outcome=path.outcome,
        reversal=path.reversal,
        certified=path.certified,
        time=replay.time,
        final_gap=float(replay.y[0]),
        events=replay.events,
        engine=plugin,
        steps=replay.steps,
        decided=path.decided,
        rtol=rtol,
        terms=terms_of(model, replay, p) if ledger else None,
        momentum=model.values("angular_momentum", replay.y, p)["angular_momentum"] if conserved else 1.0,
        trajectory=_trajectory(problem, path, replay, model, plugin, rtol) if trajectory else None,
    )


def confirmed(problem: Problem, rtol: float, plugin: str, until: float | None = None) -> bool:
    """True if the kernel's trajectory, if it is not too long, agrees with the equations step by step."""
    try:
        ran = followed(problem, rtol, until, ledger=True, trajectory=True)
        assert ran.steps is not None  # requested
        if ran.steps.rows.size > 10 * PHASES:  # each is integrated: minutes
            return False
        Confirmation(sequence_in(problem, ran), ran.steps, problem.key(full=True), plugin, rtol).run()
    except (ComputationError, Stopped):
        return False
    return True


def quadratures(model: Model, ledger: bool) -> tuple[str, ...]:
    """Names of the quadratures: the rotation where it is not a state, and the model's terms of the ledger."""
    rotation = ("rotation",) if model.has("turning_rate") and not model.strings else ()
    return rotation + (model.names("energy_rates") if ledger else ())


def _rotation(replay: Replay, model: Model) -> float:
    if model.strings and model.oblique:
        return float(replay.y[list(model.state).index("rotation")])
    return replay.extra("rotation") if "rotation" in replay.extras else 0.0


def terms_of(model: Model, replay: Replay, p: np.ndarray) -> dict[str, float]:
    """The ledger, over m v0^2."""
    first, last = (model.values("energies", y, p) for y in (model.start(p), replay.y))
    terms = dict.fromkeys(TERMS, 0.0) | {name: replay.extra(name) for name in replay.extras if name != "rotation"}
    terms |= {"initial": first["kinetic"], "final": last["kinetic"], "dry_contact": replay.dry_loss}
    terms["strings"] = last["strings"] - first["strings"] if model.strings else 0.0
    terms["dry_friction"] += replay.friction_loss
    stored = last.get("own_energy", 0.0) - first.get("own_energy", 0.0)
    terms |= {"own_events": replay.own_loss, "own_terms": stored + terms.pop("own_work", 0.0)}
    absent = [name for name, items in (("own_events", model.own_events), ("own_terms", model.own_terms)) if not items]
    return {name: value for name, value in terms.items() if name not in absent}


def _trajectory(
    problem: Problem, path: EventSequence, replay: Replay, model: Model, plugin: str, rtol: float
) -> xarray.Dataset:
    from ..engines.casadi.trajectory import dataset, stretch  # imports xarray

    p = model.group_values(problem.groups)
    pieces = [stretch(piece, model, replay, p, plugin) for piece in replay.pieces]
    try:
        return dataset(pieces, model, problem, replay.y, path.outcome, plugin, rtol)
    except ComputationError as error:
        raise problem.in_si(error) from None
