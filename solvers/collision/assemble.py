"""Conversion of an engine's dimensionless findings for one collision into a `Collision` in SI units."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..model.cohesion import generalised_centrifugal
from ..model.dimensionless import DimensionlessGroups
from ..scene.scene import Scene
from .outcome import Energy, Event
from .result import Collision

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Finding:
    """An engine's findings: times in x0/v0, gaps in x0, rates in their scale; the ledger and the trajectory are in SI.

    Arguments:
        outputs: the model's outputs at separation, by name; empty for a stick.
        rotation: angle turned by the line of centres until the end, rad.
        time: end of the trajectory: separation, or for a stick the end of integration.
        decided: time at which a stick was certain; None: at the end.
        rtol: relative tolerance that was asked for.
        drift: |L/L(0) - 1| at the end; None where the angular momentum L is not conserved.
    """

    outcome: str
    reversal: str | None
    certified: bool
    outputs: Mapping[str, float]
    rotation: float
    time: float
    smallest_gap: float
    slip: float
    events: Sequence[tuple[str, float]]
    engine: str
    steps: int
    rtol: float
    energy: Energy | None = None
    drift: float | None = None
    trajectory: xarray.Dataset | None = None
    decided: float | None = None


def assembled(scene: Scene, n: DimensionlessGroups, found: Finding) -> Collision:
    """The `Collision` in SI units; quantities that a stick leaves undefined are None."""
    separated = found.outcome != "stick"
    time = found.time * n.time

    def rate(name: str) -> float | None:
        if not separated:
            return None
        return found.outputs[name] * n.rate if n.oblique else 0.0

    return Collision(
        outcome=found.outcome,
        restitution=found.outputs["restitution"] if separated else 0.0,
        tangential_restitution=found.outputs["tangential_restitution"] if separated and n.angle > 0 else None,
        slip_restitution=found.slip if separated and n.oblique and math.isfinite(found.slip) else None,
        rotation=found.rotation if separated else None,
        contact_time=time if separated else None,
        smallest_gap=found.smallest_gap * n.length if separated else None,
        final_spin=rate("final_spin"),
        final_spin_partner=partner_spin(scene, rate("final_spin"), found.outputs, n),
        final_rotation_rate=rate("final_rotation_rate"),
        stokes=n.stokes,
        centrifugal=n.centrifugal,
        generalised_centrifugal=generalised_centrifugal(scene, n),
        capillary=n.capillary,
        reynolds=n.reynolds,
        speed=n.speed,
        angle=n.angle,
        reversal=found.reversal,
        certified=found.certified and not separated,
        until=None if separated else time,
        decided=None if separated else time if found.decided is None else found.decided * n.time,
        events=tuple(Event(kind, at * n.time) for kind, at in found.events),
        energy=found.energy,
        angular_momentum_drift=found.drift,
        engine=found.engine,
        steps=found.steps,
        rtol=found.rtol,
        scene=scene,
        trajectory=found.trajectory,
    )


def partner_spin(scene: Scene, own: float | None, outputs: Mapping[str, float], n: DimensionlessGroups) -> float | None:
    """Spin of the partner, rad/s: its own output, that of an equal sphere, or 0 for a wall."""
    if own is None or not (scene.pair or scene.wall):
        return None
    if scene.wall:
        return 0.0
    return outputs["final_spin_partner"] * n.rate if n.oblique and "final_spin_partner" in outputs else own
