"""Conversion of an engine's dimensionless results of one collision into a `Collision` in SI units."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ..model.dimensionless import Problem
from .outcome import Energy, Event
from .result import Collision

if TYPE_CHECKING:
    import xarray


def assembled(
    problem: Problem,
    *,
    outcome: str,
    reversal: str | None,
    certified: bool,
    outputs: Mapping[str, float],
    rotation: float,
    time: float,
    smallest_gap: float,
    final_gap: float,
    slip: float,
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
        outputs: the model's outputs at separation, by name; empty for a stick.
        rotation: angle turned by the line of centres until the end, rad.
        time: end of the trajectory (x0/v0): separation, or for a stick the end of integration.
        smallest_gap, final_gap: over x0.
        events: words, and times over x0/v0.
        terms: of the ledger, over m v0^2; None without one.
        momentum: L/L(0) at the end, with a ledger.
        decided: time (x0/v0) at which a stick was certain; None: at the end.

    Raises:
        ComputationError: the ledger of a pair that separates is open, as the trajectory is then wrong.
    """
    separated, scene = outcome != "stick", problem.scene
    end, energy = time * problem.time, None if terms is None else Energy.of(problem, terms)
    if energy is not None and separated:
        energy.check(rtol)
    torque = scene.pendulum is not None or (scene.wall and problem.oblique)
    drift = None if terms is None or torque else abs(momentum - 1.0) if problem.oblique else 0.0

    def rate(name: str) -> float | None:
        if not separated:
            return None
        return outputs[name] * problem.rate if problem.oblique else 0.0

    if scene.package is not None:  # which of the gaps of its group it is
        touched = {"rough": scene.package.touched(problem.groups)}
        reversal, events = touched.get(reversal or "", reversal), [(touched.get(word, word), at) for word, at in events]

    partner = "final_spin_partner" if "final_spin_partner" in outputs else "final_spin"
    return Collision(
        outcome=outcome,
        restitution=outputs["restitution"] if separated else 0.0,
        tangential_restitution=outputs["tangential_restitution"] if separated and problem.angle > 0 else None,
        slip_restitution=slip if separated and problem.oblique and math.isfinite(slip) else None,
        rotation=rotation if separated else None,
        contact_time=end if separated else None,
        smallest_gap=smallest_gap * problem.length if separated else None,
        final_spin=rate("final_spin"),
        final_spin_partner=0.0 if separated and scene.wall else rate(partner) if scene.pair else None,
        final_rotation_rate=rate("final_rotation_rate"),
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
        until=None if separated else end,
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
