"""Construction of a table: layouts, boundaries as series, results between them."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import ComputationError
from ..many.results import REVERSALS
from .cells import Strip
from .collisions import Signatures
from .data import Data
from .fit import Coarse, Order, Unresolved, fit
from .layout import EDGE_ORDER, Layout
from .maps import LINEAR, LOG, MAPS, ROOT
from .series import Forest, transform

ANGLE_MAPS = tuple(low + 3 * high for low in (LINEAR, ROOT) for high in (LINEAR, ROOT))
_SLICES = (0.04, 0.5, 0.96)  # places across a panel at which maps of a cell are compared
_UNRESOLVED = 10_000  # coefficients as which a line counts that a map does not resolve
_WORTH = 0.8  # a map is taken instead of a simpler one where it needs fewer coefficients by this factor
_PART = 0.15  # of the error asked for: tolerance of the series


@dataclass
class Slice:
    """A range of the third variable (or the whole of a table without one), and the layouts at its nodes."""

    low: float
    high: float
    layouts: list[Layout]


@dataclass
class Builder:
    """The flat arrays of a table while slices are added.

    Arguments:
        signatures: of the layouts.
        of: results.
        error: asked for.
        tell: called after every panel.
        orders: coefficients of a patch in angle and height.
    """

    signatures: Signatures
    of: tuple[str, ...]
    error: float
    tell: Callable[[], None]
    orders: tuple[int, int] = (14, 14)
    most: int = 4000
    shapes: Forest = field(init=False)
    values: Forest = field(init=False)
    first_panel: list[int] = field(default_factory=lambda: [0])
    cuts: list[tuple[int, int]] = field(default_factory=list)
    maps: list[int] = field(default_factory=list)
    first_edge: list[int] = field(default_factory=lambda: [0])
    edges: list[int] = field(default_factory=list)
    cells: list[tuple[int, int, int, int]] = field(default_factory=list)
    slices: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.shapes, self.values = Forest(1), Forest(len(self.of))

    def mark(self) -> tuple[int, ...]:
        """The lengths of everything, for `reset`."""
        lists = (self.first_panel, self.cuts, self.maps, self.first_edge, self.edges, self.cells, self.slices)
        return (*(len(one) for one in lists), *self.shapes.mark(), *self.values.mark())

    def reset(self, mark: tuple[int, ...]) -> None:
        """Take away what was added since a mark."""
        lists: tuple[list[Any], ...] = (
            self.first_panel, self.cuts, self.maps, self.first_edge, self.edges, self.cells, self.slices,
        )  # fmt: skip
        for one, size in zip(lists, mark):
            del one[size:]
        self.shapes.reset(mark[7:9])
        self.values.reset(mark[9:11])

    def add(self, part: Slice) -> None:
        """Add a slice. Coarse if its nodes do not resolve it; ComputationError where a function is not resolved."""
        self.slices = self.slices or [part.low]
        panels = part.layouts[0].panels
        previous = self._cut([one.panels[0].low for one in part.layouts])
        for which, panel in enumerate(panels):
            following = self._cut([one.panels[which].high for one in part.layouts])
            self.cuts.append((previous, following))
            strip = self._strip(part, which)
            self.maps.append(strip.code)
            self.edges += strip.edges
            self.first_edge.append(len(self.edges))
            for k, label in enumerate(panel.labels):
                self.cells.append(self._cell(strip, k, label))
            previous = following
            self.tell()
        self.slices.append(part.high)
        self.first_panel.append(len(self.maps))

    def _cut(self, angles: list[float]) -> int:
        """The root of an angle between panels, by its values at the nodes."""
        series = transform(len(angles)) @ np.array(angles)
        if len(angles) > 2 and np.abs(series[-2:]).sum() > 1e-7:
            raise Coarse("an angle where boundaries meet")
        root = self.shapes.node()
        self.shapes.leaf(root, np.zeros(2), np.ones(2), series.reshape(1, -1, 1, 1))
        return root

    def _strip(self, part: Slice, which: int) -> Strip:
        """A panel, with the map of the angle that needs the fewest coefficients."""
        panel = part.layouts[0].panels[which]
        best: tuple[float, int] = (np.inf, LINEAR)
        failure: Unresolved | None = None
        middle = Slice(part.low, part.high, [part.layouts[len(part.layouts) // 2]])
        for code in ANGLE_MAPS if panel.arcs else (LINEAR,):
            forest = Forest(1)
            try:
                self._edges(middle, which, code, forest)
            except Unresolved as error:
                failure = error
                continue
            cost = sum(one.size for one in forest.coefficients)
            if cost < _WORTH * best[0]:
                best = cost, code
            if len(forest.box) == len(panel.arcs):  # a patch for each boundary: smooth
                break
        if best[0] == np.inf and panel.arcs:
            assert failure is not None
            angle = np.degrees(panel.low + failure.place[0] * (panel.high - panel.low))
            names = " and ".join(self.signatures.said(label) for label in panel.labels)
            raise ComputationError(
                f"a boundary near {angle:.6g} deg between {names} could not be tabulated: {failure}",
                advice="leave that angle out of the range, or ask for a smaller range of St",
            )
        edges = self._edges(part, which, best[1], self.shapes)
        return Strip(part.layouts, which, best[1], self.shapes.trees(), edges)

    def _edges(self, part: Slice, which: int, code: int, forest: Forest) -> list[int]:
        strip = Strip(part.layouts, which, code, Forest(1).trees(), [])
        edges = []
        for k in range(len(part.layouts[0].panels[which].arcs)):

            def sample(points: np.ndarray, k: int = k) -> np.ndarray:
                heights = [
                    one.log_stokes(which, k, strip.angles(points[:, 0], m)) for m, one in enumerate(part.layouts)
                ]
                return np.stack(heights, axis=1)[:, :, None]

            edges.append(fit(forest, sample, EDGE_ORDER))
        return edges

    def _cell(self, strip: Strip, k: int, label: int) -> tuple[int, int, int, int]:
        """Outcome, first criterion, map and root of a cell."""
        outcome = self.signatures.outcomes[label]
        met = next((REVERSALS.index(one) for one in self.signatures.events[label] if one in REVERSALS), -1)
        if outcome == 0:
            return 0, -1, 0, -1
        tolerance = _PART * self.error
        code = self._map(strip, k, tolerance)
        order = Order(self.orders, tolerance, most=self.most)
        try:
            root = fit(self.values, lambda points: strip.results(points, k, code), order, seed=len(self.cells))
        except Unresolved as error:
            raise self._unresolved(strip, k, code, label, error) from None
        return outcome, met, code, root

    def _unresolved(self, strip: Strip, k: int, code: int, label: int, error: Unresolved) -> ComputationError:
        place = strip.place(error.place, k, code)
        return ComputationError(
            f"{self.signatures.said(label)} near {place} could not be tabulated to {self.error:g}: {error}",
            advice="leave that place out of the ranges, or ask for a larger error",
        )

    def _map(self, strip: Strip, k: int, tolerance: float) -> int:
        """The coordinate across cell k with which series along a few lines need the fewest coefficients.

        A code holds the maps of both ends, lower + 3 upper; those with the fewest logarithms are tried first.
        """
        middle = len(strip.layouts) // 2
        best: tuple[float, int] = (np.inf, LINEAR)
        for code in sorted(MAPS, key=lambda one: (one % 3 == LOG) + (one // 3 == LOG)):
            forest = Forest(len(self.of))
            for x in _SLICES:

                def sample(points: np.ndarray, x: float = x, code: int = code) -> np.ndarray:
                    across = np.column_stack([np.full(len(points), x), points[:, 1]])
                    return strip.results(across, k, code, middle)

                try:
                    fit(forest, sample, Order((1, 16), tolerance, most=80))
                except Unresolved:
                    forest.coefficients.append(np.zeros(_UNRESOLVED))
            cost = float(sum(one.size for one in forest.coefficients))
            if cost < _WORTH * best[0]:
                best = cost, code
            if len(forest.box) == len(_SLICES):  # a patch for each line: smooth
                break
        return best[1]

    def data(self, low: np.ndarray, high: np.ndarray, logarithmic: bool, kind: type) -> Data:
        """The arrays of the table, which readers evaluate."""
        outcome, criterion, cell_map, root = (
            np.array([one[k] for one in self.cells], dtype=kind_)
            for k, kind_ in enumerate((np.int8, np.int8, np.int8, np.int32))
        )
        return Data(
            low, high, logarithmic, np.array(self.slices), np.array(self.first_panel, dtype=np.int32),
            np.array(self.cuts, dtype=np.int32).reshape(-1, 2), np.array(self.maps, dtype=np.int8),
            np.array(self.first_edge, dtype=np.int32), np.array(self.edges, dtype=np.int32),
            outcome, criterion, cell_map, root,
            np.array([0.0 if name == "restitution" else np.nan for name in self.of]),
            self.shapes.trees(), self.values.trees(kind),
        )  # fmt: skip
