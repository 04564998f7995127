"""Pairs that collide: checked vectors, masses and radii, and the motion relative to the centre of mass."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from numbers import Real
from typing import Any

import numpy as np

from ....generated.automaton import TURNLESS
from ...engines.taylor.call import KernelImpacts
from ...errors import InputError
from ...scene.scene import Scene
from ...scene.units import quantity
from ...scene.values import array, scalar

AXES = ("x", "y", "z")


def components(**vectors: np.ndarray) -> dict[str, np.ndarray]:
    """Components by the names of quantities, from vectors along the last axis."""
    return {f"{name}_{axis}": rows[..., k] for name, rows in vectors.items() for k, axis in enumerate(AXES)}


def dot(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Scalar products of vectors along the last axis, kept as an axis of length 1."""
    products: np.ndarray = np.sum(first * second, axis=-1, keepdims=True)
    return products


def length(vectors: np.ndarray) -> np.ndarray:
    """Lengths of vectors along the last axis."""
    lengths: np.ndarray = np.sqrt(np.sum(vectors * vectors, axis=-1))
    return lengths


@dataclass(frozen=True)
class Bodies:
    """Masses, radii and moments of inertia of a scene's two spheres, SI; beside a wall the second has none."""

    mass: tuple[float, float]
    radius: tuple[float, float]

    @property
    def inertia(self) -> tuple[float, float]:
        """Moments of inertia about a diameter, kg m^2."""
        first, second = (0.4 * mass * radius**2 for mass, radius in zip(self.mass, self.radius, strict=True))
        return first, second

    @property
    def reduced_mass(self) -> float:
        return self.mass[0] * self.mass[1] / (self.mass[0] + self.mass[1])

    @classmethod
    def of(cls, scene: Scene) -> Bodies:
        return cls.made_of(scene.material)

    @classmethod
    def made_of(cls, quantities: Mapping[str, Any]) -> Bodies:
        """The spheres of these quantities by vocabulary name, numbers or columns, SI."""
        names = ("reduced_radius", "reduced_mass", "radius_ratio", "mass_ratio")
        a, m, size, weight = (quantities[name] for name in names)
        return cls((m * (1 + weight) / weight, m * (1 + weight)), (a * (1 + size) / size, a * (1 + size)))


@dataclass(frozen=True)
class Pairs:
    """Pairs at initial contact, one a row, SI.

    Attributes:
        shape: of the request, whose rows these are.
        normal: (pairs, 3), unit vectors from the first particle to the second, or to the wall; one without a direction
            as it is given.
        velocities: (pairs, 2, 3), of the centres; the second beside a wall is the wall's.
        spins: (pairs, 2, 3); the second beside a wall is zero.
    """

    scene: Scene
    shape: tuple[int, ...]
    normal: np.ndarray
    velocities: np.ndarray
    spins: np.ndarray

    @property
    def size(self) -> int:
        return int(self.normal.shape[0])

    @property
    def distance(self) -> float:
        """Distance of the centres at initial contact, m."""
        return sum(Bodies.of(self.scene).radius) + float(self.scene.material["film_thickness"])

    @cached_property
    def turning(self) -> np.ndarray:
        """Angular velocity of the line of centres at initial contact, rad/s."""
        rates: np.ndarray = np.cross(self.normal, self.sliding) / self.distance
        return rates

    @cached_property
    def impacts(self) -> KernelImpacts:
        """The pairs as the kernel in space takes them."""
        others = components(
            initial_normal=self.normal,
            impact_turning=self.turning,
            impact_spin=self.spins[:, 0],
            impact_partner_spin=self.spins[:, 1],
        )
        return KernelImpacts(self.scene, -self.opening, np.zeros(self.size), others)

    @cached_property
    def opening(self) -> np.ndarray:
        """Normal component of the relative velocity, negative on approach, m/s."""
        velocity: np.ndarray = dot(self.normal, self.velocities[:, 1] - self.velocities[:, 0])[:, 0]
        return velocity

    @cached_property
    def sliding(self) -> np.ndarray:
        """Relative velocity of the second centre, or of the wall, across the line of centres, m/s.

        What rounding alone may have made is zero: a head-on collision is one in every direction.
        """
        relative = self.velocities[:, 1] - self.velocities[:, 0]
        across = relative - dot(self.normal, relative) * self.normal
        largest = np.max(np.abs(self.velocities), axis=(1, 2))
        velocity: np.ndarray = np.where((length(across) > TURNLESS * largest)[:, None], across, 0.0)
        return velocity

    @cached_property
    def head_on(self) -> np.ndarray:
        """Mask of pairs of spheres in which nothing moves across the line of centres: head-on, with or without twist.

        No torque acts on twist, so that the line never turns. What rounding alone may have made is nothing.
        """
        radii = np.array(Bodies.of(self.scene).radius)[:, None]
        twists = dot(self.spins, self.normal[:, None]) * self.normal[:, None]
        across = np.concatenate([self.sliding[:, None], radii * (self.spins - twists)], axis=1)
        fastest = np.max(length(np.concatenate([self.sliding[:, None], radii * self.spins], axis=1)), axis=1)
        mask: np.ndarray = np.max(length(across), axis=1) <= TURNLESS * fastest
        return mask

    def subset(self, which: np.ndarray) -> Pairs:
        rows = (self.normal[which], self.velocities[which], self.spins[which])
        return Pairs(self.scene, rows[0].shape[:1], *rows)


