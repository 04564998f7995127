"""From the end of a relative motion to both particles in the laboratory: what is conserved stays so to rounding."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ....generated.automaton import OUTCOMES, STICK
from ...engines.casadi.replay import Replay
from ...model.model import Model
from ...results import TERMS as OF_KERNEL
from ...scene.scene import Scene
from ..by_replay import terms_of
from ..outcome import absent_terms, open_beyond
from .pairs import Bodies, Pairs, dot, length

TERMS = tuple(name for name in OF_KERNEL if name != "strings")  # which hold the spheres in a plane
_INITIAL, _FINAL, _SHEAR = (TERMS.index(name) for name in ("initial", "final", "tangential_lubrication"))
OPEN = "the energy ledger is open: try a smaller rtol, or another engine"
GREW = "energy has grown: errors have added up over a long trajectory; try a smaller rtol, or another engine"
TRANSVERSE = [_INITIAL, _FINAL, _SHEAR]
"""Places of the terms to which motion across the line of centres contributes."""
_SHAPES = {"normal": (3,), "turning": (3,), "sliding": (3,), "spins": (2, 3), "energy": (len(TERMS),)}  # of others ()
FAILED = -1
_STICK = OUTCOMES.index(STICK)


@dataclass
class Ends:
    """Ends of collisions, a row each, SI; rows that nothing has been written to are NaN, and failed.

    Attributes:
        gap: of the surfaces, m.
        opening: normal relative velocity, m/s.
        time: of a stick, where its integration stopped, until `put_at_contact`.
        turning: angular velocity of the line of centres, rad/s.
        sliding: beside a wall, velocity along it relative to the wall, m/s.
        energy: terms of the ledger in the order of `TERMS`, J; NaN without one.
    """

    outcome: np.ndarray
    certified: np.ndarray
    reason: np.ndarray
    time: np.ndarray
    gap: np.ndarray
    opening: np.ndarray
    slip: np.ndarray
    normal: np.ndarray
    turning: np.ndarray
    sliding: np.ndarray
    spins: np.ndarray
    energy: np.ndarray

    @classmethod
    def blank(cls, size: int) -> Ends:
        """Ends of which nothing is known."""
        numbers = {entry.name: np.full((size, *_SHAPES.get(entry.name, ())), np.nan) for entry in fields(cls)}
        codes = {"outcome": np.full(size, FAILED, np.int8), "certified": np.zeros(size, bool)}
        return cls(**numbers | codes | {"reason": np.full(size, "", object)})

    def put(self, where: np.ndarray, other: Ends) -> None:
        for name, values in vars(other).items():
            getattr(self, name)[where] = values

    def put_at_contact(self, pairs: Pairs) -> np.ndarray:
        """Put sticks where they were at initial contact, at time 0; returns until when they were integrated, s.

        That depends on tolerance and rounding, and so does the state there. A stick's momentum, angular momentum and
        twist at initial contact depend on neither, and define its motion as one body (`after`).
        """
        sticks = self.outcome == _STICK
        until = np.where(sticks, self.time, np.nan)
        self.time[sticks], self.gap[sticks] = 0.0, float(pairs.scene.material["film_thickness"])
        self.normal[sticks], self.spins[sticks] = pairs.normal[sticks], pairs.spins[sticks]
        return until


def across(vectors: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """The parts of vectors across a direction."""
    result: np.ndarray = vectors - dot(vectors, normal) * normal
    return result


@dataclass(frozen=True)
class Motions:
    """Both particles after their collisions.

    Attributes:
        position: of the second centre from the first, or of the wall's surface, m.
        angular_velocity: of a stick, the rigid rotation with its angular momentum; NaN where they separated.
    """

    position: np.ndarray
    velocities: np.ndarray
    spins: np.ndarray
    centre_velocity: np.ndarray
    angular_velocity: np.ndarray


def after(pairs: Pairs, ends: Ends) -> Motions:
    """The motion after a collision, beside a wall as `_after_wall`; two spheres that stick turn as one body.

    A stick keeps its angular momentum L. Across the line of centres it turns with L over the doublet's inertia there,
    m r^2 + I_1 + I_2. The orbit has no momentum along the line, where L is that of twist, I_1 w_1 + I_2 w_2. Twist has
    no friction to leading logarithm: each sphere keeps its own, and the doublet's angular velocity has their mean by
    inertia. Among all motions with this L and twist the one returned has the least energy.
    """
    if pairs.scene.wall:
        return _after_wall(pairs, ends)
    bodies = Bodies.of(pairs.scene)
    sticks = (ends.outcome == _STICK)[:, None]
    normal = ends.normal / length(ends.normal)[:, None]
    apart = (sum(bodies.radius) + ends.gap)[:, None]
    (first, second), m = bodies.inertia, bodies.reduced_mass
    inertia = m * apart**2 + first + second
    momentum = angular_momentum(pairs)
    rigid = across(momentum, normal) / inertia
    along = dot(momentum, normal) / (first + second) * normal
    turning = np.where(sticks, rigid, across(ends.turning, normal))
    twists = dot(ends.spins, normal[:, None]) * normal[:, None]
    spins = np.where(sticks[:, None], rigid[:, None] + twists, ends.spins)
    heavy = int(second > first)  # its spin takes what rounding leaves of the angular momentum
    spins = np.array(spins)
    spins[:, heavy] += (momentum - m * apart**2 * turning - first * spins[:, 0] - second * spins[:, 1]) / max(
        first, second
    )
    relative = apart * np.cross(turning, normal)
    relative += np.where(sticks, 0.0, ends.opening[:, None]) * normal
    whole = sum(bodies.mass)
    centre = (bodies.mass[0] * pairs.velocities[:, 0] + bodies.mass[1] * pairs.velocities[:, 1]) / whole
    velocities = np.stack(
        [centre - bodies.mass[1] / whole * relative, centre + bodies.mass[0] / whole * relative], axis=1
    )
    return Motions(apart * normal, velocities, spins, centre, np.where(sticks, rigid + along, np.nan))


def gains_energy(pairs: Pairs, ends: Ends, rtol: float) -> np.ndarray:
    """Mask of ends with more energy than at initial contact, relative to the centre of mass or to the wall.

    Film, shear and rebounds only take energy, and so do attractions between contact and separation: such a trajectory
    is wrong, as one is that was followed further than doubles reach. What a model declares may give energy.
    """
    if pairs.scene.package is not None and pairs.scene.package.bends:
        return np.zeros(pairs.size, bool)
    bodies = Bodies.of(pairs.scene) if not pairs.scene.wall else None
    mass = float(pairs.scene.material["reduced_mass"])
    inertia = np.array(
        bodies.inertia if bodies else (0.4 * mass * float(pairs.scene.material["reduced_radius"]) ** 2, 0)
    )

    def energy(velocities: np.ndarray, spins: np.ndarray) -> np.ndarray:
        relative = velocities[:, 1] - velocities[:, 0]
        twice: np.ndarray = mass * dot(relative, relative)[:, 0] + (inertia * length(spins) ** 2).sum(axis=1)
        return twice

    with np.errstate(all="ignore"):
        motions = after(pairs, ends)
        spins = np.where(inertia[:, None] > 0, motions.spins, 0.0)
        most = energy(pairs.velocities, pairs.spins) * (1 + open_beyond(rtol))
        return np.asarray((ends.outcome > 0) & ~(energy(motions.velocities, spins) <= most))


def _after_wall(pairs: Pairs, ends: Ends) -> Motions:
    """The motion after a collision with a wall, whose velocity stays; a stick neither slides nor rolls on."""
    radius = float(pairs.scene.material["reduced_radius"])
    sticks = (ends.outcome == _STICK)[:, None]
    wall = pairs.velocities[:, 1]
    twist = dot(ends.spins[:, 0], pairs.normal) * pairs.normal
    leaving = ends.sliding - ends.opening[:, None] * pairs.normal
    velocity = wall + np.where(sticks, 0.0, leaving)
    spins = np.stack([np.where(sticks, twist, ends.spins[:, 0]), np.full_like(twist, np.nan)], axis=1)
    velocities = np.stack([velocity, wall], axis=1)
    apart = (radius + ends.gap)[:, None] * pairs.normal
    return Motions(apart, velocities, spins, wall, np.where(sticks, twist, np.nan))


def angular_momentum(pairs: Pairs) -> np.ndarray:
    """Angular momentum about the centre of mass at initial contact, kg m^2/s."""
    bodies = Bodies.of(pairs.scene)
    turning = np.cross(pairs.normal, pairs.velocities[:, 1] - pairs.velocities[:, 0])
    spinning = bodies.inertia[0] * pairs.spins[:, 0] + bodies.inertia[1] * pairs.spins[:, 1]
    momentum: np.ndarray = bodies.reduced_mass * pairs.distance * turning + spinning
    return momentum


def of_kernel(ledgers: np.ndarray) -> np.ndarray:
    """The terms of ledgers by the kernel, (collisions, terms); zero those of declared events and terms without any."""
    names, none = ledgers.dtype.names or (), np.zeros(ledgers.size)
    return np.stack([ledgers[name] if name in names else none for name in map(OF_KERNEL.get, TERMS)], axis=-1)


def of_replay(model: Model, replay: Replay, p: np.ndarray) -> np.ndarray:
    """The terms of one trajectory that is replayed."""
    terms = terms_of(model, replay, p)
    return np.array([terms.get(name, 0.0) for name in TERMS])


def residual(terms: np.ndarray) -> np.ndarray:
    """What the terms (collisions, terms) leave of the initial energy: the error of the integration."""
    rest: np.ndarray = terms[:, _INITIAL] - np.sum(np.delete(terms, _INITIAL, axis=1), axis=1)
    return rest


def is_open(terms: np.ndarray, decided: np.ndarray, rtol: float) -> np.ndarray:
    """Mask of decided collisions whose residual says that the trajectory is wrong."""
    rest = np.abs(residual(terms))
    mask: np.ndarray = decided & (rest > open_beyond(rtol) * np.maximum(np.abs(terms).max(axis=1), rest))
    return mask


def named(scene: Scene, terms: np.ndarray) -> dict[str, np.ndarray]:
    """The terms by name, without those of forces that the scene does not have, and the residual."""
    result = {name: terms[:, k] for k, name in enumerate(TERMS)} | {"residual": residual(terms)}
    return {name: values for name, values in result.items() if name not in absent_terms(scene)}
