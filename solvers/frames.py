"""The doublet at a few instants, seen from above: where the spheres are, how they have turned, and their picture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, FancyArrowPatch, Polygon, Rectangle

from .result import Collision
from .scene import Scene

LIQUID, VELOCITY, FIRST, SECOND, INK = "#56B4E9", "#D55E00", "#E8E8E8", "#BDBDBD", "#202020"
_FLOWN = 5  # frames of a flight that shows something; else 3
_APART = 0.8  # of R: how much further apart the last frame of a separated pair is
_BETWEEN = 0.7  # of R: space between frames
_ARROW = 1.15  # of R: length of the fastest velocity's arrow, half of it on either side of the centre

Vector = tuple[float, float]


@dataclass(frozen=True)
class Frame:
    """The doublet at one instant. SI units and radians; the centre of mass rests at the origin.

    Arguments:
        gap: between the surfaces.
        angle: of the line of centres, counter-clockwise from that at first touch.
        turned: angle by which the first sphere has turned.
        radius: of the first sphere.
        partner: radius of the second; infinite for a wall.
        partner_turned: angle by which that has turned.
        share: part of the distance between the centres that the first is away from the centre of mass.
        relative: velocity of the second sphere relative to the first; None where it is not shown.
        free: after rupture, drawn on along straight lines.
    """

    time: float
    gap: float
    angle: float
    turned: float
    radius: float
    relative: Vector | None = None
    free: bool = False
    partner: float = 0.0  # as the first, unless given
    partner_turned: float | None = None
    share: float = 0.5

    @property
    def wall(self) -> bool:
        return math.isinf(self.partner)

    @property
    def radii(self) -> Vector:
        return self.radius, self.partner or self.radius

    @property
    def distance(self) -> float:
        """Distance between the centres, R_1 + R_2 + x; beside a wall, from the first's to the wall."""
        return self.radius + self.gap if self.wall else sum(self.radii) + self.gap

    @property
    def centres(self) -> tuple[Vector, Vector]:
        """Where the two are; of a wall, the point of it that is nearest."""
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


def frames(collision: Collision) -> list[Frame]:
    """Return instants equally spaced in time from first touch on, and for a separated pair one after rupture."""
    flight = _Flight.of(collision)
    still = np.ptp(flight.rotation) < math.radians(20) and np.ptp(flight.gap) < 0.2 * flight.first.radius
    instants = np.linspace(0.0, flight.time[-1], 3 if still else _FLOWN + (collision.outcome == "stick"))
    found = [flight.at(instant) for instant in (instants if flight.time[-1] > 0 else [0.0])]
    found[0] = replace(found[0], relative=flight.approach)
    if collision.outcome != "stick" and any(flight.parting):
        found += [flight.apart(_wait(flight.last, *flight.parting))]
    return found


def sampled(collision: Collision, instants: Sequence[float]) -> list[Frame]:
    """Return the given instants, s from first touch: straight lines before it and after rupture.

    A stick has no instants after its end.
    """
    flight, found = _Flight.of(collision), []
    for instant in instants:
        if instant < 0:
            found.append(flight.before(instant))
        elif instant <= flight.time[-1]:
            found.append(flight.at(instant))
        elif collision.outcome != "stick":
            found.append(flight.apart(instant - flight.time[-1]))
    return found


