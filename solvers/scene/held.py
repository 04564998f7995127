"""The quantity of an impact that is held while other entries of its scene vary: a speed, or the Stokes number."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ..host.arguments import check_name
from .schema import SPEEDS

if TYPE_CHECKING:
    from .groups import System  # imports casadi, which the check of an option does without

HOLDS = ("speed", "stokes", "relative_speed")
NAMES = {"speed": "normal speed", "stokes": "Stokes number", "relative_speed": "relative speed"}
"""What each is called in texts."""
AXIS_LABELS = {
    "speed": "normal speed (m/s)",
    "stokes": "Stokes number $St_n$",
    "relative_speed": "relative speed (m/s)",
}


def check_hold(hold: object, label: str = "hold") -> str:
    """The held quantity, one of `HOLDS`; InputError otherwise."""
    return check_name(hold, HOLDS, label)


def held_quantity(scene: System, hold: object) -> str:
    """The held quantity; None means the relative speed where the scene gives that, else the normal speed."""
    if hold is not None:
        return check_hold(hold)
    return "speed" if scene.impact.relative_speed is None else "relative_speed"


def impact_quantity(scene: System) -> str | None:
    """Which of `HOLDS` the scene gives; None without an impact's speed."""
    names = (name.partition(".")[2] for name in SPEEDS)
    return next((name for name in names if getattr(scene.impact, name) is not None), None)


def impact_value(scene: System, quantity: str) -> float | None:
    """The impact's Stokes number, normal speed or relative speed (m/s), however the scene gives it."""
    if quantity != "relative_speed":
        return scene.stokes if quantity == "stokes" else scene.speed
    if scene.impact.relative_speed is not None or scene.speed is None or scene.impact.angle is None:
        return scene.impact.relative_speed
    return scene.speed / math.cos(scene.impact.angle)


def adjusted_impact(before: System, after: System, quantity: str, hold: str) -> tuple[float, str]:
    """The number by which `after` gives its impact if `hold` keeps the value it has in `before`, and a remark on it.

    The remark is empty where neither speed nor Stokes number changes.

    Arguments:
        quantity: in which both scenes give their impact.
    """
    ratios = {name: _per_speed(before, name) / _per_speed(after, name) for name in HOLDS}
    number = float(getattr(before.impact, quantity)) * ratios[hold] / ratios[quantity]
    if ratios[hold] == ratios[quantity] and ratios["stokes"] == 1:
        return number, ""
    other = "speed" if hold == "stokes" else "stokes"
    old, remark = impact_value(before, other), held_text(before, hold)
    if old is not None:
        remark += f"; {NAMES[other]} {old:.4g} -> {old * ratios[hold] / ratios[other]:.4g}{_unit(other)}"
    return number, remark


def _per_speed(scene: System, quantity: str) -> float:
    """The value of a quantity at a normal speed of 1 m/s."""
    if quantity == "relative_speed":
        return 1.0 if scene.impact.angle is None else 1 / math.cos(scene.impact.angle)
    return scene.stokes_per_speed if quantity == "stokes" else 1.0


def _unit(quantity: str) -> str:
    return "" if quantity == "stokes" else " m/s"


def held_text(scene: System, quantity: str) -> str:
    """What is held while entries vary, in words."""
    value = impact_value(scene, quantity)
    return f"held: {NAMES[quantity]}" + ("" if value is None else f" {value:.4g}{_unit(quantity)}")
