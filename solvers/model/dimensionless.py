"""Dimensionless groups of a collision, the scales for conversion to SI, and the generalised centrifugal number."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...generated import scaling
from ..errors import ComputationError, InputError
from ..scene.contact import GAPS
from ..scene.groups import Formula, formulas, si_values
from ..scene.scene import Scene
from .key import ModelKey
from .model import Model, load, select_model

FIRST_RATES = ("initial_turning", "initial_spin", "initial_partner_spin")


@dataclass(frozen=True)
class Problem:
    """One collision as engines take it: groups by name, and the SI scales of length, time, angular velocity and energy.

    `centrifugal` and `capillary` are None without a bridge, `reynolds` without the liquid's density.
    """

    scene: Scene
    groups: dict[str, float]
    angle: float  # rad
    speed: float  # m/s
    length: float  # x0, m
    time: float  # x0/v0, s
    rate: float  # scale of angular velocities, rad/s: v0 T/(4a), omega0 without spins; beside a wall v0 T/a
    energy: float  # m v0^2, J
    stokes: float
    centrifugal: float | None
    capillary: float | None
    reynolds: float | None

    @cached_property
    def oblique(self) -> bool:
        """True if something moves sideways: the impact has an angle, or a sphere spins."""
        return any(self.groups.get(name, 0.0) != 0 for name in FIRST_RATES)

    def key(self, full: bool = False) -> ModelKey:
        """The smallest structure with its laws; `full`: with the spin as a state of its own, as for the ledger."""
        return select_model(self.scene, self.oblique, full, fold=True)

    def model(self, full: bool = False) -> Model:
        """The model of `key`."""
        return load(self.key(full))

    @property
    def generalised_centrifugal(self) -> float | None:
        """Ce_F = m omega0^2 a/F(x0), F the sum of all attractions at initial contact; None without attraction.

        It is 0 head-on and with a wall, where no line of centres rotates.
        """
        scene = self.scene
        if scene.bridge is None and scene.attraction is None:
            return None
        chosen = select_model(scene, oblique=False)
        free = chosen.structure.replace("_strings", "")  # strings pull inward but are not a cohesive force
        model = load(ModelKey(free, tuple(law for law in chosen.laws if law[0] != "strings"), chosen.package))
        p = model.group_values(self.groups)
        still = np.array([1.0, 0.0, *(model.start(p)[2:] if len(model.state) > 2 else ())])
        force = model.values("inward_force", still, p)["inward_force"] * self.energy / self.length
        if not force > 0:
            return None
        rate = 0.0 if scene.wall else self.groups["initial_rate"]
        return float(scaling.generalised_centrifugal(scene.reduced_radius, scene.reduced_mass, rate, force))

    def in_si(self, error: ComputationError) -> ComputationError:
        """A `ComputationError` with dimensionless time and state, converted to SI units; one that is in SI as it is."""
        if "normal velocity" in error.state:
            return error
        state = dict(error.state)
        shown: dict[str, float] = {}
        if "gap" in state:
            shown |= {"gap": state["gap"] * self.length, "normal velocity": state["normal_velocity"] * self.speed}
        if "orbital_momentum" in state:
            ratio = self.groups.get("radius_ratio", 1.0)
            distance = (1 + ratio) ** 2 / ratio + self.groups["aspect"] * state["gap"]
            shown["rotation rate"] = state["orbital_momentum"] / distance**2 * self.rate
        for name, label in (("spin", "spin"), ("partner_spin", "partner's spin")):
            if name in state:
                shown[label] = state[name] * self.rate
        if "decay" in state:
            shown["e-foldings of sliding"] = state["decay"]
        time = None if error.time is None else error.time * self.time
        return ComputationError(error.message, error.phase, time, shown, error.advice)


def _as_given(scene: Scene, speed: float, stokes: float) -> float:
    """The impact's Stokes number if given, which avoids the rounding of a conversion by the speed."""
    entry = scene.impact.stokes
    return entry if entry is not None and scene.speed_of(entry) == speed else stokes


_ENTRIES = {"speed": "impact.speed", "impact_spin": "impact.spin", "impact_partner_spin": "impact.partner_spin"}
# Ranges of groups and scales in which products and quotients of several stay within a double's range. Divisors have a
# lower limit.
_RANGES = (
    dict.fromkeys(("adhesion", "weight", "obliquity"), (0.0, 1e100))
    | dict.fromkeys(("stokes", "aspect", "capillary", "string_ratio", "rupture_gap"), (1e-100, 1e100))
    | dict.fromkeys(("time", "energy"), (1e-300, 1e300))
)
_SCALES: dict[str, Formula] = {
    "time": (lambda film_thickness, speed: film_thickness / speed, ("film_thickness", "speed")),
    "energy": (lambda mass, speed: mass * speed * speed, ("reduced_mass", "speed")),
}


def _finite(name: str, formula: Formula, values: Mapping[str, float]) -> float:
    """A group or scale by its formula; InputError outside its range in `_RANGES`."""
    function, arguments = formula
    inputs = [values[argument] for argument in arguments]
    try:
        value = float(function(*inputs))
    except (OverflowError, ZeroDivisionError):
        value = math.inf
    least, most = _RANGES.get(name, (0.0, math.inf))
    if least <= abs(value) <= most and math.isfinite(value):
        return value
    numbers = dict(zip(arguments, inputs, strict=True))
    spins = [spin for spin in ("impact_spin", "impact_partner_spin") if numbers.get(spin)]
    quantity = spins[0] if spins else "speed" if "speed" in arguments else arguments[0]
    entry, shown = _ENTRIES.get(quantity, quantity), numbers[quantity]
    kind = "scale" if name in _SCALES else "number"
    span = "within a double's range" if most == math.inf else f"from {least:g} to {most:g}"
    raise InputError(entry, shown, f"quantities whose {name.replace('_', ' ')} {kind} is {span}", "is too far off")


def nondimensionalise(scene: Scene, speed: float, angle: float) -> Problem:
    """A scene's collision at normal speed `speed` (m/s) and `angle` (rad).

    A group exists if the scene has all its quantities; without an elastic criterion elastic_gap is 0.
    """
    values = dict(si_values(scene, speed, angle))
    plain = (
        "dry_restitution", "friction", "contact_tangential_restitution", "volume", "contact_angle", "radius_ratio",
        "mass_ratio",
    )  # fmt: skip
    groups: dict[str, float] = {name: values[name] for name in plain if name in values}
    if scene.package is not None:
        scene.package.demand(scene.entries)
        groups |= {name: values[name] for name in scene.package.plain}
    groups |= dict.fromkeys(GAPS.values(), 0.0)
    for name, formula in formulas(scene).items():
        if all(map(values.__contains__, formula[1])):
            groups[name] = values[name] = _finite(name, formula, values)
    x0 = scene.liquid.film_thickness
    scales = {name: _finite(name, formula, values) for name, formula in _SCALES.items()}
    return Problem(
        scene=scene,
        groups=groups,
        angle=angle,
        speed=speed,
        length=x0,
        time=scales["time"],
        rate=groups["rate_scale"],
        energy=scales["energy"],
        stokes=_as_given(scene, speed, groups["stokes"]),
        centrifugal=groups.get("centrifugal"),
        capillary=groups.get("capillary"),
        reynolds=groups.get("reynolds"),
    )
