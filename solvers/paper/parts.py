"""What a part of the reproduction hands to the report: comparisons, tables, pictures and words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from .printed import PRINTED, Printed


@dataclass(frozen=True)
class Comparison:
    """A printed number or finding beside ours.

    Arguments:
        key: of the printed entry.
        ours: what this run computed; a number, or the finding in words.
        used: the variants it was computed with.
        why: why it differs, or what is to be said of it.
        agrees: for a finding in words, whether it is the paper's.
        beside: a second number of ours that goes with the first, in words.
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
        """Ours over the paper's, minus one; None for words."""
        return None if isinstance(self.ours, str) else self.ours / self.printed.value - 1

    @property
    def verdict(self) -> str:
        """The relative difference, and whether ours rounds to the printed digits; or, of words, whether they agree."""
        if isinstance(self.ours, str) or self.difference is None:
            return "agrees" if self.agrees else "differs"
        rounded = f"{self.ours:.{self.printed.digits}f}" == self.printed.text
        return f"{round(100 * self.difference, 1) + 0.0:+.1f} %" + (" (rounds to it)" if rounded else "")

    @property
    def shown(self) -> str:
        text = self.ours if isinstance(self.ours, str) else number(self.ours)
        return f"{text} {self.beside}".strip()


@dataclass(frozen=True)
class Table:
    """A table of the report: a caption, a head, rows of text."""

    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True)
class Picture:
    """A picture of the report: file name in its folder, caption, width in cm at which it is to be read."""

    file: str
    caption: str
    width: float


@dataclass(frozen=True)
class Part:
    """One part: a title, and what there is to show, in this order: words, pictures, formulas, tables."""

    title: str
    words: str = ""
    comparisons: Sequence[Comparison] = ()
    pictures: Sequence[Picture] = ()
    formulas: Sequence[tuple[str, str, str]] = ()  # heading, LaTeX, note
    tables: Sequence[Table] = ()
    scenes: Sequence[str] = field(default=())  # presets used


def number(value: float | None) -> str:
    """Four significant digits or more where they tell; a dash for None or what is no number."""
    return "-" if value is None or not math.isfinite(value) else f"{value:#.4g}"


def degrees(angle: float) -> str:
    """An angle in degrees, without trailing zeros."""
    return f"{math.degrees(angle):.4g}°"
