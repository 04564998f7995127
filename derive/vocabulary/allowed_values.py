"""Intervals of allowed values of a declared quantity, parsed from text such as `> 0 and <= 5`."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_SIDE = re.compile(rf"(>=|<=|>|<)\s*({_NUMBER})")
_SPAN = re.compile(rf"(?:from\s+)?({_NUMBER})\s+to\s+({_NUMBER})")


class BoundsError(ValueError):
    """Text that is not an interval."""


@dataclass(frozen=True)
class Bounds:
    """An interval, open or closed at either end."""

    text: str
    low: float = -math.inf
    high: float = math.inf
    low_open: bool = False
    high_open: bool = False

    @classmethod
    def read(cls, text: str) -> Bounds:
        """The interval described by a text; BoundsError if it cannot be parsed or contains no number."""
        if not isinstance(text, str):
            raise BoundsError(text)
        words = " ".join(text.split())
        if span := _SPAN.fullmatch(words):
            result = cls(f"from {span[1]} to {span[2]}", float(span[1]), float(span[2]))
        else:
            result = cls(words)
            for clause in words.split(" and "):
                side = _SIDE.fullmatch(clause.strip())
                if side is None:
                    raise BoundsError(text)
                value, is_open = float(side[2]), len(side[1]) == 1
                if side[1][0] == ">":
                    result = cls(words, value, result.high, is_open, result.high_open)
                else:
                    result = cls(words, result.low, value, result.low_open, is_open)
        if not result.low < result.high:
            raise BoundsError(text)
        return result

    @property
    def positive(self) -> bool:
        return self.low > 0 or (self.low == 0 and self.low_open)

    @property
    def not_negative(self) -> bool:
        return self.low >= 0

    def to_json(self) -> dict[str, object]:
        """The interval as written in a manifest: infinite ends are null."""
        return {
            "text": self.text,
            "low": None if math.isinf(self.low) else self.low, "high": None if math.isinf(self.high) else self.high,
            "low_open": self.low_open, "high_open": self.high_open,
        }  # fmt: skip
