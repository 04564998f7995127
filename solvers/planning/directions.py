"""The direction of the lines through the scatter of planned impacts.

A line that is nearly parallel to a boundary gives its probability badly. Where one boundary is near, the lines go
across it; where several meet, between their normals.
"""

from __future__ import annotations

import numpy as np

from ..fitting import changes as boundaries
from ..fitting.law import BoundLaw
from ..fitting.lines import Lines
from ..fitting.measurements import Measurements

_NEAR = 4.0  # standard deviations within which a boundary counts
_TRIED = 36
_OUTCOMES = 3


def directions(law: BoundLaw, plan: Measurements) -> np.ndarray:
    """(rows,), angle from the axis of speeds to that of angles, both in standard deviations."""
    size = plan.size
    if not ((plan.speed_sd > 0) & (plan.angle_sd > 0)).any():
        return np.zeros(size)
    normal = np.full((size, _OUTCOMES, 2), np.nan)  # by the pair of outcomes, which their sum names
    nearest = np.full((size, _OUTCOMES), np.inf)
    for across in (0.0, np.pi / 2):
        lines = Lines.of(plan, np.full(size, across), np.ones(size, int))
        found = boundaries.locate(law, lines, within=1e-3)
        pair = found.before.astype(int) + found.after - 1
        known = np.flatnonzero((found.before >= 0) & (found.after >= 0) & (np.abs(found.y) < _NEAR))
        order = known[np.argsort(np.abs(found.y[known]))]
        row = lines.row[found.line]
        _, first = np.unique(row[order] * _OUTCOMES + pair[order], return_index=True)
        which = order[first]
        which = which[np.abs(found.y[which]) < nearest[row[which], pair[which]]]
        if not which.size:
            continue
        of = boundaries.normals(law, lines, found, which, True)
        speed, angle, at = of.speed, of.angle, row[which]
        if plan.relative:
            normal_speed, at_angle = lines.at(found.line[which], found.y[which])
            angle = angle - speed * normal_speed * np.tan(at_angle)
            speed = speed * np.cos(at_angle)
        pointing = np.column_stack([speed * plan.speed_sd[at], angle * plan.angle_sd[at]])
        with np.errstate(invalid="ignore", divide="ignore"):
            pointing /= np.linalg.norm(pointing, axis=1, keepdims=True)
        axis = np.array([np.cos(across), np.sin(across)])
        pointing[~np.isfinite(pointing).all(axis=1)] = axis
        nearest[at, pair[which]] = np.abs(found.y[which])
        normal[at, pair[which]] = pointing
    tried = np.pi * np.arange(_TRIED) / _TRIED
    cosine = np.abs(normal @ np.stack([np.cos(tried), np.sin(tried)]))
    worst = np.where(np.isfinite(cosine), cosine, 1.0).min(axis=1)
    return np.where(np.isfinite(nearest).any(axis=1), tried[worst.argmax(axis=1)], 0.0)
