"""Quantities and dimensionless groups of a scene, by the emitted formulas."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any

from ...generated import scaling
from ..host import emitted
from .quantities import quantities
from .system import System

Formula = tuple[Callable[..., Any], tuple[str, ...]]
_VARIANTS = ("initial_rate_pair", "initial_rate_wall", "centrifugal_pair", "generalised_centrifugal")


def formulas(scene: System) -> dict[str, Formula]:
    """Emitted formulas by group or scale, each with the names of its arguments, for the scene's partner and laws.

    A formula takes floats or CasADi expressions.
    """
    found: dict[str, Formula] = {
        name: (getattr(scaling, name), arguments)
        for name, arguments in scaling.ARGUMENTS.items()
        if name not in _VARIANTS
    }
    if scene.wall:
        found["initial_rate"] = scaling.initial_rate_wall, scaling.ARGUMENTS["initial_rate_wall"]
        found["centrifugal"] = _nothing, ("surface_tension",)
    elif scene.partner is not None:
        for name in ("initial_rate", "centrifugal"):
            found[name] = getattr(scaling, f"{name}_pair"), scaling.ARGUMENTS[f"{name}_pair"]
    if scene.bridge is not None and scene.bridge.rupture == "own":
        law = law_module(scene, "bridge", scene.bridge.law)

        def own(reduced_radius: Any, film_thickness: Any, volume: Any, contact_angle: Any) -> Any:
            return 2 * reduced_radius * law.rupture_distance(volume, contact_angle) / film_thickness

        found["rupture_gap"] = own, scaling.ARGUMENTS["rupture_gap"]
    if scene.package is not None:
        found |= {name: (function, arguments) for name, (arguments, function) in scene.package.groups.items()}
    return found


def _nothing(surface_tension: Any) -> Any:
    """Ce with a wall: 0, as there is no line of centres that rotates."""
    return 0 * surface_tension


def law_module(scene: System, slot: str, name: str) -> Any:
    """The emitted module of a law, from the library or the user's model."""
    if scene.package is not None and name in scene.package.laws(slot):
        return scene.package.law(slot, name)
    return emitted.law(slot, name)


def si_values(scene: System, speed: float | None, angle: float | None) -> dict[str, float]:
    """The scene's quantities by vocabulary name, SI; speed and angle only if given."""
    impact = {"speed": speed, "angle": angle}
    return _without_impact(scene) | {name: value for name, value in impact.items() if value is not None}


@lru_cache(maxsize=64)
def _without_impact(scene: System) -> dict[str, float]:
    return quantities({name: value for name, value in scene.si if not name.startswith("impact.")}, scene.ways)


@lru_cache(maxsize=64)
def scaled(group: str, scene: System, speed: float | None = None) -> float:
    """Return a group by its emitted formula; inf where a double overflows."""
    values = si_values(scene, speed, None)
    formula, arguments = formulas(scene)[group]
    try:
        return float(formula(*(values[name] for name in arguments)))
    except (OverflowError, ZeroDivisionError):
        return math.inf
