"""Dimensionless groups of a collision, the scales for conversion to SI, and the generalised centrifugal number."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from ...generated import scaling
from ..errors import ComputationError
from ..scene.groups import groups_and_scales
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

    @classmethod
    def read(
        cls,
        scene: Scene | str | Path,
        stokes: float | str | None = None,
        speed: float | str | None = None,
        angle: float | str | None = None,
        relative_speed: float | str | None = None,
    ) -> Problem:
        """The collision of a scene, a file or a preset, with another impact where one is given."""
        loaded = Scene.load(scene).with_impact(stokes, speed, angle, relative_speed)
        return nondimensionalise(loaded, *loaded.need_impact())

    @cached_property
    def oblique(self) -> bool:
        """True if something moves sideways: the impact has an angle, or a sphere spins."""
        return any(self.groups.get(name, 0.0) != 0 for name in FIRST_RATES)

    def key(self, full: bool = False) -> ModelKey:
        """The smallest structure with its laws; `full`: with the spin as a state of its own, as for the ledger."""
        return select_model(self.scene, self.oblique, full, True, False)  # as a kernel asks: from one cache

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
        values: dict[str, float] = {}
        if "gap" in state:
            values |= {"gap": state["gap"] * self.length, "normal velocity": state["normal_velocity"] * self.speed}
        if "orbital_momentum" in state:
            ratio = self.groups.get("radius_ratio", 1.0)
            distance = (1 + ratio) ** 2 / ratio + self.groups["aspect"] * state["gap"]
            values["rotation rate"] = state["orbital_momentum"] / distance**2 * self.rate
        for name, label in (("spin", "spin"), ("partner_spin", "partner's spin")):
            if name in state:
                values[label] = state[name] * self.rate
        if "decay" in state:
            values["e-foldings of sliding"] = state["decay"]
        time = None if error.time is None else error.time * self.time
        return ComputationError(error.message, error.phase, time, values, error.advice)


def nondimensionalise(scene: Scene, speed: float, angle: float) -> Problem:
    """A scene's collision at normal speed `speed` (m/s) and `angle` (rad).

    A group exists if the scene has all its quantities; without an elastic criterion elastic_gap is 0.
    """
    groups, scales = groups_and_scales(scene, speed, angle)
    given = scene.impact.stokes  # it has no rounding of a conversion by the speed
    return Problem(
        scene=scene,
        groups=groups,
        angle=angle,
        speed=speed,
        length=scene.liquid.film_thickness,
        time=scales["time"],
        rate=groups["rate_scale"],
        energy=scales["energy"],
        stokes=given if given is not None and scene.speed_of(given) == speed else groups["stokes"],
        centrifugal=groups.get("centrifugal"),
        capillary=groups.get("capillary"),
        reynolds=groups.get("reynolds"),
    )
