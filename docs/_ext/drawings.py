"""Drawings of the geometry, for the pages that explain the physics. Thicknesses are exaggerated."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle, FancyArrowPatch, Polygon

SOLID, EDGE, LIQUID, INK, RED, BLUE = "#d9d4c7", "#6b665a", "#bfdcec", "#222222", "#b8443a", "#2a6f97"


def write(folder: Path) -> None:
    """Write every drawing as SVG."""
    folder.mkdir(parents=True, exist_ok=True)
    style = {"svg.hashsalt": "wetdoublet", "font.size": 13, "mathtext.fontset": "cm"}
    with mpl.rc_context(style):
        for draw in (coatings, impact, doublet, film, pendulum, barrier):
            draw().savefig(folder / f"{draw.__name__}.svg", metadata={"Date": None})


def _canvas(width: float, height: float, x: tuple[float, float], y: tuple[float, float]) -> tuple[Figure, Any]:
    figure = Figure(figsize=(width, height))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=x, ylim=y, aspect="equal")
    axes.axis("off")
    return figure, axes


def _sphere(axes: Any, x: float, y: float, radius: float = 1.0, coating: float = 0.0, z: int = 2) -> None:
    if coating:
        axes.add_patch(Circle((x, y), radius + coating, fc=LIQUID, ec=BLUE, lw=0.8, zorder=z - 1))
    axes.add_patch(Circle((x, y), radius, fc=SOLID, ec=EDGE, lw=1, zorder=z))
    axes.plot(x, y, ".", color=INK, ms=4, zorder=z + 2)


def _arrow(axes: Any, start: tuple[float, float], end: tuple[float, float], style: str = "-|>", **how: Any) -> None:
    chosen = {"color": INK, "lw": 1.4, "mutation_scale": 11, "shrinkA": 0, "shrinkB": 0, "zorder": 6} | how
    axes.add_patch(FancyArrowPatch(start, end, arrowstyle=style, **chosen))


def _measure(axes: Any, left: float, right: float, y: float, text: str, above: float = 0.08) -> None:
    """A dimension line between two abscissae, arrows from outside where there is no room."""
    for x in (left, right):
        axes.plot([x, x], [y - 0.09, y + 0.09], color=INK, lw=0.8, zorder=6)
    if right - left > 0.35:
        _arrow(axes, (left, y), (right, y), "<|-|>", lw=0.9, mutation_scale=8)
    else:
        _arrow(axes, (left - 0.3, y), (left, y), lw=0.9, mutation_scale=8)
        _arrow(axes, (right + 0.3, y), (right, y), lw=0.9, mutation_scale=8)
    axes.text((left + right) / 2, y + above, text, ha="center", va="bottom", zorder=7)


def coatings() -> Figure:
    """Two coated spheres before and at initial contact."""
    figure, axes = _canvas(6.4, 3.3, (-3.3, 3.3), (-1.75, 1.65))
    d = 0.16
    _sphere(axes, -1 - d, 0, coating=d)
    _sphere(axes, 1 + d, 0, coating=d)
    axes.plot([-2.6, 2.6], [0, 0], color=INK, lw=0.8, ls=(0, (6, 3)), zorder=3)
    axes.text(2.65, 0.0, "line of\ncentres", va="center", ha="left", fontsize=10)
    for x in (-d, d):
        axes.plot([x, x], [0, -1.4], color=INK, lw=0.6, zorder=5)
    _measure(axes, -d, d, -1.3, "")
    axes.text(0, -1.46, "film thickness $x_0$", ha="center", va="top")
    _arrow(axes, (-1 - d, 0), (-1 - d - 0.78, 0.62), lw=1)
    axes.text(-1.62, 0.12, "$R$", ha="right", va="bottom")
    angle = np.radians(118)
    for scale, ha in ((-1, "right"), (1, "left")):
        at = (scale * (1 + d) + scale * np.cos(angle) * (1 + d / 2) * -1, np.sin(angle) * (1 + d / 2))
        axes.annotate(
            "coating $\\delta$",
            at,
            (scale * 2.2, 1.42),
            ha=ha,
            va="center",
            arrowprops={"arrowstyle": "-", "lw": 0.8},
            zorder=8,
        )
    axes.text(0, 1.4, "$x_0 = \\delta + \\delta$", ha="center", va="center", fontsize=14)
    return figure


def impact() -> Figure:
    """The relative velocity at initial contact and its components."""
    figure, axes = _canvas(6.4, 3.6, (-3.3, 3.3), (-1.5, 2.2))
    d = 0.12
    _sphere(axes, -1 - d, 0, coating=d)
    _sphere(axes, 1 + d, 0, coating=d)
    axes.plot([-3, 3], [0, 0], color=INK, lw=0.8, ls=(0, (6, 3)), zorder=3)
    centre = (1 + d, 0.0)
    normal, tangential = 1.15, 1.6
    end = (centre[0] - normal, tangential)
    _arrow(axes, centre, end, color=RED, lw=2)
    _arrow(axes, centre, (centre[0] - normal, 0), color=BLUE, lw=2)
    _arrow(axes, (centre[0] - normal, 0), end, color=BLUE, lw=2)
    axes.text(centre[0] - normal / 2 - 0.05, -0.1, "$v_0$", color=BLUE, ha="center", va="top", fontsize=14, zorder=8)
    axes.text(centre[0] - normal - 0.08, 1.25, "$v_0\\,\\tan\\theta_0$", color=BLUE, ha="right", fontsize=14, zorder=8)
    axes.text(0.95, 1.22, "$v_0/\\cos\\theta_0$", color=RED, ha="left", va="center", fontsize=14, zorder=8)
    turn = np.degrees(np.arctan2(tangential, -normal))
    axes.add_patch(Arc(centre, 1.0, 1.0, theta1=turn, theta2=180, color=INK, lw=1, zorder=6))
    axes.text(centre[0] - 0.62, 0.2, "$\\theta_0$", ha="right", va="bottom", fontsize=13, zorder=8)
    axes.text(0, -1.4, "seen from the left sphere", ha="center", fontsize=10)
    return figure


def doublet() -> Figure:
    """The doublet that turns: angles, rates, forces and lever arms."""
    figure, axes = _canvas(6.4, 4.2, (-3.2, 3.2), (-2.15, 2.05))
    beta, gap = np.radians(24), 0.34
    along = np.array([np.cos(beta), np.sin(beta)])
    across = np.array([-along[1], along[0]])
    half = 1 + gap / 2
    one, two = -half * along, half * along
    neck = []
    for side in (1, -1):
        s = np.linspace(-1, 1, 21)
        width = 0.42 + 0.10 * s**2
        edge = [along * (each * 0.32) + side * across * w for each, w in zip(s, width)]
        neck += edge if side > 0 else edge[::-1]
    axes.add_patch(Polygon(neck, closed=True, fc=LIQUID, ec=BLUE, lw=0.8, zorder=1))
    for centre in (one, two):
        _sphere(axes, *centre)
    axes.plot([-2.4, 2.6], [0, 0], color=INK, lw=0.7, ls=":", zorder=3)
    ends = np.array([-2.55 * along, 2.55 * along])
    axes.plot(ends[:, 0], ends[:, 1], color=INK, lw=0.8, ls=(0, (6, 3)), zorder=3)
    axes.add_patch(Arc((0, 0), 4.6, 4.6, theta1=0, theta2=np.degrees(beta), color=INK, lw=1, zorder=6))
    axes.text(2.42, 0.42, "$\\beta$", fontsize=14, va="center")
    axes.add_patch(
        FancyArrowPatch(
            (2.75, 0.75),
            (2.35, 1.55),
            connectionstyle="arc3,rad=0.25",
            arrowstyle="-|>",
            mutation_scale=12,
            color=RED,
            lw=1.6,
        )
    )
    axes.text(2.72, 1.35, "$\\omega$", color=RED, fontsize=15)
    for centre in (one, two):
        at = centre + 0.5 * across
        axes.add_patch(
            FancyArrowPatch(
                centre + 0.42 * along + 0.3 * across,
                centre - 0.42 * along + 0.3 * across,
                connectionstyle="arc3,rad=0.45",
                arrowstyle="-|>",
                mutation_scale=11,
                color=RED,
                lw=1.4,
                zorder=6,
            )
        )
        axes.text(*(at + 0.12 * across), "$\\xi$", color=RED, fontsize=14, ha="center", va="center", zorder=7)
    _arrow(axes, (0, 0), tuple(-0.75 * across), color=BLUE, lw=2)
    axes.text(*(-0.98 * across), "$F_t$", color=BLUE, ha="center", va="center", fontsize=14)
    below = -1.28 * across
    for point in (one, two, np.zeros(2)):
        foot = point - 1.36 * across
        axes.plot([point[0], foot[0]], [point[1], foot[1]], color=INK, lw=0.5, zorder=3)
    _arrow(axes, tuple(one + below), tuple(below), "<|-|>", lw=0.9, mutation_scale=8)
    _arrow(axes, tuple(below), tuple(two + below), "<|-|>", lw=0.9, mutation_scale=8)
    axes.text(*(one / 2 + 1.5 * -across), "arm $r/2$", ha="center", va="center", rotation=np.degrees(beta))
    axes.text(*(two / 2 + 1.5 * -across), "$r/2$", ha="center", va="center", rotation=np.degrees(beta))
    axes.annotate(
        "gap $x$", tuple(0.05 * across), (-0.55, 1.75), ha="center", arrowprops={"arrowstyle": "-", "lw": 0.8}, zorder=8
    )
    axes.annotate(
        "bridge", tuple(0.46 * across), (0.75, 1.75), ha="center", arrowprops={"arrowstyle": "-", "lw": 0.8}, zorder=8
    )
    return figure


def film() -> Figure:
    """The gap close to, the wetted disc, and the pressure in it."""
    figure, axes = _canvas(6.4, 3.5, (-3.2, 3.2), (-1.75, 1.75))
    s = np.linspace(-2.6, 2.6, 200)
    half = 0.16 + s**2 / 9
    rim = 0.42
    inside = np.abs(s) <= np.sqrt((rim - 0.16) * 9)
    axes.fill_between(s, half, 1.6, color=SOLID, zorder=1)
    axes.fill_between(s, -half, -1.6, color=SOLID, zorder=1)
    axes.fill_between(s[inside], -half[inside], half[inside], color=LIQUID, zorder=1)
    axes.plot(s, half, color=EDGE, lw=1.2)
    axes.plot(s, -half, color=EDGE, lw=1.2)
    x = s[inside]
    pressure = 1 / (half[inside] ** 2) - 1 / rim**2
    profile = 0.95 * pressure / pressure.max()
    axes.plot(x, half[inside] + profile, color=RED, lw=1.8, zorder=4)
    axes.text(0.75, 1.0, "pressure $p(s)$", color=RED, ha="left", va="center", zorder=5)
    _arrow(axes, (0, -0.16), (0, 0.16), "<|-|>", lw=1, mutation_scale=8)
    axes.text(0.08, 0, "$x$", va="center", ha="left", fontsize=13)
    edge = x[-1]
    _arrow(axes, (edge, -rim), (edge, rim), "<|-|>", lw=1, mutation_scale=8)
    axes.text(edge + 0.1, 0, "$x_0$", va="center", ha="left", fontsize=13)
    _arrow(axes, (0, -1.05), (edge, -1.05), "<|-|>", lw=0.9, mutation_scale=8)
    axes.plot([0, 0], [-1.15, -0.16], color=INK, lw=0.5)
    axes.plot([edge, edge], [-1.15, -rim], color=INK, lw=0.5)
    axes.text(edge / 2, -1.1, "wetted disc", ha="center", va="top")
    axes.text(-2.95, 0, "$h = x + s^2/2a$", va="center", ha="left", fontsize=13)
    return figure


def pendulum() -> Figure:
    """Two spheres on strings one diameter apart."""
    figure, axes = _canvas(4.8, 4.4, (-2.6, 2.6), (-2.9, 1.9))
    axes.plot([-2.2, 2.2], [1.5, 1.5], color=INK, lw=2)
    for x, swing in ((-0.62, -0.62), (0.62, 0.62)):
        axes.plot([x, x], [1.5, -1.75], color=INK, lw=0.7, ls=":")
        axes.plot([x, x + swing], [1.5, -1.75], color=INK, lw=1.2)
        axes.add_patch(Circle((x + swing, -1.75), 0.6, fc=SOLID, ec=EDGE, lw=1, zorder=3))
        axes.plot(x, 1.5, "o", color=INK, ms=4)
    _measure(axes, -0.62, 0.62, 1.62, "$2R$", above=0.04)
    axes.text(-1.05, 0.0, "$l$", ha="right", fontsize=14)
    _measure(axes, 0.62, 1.24, -2.6, "")
    axes.plot([0.62, 0.62], [-1.75, -2.7], color=INK, lw=0.5)
    axes.plot([1.24, 1.24], [-1.75, -2.7], color=INK, lw=0.5, zorder=4)
    axes.text(0.5, -2.6, "swing $d$", va="center", ha="right", fontsize=13)
    return figure


def barrier() -> Figure:
    """The effective potential of a doublet: why a stick below the barrier never separates."""
    figure = Figure(figsize=(6.4, 3.5), layout="constrained")
    axes = figure.subplots()
    x = np.linspace(0.02, 3, 300)
    potential = 1.25 / (1 + 0.22 * x) ** 2 - 1.0 * np.exp(-1.1 * x)
    axes.plot(x, potential, color=BLUE, lw=2.2)
    top = int(potential.argmax())
    level = potential[top] - 0.1
    axes.axhline(potential[top], color=INK, lw=0.8, ls=":")
    left = x[: top + 1][potential[: top + 1] < level]
    axes.plot([left[0], left[-1]], [level, level], color=RED, lw=2)
    axes.text(
        left[-1] + 0.25, level - 0.06, "energy below the barrier:\na proved stick", color=RED, ha="left", va="top"
    )
    axes.text(x[top], potential[top] + 0.02, "barrier", ha="center", va="bottom")
    axes.set_ylim(None, potential[top] + 0.15)
    axes.set(xlabel="gap", ylabel="effective potential", xticks=[], yticks=[], xlim=(0, 3))
    axes.spines[["top", "right"]].set_visible(False)
    return figure
