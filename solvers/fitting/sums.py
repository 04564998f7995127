"""Sums over the lines of each row: of likelihoods with their derivatives, and of results."""

from __future__ import annotations

import numpy as np


class RowSums:
    """Sums of positive terms by row, kept as logarithms, and the derivatives of the sums' logarithms."""

    def __init__(self, rows: int, size: int) -> None:
        self._rows, self._size = rows, size
        self._parts: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []

    def add(self, row: np.ndarray, log: np.ndarray, slope: np.ndarray) -> None:
        """Add terms by their logarithms, with the derivatives of these."""
        self._parts.append((row, log, slope))

    def result(self) -> tuple[np.ndarray, np.ndarray]:
        """Logarithms of the sums, -1e300 for an empty one, and their derivatives."""
        row, log, slope = (np.concatenate(each) for each in zip(*self._parts, strict=True))
        top = np.full(self._rows, -1e300)
        np.maximum.at(top, row, log)
        term = np.exp(log - top[row])
        whole = np.bincount(row, term, self._rows)
        found = np.where(whole > 0, top + np.log(np.maximum(whole, 1e-300)), -1e300)
        slopes = np.zeros((self._rows, self._size))
        np.add.at(slopes, row, (term / whole[row])[:, None] * slope)
        return found, slopes


class Moments:
    """Mean and variance of results over the scatter, by row."""

    def __init__(self, of: tuple[str, ...], rows: int) -> None:
        self._sums = {name: np.zeros((3, rows)) for name in of}

    def add(self, name: str, row: np.ndarray, weight: np.ndarray, scatter: np.ndarray, at: np.ndarray) -> None:
        share = np.exp(scatter) * weight[:, None]
        for power in range(3):
            np.add.at(self._sums[name][power], row, (share * at**power).sum(axis=1))

    def result(self) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
        mean, spread = {}, {}
        for name, (mass, first, second) in self._sums.items():
            with np.errstate(divide="ignore", invalid="ignore"):
                mean[name] = first / mass
                spread[name] = np.sqrt(np.maximum(second / mass - mean[name] ** 2, 0.0))
        return mean, spread
