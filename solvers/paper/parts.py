"""Data of a part of the reproduction for the report: comparisons, tables, figures and text."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ..formatting.document import Picture, Table
from .printed import PRINTED, Printed


@dataclass(frozen=True)
class Comparison:
    """A printed number or finding with ours.

    Arguments:
        key: key of the printed entry.
        ours: computed number, or the finding in words.
        used: the variants used.
        why: reason for a difference, or a comment.
        agrees: for a finding in words, True if it agrees with the paper.
        beside: a second number of ours, as text.
    """

    key: str
    ours: float | str
    used: str
    why: str = ""
    agrees: bool | None = None
    beside: str = ""

    @property
    def printed(self) -> Printed:
        return PRINTED[self.key]

    @property
    def difference(self) -> float | None:
        """Relative difference from the paper; None for words."""
        return None if isinstance(self.ours, str) else self.ours / self.printed.value - 1

    @property
    def verdict(self) -> str:
        """Text of the relative difference and rounding to the printed digits; for words, agreement."""
        if isinstance(self.ours, str) or self.difference is None:
            return "agrees" if self.agrees else "differs"
        rounded = f"{self.ours:.{self.printed.digits}f}" == self.printed.text
        return f"{round(100 * self.difference, 1) + 0.0:+.1f} %" + (" (rounds to it)" if rounded else "")

    @property
    def shown(self) -> str:
        text = self.ours if isinstance(self.ours, str) else number(self.ours)
        return f"{text} {self.beside}".strip()


@dataclass(frozen=True)
class Part:
    """One part: a title, then text, figures, formulas and tables, in this order."""

    title: str
    words: str = ""
    comparisons: Sequence[Comparison] = ()
    pictures: Sequence[Picture] = ()
    formulas: Sequence[tuple[str, str, str]] = ()  # heading, LaTeX, note
    tables: Sequence[Table] = ()
    scenes: Sequence[str] = ()  # presets used


def number(value: float | None) -> str:
    """A number with four or more significant digits; a dash for None or NaN."""
    return "-" if value is None or not math.isfinite(value) else f"{value:#.4g}"


def degrees(angle: float) -> str:
    """An angle in rad as degrees, without trailing zeros."""
    return f"{math.degrees(angle):.4g}°"
