"""Reader of a table with numpy; the reader in C (`reader.h`) does the same, operation by operation."""

from dataclasses import dataclass

import numpy as np

from .data import Data
from .maps import forward, near

OUTSIDE = -1  # outcome of an impact outside the table
_LEAST = 1e-300


@dataclass(frozen=True)
class Read:
    """What a table says of impacts.

    Attributes:
        outcome: 0 stick, 1 stick-rotate-separate, 2 bounce, OUTSIDE.
        criterion: first rebound criterion of a bounce, -1 for none.
        values: results (n x results); NaN for a stick.
        slopes: their derivatives by the third variable (its logarithm where the table is over that), the angle and
            ln St (3 x n x results), if asked for.
        panel, cell, patch: where it was found; -1 outside, and no patch for a stick.
    """

    outcome: np.ndarray
    criterion: np.ndarray
    values: np.ndarray
    slopes: np.ndarray
    panel: np.ndarray
    cell: np.ndarray
    patch: np.ndarray


def read(data: Data, third: np.ndarray, angle: np.ndarray, height: np.ndarray, slopes: bool = False) -> Read:
    """Results at the third variable (or its logarithm), angles (rad) and ln St, 1-D arrays of one length."""
    size, count = angle.size, data.results.count
    at = np.stack([third, angle, height])
    inside = np.flatnonzero(((at >= data.low[:, None]) & (at <= data.high[:, None])).all(axis=0))
    outcome, criterion = np.full(size, OUTSIDE), np.full(size, -1)
    values = np.full((size, count), np.nan)
    along = np.full((3 if slopes else 0, size, count), np.nan)
    panels, cells, patches = (np.full(size, -1) for _ in range(3))
    if inside.size:
        place = Place(data, at[:, inside], slopes)
        panels[inside], cells[inside] = place.panel, place.cell
        outcome[inside], criterion[inside] = data.outcome[place.cell], data.criterion[place.cell]
        root = data.root[place.cell]
        free = np.flatnonzero(root >= 0)
        values[inside] = data.of_stick
        by_series, slope = data.results.values(root[free], place.t[free], place.x[free], place.z[free], slopes)
        values[inside[free]] = by_series
        patches[inside[free]] = data.results.patch_of(root[free], place.x[free], place.z[free])
        if slopes:
            along[:, inside] = 0.0 * data.of_stick
            along[:, inside[free]] = np.einsum("ijn,inm->jnm", place.chain[:, :, free], slope)
    return Read(outcome, criterion, values, along, panels, cells, patches)


def slice_of(data: Data, third: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The slices of values of the third variable, and the coordinates t there."""
    part = np.clip(np.searchsorted(data.slices, third, side="right") - 1, 0, data.slices.size - 2)
    return part, (third - data.slices[part]) / (data.slices[part + 1] - data.slices[part])


class Place:
    """The cells of impacts, and their coordinates there.

    Attributes:
        chain: derivatives of t, x and z (first index) by the three variables (second).
    """

    def __init__(self, data: Data, at: np.ndarray, slopes: bool) -> None:
        third, angle, height = at
        size = angle.size
        part, self.t = slice_of(data, third)
        wide = data.slices[part + 1] - data.slices[part]
        none = np.zeros(size)

        def shape(root: np.ndarray, which: np.ndarray | slice = slice(None)) -> tuple[np.ndarray, np.ndarray]:
            value, slope = data.shapes.values(root, self.t[which], self.x[which], none[which], True)
            return value[:, 0], slope[:2, :, 0]

        self.x = none
        panel, last = data.first_panel[part].copy(), data.first_panel[part + 1] - 1
        low, low_by = shape(data.cuts[panel, 0])
        high, high_by = shape(data.cuts[panel, 1])
        while True:
            on = np.flatnonzero((angle >= high) & (panel < last))
            if not on.size:
                break
            panel[on] += 1
            low[on], low_by[:, on] = high[on], high_by[:, on]
            value, slope = shape(data.cuts[panel[on], 1], on)
            high[on], high_by[:, on] = value, slope
        across = np.clip((angle - low) / (high - low), 0.0, 1.0)
        x, by_across, _ = forward(data.maps[panel], across, 0.0)
        self.x = np.clip(x, 0.0, 1.0)
        x_by_t = by_across * -(low_by[0] + across * (high_by[0] - low_by[0])) / (high - low)
        x_by_angle = by_across / (high - low)

        edge, end = data.first_edge[panel].copy(), data.first_edge[panel + 1]
        floor, floor_by = np.full(size, data.low[2]), np.zeros((2, size))
        ceiling, ceiling_by = np.full(size, data.high[2]), np.zeros((2, size))
        open_ = np.flatnonzero(edge < end)
        while open_.size:
            value, slope = shape(data.edges[edge[open_]], open_)
            above = height[open_] >= value
            up, down = open_[above], open_[~above]
            floor[up], floor_by[:, up] = value[above], slope[:, above]
            ceiling[down], ceiling_by[:, down] = value[~above], slope[:, ~above]
            edge[up] += 1
            open_ = up[edge[up] < end[up]]
        self.panel, self.cell = panel, edge + panel
        tall = np.maximum(ceiling - floor, _LEAST)
        part_up = np.clip((height - floor) / tall, 0.0, 1.0)
        least = near(tall)
        z, by_part, by_least = forward(data.cell_map[self.cell], part_up, least)
        self.z = np.clip(z, 0.0, 1.0)
        if not slopes:
            return
        grows = ceiling_by - floor_by
        z_by = by_part * -(floor_by + part_up * grows) / tall - by_least * least * grows / tall
        self.chain = np.zeros((3, 3, size))
        self.chain[0, 0] = 1 / wide
        self.chain[1, 0], self.chain[1, 1] = x_by_t / wide, x_by_angle
        self.chain[2, 0] = (z_by[0] + z_by[1] * x_by_t) / wide
        self.chain[2, 1] = z_by[1] * x_by_angle
        self.chain[2, 2] = by_part / tall
