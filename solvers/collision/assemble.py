"""Conversion of an engine's dimensionless results of one collision into a `Collision` in SI units."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ...generated.automaton import STICK
from ..model.dimensionless import Problem
from ..results import DEFINITIONS, OF_SEPARATION
from .outcome import Energy, Event
from .result import Collision

if TYPE_CHECKING:
    import xarray

_OF_MOTION = tuple(DEFINITIONS[name] for name in (*OF_SEPARATION, "until"))


def assembled(
    problem: Problem,
    results: Mapping[str, float],
    *,
    outcome: str,
    reversal: str | None,
    certified: bool,
    time: float,
    final_gap: float,
    events: Sequence[tuple[str, float]],
    engine: str,
    steps: int,
    rtol: float,
    terms: Mapping[str, float] | None = None,
    momentum: float = 1.0,
    trajectory: xarray.Dataset | None = None,
    decided: float | None = None,
) -> Collision:
    """The `Collision` in SI units; quantities that a stick leaves undefined are None.

    Arguments:
        results: by name, over their scales; without the model's outputs for a stick, and without rates head-on.
        time: end of the trajectory (x0/v0): separation, or for a stick the end of integration.
        final_gap: over x0.
        events: words, and times over x0/v0.
        terms: of the ledger, over m v0^2; None without one.
        momentum: L/L(0) at the end, with a ledger.
        decided: time (x0/v0) at which a stick was certain; None: at the end.

    Raises:
        ComputationError: the ledger of a pair that separates is open, as the trajectory is then wrong.
    """
    separated, scene = outcome != STICK, problem.scene
    energy = None if terms is None else Energy.of(problem, terms)
    if energy is not None and separated:
        energy.check(rtol)
    torque = scene.pendulum is not None or (scene.wall and problem.oblique)
    drift = None if terms is None or torque else abs(momentum - 1.0) if problem.oblique else 0.0
    if scene.package is not None:  # which of the gaps of its group it is
        touched = {"rough": scene.package.touched(problem.groups)}
        reversal, events = touched.get(reversal or "", reversal), [(touched.get(word, word), at) for word, at in events]
    exists = {
        "all": True, "separated": separated, "sliding": separated and problem.angle > 0,
        "slipping": separated and problem.oblique, "stick": not separated,
    }  # fmt: skip
    results = {**results, "contact_time": time, "until": time}
    zero = {row.name for row in _OF_MOTION if row.scale == "rate" and not problem.oblique}  # nothing turns head-on
    zero |= {"final_spin_partner"} if separated else {"restitution"}
    values: dict[str, Any] = dict.fromkeys(row.name for row in _OF_MOTION)
    for row in _OF_MOTION:
        if exists[row.exists]:
            result = results.get(row.name, 0.0) if row.name in zero else results[row.name]
            value = result * (getattr(problem, row.scale) if row.scale else 1.0)
            if row.name != "slip_restitution" or math.isfinite(value):  # no other may be NaN
                values[row.name] = value
    if "final_spin_partner" not in results and not scene.wall:  # equal spheres spin alike
        values["final_spin_partner"] = values["final_spin"] if scene.pair else None
    end = time * problem.time
    return Collision(
        **values,
        outcome=outcome,
        final_gap=final_gap * problem.length if separated else None,
        stokes=problem.stokes,
        centrifugal=problem.centrifugal,
        generalised_centrifugal=problem.generalised_centrifugal,
        capillary=problem.capillary,
        reynolds=problem.reynolds,
        speed=problem.speed,
        angle=problem.angle,
        reversal=reversal,
        certified=certified and not separated,
        decided=None if separated else end if decided is None else decided * problem.time,
        events=tuple(Event(kind, at * problem.time) for kind, at in events),
        energy=energy,
        angular_momentum_drift=drift,
        engine=engine,
        steps=steps,
        rtol=rtol,
        scene=scene,
        trajectory=trajectory,
    )
