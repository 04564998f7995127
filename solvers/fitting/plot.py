"""A fit as a figure: data over the map, results with their band, profiles and residuals."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from scipy.stats import chi2

from ...generated.automaton import OUTCOMES
from ..formatting.style import EDGES, FILLS, INK, LETTERS, NOTE, broken, patch, picture, plain_text
from ..formatting.ticks import plain
from ..many.collide_many import collide_many
from ..results import DEFINITIONS
from ..scene.held import AXIS_LABELS
from .free_entries import unit_shown
from .joint import Part, home
from .measurements import OBSERVED
from .optimise import whitening
from .profiles import profile_point
from .result import Fit

_GRID = 40  # points of the map along each axis
_FINE = 120  # of the outcomes of the estimates
_TRIED = 32  # values of the entries, for bands
_JOINT = 0.95
_CURVE = 80  # points of a curve of a result
_PROFILE = 5  # points of a profile to each side
_MARKS = {0: "o", 1: "s", 2: "^", -1: "x"}  # by outcome; -1: not recorded
_LINES = ("#2a6f97", "#c1554a", "#4f772d")


@picture
def draw(fit: Fit) -> Figure:
    """The four kinds of pictures of a fit in one figure."""
    free, count = fit.free, len(fit.parts)
    figure = Figure(figsize=(11.0, 3.4 + 4.2 * count), layout="constrained")
    halves: Any = figure.subfigures(2, 1, height_ratios=(1.25 * count, 1.0))
    top, bottom = halves
    samples, pairs, at = _samples(fit), top.subplots(count, 2, squeeze=False), 0
    for (left, right), member in zip(pairs, fit.parts, strict=True):
        own = samples[:, [free.names.index(member.entries[name]) for name in member.names]]
        rows = np.arange(at, at := at + member.data.size)
        _map(left, member, own, fit.rows.contradicting[np.isin(fit.rows.contradicting, rows)] - rows[0])
        _results(right, member, own, {name: values[rows] for name, values in fit.rows.expected.items()})
        for axes in (left, right) if count > 1 else ():
            axes.set_title(f"{plain_text(member.label)}\n{axes.get_title()}", fontsize=9)
    axes = bottom.subplots(1, free.size + 1, width_ratios=[1.0] * free.size + [1.5], squeeze=False)[0]
    for k in range(free.size):
        _profile(axes[k], fit, k)
    axes[0].set_ylabel("log-likelihood - maximum")
    _residuals(axes[-1], fit)
    return figure


def _samples(fit: Fit) -> np.ndarray:
    """Values of the entries within their joint 95 % region, the estimates first; bands are the range over them.

    The ends of the intervals are among them: where the likelihood falls faster to one side than its curvature says, all
    that is drawn on that side may be less likely.
    """
    free, objective = fit.free, fit.objective
    white = whitening(objective, fit.best)
    ends = [(estimate.low, estimate.high) for estimate in fit.estimates.values()]
    low = [free.low[k] if end[0] is None else free.entries[k].inner(end[0]) for k, end in enumerate(ends)]
    high = [free.high[k] if end[1] is None else free.entries[k].inner(end[1]) for k, end in enumerate(ends)]
    radius = np.sqrt(chi2.ppf(_JOINT, free.size))
    normal = np.random.default_rng(0).standard_normal((_TRIED, free.size))
    normal *= radius * np.linspace(0.4, 1.0, _TRIED)[:, None] / np.linalg.norm(normal, axis=1)[:, None]
    least = objective.value(fit.best) - radius**2 / 2
    ends_inside = [point for both in fit.ends for point in both if np.isfinite(objective.value(point))]
    inside = [fit.best, *ends_inside]
    tried = np.clip(fit.best + normal @ white.T, low, high)
    inside += [point for point in tried if objective.value(point) >= least]
    return np.array([free.values(point) for point in inside])


def _collided(member: Part, values: np.ndarray, speed: np.ndarray, angle: np.ndarray, of: tuple[str, ...] = ()) -> Any:
    """Collisions at all points with each of several values of the part's entries, (values, points)."""
    count, size = values.shape[0], speed.size
    vary = {}
    for k, name in enumerate(member.names):
        vary[name] = member.scene.as_given(name, np.repeat(values[:, k], size))
    kind: dict[str, Any] = {member.data.speed_name: np.tile(speed, count)}
    return collide_many(member.scene, angle=np.tile(angle, count), vary=vary, of=("outcome", *of), **kind)


