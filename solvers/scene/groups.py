"""Quantities and dimensionless groups of a scene, by the emitted formulas."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

from ...generated import scaling
from ..host import emitted
from .system import System
from .user_model import Package

Formula = tuple[Callable[..., Any], tuple[str, ...]]
_VARIANTS = ("initial_rate_pair", "initial_rate_wall", "centrifugal_pair", "generalised_centrifugal")


def formulas(scene: System) -> Mapping[str, Formula]:
    """Emitted formulas by group or scale, each with the names of its arguments, for the scene's partner and laws.

    A formula takes floats or CasADi expressions.
    """
    own = scene.bridge.law if scene.bridge is not None and scene.bridge.rupture == "own" else None
    return _formulas(scene.wall, scene.partner is not None, own, scene.package)


@lru_cache(maxsize=64)
def _formulas(wall: bool, pair: bool, law: str | None, package: Package | None) -> Mapping[str, Formula]:
    """The formulas; `law` is that of a bridge which ruptures at its law's own distance."""
    found: dict[str, Formula] = {
        name: (getattr(scaling, name), arguments)
        for name, arguments in scaling.ARGUMENTS.items()
        if name not in _VARIANTS
    }
    if wall:
        found["initial_rate"] = scaling.initial_rate_wall, scaling.ARGUMENTS["initial_rate_wall"]
        found["centrifugal"] = _nothing, ("surface_tension",)
    elif pair:
        for name in ("initial_rate", "centrifugal"):
            found[name] = getattr(scaling, f"{name}_pair"), scaling.ARGUMENTS[f"{name}_pair"]
    if law is not None:
        rupture_distance = _law(package, "bridge", law).rupture_distance

        def own(reduced_radius: Any, film_thickness: Any, volume: Any, contact_angle: Any) -> Any:
            return 2 * reduced_radius * rupture_distance(volume, contact_angle) / film_thickness

        found["rupture_gap"] = own, scaling.ARGUMENTS["rupture_gap"]
    if package is not None:
        found |= {name: (function, arguments) for name, (arguments, function) in package.groups.items()}
    return found


def _nothing(surface_tension: Any) -> Any:
    """Ce with a wall: 0, as there is no line of centres that rotates."""
    return 0 * surface_tension


def law_module(scene: System, slot: str, name: str) -> Any:
    """The emitted module of a law, from the library or the user's model."""
    return _law(scene.package, slot, name)


def _law(package: Package | None, slot: str, name: str) -> Any:
    if package is not None and name in package.laws(slot):
        return package.law(slot, name)
    return emitted.law(slot, name)


def si_values(scene: System, speed: float | None, angle: float | None) -> dict[str, float]:
    """The scene's quantities by vocabulary name, SI; speed and angle only if given."""
    impact = {"speed": speed, "angle": angle}
    return {**scene.material, **{name: value for name, value in impact.items() if value is not None}}


def scaled(group: str, scene: System, speed: float | None = None) -> float:
    """Return a group by its emitted formula; inf where a double overflows."""
    values = si_values(scene, speed, None)
    formula, arguments = formulas(scene)[group]
    try:
        return float(formula(*(values[name] for name in arguments)))
    except (OverflowError, ZeroDivisionError):
        return math.inf
