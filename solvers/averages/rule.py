"""Gauss-Kronrod panels: means with an error estimate, the difference from the Gauss rule on a part of the nodes."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np


@dataclass(frozen=True)
class Rule:
    """Two rules on (0, 1): points, and the weights of Kronrod's and of Gauss's, which are 0 at every other point."""

    points: np.ndarray
    kronrod: np.ndarray
    gauss: np.ndarray

    @classmethod
    def of(cls, points: tuple[float, ...], kronrod: tuple[float, ...], gauss: tuple[float, ...]) -> Rule:
        """The rule from what is printed: points on (-1, 1) that are not negative, descending, and their weights."""
        inner = np.zeros(2 * len(points) - 1)
        inner[1::2] = _mirrored(np.array(gauss), len(points) - 1)
        half = np.array(points)
        return cls(
            (1 + np.concatenate([-half, half[-2::-1]])) / 2, _mirrored(np.array(kronrod), inner.size) / 2, inner / 2
        )

    @property
    def size(self) -> int:
        return int(self.points.size)


def _mirrored(half: np.ndarray, size: int) -> np.ndarray:
    """Weights from one end to the middle, continued to the other end; an odd number has one in the middle."""
    return np.concatenate([half, half[size // 2 - 1 :: -1]])


# Piessens, de Doncker-Kapenga, Ueberhuber & Kahaner, QUADPACK, 1983: 7 and 15 points
RULE = Rule.of(
    (
        0.991455371120812639206854697526329, 0.949107912342758524526189684047851, 0.864864423359769072789712788640926,
        0.741531185599394439863864773280788, 0.586087235467691130294144691258438, 0.405845151377397166906606412076961,
        0.207784955007898467600689403773245, 0.0,
    ),
    (
        0.022935322010529224963732008058970, 0.063092092629978553290700663189204, 0.104790010322250183839876322541518,
        0.140653259715525918745189590510238, 0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
        0.204432940075298892414161999234649, 0.209482141084727828012999174891714,
    ),
    (
        0.129484966168869693270611432679082, 0.279705391489276667901467771423780, 0.381830050505118944950369775488975,
        0.417959183673469387755102040816327,
    ),
)  # fmt: skip


@dataclass(frozen=True)
class Panels:
    """Panels of integrals; each is a part of an interval, in a variable u from 0 to 1 along the interval.

    At an end that is sharp, where an integrand may start as a square root, the map from u is quadratic.

    Attributes:
        of: index of what the interval belongs to.
        low, high: the interval.
        sharp_low, sharp_high: whether its ends are sharp.
        first, last: the part, in u.
    """

    of: np.ndarray
    low: np.ndarray
    high: np.ndarray
    sharp_low: np.ndarray
    sharp_high: np.ndarray
    first: np.ndarray
    last: np.ndarray

    @classmethod
    def whole(
        cls, of: np.ndarray, low: np.ndarray, high: np.ndarray, sharp_low: np.ndarray, sharp_high: np.ndarray
    ) -> Panels:
        """One panel for each interval."""
        return cls(of, low, high, sharp_low, sharp_high, np.zeros(of.size), np.ones(of.size))

    @property
    def size(self) -> int:
        return int(self.of.size)

    @staticmethod
    def joined(*parts: Panels) -> Panels:
        """All panels of these."""
        return Panels(*(np.concatenate([getattr(one, each.name) for one in parts]) for each in fields(Panels)))

    def where(self, which: np.ndarray) -> Panels:
        return Panels(*(getattr(self, each.name)[which] for each in fields(self)))

    def halved(self) -> Panels:
        """Both halves of every panel."""
        middle = (self.first + self.last) / 2
        return Panels.joined(replace(self, last=middle), replace(self, first=middle))

    def nodes(self, rule: Rule) -> tuple[np.ndarray, np.ndarray]:
        """Nodes, and the lengths that belong to them (to be multiplied by weights of the rule): (panels, points)."""
        part = (self.last - self.first)[:, None]
        u = self.first[:, None] + part * rule.points
        low, high = self.sharp_low[:, None], self.sharp_high[:, None]
        place = np.where(low & high, u * u * (3 - 2 * u), np.where(low, u * u, np.where(high, u * (2 - u), u)))
        slope = np.where(low & high, 6 * u * (1 - u), np.where(low, 2 * u, np.where(high, 2 * (1 - u), 1.0)))
        length = (self.high - self.low)[:, None]
        return self.low[:, None] + length * place, length * part * slope


def summed(of: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Sums of rows of `values` that belong to the same index: (count, columns)."""
    return np.stack([np.bincount(of, column, count) for column in values.T], axis=1)
