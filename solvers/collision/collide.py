"""One collision: scene in, `Collision` out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path as FilePath
from typing import TYPE_CHECKING

import numpy as np

from ..engines.casadi.integrators import tolerance as told
from ..engines.casadi.locate import Path, locate
from ..engines.casadi.replay import Flown, Stopped, as_located, fly
from ..errors import ComputationError
from ..host.arguments import check_flag
from ..model.cohesion import generalised_centrifugal
from ..model.dimensionless import Numbers, numbers
from ..model.model import Model, choose, load
from ..model.phases import Flow, Region
from ..model.validity import warn
from ..scene.scene import Scene
from ..settings import check_engine, check_rtol
from .by_kernel import collision
from .outcome import Energy, Event
from .result import Collision

if TYPE_CHECKING:
    import xarray

Find = Callable[[Model, dict[str, float], float, tuple[str, ...]], Path]
_TIGHTEST = 1e-13
_LEDGER = ("normal_lubrication", "tangential_lubrication", "capillary", "attraction")


def collide(
    scene: Scene | str | FilePath,
    *,
    stokes: float | str | None = None,
    speed: float | str | None = None,
    angle: float | str | None = None,
    rtol: float = 1e-9,
    engine: str | None = None,
    ledger: bool = True,
    trajectory: bool = False,
) -> Collision:
    """Collide two wet particles.

    Arguments:
        scene: a Scene, a path to a scene file, or a preset's name.
        stokes: Stokes number of the impact; or
        speed: its normal speed, m/s or a string with its unit. Either overrides the scene's.
        angle: impact angle, rad or a string with its unit.
        rtol: relative tolerance of the integrators, 1e-13..1e-3.
        engine: "cvodes", "rosenbrock" or "taylor" (compiled on first use; rosenbrock where it does not apply); None
            chooses (cvodes for one collision).
        ledger: integrate the energy ledger and keep the spin as a state to see the drift of angular momentum.
        trajectory: keep the trajectory as an xarray Dataset.

    Returns:
        The Collision.

    Raises:
        InputError: a field or option is not acceptable.
        ComputationError: the flight could not be completed; says in which phase, when and at what state.

    Warns:
        ModelWarning: the scene leaves the range that a law was made for.

    Example:
        >>> from wetdoublet.solvers import collide
        >>> collide("granulation", stokes=0.02, angle="75 deg").restitution > 1
        True
    """
    rtol, plugin = check_rtol(rtol), check_engine(engine) or "cvodes"
    ledger, trajectory = check_flag(ledger, "ledger"), check_flag(trajectory, "trajectory")
    loaded = Scene.load(scene).with_impact(stokes=stokes, speed=speed, angle=angle)
    v0, theta0 = loaded.need_impact()
    dimensionless = numbers(loaded, v0, theta0)
    said = warn(loaded)
    by = _by_kernel if plugin == "taylor" else by_casadi
    result = by(loaded, dimensionless, rtol, plugin, ledger, trajectory)
    return replace(result, warnings=said) if said else result


def by_casadi(
    scene: Scene, n: Numbers, rtol: float, plugin: str, ledger: bool, trajectory: bool, find: Find = locate
) -> Collision:
    """By CVODES or Rosenbrock: what `collide` does with one of them.

    Arguments:
        find: what locates the flight; it is the same for both engines.
    """
    found = _compute(scene, n, rtol, plugin, ledger, trajectory, find)
    return _result(scene, n, *found, trajectory)


def _by_kernel(scene: Scene, n: Numbers, rtol: float, _plugin: str, ledger: bool, trajectory: bool) -> Collision:
    """By the Taylor kernel; what it hands over is Rosenbrock's."""
    found = collision(scene, n, rtol, ledger, trajectory)
    return found or by_casadi(scene, n, rtol, "rosenbrock", ledger, trajectory)


def _compute(
    scene: Scene, n: Numbers, rtol: float, plugin: str, ledger: bool, trajectory: bool, find: Find = locate
) -> tuple[Path, Flown, Flow, str, float]:
    """Locate, then fly with the engine; both tightened while the engine's error exceeds the distance to a boundary.

    Where no tolerance helps, the located flight itself is the answer. Also returns the engine that answers and the
    tolerance that it took.
    """
    small = load(choose(scene, n.oblique, fold=True))
    choice = choose(scene, n.oblique, full=ledger or trajectory, fold=True)
    flow = Flow(choice, Region(1, 1, False), _extras(load(choice), ledger))
    tolerance = rtol
    while True:
        try:
            located = find(small, n.groups, tolerance, ())
        except ComputationError as error:
            raise n.in_si(error) from None
        start = flow.model.start(flow.model.group_values(n.groups))
        try:
            flown = fly(located, plugin, told(tolerance, plugin, n.groups), flow, start)
        except Stopped as failure:
            if failure.missed and tolerance > _TIGHTEST:
                tolerance = tolerance * 1e-2 if tolerance > 200 * _TIGHTEST else _TIGHTEST
                continue
            try:
                located = find(flow.model, n.groups, tolerance, flow.extras)
            except ComputationError:
                raise n.in_si(_failure(failure, flow.model, plugin)) from None
            return located, as_located(located, choice), flow, "rosenbrock", tolerance
        return located, flown, flow, plugin, tolerance


