"""Ranges on the command line: `LO:HI:N`, or `log:LO:HI:N`, both ends included."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from .errors import InputError

_MOST = 10_000_000  # values: more is a slip of the hand


def parse_range(text: str, label: str, read: Callable[[str], float], *, unit: str = "") -> list[float]:
    """Return the values of a range, evenly spaced, or evenly in the logarithm.

    Arguments:
        text: `LO:HI:N` or `log:LO:HI:N`; N = 1 only with LO = HI.
        label: option that the range belongs to, for the error.
        read: turns one end into an SI number, or raises InputError.
        unit: said of LO and HI in the error (`in degrees`).

    Raises:
        InputError: not a range, LO above HI, a count that is no whole number, too large or does not fit.
    """
    accepted = f"LO:HI:N or log:LO:HI:N{' ' + unit if unit else ''}, LO < HI and N >= 2 (or LO = HI and N = 1)"
    parts = text.split(":")
    logarithmic = parts[0].strip() == "log"
    if logarithmic:
        parts = parts[1:]
    if len(parts) != 3 or not re.fullmatch(r"\s*[0-9]{1,30}\s*", parts[2], re.ASCII):
        raise InputError(label, text, accepted, "is not a range")
    low, high, count = read(parts[0]), read(parts[1]), int(parts[2])
    if count > _MOST:
        raise InputError(label, text, f"{accepted}, N at most {_MOST}", "has too many values")
    if low > high or count < 1 or (count == 1) != (low == high):
        raise InputError(label, text, accepted, "is not a range")
    if logarithmic and low <= 0:
        raise InputError(label, text, accepted + ", LO > 0 for log", "has no logarithm")
    if count == 1:
        return [low]
    steps = [i / (count - 1) for i in range(1, count - 1)]
    if logarithmic:
        log_low, log_high = math.log(low), math.log(high)
        inner = [math.exp(log_low + s * (log_high - log_low)) for s in steps]
    else:
        inner = [low + s * (high - low) for s in steps]
    return [low, *inner, high]  # the ends exactly as they were given