@dataclass(frozen=True)
class _Flight:
    """A trajectory, to be read at any instant."""

    time: np.ndarray
    gap: np.ndarray
    rotation: np.ndarray
    turned: tuple[np.ndarray, np.ndarray]  # of the two
    first: Frame  # at first touch
    approach: Vector  # relative velocity at first touch
    parting: tuple[float, float]  # opening velocity and velocity across the line of centres at the end
    spins: tuple[float, float]  # at the end

    @classmethod
    def of(cls, collision: Collision) -> _Flight:
        data = collision.trajectory
        if data is None:
            raise ValueError("the collision has no trajectory: pass trajectory=True to collide()")
        time, gap, rotation = (np.asarray(data[name], dtype=float) for name in ("time", "gap", "rotation"))
        rate, spin = np.asarray(data["rotation_rate"]), np.asarray(data["spin"])
        other = np.asarray(data["spin_partner"]) if "spin_partner" in data else spin
        turned = orientation(time, rotation, rate, spin), orientation(time, rotation, rate, other)
        first = _first(collision.scene, float(gap[0]))
        sideways = collision.speed * math.tan(collision.angle)
        approach = (-collision.speed, sideways * (1.0 if first.wall else first.distance / (first.distance - gap[0])))
        across = float(data["sliding_velocity"][-1]) if first.wall and collision.angle else float(rate[-1])
        across *= 1.0 if first.wall else first.distance - gap[0] + gap[-1]
        parting = float(data["opening_velocity"][-1]), across
        return cls(time, gap, rotation, turned, first, approach, parting, (float(spin[-1]), float(other[-1])))

    def at(self, instant: float) -> Frame:
        known = (self.gap, self.rotation, *self.turned)
        gap, rotation, turned, other = (float(np.interp(instant, self.time, values)) for values in known)
        return replace(self.first, time=float(instant), gap=gap, angle=rotation, turned=turned, partner_turned=other)

    @property
    def last(self) -> Frame:
        return self.at(float(self.time[-1]))

    def before(self, instant: float) -> Frame:
        """The pair on its way to first touch."""
        first = self.at(0.0)
        x, y = first.distance + self.approach[0] * instant, self.approach[1] * instant * (not first.wall)
        gap = math.hypot(x, y) - (first.distance - first.gap)
        return replace(
            first, time=float(instant), gap=gap, angle=math.atan2(y, x), turned=0.0, partner_turned=0.0,
            relative=self.approach, free=True,
        )  # fmt: skip

    def apart(self, wait: float) -> Frame:
        """The pair on straight lines, a time after rupture."""
        last, (opening, across) = self.last, self.parting
        x, y = last.distance + opening * wait, across * wait * (not last.wall)
        along, side = (math.cos(last.angle), math.sin(last.angle)), (-math.sin(last.angle), math.cos(last.angle))
        relative = (opening * along[0] + across * side[0], opening * along[1] + across * side[1])
        gap, angle = math.hypot(x, y) - (last.distance - last.gap), last.angle + math.atan2(y, x)
        turned, other = last.turned + self.spins[0] * wait, (last.partner_turned or 0.0) + self.spins[1] * wait
        return replace(
            last, time=last.time + wait, gap=gap, angle=angle, turned=turned, partner_turned=other, relative=relative,
            free=True,
        )  # fmt: skip


def _first(scene: Scene, gap: float) -> Frame:
    """The two at first touch."""
    radius = 2 * scene.particles.reduced_radius
    if scene.wall:
        return Frame(0.0, gap, 0.0, 0.0, radius, partner=math.inf, partner_turned=0.0)
    radii, masses = scene.radius_ratio or 1.0, scene.mass_ratio or 1.0
    return Frame(0.0, gap, 0.0, 0.0, radius, partner=radii * radius, share=masses / (1 + masses), partner_turned=0.0)


def _wait(last: Frame, opening: float, across: float) -> float:
    """Time after rupture until the pair is as far apart as shows: |(r + u t, r omega t)| = goal, u >= 0 at rupture."""
    across *= not last.wall
    speed = math.hypot(opening, across)
    goal = last.distance + _APART * last.radius
    lead = last.distance * opening
    return (math.sqrt(lead**2 + speed**2 * (goal**2 - last.distance**2)) - lead) / speed**2


def orientation(time: np.ndarray, rotation: np.ndarray, rotation_rate: np.ndarray, spin: np.ndarray) -> np.ndarray:
    """Return the angle each sphere has turned, int xi dt: the doublet's own angle and the integral of the slip.

    The angle of the doublet is integrated exactly; only the slip xi - omega, soon gone, is left to the trapezoids.
    """
    slip = spin - rotation_rate
    pieces = 0.5 * (slip[1:] + slip[:-1]) * np.diff(time)
    turned: np.ndarray = rotation + np.concatenate([[0.0], np.cumsum(pieces)])
    return turned


def wetted_radius(scene: Scene, gap: float) -> float:
    """Return the radius of the liquid between the spheres, m: of a bridge, else where the film is filled.

    Surfaces are parabolas, h = x + s^2/R, R = 2a; with a bridge, the volume between them inside s is V R^3.
    """
    radius = 2 * scene.reduced_radius
    if scene.bridge is None:
        return math.sqrt(radius * max(scene.liquid.film_thickness - gap, 0.0))
    volume = scene.bridge.volume
    square = radius * (math.sqrt(gap**2 + 2 * volume * radius**2 / math.pi) - gap)
    smallest = 2 * scene.particles.reduced_radius * min(scene.radius_ratio or 1.0, 1.0)
    return min(math.sqrt(square), 0.9 * smallest)