def _extras(model: Model, ledger: bool) -> tuple[str, ...]:
    """What is integrated along: the rotation where it is not a state, the ledger's terms that the model has."""
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
    scene: Scene, n: Numbers, path: Path, flown: Flown, flow: Flow, plugin: str, rtol: float, trajectory: bool
) -> Collision:
    model, separated = flow.model, path.separated
    p = model.group_values(n.groups)
    outputs = model.values("outputs", flown.y, p) if separated else {}
    duration = flown.time * n.time

    def rate(name: str) -> float | None:
        if not separated:
            return None
        return outputs[name] * n.rate if n.oblique else 0.0

    energy = _ledger(model, flown, p, n) if "normal_lubrication" in flow.extras else None
    if energy is not None and separated:
        _demand_closed(energy, rtol)
    return Collision(
        outcome=path.outcome,
        restitution=outputs.get("restitution", 0.0),
        tangential_restitution=outputs.get("tangential_restitution"),
        rotation=_rotation(flown, model) if separated else None,
        contact_time=duration if separated else None,
        smallest_gap=flown.smallest_gap * n.length if separated else None,
        final_spin=rate("final_spin"),
        final_spin_partner=_partner_spin(scene, rate, outputs),
        final_rotation_rate=rate("final_rotation_rate"),
        stokes=n.stokes,
        centrifugal=n.centrifugal,
        generalised_centrifugal=generalised_centrifugal(scene, n),
        capillary=n.capillary,
        reynolds=n.reynolds,
        speed=n.speed,
        angle=n.angle,
        reversal=path.reversal,
        certified=path.certified and not separated,
        until=None if separated else duration,
        events=tuple(Event(kind, time * n.time) for kind, time in flown.events),
        energy=energy,
        angular_momentum_drift=_drift(model, flown, p) if "normal_lubrication" in flow.extras else None,
        engine=plugin,
        steps=flown.steps,
        scene=scene,
        trajectory=_trajectory(scene, path, flown, model, n, plugin, rtol) if trajectory else None,
    )


def _rotation(flown: Flown, model: Model) -> float:
    if model.strings and model.oblique:
        return float(flown.y[list(model.state).index("rotation")])
    return flown.extra("rotation") if "rotation" in flown.extras else 0.0


def _partner_spin(scene: Scene, rate: Callable[[str], float | None], outputs: dict[str, float]) -> float | None:
    """Spin of the partner: its own, that of an equal, or none for a wall."""
    if scene.partner is None:
        return None
    if scene.wall:
        return None if rate("final_spin") is None else 0.0
    return rate("final_spin_partner" if "final_spin_partner" in outputs else "final_spin")


def _ledger(model: Model, flown: Flown, p: np.ndarray, n: Numbers) -> Energy:
    first = model.values("energies", model.start(p), p)
    last = model.values("energies", flown.y, p)

    def taken(name: str) -> float:
        return flown.extra(name) if name in flown.extras else 0.0

    return Energy(
        initial=first["kinetic"] * n.energy,
        final=last["kinetic"] * n.energy,
        normal_lubrication=flown.extra("normal_lubrication") * n.energy,
        tangential_lubrication=taken("tangential_lubrication") * n.energy,
        capillary=taken("capillary") * n.energy,
        attraction=taken("attraction") * n.energy if "attraction" in model.works else None,
        dry_contact=flown.dry_loss * n.energy,
        strings=(last["strings"] - first["strings"]) * n.energy if model.strings else 0.0,
    )


def _demand_closed(energy: Energy, rtol: float) -> None:
    if energy.is_open(rtol):
        raise ComputationError(
            f"the energy ledger is open by {abs(energy.residual) / energy.largest:.1e} of its largest term",
            advice="try a smaller --rtol, or the other --engine; please report the scene",
        )


def _drift(model: Model, flown: Flown, p: np.ndarray) -> float | None:
    """|L/L(0) - 1| at the end; None with strings or a wall, which take from L; 0 head-on."""
    if model.strings or model.wall:
        return None
    if not model.oblique:
        return 0.0
    return abs(model.values("angular_momentum", flown.y, p)["angular_momentum"] - 1.0)


def _trajectory(
    scene: Scene, path: Path, flown: Flown, model: Model, n: Numbers, plugin: str, rtol: float
) -> xarray.Dataset:
    from ..engines.casadi.trajectory import attributes, dataset, stretch  # imports xarray

    attrs = attributes(scene, path.outcome, plugin, rtol)
    tolerance, p = told(rtol, plugin, n.groups), model.group_values(n.groups)
    pieces = [stretch(piece, model, flown, p, plugin, tolerance) for piece in flown.pieces]
    try:
        return dataset(pieces, model, n, flown.y, attrs)
    except ComputationError as error:
        raise n.in_si(error) from None
