"""A pair in Cartesian velocities: its arrival, the forces between its bodies, and the rates of its state.

Written from the model's description alone: the relative velocity is a vector in the laboratory's axes, turned by no
centrifugal term; nothing is eliminated. Collisions in a plane lie in that of x and y.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from wetdoublet.solvers import Scene

from .two_bodies import Bodies, bodies_of

X, N, W, SPIN, PARTNER = 0, 1, 4, 7, 10
FAR = 1e30
Vector = tuple[Any, Any, Any]
ZERO: Vector = (0.0, 0.0, 0.0)


def dot(p: Vector, q: Vector) -> Any:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p: Vector, q: Vector) -> Vector:
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


def plus(p: Vector, s: Any, q: Vector) -> Vector:
    """P + s q."""
    return p[0] + s * q[0], p[1] + s * q[1], p[2] + s * q[2]


def across(p: Vector, n: Vector) -> Vector:
    """What of p is perpendicular to n."""
    return plus(p, -dot(p, n), n)


def at(y: Any, where: int) -> Vector:
    return y[where], y[where + 1], y[where + 2]


@dataclass(frozen=True)
class Arrival:
    """Initial contact: unit normal from the first body to the second, velocities (m/s), angular velocities (rad/s)."""

    normal: Vector
    velocities: tuple[Vector, Vector]
    spins: tuple[Vector, Vector]

    @property
    def relative(self) -> Vector:
        return plus(self.velocities[1], -1.0, self.velocities[0])

    @property
    def speed(self) -> float:
        """Normal approach speed."""
        return float(-dot(self.relative, self.normal))


def planar_arrival(
    scene: Scene, speed: float | None = None, axes: Sequence[Vector] = (), drift: Vector = ZERO
) -> Arrival:
    """The arrival of a scene's impact, in the plane of the normal and a tangential direction; x and y without `axes`.

    The line of centres turns from the first to the second axis; `drift` is the velocity of the centre of mass, left out
    beside a wall, which is at rest. The angle means omega_0 = v0 tan(theta0)/(R_1 + R_2).
    """
    b, (usual, angle) = bodies_of(scene), scene.need_impact()
    speed, (normal, tangent) = speed or usual, axes or ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    along = speed * math.tan(angle) * (1.0 if b.wall else 1 + b.film_thickness / b.contact)
    relative = plus(plus(ZERO, -speed, normal), along, tangent)
    share = 1.0 if b.wall else b.m / b.masses[0]
    drift = ZERO if b.wall else drift
    spin = float(scene.entries.get("impact.spin", 0.0))
    partner = 0.0 if b.wall else float(scene.entries.get("impact.partner_spin", spin))
    out = cross(normal, tangent)
    velocities = plus(drift, -share, relative), plus(drift, 1 - share, relative)
    return Arrival(normal, velocities, (plus(ZERO, spin, out), plus(ZERO, partner, out)))


class Mechanics:
    """The state `y` of a pair, and its phase: closing, resting, sliding, inside the film."""

    def __init__(self, b: Bodies, arrival: Arrival, strings: Any = None) -> None:
        self.b, self.v0, self.strings = b, arrival.speed, strings
        second = ZERO if b.wall else arrival.spins[1]
        self.y = np.array([b.film_thickness, *arrival.normal, *arrival.relative, *arrival.spins[0], *second])
        beside = plus(arrival.relative, self.v0, arrival.normal)
        self.rotates = any(map(any, (beside, arrival.spins[0], second)))
        self.flat = not (beside[2] or arrival.normal[2] or any((*arrival.spins[0][:2], *second[:2])))
        self.elastic = b.elastic_gap(self.v0)
        self.solid = max(self.elastic, b.roughness)
        self.rim = bool(b.law) and b.film != "constant-volume"  # whether passing x0 is an event
        self.inside, self.sheared = True, b.edge >= b.film_thickness
        self.closing, self.resting = True, False
        self.sliding = 0.0  # in resting contact with friction: the sign of the slip (in space: 1); 0 while rolling

    def opening(self, y: Any) -> Any:
        return dot(at(y, W), at(y, N))

    def sideways(self, y: Any) -> Vector:
        """Velocity across the line of centres."""
        return across(at(y, W), at(y, N))

    def arms(self, x: float) -> tuple[float, float]:
        b = self.b
        if b.wall:
            return b.radii[0], 0.0
        stretch = 1 + x / b.contact if b.arm == "midgap" else 1.0
        return b.radii[0] * stretch, b.radii[1] * stretch

    def slip(self, y: Any) -> Vector:
        one, other = self.arms(y[X])
        return plus(self.sideways(y), -1.0, cross(plus(plus(ZERO, one, at(y, SPIN)), other, at(y, PARTNER)), at(y, N)))

    def signed(self, slip: Vector, y: Any) -> Any:
        """A slip in the plane, positive where the line of centres turns about z; in space its size."""
        return cross(at(y, N), slip)[2] if self.flat else math.hypot(*slip)

    def against(self, y: Any) -> Vector:
        """Unit vector of what the contact gives to the second body against a slip of sign 1."""
        if self.flat:
            return cross(at(y, N), (0.0, 0.0, 1.0))
        slip = self.slip(y)
        return plus(ZERO, -1 / (math.hypot(*slip) or 1.0), slip)

    def loads(self, y: Any) -> tuple[float, Vector, Vector, Vector]:
        """Forces that are no contact's on the second: outward and across, and the torques on both bodies."""
        b, x, n, w = self.b, y[X], at(y, N), at(y, W)
        outward = -b.pull(x)
        if b.wets(self.inside, not self.closing) and not self.resting:
            outward -= b.drag(x) * dot(w, n)
        log = math.log(b.edge / x) if self.sheared else 0.0
        own, mixed, other = b.friction_matrix
        one, two = across(at(y, SPIN), n), across(at(y, PARTNER), n)
        if b.wall:
            force = plus(plus(ZERO, -log * other, across(w, n)), log * mixed, cross(one, n))
            return outward, force, plus(plus(ZERO, -log * own, one), log * mixed, cross(n, w)), ZERO
        r, stretch = b.contact + x, 1 + x / b.contact if b.arm == "midgap" else 1.0
        line = plus(ZERO, 1 / r, cross(n, w))
        slip, partner = plus(line, -1.0, one), plus(line, -1.0, two)
        first = plus(plus(ZERO, log * stretch * own, slip), log * stretch * mixed, partner)
        second = plus(plus(ZERO, log * stretch * mixed, slip), log * stretch * other, partner)
        force = plus(ZERO, -1 / (b.contact * stretch), cross(plus(first, 1.0, second), n))
        if self.strings:
            pull = self.swing(r, n)
            outward += dot(pull, n)
            force = plus(force, 1.0, across(pull, n))
        return outward, force, first, second

    def swing(self, r: float, n: Vector) -> Vector:
        """Force of the strings on the relative coordinate, from how far it is from where both hang."""
        off = plus(plus(ZERO, r, n), -self.b.contact, (1.0, 0.0, 0.0))
        stretched = dot(off, off) / 4 if self.strings.law == "exact" else 0.0
        return plus(ZERO, -self.b.m * self.strings.gravity / math.sqrt(self.strings.length**2 - stretched), off)

    def hung(self, x: float) -> float:
        length, stiff = self.strings.length, 4 * self.b.m * self.strings.gravity
        if self.strings.law != "exact":
            return float(stiff * (x / 2) ** 2 / (2 * length))
        return float(stiff * (length - math.sqrt(length**2 - (x / 2) ** 2)))

    def reaction(self, y: Any) -> float:
        """What holds a resting gap: the net force inward."""
        sideways = self.sideways(y)
        turned = 0.0 if self.b.wall else self.b.m * dot(sideways, sideways) / (self.b.contact + y[X])
        return -self.loads(y)[0] - turned

    def yields(self, x: float) -> tuple[float, float, float]:
        """Change of the slip by a unit of impulse that a contact gives against it, and what the spins get."""
        b, (one, other) = self.b, self.arms(x)
        spins = one / b.inertias[0], 0.0 if b.wall else other / b.inertias[1]
        return 1 / b.m + one * spins[0] + other * spins[1], *spins

    def needed(self, y: Any) -> float:
        """The contact's force against the slip that keeps it zero at rest, in the plane."""
        b, (one, other) = self.b, self.arms(y[X])
        _, force, first, second = self.loads(y)
        driven = cross(at(y, N), force)[2] / b.m - one * first[2] / b.inertias[0]
        return (driven - (0.0 if b.wall else other * second[2] / b.inertias[1])) / self.yields(y[X])[0]

    def rates(self, _: float, state: np.ndarray) -> list[float]:
        try:
            return self.slopes(state.tolist())
        except (ArithmeticError, ValueError):  # a trial step out of the domain: rejected for its error
            return [FAR] * state.size

    def slopes(self, y: list[float]) -> list[float]:
        b = self.b
        n, u, beside = at(y, N), self.opening(y), self.sideways(y)
        outward, force, first, second = self.loads(y)
        r = b.contact + y[X]
        if self.resting:
            u = 0.0
            outward = 0.0 if b.wall else -b.m * dot(beside, beside) / r
            if b.friction is not None and self.rotates:
                rub = self.sliding * b.friction * self.reaction(y) if self.sliding else self.needed(y)
                (one, other), impulse = self.arms(y[X]), plus(ZERO, rub, self.against(y))
                force, turn = plus(force, 1.0, impulse), cross(n, impulse)
                first, second = plus(first, -one, turn), plus(second, -other, turn)
        turning = ZERO if b.wall else plus(ZERO, 1 / r, beside)
        pushed = plus(plus(ZERO, outward / b.m, n), 1 / b.m, force)
        other = ZERO if b.wall else plus(ZERO, 1 / b.inertias[1], second)
        return [u, *turning, *pushed, *plus(ZERO, 1 / b.inertias[0], first), *other]
