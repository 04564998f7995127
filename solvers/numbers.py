"""A collision in dimensionless numbers: the groups its model takes, and the scales that lead back to SI."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..generated import scaling
from .errors import ComputationError, InputError

if TYPE_CHECKING:
    from .scene import Scene


@dataclass(frozen=True)
class Numbers:
    """Groups by name, and the SI scales of length, time, angular velocity and energy.

    `centrifugal` and `capillary` are None without a bridge, `reynolds` without the liquid's density.
    """

    groups: dict[str, float]
    angle: float  # rad
    speed: float  # m/s
    length: float  # x0, m
    time: float  # x0/v0, s
    rate: float  # omega0, rad/s
    energy: float  # m v0^2, J
    stokes: float
    centrifugal: float | None
    capillary: float | None
    reynolds: float | None

    @property
    def oblique(self) -> bool:
        return self.groups["obliquity"] > 0

    def in_si(self, error: ComputationError) -> ComputationError:
        """A failure in dimensionless time and state, in SI units."""
        state = dict(error.state)
        shown: dict[str, float] = {}
        if "gap" in state:
            shown |= {"gap": state["gap"] * self.length, "opening velocity": state["opening"] * self.speed}
        if "orbit" in state:
            shown["rotation rate"] = state["orbit"] / (4 + self.groups["aspect"] * state["gap"]) ** 2 * self.rate
        if "spin" in state:
            shown["spin"] = state["spin"] * self.rate
        time = None if error.time is None else error.time * self.time
        return ComputationError(error.message, error.phase, time, shown, error.advice)


def si_values(scene: Scene, speed: float | None, angle: float | None) -> dict[str, float]:
    """The scene's quantities under the vocabulary's names, SI; those of the impact as far as they are given."""
    particles, liquid = scene.particles, scene.liquid
    values = {
        "reduced_radius": particles.reduced_radius,
        "reduced_mass": particles.reduced_mass,
        "roughness": particles.roughness,
        "dry_restitution": particles.dry_restitution,
        "viscosity": liquid.viscosity,
        "film_thickness": liquid.film_thickness,
        "glass_transition_pressure": liquid.glass_transition_pressure,
    }
    values |= {name: value for name, value in (("speed", speed), ("angle", angle)) if value is not None}
    if particles.youngs_modulus is not None and particles.poisson_ratio is not None:
        values |= {"youngs_modulus": particles.youngs_modulus, "poisson_ratio": particles.poisson_ratio}
    if liquid.density is not None:
        values["density"] = liquid.density
    if scene.bridge is not None:
        bridge = scene.bridge
        values |= {
            "surface_tension": bridge.surface_tension,
            "volume": bridge.volume,
            "contact_angle": bridge.contact_angle,
        }
    if scene.pendulum is not None:
        values |= {"string_length": scene.pendulum.length, "gravity": scene.pendulum.gravity}
    if scene.package is not None:
        own = {f"custom.{name}": name for name in scene.package.quantities}
        values |= {own[entry]: float(value) for entry, value in scene.si if entry in own}
    return values


def group_functions(scene: Scene) -> dict[str, tuple[tuple[str, ...], Callable[..., Any]]]:
    """Every group and scale of a scene: name -> the quantities that it takes, in order, and its emitted formula."""
    found = {name: (arguments, getattr(scaling, name)) for name, arguments in scaling.ARGUMENTS.items()}
    return found if scene.package is None else found | scene.package.groups


def _finite(name: str, arguments: tuple[str, ...], function: Callable[..., Any], values: Mapping[str, float]) -> float:
    """A group by its emitted formula; InputError where it leaves the range of a double."""
    given = [values[argument] for argument in arguments]
    try:
        value = float(function(*given))
    except (OverflowError, ZeroDivisionError):
        value = math.inf
    if math.isfinite(value):
        return value
    entry = "impact.speed" if "speed" in arguments else arguments[0]
    shown = dict(zip(arguments, given, strict=True)).get("speed", given[0])
    raise InputError(entry, shown, f"quantities whose {name} number is within a double's range", "is too far off")


def numbers(scene: Scene, speed: float, angle: float) -> Numbers:
    """Dimensionless numbers of a scene's collision at normal speed `speed` (m/s) and `angle` (rad).

    A group exists where the scene has what it is made of; an absent elastic criterion has elastic_gap 0.
    """
    values = si_values(scene, speed, angle)
    plain = ("dry_restitution", "volume", "contact_angle")
    groups: dict[str, float] = {name: values[name] for name in plain if name in values}
    if scene.package is not None:
        scene.package.demand(scene.entries)
        groups |= {name: values[name] for name in scene.package.plain}
    groups["elastic_gap"] = 0.0
    for name, (arguments, function) in group_functions(scene).items():
        if all(argument in values for argument in arguments):
            groups[name] = _finite(name, arguments, function, values)
    x0 = scene.liquid.film_thickness
    return Numbers(
        groups=groups,
        angle=angle,
        speed=speed,
        length=x0,
        time=x0 / speed,
        rate=groups["initial_rate"],
        energy=scene.particles.reduced_mass * speed**2,
        stokes=groups["stokes"],
        centrifugal=groups.get("centrifugal"),
        capillary=groups.get("capillary"),
        reynolds=groups.get("reynolds"),
    )
