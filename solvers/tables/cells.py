"""Collisions at points of a cell: between two boundaries of an angle panel, at the nodes of the third variable."""

from dataclasses import dataclass

import numpy as np

from .layout import Layout
from .maps import LEAST, inverse, near
from .series import Trees, nodes

_ASIDE = (5e-8, -5e-8, 1.5e-7, -1.5e-7, 3e-7, -3e-7, 6e-7, -6e-7)  # in ln St: where a collision is of another cell
_SLIVER = 2e-6  # height of a cell in ln St below which any collision near it may answer


@dataclass
class Strip:
    """An angle panel with its boundaries as series.

    Attributes:
        layouts: at the nodes of the third variable.
        which: number of the panel.
        code: map of the angle.
        edges: roots of the boundaries in `shapes`.
    """

    layouts: list[Layout]
    which: int
    code: int
    shapes: Trees
    edges: list[int]

    def angles(self, x: np.ndarray, m: int) -> np.ndarray:
        """Angles of coordinates x at a node of the third variable."""
        panel = self.layouts[m].panels[self.which]
        return panel.low + inverse(self.code, x, 0.0) * (panel.high - panel.low)

    def ends(self, x: np.ndarray, m: int, k: int) -> tuple[np.ndarray, np.ndarray]:
        """The lowest and highest ln St of cell k at coordinates x."""
        low, high = np.log(self.layouts[m].plane.stokes)
        t, none = np.full(x.size, nodes(len(self.layouts))[m]), np.zeros(x.size)

        def edge(j: int, end: float) -> np.ndarray:
            if not 0 <= j < len(self.edges):
                return np.full(x.size, end)
            return self.shapes.values(np.full(x.size, self.edges[j]), t, x, none)[0][:, 0]

        return edge(k - 1, low), edge(k, high)

    def place(self, at: np.ndarray, k: int, code: int) -> str:
        """A place (x, z) of cell k, and what a collision there is, in words."""
        m = len(self.layouts) // 2
        angle, height = self._at(at[None], m, k, code)[:2]
        plane = self.layouts[m].plane
        label = int(plane.at(angle, np.exp(height), ())[0][0])
        return f"{np.degrees(angle[0]):.6g} deg, St {np.exp(height[0]):.6g} (there: {plane.signatures.said(label)})"

    def results(self, points: np.ndarray, k: int, code: int, only: int | None = None) -> np.ndarray:
        """Results (n x nodes x results) at points (x, z) of cell k with this map; NaN where there are none.

        Arguments:
            only: the one node of the third variable to compute.
        """
        which = range(len(self.layouts)) if only is None else [only]
        return np.stack([self._results(points, m, k, code) for m in which], axis=1)

    def _at(
        self, points: np.ndarray, m: int, k: int, code: int
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Angles, ln St, and the ends of the cell there."""
        floor, ceiling = self.ends(points[:, 0], m, k)
        tall = np.maximum(ceiling - floor, 0.0)
        height = floor + inverse(code, points[:, 1], near(tall)) * tall
        margin = np.minimum(0.5 * LEAST, 0.5 * tall)
        return self.angles(points[:, 0], m), np.clip(height, floor + margin, ceiling - margin), floor, ceiling

    def _results(self, points: np.ndarray, m: int, k: int, code: int) -> np.ndarray:
        layout = self.layouts[m]
        plane, label = layout.plane, layout.panels[self.which].labels[k]
        angle, height, floor, ceiling = self._at(points, m, k, code)
        # an edge of the range is no boundary
        height = np.clip(height, *np.log(plane.stokes))
        labels, values = plane.at(angle, np.exp(height))
        for aside in _ASIDE:
            wrong = np.flatnonzero(labels != label)
            if not wrong.size:
                return values
            moved = np.clip(height[wrong] + aside, *np.log(plane.stokes))
            again, recomputed = plane.at(angle[wrong], np.exp(moved))
            fits = again == label
            labels[wrong[fits]], values[wrong[fits]] = label, recomputed[fits]
        wrong = labels != label
        values[wrong] = np.nan
        slivers = wrong & (ceiling - floor < _SLIVER)
        if slivers.any() and not wrong.all():
            _fill(values, slivers, ~wrong, points)
        return values


def _fill(values: np.ndarray, missing: np.ndarray, known: np.ndarray, points: np.ndarray) -> None:
    """Values of the nearest known points, where a cell is too thin to matter."""
    have = np.flatnonzero(known)
    for k in np.flatnonzero(missing).tolist():
        distance = ((points[have] - points[k]) ** 2 * (1.0, 100.0)).sum(axis=1)
        values[k] = values[have[int(np.argmin(distance))]]