def draw_strip(axes: Axes, collision: Collision, pictures: Sequence[Frame], captions: Sequence[str]) -> None:
    """Draw the frames side by side, to one scale, a caption under each; lengths are in sphere radii."""
    radius = pictures[0].radius
    fastest = max((math.hypot(*frame.relative) for frame in pictures if frame.relative), default=1.0)
    bottom = -max(frame.half_height for frame in pictures) / radius - 0.25
    place, edge = 0.0, 0.0
    for frame, caption in zip(pictures, captions, strict=True):
        half = max(frame.half_width / radius, 1.75)
        place = edge + half
        _draw(axes, collision, frame, place, fastest)
        axes.text(place, bottom, caption, ha="center", va="top", fontsize=8, linespacing=1.25)
        edge = place + half + _BETWEEN
    axes.set_xlim(-0.2, edge - _BETWEEN + 0.2)
    axes.set_ylim(bottom, -bottom)
    axes.set_aspect("equal")
    axes.set_axis_off()


def strip_size(pictures: Sequence[Frame]) -> tuple[float, float]:
    """Width and height of the strip in sphere radii, captions left out."""
    radius = pictures[0].radius
    width = sum(2 * max(frame.half_width / radius, 1.75) + _BETWEEN for frame in pictures) - _BETWEEN
    return width + 0.4, 2 * max(frame.half_height for frame in pictures) / radius + 0.5


def _draw(axes: Axes, collision: Collision, frame: Frame, place: float, fastest: float) -> None:
    """One frame around (place, 0), lengths in sphere radii."""
    radius, scene = frame.radius, collision.scene
    centres = [(place + x / radius, y / radius) for x, y in frame.centres]
    radii = [each / radius for each in frame.radii]
    film = scene.liquid.film_thickness / (2 * radius)
    if frame.wall:
        _draw_wall(axes, centres[1], film)
    for centre, size in zip(centres, radii):
        if math.isfinite(size):
            axes.add_patch(Circle(centre, size + film, facecolor=LIQUID, alpha=0.55, linewidth=0, zorder=1))
    half = wetted_radius(scene, frame.gap) / radius
    if half > 0 and not frame.free:
        axes.add_patch(Polygon(_neck(frame, place, half), closed=True, facecolor=LIQUID, edgecolor="none", zorder=2))
    turns = frame.turned, frame.turned if frame.partner_turned is None else frame.partner_turned
    for centre, size, turned, shade, start in zip(centres, radii, turns, (FIRST, SECOND), (0.0, math.pi), strict=True):
        if not math.isfinite(size):
            continue
        ball = Circle(centre, size, facecolor=shade, edgecolor=INK, linewidth=0.8, zorder=3)
        ball.set_gid("sphere")
        axes.add_patch(ball)
        rim = (centre[0] + size * math.cos(start + turned), centre[1] + size * math.sin(start + turned))
        axes.plot(*zip(centre, rim), color=INK, linewidth=1.2, zorder=4)
        axes.plot(*centre, marker="o", markersize=2.2, color=INK, zorder=4)
    if frame.relative:
        shares = (-1.0, 0.0) if frame.wall else (-2 * frame.share, 2 * (1 - frame.share))
        for centre, share in zip(centres, shares, strict=True):
            if not share:
                continue
            length = share * _ARROW / fastest
            # centred, so that the tips of a head-on approach stay apart
            x, y = 0.5 * length * frame.relative[0], 0.5 * length * frame.relative[1]
            ends = (centre[0] - x, centre[1] - y), (centre[0] + x, centre[1] + y)
            arrow = FancyArrowPatch(*ends, arrowstyle="-|>", mutation_scale=9, shrinkA=0, shrinkB=0, zorder=5)
            arrow.set(color=VELOCITY, linewidth=1.4)
            axes.add_patch(arrow)


def _draw_wall(axes: Axes, nearest: Vector, film: float) -> None:
    """The wall, at the right, with its film."""
    high = 1.6  # of R, as the frame's half_height
    left = nearest[0]
    axes.add_patch(Rectangle((left - film, -high), film, 2 * high, facecolor=LIQUID, alpha=0.55, linewidth=0, zorder=1))
    solid = Rectangle((left, -high), 0.35, 2 * high, facecolor=SECOND, edgecolor=INK, linewidth=0.8, zorder=3)
    solid.set_gid("wall")
    axes.add_patch(solid)


def _neck(frame: Frame, place: float, half: float) -> np.ndarray:
    """Outline of the liquid between the spheres: along one surface, and back along the other."""
    rise = np.linspace(-half, half, 25)
    far = frame.distance / frame.radius
    near = np.sqrt(1 - rise**2)  # from the first's centre
    other = frame.radii[1] / frame.radius
    back = np.full(rise.size, far) if frame.wall else far - np.sqrt(other**2 - rise**2)
    outline = np.concatenate([np.column_stack([near, rise]), np.column_stack([back, rise])[::-1]])
    c, s = math.cos(frame.angle), math.sin(frame.angle)
    origin = np.array(frame.centres[0]) / frame.radius
    turned: np.ndarray = outline @ np.array([[c, s], [-s, c]]) + origin + [place, 0.0]
    return turned
