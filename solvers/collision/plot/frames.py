"""The doublet at a few instants in the plane of motion: positions and orientations of the spheres."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...errors import InputError
from ...scene.scene import Scene
from ..outcome import Outcome

_MOVING = 5  # frames of a trajectory with visible motion; else 3
_APART = 0.8  # extra distance in the last frame of a separated pair, in units of R

Vector = tuple[float, float]


@dataclass(frozen=True)
class Frame:
    """The doublet at one instant. SI units and radians; the centre of mass rests at the origin.

    Arguments:
        gap: gap between the surfaces.
        angle: angle of the line of centres, counter-clockwise from initial contact.
        turned: angle by which the first sphere has turned.
        radius: radius of the first sphere.
        partner: radius of the second sphere; infinite for a wall, 0 if it is that of the first.
        partner_turned: angle by which the second has turned.
        slid: distance by which a wall has moved past the sphere's centre.
        share: distance of the first from the centre of mass, as a part of the distance between the centres.
        relative: velocity of the second sphere relative to the first; None where it is not shown.
        free: before initial contact or after rupture, on straight lines.
    """

    time: float
    gap: float
    angle: float
    turned: float
    radius: float
    relative: Vector | None = None
    free: bool = False
    partner: float = 0.0
    partner_turned: float | None = None
    slid: float = 0.0
    share: float = 0.5

    @property
    def wall(self) -> bool:
        return math.isinf(self.partner)

    @property
    def radii(self) -> Vector:
        return self.radius, self.partner or self.radius

    @property
    def distance(self) -> float:
        """Distance between the centres, R_1 + R_2 + x; with a wall, from the first's centre to the wall."""
        return self.radius + self.gap if self.wall else sum(self.radii) + self.gap

    @property
    def centres(self) -> tuple[Vector, Vector]:
        """Centres of the two spheres; for a wall, its point nearest to the sphere."""
        x, y = self.distance * math.cos(self.angle), self.distance * math.sin(self.angle)
        if self.wall:
            return (-x / 2, -y / 2), (x / 2, y / 2)
        return (-self.share * x, -self.share * y), ((1 - self.share) * x, (1 - self.share) * y)

    @property
    def half_width(self) -> float:
        if self.wall:
            return abs(self.centres[0][0]) + self.radius
        return max(abs(centre[0]) + radius for centre, radius in zip(self.centres, self.radii))

    @property
    def half_height(self) -> float:
        if self.wall:
            return abs(self.centres[0][1]) + 1.6 * self.radius
        return max(abs(centre[1]) + radius for centre, radius in zip(self.centres, self.radii))


def frames(collision: Outcome) -> list[Frame]:
    """Return frames equally spaced in time, from initial contact on; for a separated pair one after rupture too."""
    trajectory = _Trajectory.of(collision)
    still = np.ptp(trajectory.rotation) < math.radians(20) and np.ptp(trajectory.gap) < 0.2 * trajectory.contact.radius
    instants = np.linspace(0.0, trajectory.time[-1], 3 if still else _MOVING + (collision.outcome == "stick"))
    result = [trajectory.at(instant) for instant in (instants if trajectory.time[-1] > 0 else [0.0])]
    result[0] = replace(result[0], relative=trajectory.approach)
    if collision.outcome != "stick" and any(trajectory.parting):
        result += [trajectory.apart(_wait(trajectory.last, *trajectory.parting))]
    return result


def sampled(collision: Outcome, instants: Sequence[float]) -> list[Frame]:
    """Return frames at these instants, s since initial contact; motion is straight before it and after rupture.

    A stick has no instants after its end.
    """
    trajectory, result = _Trajectory.of(collision), []
    for instant in instants:
        if instant < 0:
            result.append(trajectory.before(instant))
        elif instant <= trajectory.time[-1]:
            result.append(trajectory.at(instant))
        elif collision.outcome != "stick":
            result.append(trajectory.apart(instant - trajectory.time[-1]))
    return result


