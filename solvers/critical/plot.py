"""Critical speeds as a picture."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ..formatting.style import INK, NOTE, picture

if TYPE_CHECKING:
    from .result import Critical


@picture
def draw(found: Critical) -> Any:
    """Relative speed up to which impacts stick, over the angle; by material where each has one angle."""
    from matplotlib.figure import Figure

    labels = list(dict.fromkeys(one.label for one in found.rows))
    by_angle = len(found.rows) > len(labels) or len(labels) == 1
    figure = Figure(figsize=(6.4, 4.0), layout="constrained")
    axes = figure.subplots()
    for label in labels if by_angle else [""]:
        rows = [one for one in found.rows if not by_angle or one.label == label]
        x = [math.degrees(one.angle) for one in rows] if by_angle else list(range(len(rows)))
        y = [math.nan if one.relative_speed is None else one.relative_speed for one in rows]
        style = "o-" if by_angle and len(labels) > 1 else "o"
        (line,) = axes.plot(
            x, y, style, label=label or None, **({} if len(labels) > 1 and by_angle else {"color": INK})
        )
        for at, one in zip(x, rows, strict=True):
            if one.interval is not None and None not in one.interval:
                axes.plot([at, at], one.interval, "-", color=line.get_color(), linewidth=3, alpha=0.4)
            if one.bounces_above is not None and one.bounces_above != one.relative_speed:
                axes.plot(at, one.bounces_above, "^", color=NOTE, markersize=4)
    if not by_angle:
        axes.set_xticks(range(len(labels)), labels, rotation=30, ha="right")
    axes.set_yscale("log")
    axes.set_xlabel("impact angle (deg)" if by_angle else "")
    axes.set_ylabel("relative speed (m/s)")
    axes.set_title("sticks up to (o, with its 95 % interval); bounces above (^)", fontsize=9)
    if by_angle and len(labels) > 1:
        axes.legend()
    return figure
