"""A collision as a figure: its quantities over time, and the doublet at a few instants."""

import math
import re
from collections.abc import Sequence

from matplotlib.figure import Figure

from ....generated.automaton import STICK
from ...formatting.style import LONGEST, picture, plain_text, title
from ..outcome import Outcome
from ..text import against, is_followed_on, name_of, prefix, reason, stopped
from .frames import Frame, frames
from .strip import draw_strip, strip_size
from .time_panels import GREY, letter, micro, time_panels

WIDTH = 9.0  # inches
_ROW = 1.35  # height of a row of panels, inches
_STRIP = WIDTH - 0.5


@picture
def draw(collision: Outcome) -> Figure:
    """Draw a collision; ValueError if it has no trajectory."""
    pictures = frames(collision)
    data = collision.trajectory
    duration = float(data["time"][-1]) if data is not None else 0.0
    rows = 0 if duration <= 0 else 4 if _turns(collision) else 2
    across, high = strip_size(pictures)
    strip = min(_STRIP * high / across, 2.0) + 0.45
    figure = Figure(figsize=(WIDTH, 1.0 + strip + rows * _ROW + 0.75 * bool(rows)), layout="constrained")
    grid = figure.add_gridspec(1 + bool(rows), 1, height_ratios=[rows * _ROW + 0.75, strip] if rows else [strip])
    title(figure, _title(collision))
    if rows:
        time_panels(figure, grid[0], collision, rows, pictures)
    axes = figure.add_subplot(grid[-1])
    latest = duration or pictures[-1].time
    draw_strip(axes, collision, pictures, [_caption(frame, collision, latest, pictures[-1]) for frame in pictures])
    letter(axes, "c" if rows == 4 else "b" if rows else "")
    figure.supxlabel(_note(collision, pictures), color=GREY)
    return figure


def _turns(collision: Outcome) -> bool:
    return collision.scene.turns(collision.angle)


def _short(value: float) -> str:
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"


def _title(collision: Outcome) -> str:
    name = plain_text(name_of(collision.scene, LONGEST)) + against(collision.scene)
    impact = f"St {collision.stokes:.4g}, {math.degrees(collision.angle):.4g}°{_spins(collision)}"
    numbers = f"{impact}, $e_n$ = {collision.restitution:.4g}"
    parts = [reason(collision), stopped(collision) if collision.outcome == "stick" else ""]
    why = re.sub(r"(?<=\d )us\b", "µs", "; ".join(text for text in parts if text))
    return f"{name}: {collision.outcome}   ({numbers})\n{why}"


def _spins(collision: Outcome) -> str:
    spins = [spin for spin in (collision.scene.impact.spin, collision.scene.impact.partner_spin) if spin is not None]
    return f", ξ₀ = {' and '.join(f'{spin:.4g}' for spin in spins)} rad/s" if any(spins) else ""


def _note(collision: Outcome, pictures: Sequence[Frame]) -> str:
    text = "Seen from above, to scale (thin films thicker, to be seen); liquid in blue; arrows: velocities"
    text += "; lines: marks that met at initial contact."
    if collision.scene.wall and _turns(collision):
        text += "\nBeside a wall no line of centres turns (ω = 0): the sphere slides and rolls along it."
    if collision.contact_time == 0 or collision.until == 0:
        text += "\nThe outcome is certain at initial contact: there is no trajectory to follow."
    elif pictures[-1].free:
        strings = ", strings left out" if collision.scene.pendulum is not None else ""
        text += f"\nLast picture: drawn on after rupture along straight lines{strings}."
    elif collision.certified and not is_followed_on(collision):
        text += "\nThe outcome is certain from the last picture on: the trajectory was not followed further."
    return text


def _caption(frame: Frame, collision: Outcome, latest: float, last: Frame) -> str:
    factor, unit = prefix(max(latest, frame.time))
    time = "initial contact" if frame.time == 0 else f"{_short(frame.time / factor)} {micro(unit + 's')}"
    moved = ""
    if _turns(collision) and frame.wall:
        size, name = prefix(frame.slid)
        moved = f"\nslid {_short(frame.slid / size)} {micro(name + 'm')}" if frame.slid else "\nslid 0"
    elif _turns(collision):
        moved = f"\nβ = {_short(math.degrees(frame.angle))}°"
    ending = "\napart" if frame.free else "\nsticks" if collision.outcome == STICK and frame is last else ""
    return f"{time}{moved}{ending}"