@dataclass(frozen=True)
class _Trajectory:
    """A trajectory that can be evaluated at any instant."""

    time: np.ndarray
    gap: np.ndarray
    rotation: np.ndarray
    turned: tuple[np.ndarray, np.ndarray]  # angles of the two spheres
    slid: np.ndarray  # distance moved along a wall
    contact: Frame  # at initial contact
    approach: Vector  # relative velocity at initial contact
    parting: tuple[float, float]  # normal and transverse relative velocity at the end
    impact_spins: tuple[float, float]
    final_spins: tuple[float, float]

    @classmethod
    def of(cls, collision: Outcome) -> _Trajectory:
        data = collision.trajectory
        if data is None:
            raise InputError("trajectory", None, "trajectory=True in collide()", "is missing from the collision")
        time, gap, rotation = (np.asarray(data[name], dtype=float) for name in ("time", "gap", "rotation"))
        rate, spin = np.asarray(data["rotation_rate"]), np.asarray(data["spin"])
        other = np.asarray(data["spin_partner"]) if "spin_partner" in data else spin
        turned = orientation(time, rotation, rate, spin), orientation(time, rotation, rate, other)
        contact = _at_contact(collision.scene, float(gap[0]))
        sideways = collision.speed * math.tan(collision.angle)
        lever = 1.0 if contact.wall else contact.distance / (contact.distance - gap[0])
        approach = -collision.speed, sideways * lever
        sliding = np.asarray(data.get("sliding_velocity", np.zeros(time.size)))
        across = float(sliding[-1]) if contact.wall else float(rate[-1]) * (contact.distance - gap[0] + gap[-1])
        parting = float(data["normal_velocity"][-1]), across
        material = collision.scene.material
        spins = (material["impact_spin"], material.get("impact_partner_spin", 0.0)), (float(spin[-1]), float(other[-1]))
        return cls(time, gap, rotation, turned, _integral(time, sliding), contact, approach, parting, *spins)

    def at(self, instant: float) -> Frame:
        """The frame at an instant of the trajectory, interpolated linearly."""
        columns = (self.gap, self.rotation, *self.turned, self.slid)
        gap, rotation, turned, other, slid = (float(np.interp(instant, self.time, values)) for values in columns)
        return replace(
            self.contact, time=float(instant), gap=gap, angle=rotation, turned=turned, partner_turned=other, slid=slid
        )

    @property
    def last(self) -> Frame:
        return self.at(float(self.time[-1]))

    def before(self, instant: float) -> Frame:
        """The pair on straight lines before initial contact; `instant` is negative, s since contact."""
        first = self.at(0.0)
        x, y = first.distance + self.approach[0] * instant, self.approach[1] * instant * (not first.wall)
        gap = math.hypot(x, y) - (first.distance - first.gap)
        return replace(
            first, time=float(instant), gap=gap, angle=math.atan2(y, x), turned=self.impact_spins[0] * instant,
            partner_turned=self.impact_spins[1] * instant, slid=self.approach[1] * instant * first.wall,
            relative=self.approach, free=True,
        )  # fmt: skip

    def apart(self, wait: float) -> Frame:
        """The pair on straight lines, `wait` seconds after rupture."""
        last, (normal_velocity, across) = self.last, self.parting
        x, y = last.distance + normal_velocity * wait, across * wait * (not last.wall)
        along, side = (math.cos(last.angle), math.sin(last.angle)), (-math.sin(last.angle), math.cos(last.angle))
        relative = (normal_velocity * along[0] + across * side[0], normal_velocity * along[1] + across * side[1])
        gap, angle = math.hypot(x, y) - (last.distance - last.gap), last.angle + math.atan2(y, x)
        first, second = self.final_spins
        turned, other = last.turned + first * wait, (last.partner_turned or 0.0) + second * wait
        return replace(
            last, time=last.time + wait, gap=gap, angle=angle, turned=turned, partner_turned=other,
            slid=last.slid + across * wait * last.wall, relative=relative, free=True,
        )  # fmt: skip


def _at_contact(scene: Scene, gap: float) -> Frame:
    """The pair at initial contact."""
    radius = 2 * scene.particles.reduced_radius
    if scene.wall:
        return Frame(0.0, gap, 0.0, 0.0, radius, partner=math.inf, partner_turned=0.0)
    radii, masses = scene.radius_ratio or 1.0, scene.mass_ratio or 1.0
    return Frame(0.0, gap, 0.0, 0.0, radius, partner=radii * radius, share=masses / (1 + masses), partner_turned=0.0)


def _wait(last: Frame, normal_velocity: float, across: float) -> float:
    """Time t from rupture to the last frame, s: |(r + u t, v t)| = `goal`, where v = `across`, zero with a wall."""
    across *= not last.wall
    speed = math.hypot(normal_velocity, across)
    goal = last.distance + _APART * last.radius
    lead = last.distance * normal_velocity
    return (math.sqrt(lead**2 + speed**2 * (goal**2 - last.distance**2)) - lead) / speed**2


def orientation(time: np.ndarray, rotation: np.ndarray, rotation_rate: np.ndarray, spin: np.ndarray) -> np.ndarray:
    """Return the angle by which a sphere has turned, int xi dt, rad: the doublet's angle plus the integral of the slip.

    The angle of the doublet comes from the integrator; only the slip xi - omega, which decays quickly, is integrated by
    the trapezoidal rule.
    """
    turned: np.ndarray = rotation + _integral(time, spin - rotation_rate)
    return turned


def _integral(time: np.ndarray, rate: np.ndarray) -> np.ndarray:
    """Cumulative integral of `rate` by the trapezoidal rule, 0 at the first instant."""
    pieces = 0.5 * (rate[1:] + rate[:-1]) * np.diff(time)
    integral: np.ndarray = np.concatenate([[0.0], np.cumsum(pieces)])
    return integral
