"""Random arrivals in space at random scenes, and how far two ends of one collision are apart."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from .mechanics import PARTNER, SPIN, Arrival, N, Vector, W, X, at, plus
from .scanned import Outcome
from .two_bodies import Bodies

FASTEST = 5.0  # surface speed of a spin, over the approach speed
STEEPEST = 85.0  # degrees, of the direction of arrival
Numbers = dict[str, np.ndarray]


def _vector(values: np.ndarray) -> Vector:
    x, y, z = values.tolist()
    return x, y, z


def direction(draw: np.random.Generator) -> np.ndarray:
    """A unit vector of any direction."""
    found = draw.normal(size=3)
    return np.asarray(found / np.linalg.norm(found))


def arrivals(bodies: Bodies, speed: float, count: int, draw: np.random.Generator) -> list[Arrival]:
    """So many arrivals with this normal speed: any directions, a spin or the angle at times zero."""
    found = []
    for _ in range(count):
        normal = direction(draw)
        angle = 0.0 if draw.random() < 0.15 else math.radians(draw.uniform(0.0, STEEPEST))
        along = np.cross(normal, direction(draw))
        along *= speed * math.tan(angle) / np.linalg.norm(along)
        spins = [
            _vector(direction(draw) * (draw.random() > 0.15) * draw.uniform(0.0, FASTEST) * speed / radius)
            for radius in bodies.radii
        ]
        relative = along - speed * normal
        if bodies.wall:
            velocities = -relative, np.zeros(3)
        else:
            drift, share = direction(draw) * draw.uniform(0.0, 2.0) * speed, bodies.m / bodies.masses[0]
            velocities = drift - share * relative, drift + (1 - share) * relative
        found.append(Arrival(_vector(normal), (_vector(velocities[0]), _vector(velocities[1])), (spins[0], spins[1])))
    return found


def request(bodies: Bodies, arrived: Sequence[Arrival]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normals, velocities and spins as `collide_pair` takes them."""
    moving = 1 if bodies.wall else 2
    normals = np.array([each.normal for each in arrived])
    velocities = np.array([each.velocities for each in arrived])
    return normals, velocities, np.array([each.spins[:moving] for each in arrived])


def quantities(bodies: Bodies, arrival: Arrival, end: Outcome) -> Numbers:
    """What is compared of a reference's end, SI; nothing of a stick's."""
    if end.outcome == "stick":
        return {}
    y, moving = end.state, 1 if bodies.wall else 2
    share = 1.0 if bodies.wall else bodies.m / bodies.masses[0]
    centre = plus(arrival.velocities[0], share, arrival.relative)
    velocities = plus(centre, -share, at(y, W)), plus(centre, 1 - share, at(y, W))
    return {
        "restitution": np.array([end.restitution]), "time": np.array([end.time]), "gap": np.array([y[X]]),
        "normal": np.array(at(y, N)), "velocities": np.array(velocities[:moving]),
        "spins": np.array([at(y, SPIN), at(y, PARTNER)][:moving]),
    }  # fmt: skip


def differences(bodies: Bodies, arrival: Arrival, one: Mapping[str, np.ndarray], other: Numbers) -> dict[str, float]:
    """Of speeds over the largest at initial contact, of restitution, time and gap over themselves."""
    fast = arrival.speed + max(
        *(math.hypot(*each) for each in arrival.velocities),
        *(math.hypot(*spin) * radius for spin, radius in zip(arrival.spins, bodies.radii) if any(spin)),
        0.0,
    )
    radii = np.array([radius for radius in bodies.radii if math.isfinite(radius)])
    scale = {"normal": 1.0, "velocities": fast, "spins": (fast / radii)[:, None]}
    if other:
        scale |= {name: abs(float(other[name][0])) or 1.0 for name in ("time", "gap")}
        scale["restitution"] = max(1e-3, abs(float(other["restitution"][0])))
    return {
        name: float(np.max(np.abs(np.reshape(one[name], -1)[: value.size].reshape(value.shape) - value) / scale[name]))
        for name, value in other.items()
    }
