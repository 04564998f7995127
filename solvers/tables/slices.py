"""Slices of the third variable: ranges in which all planes have the same layout, and the layouts at their nodes."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..boundaries.plane import ANGLE
from ..changes.brackets import bisect
from ..errors import ComputationError
from ..scene.scene import Scene
from .build import Builder, Slice
from .collisions import Collisions, Signatures
from .data import Range
from .fit import Coarse
from .layout import Layout, layout_of, with_kinks
from .series import nodes

NODES = 8  # of the third variable in a slice
_MOST = 40  # slices
_APART = 3e-7  # relative distance between values with different layouts at which the change between them is located


@dataclass
class Slicer:
    """Makes slices and adds them to a builder; looks at the impacts `doubts` (third variable, angle, St) as well."""

    scene: Scene
    range: Range
    rtol: float
    of: tuple[str, ...]
    doubts: np.ndarray
    tell: Callable[[], None]
    signatures: Signatures = field(default_factory=Signatures)
    made: int = field(default=0, init=False)
    collisions: int = field(default=0, init=False)
    failures: list[str] = field(default_factory=list, init=False)
    _layouts: dict[float, Layout] = field(default_factory=dict, init=False)

    def layout(self, at: float) -> Layout:
        """The layout at a value of the third variable (or its logarithm)."""
        if at not in self._layouts:
            scene = self.scene
            if self.range.third is not None:
                scene = scene.with_si({self.range.third: math.exp(at) if self.range.logarithmic else at})
            plane = Collisions(
                scene, ANGLE, self.range.angle, self.range.stokes, self.rtol, of=self.of, signatures=self.signatures
            )
            layout = with_kinks(layout_of(plane, self.doubts[:, 1:]))
            self.failures += layout.failures
            self._layouts[at] = layout
            self.tell()
        return self._layouts[at]

    def fill(self, builder: Builder) -> None:
        """Add all slices to a builder."""
        low, high = self.range.corners
        if self.range.third is None:
            builder.add(Slice(0.0, 1.0, [self.layout(0.0)]))
        else:
            self._fill(builder, float(low[0]), float(high[0]))
        self.collisions = sum(one.plane.collisions for one in self._layouts.values())

    def _fill(self, builder: Builder, low: float, high: float) -> None:
        self.made += 1
        if self.made > _MOST:
            raise ComputationError(
                f"more than {_MOST} slices of {self.range.third} would be needed, near {self._shown(low)}",
                advice="ask for a smaller range of it",
            )
        places = (low + nodes(NODES) * (high - low)).tolist()
        layouts = [self.layout(at) for at in places]
        for k in range(NODES - 1):
            if layouts[k].signatures != layouts[k + 1].signatures:
                first, last = self._changes(places[k], places[k + 1])
                self._fill(builder, low, first)
                builder.slices[-1] = last  # what lies between is as close to one side as to the other
                self._fill(builder, last, high)
                return
        before = builder.mark()
        try:
            builder.add(Slice(low, high, layouts))
        except Coarse:
            builder.reset(before)
            middle = 0.5 * (low + high)
            self._fill(builder, low, middle)
            self._fill(builder, middle, high)

    def _changes(self, low: float, high: float) -> tuple[float, float]:
        """Two values close to each other between which the layout changes."""
        signatures = self.layout(low).signatures
        apart = _APART * (1.0 if self.range.logarithmic else max(abs(low), abs(high)))

        def is_below(at: np.ndarray) -> np.ndarray:
            return np.array([self.layout(float(each)).signatures == signatures for each in at])

        first, last = bisect(is_below, np.array([low]), np.array([high]), apart)
        return float(first[0]), float(last[0])

    def _shown(self, at: float) -> str:
        return f"{math.exp(at) if self.range.logarithmic else at:.6g}"
