"""Quantities and dimensionless groups of a scene, by the emitted formulas."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from ...generated import scaling
from ..host import emitted
from .system import System
from .user_model import Package

Formula = tuple[Callable[..., Any], tuple[str, ...]]
_VARIANTS = (
    "initial_rate_pair", "centrifugal_pair", "generalised_centrifugal", "obliquity_pair", "obliquity_wall",
    "obliquity_space", "rate_scale_pair", "rate_scale_wall",
)  # fmt: skip


def formulas(scene: System) -> Mapping[str, Formula]:
    """Emitted formulas by group or scale, each with the names of its arguments, for the scene's partner and laws.

    A formula takes floats or CasADi expressions. Its arguments are quantities, or groups and scales before it.
    """
    own_law = scene.bridge.law if scene.bridge is not None and scene.bridge.rupture == "own" else None
    return _formulas(scene.wall, scene.pair, own_law, scene.package)


@lru_cache(maxsize=64)
def _formulas(wall: bool, pair: bool, law: str | None, package: Package | None) -> Mapping[str, Formula]:
    """The formulas; `law` is that of a bridge which ruptures at its law's own distance."""
    result: dict[str, Formula] = {
        name: (getattr(scaling, name), arguments)
        for name, arguments in scaling.ARGUMENTS.items()
        if name not in _VARIANTS
    }
    if wall:
        del result["initial_rate"], result["initial_partner_spin"]
        # no line of centres rotates
        result["centrifugal"] = (lambda surface_tension: 0 * surface_tension), ("surface_tension",)
    kind, more = ("wall", ()) if wall else ("pair", ("initial_rate", "centrifugal")) if pair else ("", ())
    for name in (*more, "obliquity", "rate_scale") if kind else ():
        result[name] = getattr(scaling, f"{name}_{kind}"), scaling.ARGUMENTS[f"{name}_{kind}"]
    formula, arguments = result["obliquity"]
    # 1 where it vanishes: nothing moves sideways then, and rates that are zero need some scale
    result["obliquity"] = (lambda *values: (scale := formula(*values)) + (scale == 0)), arguments
    if law is not None:
        rupture_distance = _law(package, "bridge", law).rupture_distance

        def law_rupture_gap(reduced_radius: Any, film_thickness: Any, volume: Any, contact_angle: Any) -> Any:
            return 2 * reduced_radius * rupture_distance(volume, contact_angle) / film_thickness

        result["rupture_gap"] = law_rupture_gap, scaling.ARGUMENTS["rupture_gap"]
    if package is not None:
        result |= {name: (function, arguments) for name, (arguments, function) in package.groups.items()}
    return result


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


def sideways(scene: System, angle: np.ndarray, varied: Mapping[str, Any]) -> np.ndarray:
    """Mask of the collisions in which something moves sideways: the impact has an angle (rad), or a sphere spins.

    Arguments:
        varied: quantities by vocabulary name that replace the scene's, SI.
    """
    moves: np.ndarray = angle > 0
    for name in ("impact_spin", "impact_partner_spin"):
        spin = varied.get(name, scene.material.get(name, 0.0))
        if np.any(spin):
            moves = moves | (np.asarray(spin) != 0)
    return moves


def rate_scales(scene: System, quantities: Mapping[str, Any]) -> np.ndarray:
    """The scale of angular velocities of each collision, rad/s, from quantities by vocabulary name, SI."""
    values = dict(quantities)
    for name in ("obliquity", "rate_scale"):
        formula, arguments = formulas(scene)[name]
        values[name] = np.asarray(formula(*(values[each] for each in arguments))).reshape(-1)  # of arrays a DM
    scales: np.ndarray = values["rate_scale"]
    return scales


def scaled(group: str, scene: System, speed: float | None = None) -> float:
    """Return a group by its emitted formula; inf where a double overflows."""
    values = si_values(scene, speed, None)
    formula, arguments = formulas(scene)[group]
    try:
        return float(formula(*(values[name] for name in arguments)))
    except (OverflowError, ZeroDivisionError):
        return math.inf
