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
from ..errors import ComputationError
from ..model.dimensionless import DimensionlessGroups
from ..model.model import Model, load, select_model, slip_restitution
from ..model.phases import Flow, Region
from ..scene.scene import Scene
from .assemble import Finding, assembled
from .outcome import Energy
from .result import Collision

if TYPE_CHECKING:
    import xarray

Find = Callable[[Model, dict[str, float], float, tuple[str, ...]], EventSequence]
ToleranceFor = Callable[[float, str, dict[str, float]], Tolerance]
_TIGHTEST = 1e-13
_LEDGER = ("normal_lubrication", "tangential_lubrication", "capillary", "attraction", "dry_friction")


def by_casadi(
    scene: Scene,
    n: DimensionlessGroups,
    rtol: float,
    plugin: str,
    ledger: bool,
    trajectory: bool,
    find: Find = locate,
    control: ToleranceFor = tolerance_for,
    replay: Callable[..., Replay] = replay,
    until: float | None = None,
    steps: int | None = None,
) -> Collision:
    """One collision by CVODES or Rosenbrock; the implementation of `collide` for these engines.

    Arguments:
        find: locates the sequence of events; the same for both engines.
        control: integrator tolerances of an engine at a given `rtol`.
        replay: integrates the located phases.
        until: time (s) to which a stick is followed on after its proof, located as usual.
        steps: most steps to locate the events; None for those of `settings`.
    """
    if until is not None or steps is not None:
        find = partial(locate, until=0.0 if until is None else until / n.time, steps=steps)
    found = _compute(scene, n, rtol, plugin, ledger, trajectory, find, control, replay)
    return _result(scene, n, *found, trajectory, rtol)


def _compute(
    scene: Scene,
    n: DimensionlessGroups,
    rtol: float,
    plugin: str,
    ledger: bool,
    trajectory: bool,
    find: Find,
    control: ToleranceFor,
    replay: Callable[..., Replay],
) -> tuple[EventSequence, Replay, Flow, str, float]:
    """Locate the events, then integrate the phases with the engine.

    Both tolerances are tightened while the engine misses a located event, that is while its error exceeds the distance
    to a boundary; one that was tightened for a grazing start is loosened where the engine cannot meet it. Where no
    tolerance helps, the trajectory of the event location at `rtol` is the result. Also returns the engine and the
    tolerance that were used.
    """
    small = load(select_model(scene, n.oblique, fold=True))
    choice = select_model(scene, n.oblique, full=ledger or trajectory, fold=True)
    flow = Flow(choice, Region(1, 1, False), _extras(load(choice), ledger))
    asked, looser = rtol, None
    while True:
        try:
            located = find(small, n.groups, asked, ())
        except ComputationError as error:
            raise n.in_si(error) from None
        start = flow.model.start(flow.model.group_values(n.groups))
        tolerance = looser or control(asked, plugin, n.groups)
        try:
            replayed = replay(located, plugin, tolerance, flow, start)
        except Stopped as failure:
            if not failure.missed and (looser := tolerance.loosened(asked)):
                continue
            if failure.missed and asked > _TIGHTEST:
                asked, looser = asked * 1e-2 if asked > 200 * _TIGHTEST else _TIGHTEST, None
                continue
            try:
                located = find(flow.model, n.groups, rtol, flow.extras)
            except ComputationError:
                raise n.in_si(_failure(failure, flow.model, plugin)) from None
            return located, as_located(located, choice), flow, "rosenbrock", rtol
        return located, replayed, flow, plugin, asked


def _extras(model: Model, ledger: bool) -> tuple[str, ...]:
    """Names of the quadratures: the rotation where it is not a state, and the model's terms of the ledger."""
    rotation = ("rotation",) if model.has("turning_rate") and not model.strings else ()
    return rotation + (tuple(name for name in model.names("energy_rates") if name in _LEDGER) if ledger else ())


def _failure(failure: Stopped, model: Model, plugin: str) -> ComputationError:
    return ComputationError(
        f"{plugin} {failure.why}",
        phase=str(failure.step.phase),
        time=failure.time,
        state=dict(zip(model.state, map(float, failure.y), strict=False)),
        advice="try --engine rosenbrock" if plugin == "cvodes" else "try --rtol 1e-8, or another impact",
    )


def _result(
    scene: Scene,
    n: DimensionlessGroups,
    path: EventSequence,
    replayed: Replay,
    flow: Flow,
    plugin: str,
    rtol: float,
    trajectory: bool,
    asked: float,
) -> Collision:
    model, separated = flow.model, path.separated
    p = model.group_values(n.groups)
    energy = _ledger(model, replayed, p, n) if "normal_lubrication" in flow.extras else None
    if energy is not None and separated:
        _demand_closed(energy, rtol)
    finding = Finding(
        outcome=path.outcome,
        reversal=path.reversal,
        certified=path.certified,
        outputs=model.values("outputs", replayed.y, p) if separated else {},
        rotation=_rotation(replayed, model),
        time=replayed.time,
        smallest_gap=replayed.smallest_gap,
        slip=slip_restitution(model, replayed.y, p) if separated else math.nan,
        events=replayed.events,
        engine=plugin,
        steps=replayed.steps,
        decided=path.decided,
        rtol=asked,
        energy=energy,
        drift=_drift(model, replayed, p) if "normal_lubrication" in flow.extras else None,
        trajectory=_trajectory(scene, path, replayed, model, n, plugin, rtol) if trajectory else None,
    )
    return assembled(scene, n, finding)


def _rotation(replayed: Replay, model: Model) -> float:
    if model.strings and model.oblique:
        return float(replayed.y[list(model.state).index("rotation")])
    return replayed.extra("rotation") if "rotation" in replayed.extras else 0.0


def _ledger(model: Model, replayed: Replay, p: np.ndarray, n: DimensionlessGroups) -> Energy:
    first = model.values("energies", model.start(p), p)
    last = model.values("energies", replayed.y, p)

    def taken(name: str) -> float:
        return replayed.extra(name) if name in replayed.extras else 0.0

    return Energy(
        initial=first["kinetic"] * n.energy,
        final=last["kinetic"] * n.energy,
        normal_lubrication=replayed.extra("normal_lubrication") * n.energy,
        tangential_lubrication=taken("tangential_lubrication") * n.energy,
        capillary=taken("capillary") * n.energy,
        attraction=taken("attraction") * n.energy if "attraction" in model.works else None,
        dry_contact=replayed.dry_loss * n.energy,
        dry_friction=(replayed.friction_loss + taken("dry_friction")) * n.energy if model.friction else None,
        own_events=replayed.own_loss * n.energy if model.own_events else None,
        strings=(last["strings"] - first["strings"]) * n.energy if model.strings else 0.0,
    )


def _demand_closed(energy: Energy, rtol: float) -> None:
    if energy.is_open(rtol):
        raise ComputationError(
            f"the energy ledger is open by {abs(energy.residual) / energy.largest:.1e} of its largest term",
            advice="try a smaller --rtol, or the other --engine; please report the scene",
        )


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
