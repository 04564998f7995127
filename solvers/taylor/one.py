"""One collision by the kernel, as `collide` shows it."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from ..cohesion import generalised_centrifugal
from ..model import choose
from ..numbers import Numbers
from ..result import Collision, Event
from ..scene import Scene
from .engine import BUDGET, Impacts, flown
from .library import HAPPENING, MOST_EVENTS

_OUTCOMES = ("stick", "stick-rotate-separate", "bounce")
# In the order of runtime/queue.h; a stop at a half turn or where the rotation reverses is among them.
_KINDS = (
    "glass", "elastic", "rough", "turned", "fell back", "film edge", "tangential edge", "rests", "released", "rupture",
    "rotation reverses", "half turn",
)  # fmt: skip


def collision(
    scene: Scene, n: Numbers, rtol: float, rest: Collision | None = None, budget: int = BUDGET
) -> Collision | None:
    """The collision by the kernel; None if it hands it over, or there is none here.

    Arguments:
        rest: the same collision by an engine that integrates along what the kernel leaves out (energy ledger, drift of
            angular momentum, trajectory); without it they are None.
    """
    log = np.zeros((1, MOST_EVENTS), HAPPENING)
    impacts = Impacts(scene, np.array([n.speed]), np.array([n.angle]), {})
    answers = flown(impacts, n.oblique, rtol, True, log, budget)
    if answers is None or answers["status"][0] > 1 or answers["events"][0] > MOST_EVENTS:
        return None
    found = answers[0]
    happened = log[0, : found["events"]]
    separated = bool(found["outcome"])

    def shown(position: int, scale: float) -> float | None:
        if not separated:
            return None
        return float(found["shown"][position]) * scale if n.oblique else 0.0

    def partner_spin() -> float | None:
        if scene.wall:
            return 0.0 if separated else None
        unequal = choose(scene, n.oblique, fold=True).structure.startswith("oblique_pair")
        return shown(4 if unequal else 3, n.rate)

    time = float(found["time"]) * n.time
    values: dict[str, Any] = {
        "outcome": _OUTCOMES[found["outcome"]],
        "restitution": float(found["shown"][0]) if separated else 0.0,
        "tangential_restitution": shown(1, 1.0) if n.oblique else None,
        "rotation": float(found["turned"]) if separated else None,
        "contact_time": time if separated else None,
        "smallest_gap": float(found["smallest_gap"]) * n.length if separated else None,
        "final_rotation_rate": shown(2, n.rate),
        "final_spin": shown(3, n.rate),
        "final_spin_partner": None if scene.partner is None else partner_spin(),
        "reversal": _KINDS[found["reversal"]] if found["reversal"] >= 0 else None,
        "certified": bool(found["certified"]),
        "until": None if separated else time,
        "events": tuple(Event(_KINDS[int(each["kind"])], float(each["time"]) * n.time) for each in happened),
        "engine": "taylor",
        "steps": int(found["steps"]),
    }
    if rest is not None:
        return dataclasses.replace(rest, **values) if rest.outcome == values["outcome"] else None
    return Collision(
        **values,
        stokes=n.stokes,
        centrifugal=n.centrifugal,
        generalised_centrifugal=generalised_centrifugal(scene, n),
        capillary=n.capillary,
        reynolds=n.reynolds,
        speed=n.speed,
        angle=n.angle,
        energy=None,
        angular_momentum_drift=None,
        scene=scene,
    )
