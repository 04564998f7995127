"""Values of entries in the units in which the scene gives them."""

from __future__ import annotations

from ..scene import units
from ..scene.scene import Scene


def unit_shown(scene: Scene, name: str) -> tuple[str, float]:
    """The unit in which the scene gives an entry, and its size in SI; empty and 1 for a plain number."""
    si = scene.fields[name].unit
    if scene.ways.volume == "absolute" and name == "bridge.volume":
        si = "m^3"
    if si is None:
        return "", 1.0
    raw = dict(scene.given).get(name)
    own = units.unit_of(raw) if isinstance(raw, str) else ""
    if own:
        return own, units.factor(own, si, name, si, raw)
    return si, 1.0


def in_unit(scene: Scene, name: str, value: float | None, digits: int = 4) -> str:
    """A value in SI as text with the scene's unit; a dash for none."""
    if value is None:
        return "-"
    unit, size = unit_shown(scene, name)
    return f"{value / size:.{digits}g} {unit}".strip()


def interval(scene: Scene, name: str, low: float | None, high: float | None) -> str:
    """An interval in the scene's unit, open ends in words."""
    unit, size = unit_shown(scene, name)
    if low is None and high is None:
        return "open at both ends"
    if low is None:
        return f"below {in_unit(scene, name, high)}"
    if high is None:
        return f"above {in_unit(scene, name, low)}"
    return f"{low / size:.4g} to {high / size:.4g} {unit}".strip()
