"""Gauss-Kronrod panels: means with an error estimate, the difference from the Gauss rule on a part of the nodes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

# Piessens, de Doncker-Kapenga, Ueberhuber & Kahaner, QUADPACK, 1983: points on (-1, 0], and their weights
_POINTS = np.array([
    -0.991455371120812639206854697526329, -0.949107912342758524526189684047851, -0.864864423359769072789712788640926,
    -0.741531185599394439863864773280788, -0.586087235467691130294144691258438, -0.405845151377397166906606412076961,
    -0.207784955007898467600689403773245, 0.0,
])  # fmt: skip
_WEIGHTS = np.array([
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204, 0.104790010322250183839876322541518,
    0.140653259715525918745189590510238, 0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714,
])  # fmt: skip

POINTS = (1 + np.concatenate([_POINTS, -_POINTS[-2::-1]])) / 2
"""Nodes on (0, 1)."""
KRONROD = np.concatenate([_WEIGHTS, _WEIGHTS[-2::-1]]) / 2
"""Their weights by Kronrod's rule."""
GAUSS = np.zeros(POINTS.size)
"""Their weights by Gauss's rule, 0 at every other node."""
GAUSS[1::2] = np.polynomial.legendre.leggauss(POINTS.size // 2)[1] / 2


@dataclass(frozen=True)
class Panels:
    """Panels of integrals; each is a part of an interval, in a variable u from 0 to 1 along the interval.

    At an end that is sharp, where an integrand may start as a square root, the map from u is quadratic.

    Attributes:
        owner: index of what the interval belongs to.
        low, high: the interval.
        sharp_low, sharp_high: whether its ends are sharp.
        first, last: the part, in u.
    """

    owner: np.ndarray
    low: np.ndarray
    high: np.ndarray
    sharp_low: np.ndarray
    sharp_high: np.ndarray
    first: np.ndarray
    last: np.ndarray

    @classmethod
    def over(cls, low: np.ndarray, high: np.ndarray, sharp_low: np.ndarray, sharp_high: np.ndarray) -> Panels:
        """One panel for each interval, which it belongs to."""
        return cls(np.arange(low.size), low, high, sharp_low, sharp_high, np.zeros(low.size), np.ones(low.size))

    @property
    def size(self) -> int:
        return int(self.owner.size)

    def joined(self, other: Panels) -> Panels:
        """The panels of both."""
        return Panels(*(np.concatenate([values, vars(other)[name]]) for name, values in vars(self).items()))

    def part(self, which: np.ndarray) -> Panels:
        return Panels(*(values[which] for values in vars(self).values()))

    def halved(self) -> Panels:
        """Both halves of every panel."""
        middle = (self.first + self.last) / 2
        return replace(self, last=middle).joined(replace(self, first=middle))

    def nodes(self) -> tuple[np.ndarray, np.ndarray]:
        """Nodes, and the lengths that belong to them (to be multiplied by weights of a rule): (panels, nodes)."""
        part = (self.last - self.first)[:, None]
        u = self.first[:, None] + part * POINTS
        low, high = self.sharp_low[:, None], self.sharp_high[:, None]
        place = np.where(low & high, u * u * (3 - 2 * u), np.where(low, u * u, np.where(high, u * (2 - u), u)))
        slope = np.where(low & high, 6 * u * (1 - u), np.where(low, 2 * u, np.where(high, 2 * (1 - u), 1.0)))
        length = (self.high - self.low)[:, None]
        return self.low[:, None] + length * place, length * part * slope


def summed(owner: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Sums of the rows of `values` that have the same owner: (count, columns)."""
    return np.stack([np.bincount(owner, column, count) for column in values.T], axis=1)
