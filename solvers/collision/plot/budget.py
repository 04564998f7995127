"""The budget of e_n^2 - 1 as a figure: the angular momentum, and what each term has given or taken, over time."""

import math

import numpy as np
from matplotlib.figure import Figure

from ....generated.automaton import STICK
from ...errors import InputError
from ...formatting.style import INK, LONGEST, picture, plain_text, title
from ..budget import Budget, angular_momentum, label_of, over_time
from ..outcome import Outcome
from ..text import against, name_of
from .time_panels import BLUE, GREEN, GREY, ORANGE, PURPLE, Column, columns_of, finish, letter

_WIDTH, _MOMENTUM, _TERMS = 9.0, 0.9, 3.2  # inches
_NOTHING = 1e-3  # of the largest term; a smaller one is not drawn
_COLOURS = {
    "rigid_rotation": GREEN, "slip": PURPLE, "sliding": GREEN, "normal_lubrication": BLUE,
    "tangential_lubrication": ORANGE, "dry_contact": "#56B4E9", "capillary": "#8C564B", "attraction": "#B0A000",
    "strings": GREY, "own_events": "#CC3311",
}  # fmt: skip


@picture
def draw(budget: Budget) -> Figure:
    """Draw the budget of a collision; InputError if it has no trajectory with a ledger, or no duration."""
    collision = budget.collision
    data = collision.trajectory
    if data is not None and not data["time"][-1] > 0:
        raise InputError("impact", None, "one that is not decided at initial contact", "has no terms over time")
    if data is None or "normal_lubrication" not in data:
        raise InputError("trajectory", None, "trajectory=True and ledger=True in collide()", "has no terms over time")
    turns = collision.scene.turns(collision.angle) and not collision.scene.wall
    heights = [_MOMENTUM] * turns + [_TERMS]
    figure = Figure(figsize=(_WIDTH, 1.3 + sum(heights)), layout="constrained")
    numbers = f"St {collision.stokes:.4g}, {math.degrees(collision.angle):.4g}°"
    total = "no $e_n$" if collision.outcome == STICK else f"$e_n^2 - 1$ = {collision.restitution**2 - 1:.4g}"
    name = plain_text(name_of(collision.scene, LONGEST)) + against(collision.scene)
    title(figure, f"{name}: {collision.outcome}   ({numbers}, {total})")
    columns = columns_of(figure, figure.add_gridspec(1, 1)[0], collision, len(heights), heights)
    for column in columns:
        _fill(column, collision, turns)
        finish(column, collision)
    for row in range(len(heights)):
        for column in columns[:-1]:
            columns[-1].panels[row].sharey(column.panels[row])
            columns[-1].panels[row].tick_params(labelleft=False)
            columns[-1].panels[row].set_ylabel("")
        letter(columns[0].panels[row], "ab"[row])
    columns[-1].panels[-1].legend(fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _fill(column: Column, collision: Outcome, turns: bool) -> None:
    """Draw the curves of a column."""
    data = collision.trajectory
    assert data is not None
    time = np.asarray(data["time"]) / column.unit[0]
    terms = over_time(collision, data)
    if turns:
        names = ("gap", "rotation_rate", "spin", "spin_partner")
        momentum, _ = angular_momentum(collision.scene, *(data[name].values for name in names if name in data))
        scale = abs(momentum[0]) or max(abs(momentum).max(), 1.0)
        column.panels[0].plot(time, momentum / scale, color=INK)
        column.panels[0].set_ylim(min(0.0, 1.1 * (momentum / scale).min()), max(1.1, 1.1 * (momentum / scale).max()))
        column.panels[0].set_ylabel("L / L(0)")
    panel = column.panels[-1]
    largest = max(abs(values).max() for values in terms.values())
    for name, values in terms.items():
        if np.any(abs(values) > _NOTHING * largest):
            word = "solids" if name == "dry_contact" else label_of(name)
            panel.plot(time, values, color=_COLOURS[name], label=word)
    panel.plot(time, sum(terms.values()), color=INK, linewidth=2, label="sum: $u^2/v_0^2 - 1$")
    panel.axhline(0, color=GREY, linewidth=0.6)
    panel.set_ylabel("given or taken over $m v_0^2/2$")