def _map(axes: Axes, member: Part, samples: np.ndarray, odd: np.ndarray) -> None:
    data = member.data
    low, high = data.speed.min(), data.speed.max()
    margin = max((high / low) ** 0.06, 1.05)
    first, last = np.degrees([data.angle.min(), data.angle.max()])
    pad = max(0.06 * (last - first), 1.5)
    limits = np.radians(max(first - pad, 0.0)), np.radians(min(last + pad, 89.0))

    def outcomes(values: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        speed = np.geomspace(low / margin, high * margin, count)
        angle = np.linspace(limits[0], limits[1], count)
        points = [grid.ravel() for grid in np.meshgrid(speed, angle, indexing="ij")]
        outcome = _collided(member, values, points[0], points[1]).outcome.values.reshape(-1, count, count)
        return np.degrees(angle), speed, outcome

    degrees, speed, codes = outcomes(samples[:1], _FINE)
    colours = ListedColormap([FILLS[name] for name in OUTCOMES])
    axes.pcolormesh(degrees, speed, codes[0], cmap=colours, vmin=-0.5, vmax=2.5, shading="nearest", rasterized=True)
    for code in range(len(OUTCOMES)):
        inside = (codes[0] == code).astype(float)
        if 0 < inside.mean() < 1:
            axes.contour(degrees, speed, inside, levels=[0.5], colors=[INK], linewidths=0.9)
    rough_degrees, rough_speed, several = outcomes(samples, _GRID)
    differs = (several != several[0]).any(axis=0).astype(float)
    if differs.any():
        axes.contourf(rough_degrees, rough_speed, differs, levels=[0.5, 1.5], colors=["#000000"], alpha=0.18)
    handles = []
    for code, mark in _MARKS.items():
        seen = data.outcome == code
        if seen.any():
            style: Any = {"color": INK, "marker": mark, "linestyle": "", "markerfacecolor": "white", "markersize": 5}
            axes.plot(np.degrees(data.angle[seen]), data.speed[seen], **style, clip_on=False, zorder=3)
            label = f"{LETTERS[OUTCOMES[code]]} observed" if code >= 0 else "outcome not recorded"
            handles.append(Line2D([], [], **style, label=label))
    if odd.size:
        style = {"color": "#b00020", "marker": "o", "linestyle": "", "markerfacecolor": "none"}
        axes.plot(np.degrees(data.angle[odd]), data.speed[odd], **style, markersize=11, clip_on=False, zorder=3)
        handles.append(Line2D([], [], **style, markersize=9, label="contradicts the model"))
    present = [patch(name) for code, name in enumerate(OUTCOMES) if (codes[0] == code).any()]
    for handle in present:
        handle.set(edgecolor=INK, hatch=None, linewidth=0.6)  # the legend may lie on the same colour
    axes.set_yscale("log")
    plain(axes.yaxis)
    axes.set_xlabel("impact angle (deg)")
    axes.set_ylabel(AXIS_LABELS[data.speed_name])
    axes.legend(handles=present + handles, fontsize=6.5, loc="best", frameon=True, framealpha=0.9)
    axes.set_title(
        "impacts on the fitted map; shaded: where the outcome is uncertain (95 %)" + _caveat(member), fontsize=9
    )


def _results(axes: Axes, member: Part, samples: np.ndarray, expected: Mapping[str, np.ndarray]) -> None:
    data = member.data
    name = next((result for result in expected if result in OBSERVED), "")
    if not name:
        axes.axis("off")
        axes.text(0.5, 0.5, "no result was measured beside the outcome", ha="center", va="center", color=NOTE)
        return
    measured, sd = data.observed[name]
    rows = np.flatnonzero(np.isfinite(measured))
    speed = np.geomspace(0.9 * data.speed.min(), 1.1 * data.speed.max(), _CURVE)
    for colour, group in zip(_LINES, _by_angle(data.angle[rows])):
        group = rows[group]
        angle = float(np.mean(data.angle[group]))
        collided = _collided(member, samples, speed, np.full(_CURVE, angle), (name,))
        values, outcome = (collided[of].values.reshape(-1, _CURVE) for of in (name, "outcome"))
        mask = np.isfinite(values).mean(axis=0) > 0.5
        low, high = (np.where(mask, extreme(values, axis=0), np.nan) for extreme in (np.fmin.reduce, np.fmax.reduce))
        at, low, high, best = broken(outcome[0], speed, low, high, values[0])
        axes.fill_between(at, low, high, color=colour, alpha=0.25, linewidth=0)
        axes.plot(at, best, color=colour, linewidth=1.2, label=f"{np.degrees(angle):.3g}°")
        axes.errorbar(data.speed[group], measured[group], sd[group], data.speed_sd[group], fmt="o", color=colour,
                      markersize=3.5, elinewidth=0.7)  # fmt: skip
        if data.columns:
            axes.plot(data.speed[group], expected[name][group], "_", color=colour, markersize=10)
    axes.set_xscale("log")
    plain(axes.xaxis)
    axes.set_xlabel(AXIS_LABELS[data.speed_name])
    axes.set_ylabel(_label(name))
    axes.legend(title="mean angle of the group", fontsize=7, title_fontsize=7)
    dashes = ";\ndashes: the fit with each impact's group entries" if data.columns else ""
    what = "measured, and the fit at the mean angle of each group with its band (95 %)"
    axes.set_title(what + _caveat(member) + dashes, fontsize=9)


def _label(name: str) -> str:
    row = DEFINITIONS[name]
    symbol, unit = f" ${row.symbol}$" if row.symbol else "", f" ({row.unit})" if row.unit != "1" else ""
    return f"{row.label.removesuffix(row.symbol).rstrip()}{symbol}{unit}"


def _caveat(member: Part) -> str:
    """The note of a picture for one value of every entry, where entries differ from impact to impact."""
    names = ", ".join(member.data.columns)
    return f",\nwith the scene's group {names}" if names else ""


def _by_angle(angle: np.ndarray) -> list[np.ndarray]:
    """Indices of at most three groups of neighbouring angles."""
    distinct, which = np.unique(np.round(angle, 4), return_inverse=True)
    parts = np.array_split(np.arange(distinct.size), min(len(_LINES), distinct.size))
    return [np.flatnonzero(np.isin(which, group)) for group in parts]


def _profile(axes: Axes, fit: Fit, k: int) -> None:
    free, objective, best = fit.free, fit.objective, fit.best
    entry = free.entries[k]
    estimate = fit.estimates[entry.name]
    unit, size = unit_shown(*home(fit.parts, entry.name))
    top = objective.value(best)
    places, heights = [float(best[k])], [0.0]
    sides = (estimate.low, free.low[k]), (estimate.high, free.high[k])
    for (bound, limit), end in zip(sides, fit.ends[k], strict=True):
        far = limit if bound is None else best[k] + 1.35 * (entry.inner(bound) - best[k])
        outward = np.linspace(best[k], np.clip(far, free.low[k], free.high[k]), _PROFILE + 1)[1:]
        both = _followed(fit, k, best, outward), _followed(fit, k, end, outward[::-1])[::-1]
        higher = np.maximum(*both) - top  # the other entries may have several maxima
        possible = np.isfinite(higher)
        places += outward[possible].tolist()
        heights += higher[possible].tolist()
    order = np.argsort(places)
    values = np.array([entry.outer(at) for at in np.array(places)[order]]) / size
    axes.plot(values, np.array(heights)[order], "-", color=_LINES[0], marker=".", markersize=4)
    axes.axhline(-objective.drop, color=NOTE, linewidth=0.8, linestyle="--")
    for bound in (estimate.low, estimate.high):
        if bound is not None:
            axes.axvline(bound / size, color=NOTE, linewidth=0.8)
    axes.axvline(estimate.value / size, color=INK, linewidth=0.8)
    if entry.log and values.max() > 20 * values.min():
        axes.set_xscale("log")
    axes.set_ylim(max(min(min(heights), -objective.drop) * 1.1, min(-5.0, -1.5 * objective.drop)), 0.4)
    name, _, owner = entry.name.partition("@")
    label = f"{'noise of ' * name.startswith('noise.')}{name.rpartition('.')[2].replace('_', ' ')}"
    axes.set_xlabel(plain_text(f"{owner}: {label}" if owner else label) + (f" ({unit})" if unit else ""))
    axes.set_title(f"{estimate.verdict} {estimate.precision}".rstrip(), fontsize=8)


def _followed(fit: Fit, k: int, start: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Heights of the profile at places of entry k, the other entries each time from the line through the last two."""
    heights, before = [], fit.best
    for at in places.tolist():
        step = (at - start[k]) / (start[k] - before[k]) if start[k] != before[k] else 0.0
        ahead = np.clip(start + step * (start - before), fit.free.low, fit.free.high)
        point = profile_point(fit.objective, ahead if np.isfinite(fit.objective.value(ahead)) else start, k, at)
        heights.append(fit.objective.value(point))
        before, start = (start, point) if np.isfinite(heights[-1]) else (before, start)
    return np.array(heights)


def _residuals(axes: Axes, fit: Fit) -> None:
    data, rows = fit.data, fit.rows
    axes.axhspan(-2, 2, color=NOTE, alpha=0.12, linewidth=0)
    axes.axhline(0, color=NOTE, linewidth=0.8)
    for name, residual in rows.residual.items():
        for code, mark in _MARKS.items():
            points = np.isfinite(residual) & (data.outcome == code)
            if points.any():
                outcome = LETTERS[OUTCOMES[code]] if code >= 0 else "outcome not recorded"
                fill = EDGES[OUTCOMES[code]] if code >= 0 else INK
                axes.plot(data.speed[points], residual[points], mark, color=INK, markerfacecolor=fill, markersize=5,
                          label=f"{outcome}, {name.replace('_', ' ')}")  # fmt: skip
    stuck = ~data.separated
    if stuck.any():
        surprise = np.sqrt(np.maximum(-2 * np.log(np.maximum(rows.probability[stuck], 1e-9)), 0.0))
        axes.plot(
            data.speed[stuck], surprise, "o", color=INK, markerfacecolor="white", markersize=4, label="outcome alone"
        )
    axes.set_xscale("log")
    plain(axes.xaxis)
    axes.set_xlabel(AXIS_LABELS[data.speed_name])
    axes.set_ylabel("residual (standard deviations)")
    axes.legend(fontsize=6.5)
    axes.set_title("residuals", fontsize=9)
