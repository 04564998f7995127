"""Conversion of an engine's dimensionless results of one collision into a `Collision` in SI units."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ..model.dimensionless import DimensionlessGroups, generalised_centrifugal
from ..scene.scene import Scene
from .outcome import Energy, Event
from .result import Collision

if TYPE_CHECKING:
    import xarray


def assembled(
    scene: Scene,
    n: DimensionlessGroups,
    *,
    outcome: str,
    reversal: str | None,
    certified: bool,
    outputs: Mapping[str, float],
    rotation: float,
    time: float,
    smallest_gap: float,
    slip: float,
    events: Sequence[tuple[str, float]],
    engine: str,
    steps: int,
    rtol: float,
    energy: Energy | None = None,
    drift: float | None = None,
    trajectory: xarray.Dataset | None = None,
    decided: float | None = None,
) -> Collision:
    """The `Collision` in SI units; quantities that a stick leaves undefined are None.

    Arguments:
        outputs: the model's outputs at separation, by name; empty for a stick.
        rotation: angle turned by the line of centres until the end, rad.
        time: end of the trajectory (x0/v0): separation, or for a stick the end of integration.
        smallest_gap: over x0.
        events: words, and times over x0/v0.
        energy, trajectory: in SI units.
        drift: |L/L(0) - 1| at the end; None where the angular momentum L is not conserved.
        decided: time (x0/v0) at which a stick was certain; None: at the end.
    """
    separated = outcome != "stick"
    end = time * n.time

    def rate(name: str) -> float | None:
        if not separated:
            return None
        return outputs[name] * n.rate if n.oblique else 0.0

    partner = "final_spin_partner" if "final_spin_partner" in outputs else "final_spin"
    return Collision(
        outcome=outcome,
        restitution=outputs["restitution"] if separated else 0.0,
        tangential_restitution=outputs["tangential_restitution"] if separated and n.angle > 0 else None,
        slip_restitution=slip if separated and n.oblique and math.isfinite(slip) else None,
        rotation=rotation if separated else None,
        contact_time=end if separated else None,
        smallest_gap=smallest_gap * n.length if separated else None,
        final_spin=rate("final_spin"),
        final_spin_partner=0.0 if separated and scene.wall else rate(partner) if scene.pair else None,
        final_rotation_rate=rate("final_rotation_rate"),
        stokes=n.stokes,
        centrifugal=n.centrifugal,
        generalised_centrifugal=generalised_centrifugal(scene, n),
        capillary=n.capillary,
        reynolds=n.reynolds,
        speed=n.speed,
        angle=n.angle,
        reversal=reversal,
        certified=certified and not separated,
        until=None if separated else end,
        decided=None if separated else end if decided is None else decided * n.time,
        events=tuple(Event(kind, at * n.time) for kind, at in events),
        energy=energy,
        angular_momentum_drift=drift,
        engine=engine,
        steps=steps,
        rtol=rtol,
        scene=scene,
        trajectory=trajectory,
    )