def without_spins(scene: Scene, own_spins: bool = False) -> Scene:
    """The scene without spins of its own; equal spheres keep one state for both unless each has its own."""
    changes = dict.fromkeys((["impact.spin"] if scene.impact.spin else []) + ["impact.partner_spin"] * own_spins, 0.0)
    return scene.with_entries(changes) if changes else scene


def spin_energy(pairs: Pairs, spins: np.ndarray) -> np.ndarray:
    """Kinetic energies of spins (pairs, 2, 3), J."""
    energies: np.ndarray = np.sum(np.array(Bodies.of(pairs.scene).inertia) * length(spins) ** 2, axis=1) / 2
    return energies


def checked(scene: Scene, normal: Any, velocities: Any, spins: Any) -> Pairs:
    """The pairs of a request, broadcast against each other; InputError for a wrong shape."""
    directions = _numbers("normal", normal, (3,), "three components")
    wall = scene.wall
    either = "(..., 1, 3), or (..., 2, 3) with the wall's velocity" if wall else "(..., 2, 3)"
    moving = _numbers("velocities", velocities, (1 if wall else 2, 3), either, more=(2, 3) if wall else None)
    turning = _numbers("spins", spins, (1 if wall else 2, 3), "(..., 1, 3): a wall has no spin" if wall else either)
    if wall:
        still = np.zeros((*turning.shape[:-2], 1, 3))
        turning = np.concatenate([turning, still], axis=-2)
        if moving.shape[-2] == 1:
            moving = np.concatenate([moving, np.zeros((*moving.shape[:-2], 1, 3))], axis=-2)
    try:
        shape = np.broadcast_shapes(directions.shape[:-1], moving.shape[:-2], turning.shape[:-2])
    except ValueError:
        shapes = f"{directions.shape}, {moving.shape} and {turning.shape}"
        accepted = "normal (..., 3), velocities and spins (..., 2, 3) whose leading shapes broadcast"
        raise InputError("normal, velocities, spins", shapes, accepted, "have shapes that do not fit") from None
    count = int(np.prod(shape))
    rows = np.broadcast_to(directions, (*shape, 3)).reshape(count, 3)
    largest = np.max(np.abs(rows), axis=1, initial=0.0, keepdims=True)
    directed = (largest > 0) & np.isfinite(largest)
    with np.errstate(all="ignore"):
        scaled = rows / largest  # no square overflows
        rows = np.where(directed, scaled / length(scaled)[:, None], rows)
    return Pairs(
        scene,
        shape,
        np.ascontiguousarray(rows),
        np.array(np.broadcast_to(moving, (*shape, 2, 3)).reshape(count, 2, 3)),
        np.array(np.broadcast_to(turning, (*shape, 2, 3)).reshape(count, 2, 3)),
    )


_UNITS = {"normal": "m", "velocities": "m/s", "spins": "rad/s"}


@dataclass(frozen=True)
class _Component:
    """A component of a vector, as `values.array` takes entries: NaN and inf pass, since they mark a pair."""

    unit: str
    accepts: str

    def number(self, raw: object, *, label: str | None = None) -> float:
        if isinstance(raw, Real) and not isinstance(raw, bool):
            return float(raw)
        if isinstance(raw, str):
            return quantity(raw, self.unit, label or "", self.accepts)
        number = scalar(raw, self, label or "")
        if not isinstance(number, float):
            raise InputError(label or "", raw, self.accepts, "is not a number")
        return number


def _numbers(
    name: str, values: Any, last: tuple[int, ...], accepted: str, more: tuple[int, ...] | None = None
) -> np.ndarray:
    shaped = f"numbers of shape {accepted}, SI or with their unit"
    numbers = array(values, _Component(_UNITS[name], shaped), name)
    shapes = {last, more} - {None}
    if not any(numbers.shape[-len(shape) :] == shape for shape in shapes if shape):
        raise InputError(name, f"an array of shape {numbers.shape}", accepted, "has another shape")
    return numbers
