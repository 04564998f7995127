"""Pictures of the doublet at a few instants, side by side and to the same scale."""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, FancyArrowPatch, Polygon, Rectangle

from ...scene.scene import Scene
from ..outcome import Outcome
from .frames import Frame, Vector

LIQUID, VELOCITY, FIRST, SECOND, INK = "#56B4E9", "#D55E00", "#E8E8E8", "#BDBDBD", "#202020"
_COAT = 3.0  # points, half of them outside: width of the line around a film, which is seen however thin
_BETWEEN = 0.7  # space between frames, in units of R
_ARROW = 1.15  # length of the longest velocity arrow, in units of R; centred on the sphere


def wetted_radius(scene: Scene, gap: float) -> float:
    """Return the radius of the liquid between the spheres, m: of the bridge, else of the region that the films fill.

    Surfaces are parabolas, h = x + s^2/R, R = 2a; with a bridge, the volume between them inside s is V R^3.
    """
    radius = 2 * scene.reduced_radius
    if scene.bridge is None:
        return math.sqrt(radius * max(scene.liquid.film_thickness - gap, 0.0))
    volume = scene.bridge.volume
    square = radius * (math.sqrt(gap**2 + 2 * volume * radius**2 / math.pi) - gap)
    smallest = 2 * scene.particles.reduced_radius * min(scene.radius_ratio or 1.0, 1.0)
    return min(math.sqrt(square), 0.9 * smallest)


def draw_strip(axes: Axes, collision: Outcome, pictures: Sequence[Frame], captions: Sequence[str]) -> None:
    """Draw the frames side by side, to the same scale, a caption under each; lengths are in sphere radii."""
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
    """Width and height of the strip in sphere radii, without captions."""
    radius = pictures[0].radius
    width = sum(2 * max(frame.half_width / radius, 1.75) + _BETWEEN for frame in pictures) - _BETWEEN
    return width + 0.4, 2 * max(frame.half_height for frame in pictures) / radius + 0.5


def _draw(axes: Axes, collision: Outcome, frame: Frame, place: float, fastest: float) -> None:
    """Draw one frame around (place, 0), lengths in sphere radii."""
    radius, scene = frame.radius, collision.scene
    centres = [(place + x / radius, y / radius) for x, y in frame.centres]
    radii = [metres / radius for metres in frame.radii]
    film = scene.liquid.film_thickness / (2 * radius)
    if frame.wall:
        _draw_wall(axes, centres[1], film, frame.slid / radius)
    for centre, size in zip(centres, radii):
        if math.isfinite(size):
            coat = Circle(centre, size + film, facecolor=LIQUID, edgecolor=LIQUID, linewidth=_COAT, zorder=1)
            coat.set_gid("film")
            axes.add_patch(coat)
    half = wetted_radius(scene, frame.gap) / radius
    if half > 0 and not frame.free:
        axes.add_patch(Polygon(_neck(frame, place, half), closed=True, facecolor=LIQUID, edgecolor="none", zorder=2))
    turns = frame.turned, frame.turned if frame.partner_turned is None else frame.partner_turned
    for centre, size, turned, shade, start in zip(centres, radii, turns, (FIRST, SECOND), (0.0, math.pi), strict=True):
        if not math.isfinite(size):
            continue
        ball = Circle(centre, size, facecolor=shade, edgecolor=INK, linewidth=0.6, zorder=3)
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
            # centred, so that the arrow heads of a head-on approach do not overlap
            x, y = 0.5 * length * frame.relative[0], 0.5 * length * frame.relative[1]
            ends = (centre[0] - x, centre[1] - y), (centre[0] + x, centre[1] + y)
            arrow = FancyArrowPatch(*ends, arrowstyle="-|>", mutation_scale=9, shrinkA=0, shrinkB=0, zorder=5)
            arrow.set(color=VELOCITY, linewidth=1.4)
            axes.add_patch(arrow)


def _draw_wall(axes: Axes, nearest: Vector, film: float, slid: float) -> None:
    """Draw the wall at the right, its film, and a mark at the point of initial contact."""
    high = 1.6  # in units of R; the same as in the frame's half_height
    left = nearest[0]
    coat = Rectangle((left - film, -high), film, 2 * high, facecolor=LIQUID, edgecolor=LIQUID, zorder=1)
    coat.set(linewidth=_COAT, gid="film")
    axes.add_patch(coat)
    solid = Rectangle((left, -high), 0.35, 2 * high, facecolor=SECOND, edgecolor=INK, linewidth=0.8, zorder=3)
    solid.set_gid("wall")
    axes.add_patch(solid)
    if abs(slid) < high:
        mark = axes.plot((left, left + 0.35), (slid, slid), color=INK, linewidth=1.2, solid_capstyle="butt", zorder=4)
        mark[0].set_gid("mark")


def _neck(frame: Frame, place: float, half: float) -> np.ndarray:
    """Outline of the liquid between the spheres: along one surface and back along the other."""
    rise = np.linspace(-half, half, 25)
    far = frame.distance / frame.radius
    near = np.sqrt(1 - rise**2)  # measured from the centre of the first sphere
    other = frame.radii[1] / frame.radius
    back = np.full(rise.size, far) if frame.wall else far - np.sqrt(other**2 - rise**2)
    outline = np.concatenate([np.column_stack([near, rise]), np.column_stack([back, rise])[::-1]])
    c, s = math.cos(frame.angle), math.sin(frame.angle)
    origin = np.array(frame.centres[0]) / frame.radius
    turned: np.ndarray = outline @ np.array([[c, s], [-s, c]]) + origin + [place, 0.0]
    return turned
