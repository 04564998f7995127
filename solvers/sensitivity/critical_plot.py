"""Critical speeds as a picture."""

import math
from collections.abc import Sequence
from typing import Any

from ..formatting.style import NOTE, picture


@picture
def draw(found: Sequence[Any]) -> Any:
    """Relative speed up to which impacts stick, over the angle; by material where each has one angle."""
    from matplotlib.figure import Figure

    labels = list(dict.fromkeys(one.material for one in found))
    by_material = len(labels) == len(found) > 1
    figure = Figure(figsize=(6.4, 4.0), layout="constrained")
    axes = figure.subplots()
    for label in [""] if by_material else labels:
        rows = [one for one in found if by_material or one.material == label]
        x = [float(k) if by_material else math.degrees(one.angle) for k, one in enumerate(rows)]
        y = [math.nan if one.relative_speed is None else one.relative_speed for one in rows]
        (line,) = axes.plot(x, y, "o" if by_material else "o-", label=label or None)
        for at, one in zip(x, rows, strict=True):
            ends = [each for each in one.interval or () if each is not None]
            if len(ends) == 2:
                axes.plot([at, at], ends, "-", color=line.get_color(), linewidth=3, alpha=0.4)
            if one.bounces_above not in (None, one.relative_speed):
                axes.plot(at, one.bounces_above, "^", color=NOTE, markersize=4)
    if by_material:
        axes.set_xticks(range(len(labels)), labels, rotation=30, ha="right")
    elif len(labels) > 1:
        axes.legend()
    axes.set(yscale="log", xlabel="" if by_material else "impact angle (deg)", ylabel="relative speed (m/s)")
    axes.set_title("sticks up to (circles, bars: 95 % interval); bounces above (triangles)", fontsize=9)
    return figure
