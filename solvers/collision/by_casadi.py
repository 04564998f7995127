"""One collision by CVODES or Rosenbrock: events located, phases integrated, the energy ledger checked."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ..engines.casadi.integrators import Tolerance, tolerance_for
from ..engines.casadi.locate import EventSequence, locate
from ..engines.casadi.replay import Replay, Stopped, as_located, replay
from ..engines.settings import Budget, casadi_steps
from ..errors import ComputationError
from ..model.dimensionless import DimensionlessGroups
from ..model.model import Model, load, select_model, slip_restitution
from ..model.phases import Flow, Region
from ..scene.scene import Scene
from .assemble import assembled
from .outcome import Energy
from .result import Collision

if TYPE_CHECKING:
    import xarray

_TIGHTEST = 1e-13
_LEDGER = ("normal_lubrication", "tangential_lubrication", "capillary", "attraction", "dry_friction")


def by_casadi(
    scene: Scene,
    n: DimensionlessGroups,
    rtol: float,
    plugin: str,
    ledger: bool,
    trajectory: bool,
    find: Callable[..., EventSequence] = locate,
    control: Callable[[float, str, dict[str, float]], Tolerance] = tolerance_for,
    replay: Callable[..., Replay] = replay,
    until: float | None = None,
    budget: Budget | None = None,
) -> Collision:
    """One collision by CVODES or Rosenbrock: its events are located, then its phases are integrated by the engine.

    Both tolerances are tightened while the engine misses a located event, that is while its error exceeds the distance
    to a boundary; one that was tightened for a grazing start is loosened where the engine cannot meet it. Where no
    tolerance helps within the steps of the budget, the trajectory of the event location is the result: computed anew
    with the steps of another budget, of which it needs no more than before.

    Arguments:
        find: locates the sequence of events; the same for both engines.
        control: integrator tolerances of an engine at a relative tolerance.
        replay: integrates the located phases.
        until: time (s) to which a stick is followed on after its proof, located as usual.
        budget: of all these integrations; None for that of `settings`.
    """
    budget = budget or Budget(casadi_steps(rtol))
    if until is not None:
        find = partial(find, until=until / n.time)
    small, choice = (select_model(scene, n.oblique, full, fold=True) for full in (False, ledger or trajectory))
    model, used = load(choice), rtol
    flow, p = Flow(choice, Region(1, 1, False), _quadratures(model, ledger)), model.group_values(n.groups)
    looser: Tolerance | None = None
    path: EventSequence | None = None
    replayed: Replay | None = None
    try:
        while replayed is None:
            tolerance = looser or control(used, plugin, n.groups)
            try:
                path = path or find(load(small), n.groups, used, (), budget=budget)
                replayed = replay(path, plugin, tolerance, flow, model.start(p), budget)
                continue
            except Stopped as stopped:
                if not (stopped.missed or budget.is_spent) and (looser := tolerance.loosened(used)):
                    continue
                if stopped.missed and used > _TIGHTEST:
                    used, looser, path = used * 1e-2 if used > 200 * _TIGHTEST else _TIGHTEST, None, None
                    continue
                failure = ComputationError(
                    f"{plugin} {stopped.why}",
                    phase=str(stopped.step.phase),
                    time=stopped.time,
                    state=dict(zip(model.state, map(float, stopped.y), strict=False)),
                    advice=f"try {'--engine rosenbrock' if plugin == 'cvodes' else '--rtol 1e-8, or another impact'}",
                )
            except ComputationError as error:
                if used == rtol:
                    raise
                failure = error
            try:
                path, used = find(model, n.groups, rtol, flow.extras, budget=Budget(budget.most)), rtol
            except ComputationError:
                raise failure from None
            replayed, plugin = as_located(path, choice), "rosenbrock"
    except ComputationError as error:
        raise n.in_si(error) from None
    assert path is not None
    energy = _energy(model, replayed, p, n) if ledger else None
    if energy is not None and path.separated and energy.is_open(rtol):
        raise ComputationError(
            f"the energy ledger is open by {abs(energy.residual) / energy.largest:.1e} of its largest term",
            advice="try a smaller --rtol, or the other --engine; please report the scene",
        )
    return assembled(
        scene,
        n,
        outcome=path.outcome,
        reversal=path.reversal,
        certified=path.certified,
        outputs=model.values("outputs", replayed.y, p) if path.separated else {},
        rotation=_rotation(replayed, model),
        time=replayed.time,
        smallest_gap=replayed.smallest_gap,
        slip=slip_restitution(model, replayed.y, p) if path.separated else math.nan,
        events=replayed.events,
        engine=plugin,
        steps=replayed.steps,
        decided=path.decided,
        rtol=used,
        energy=energy,
        drift=_drift(model, replayed, p) if ledger else None,
        trajectory=_trajectory(scene, path, replayed, model, n, plugin, rtol) if trajectory else None,
    )


def _quadratures(model: Model, ledger: bool) -> tuple[str, ...]:
    """Names of the quadratures: the rotation where it is not a state, and the model's terms of the ledger."""
    rotation = ("rotation",) if model.has("turning_rate") and not model.strings else ()
    return rotation + (tuple(name for name in model.names("energy_rates") if name in _LEDGER) if ledger else ())


def _rotation(replayed: Replay, model: Model) -> float:
    if model.strings and model.oblique:
        return float(replayed.y[list(model.state).index("rotation")])
    return replayed.extra("rotation") if "rotation" in replayed.extras else 0.0


def _energy(model: Model, replayed: Replay, p: np.ndarray, n: DimensionlessGroups) -> Energy:
    first, last = (model.values("energies", y, p) for y in (model.start(p), replayed.y))
    spent = {name: replayed.extra(name) if name in replayed.extras else 0.0 for name in _LEDGER}
    terms = spent | {"initial": first["kinetic"], "final": last["kinetic"], "dry_contact": replayed.dry_loss}
    terms["strings"] = last["strings"] - first["strings"] if model.strings else 0.0
    terms["dry_friction"] += replayed.friction_loss
    terms["own_events"] = replayed.own_loss
    absent = {"attraction": "attraction" not in model.works, "dry_friction": not model.friction}
    absent["own_events"] = not model.own_events
    return Energy(**{name: value * n.energy for name, value in terms.items() if not absent.get(name)})


def _drift(model: Model, replayed: Replay, p: np.ndarray) -> float | None:
    """|L/L(0) - 1| at the end; None with strings or a wall, which exert a torque; 0 head-on."""
    if model.strings or model.wall:
        return None
    if not model.oblique:
        return 0.0
    return abs(model.values("angular_momentum", replayed.y, p)["angular_momentum"] - 1.0)


def _trajectory(
    scene: Scene, path: EventSequence, replayed: Replay, model: Model, n: DimensionlessGroups, plugin: str, rtol: float
) -> xarray.Dataset:
    from ..engines.casadi.trajectory import attributes, dataset, stretch  # imports xarray

    attrs = attributes(scene, path.outcome, plugin, rtol)
    tolerance, p = tolerance_for(rtol, plugin, n.groups), model.group_values(n.groups)
    pieces = [stretch(piece, model, replayed, p, plugin, tolerance) for piece in replayed.pieces]
    try:
        return dataset(pieces, model, n, replayed.y, attrs)
    except ComputationError as error:
        raise n.in_si(error) from None
