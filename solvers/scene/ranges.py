"""Ranges on the command line: `LO:HI:N`, or `log:LO:HI:N`, both ends included."""

import math
import re
from collections.abc import Callable, Mapping

from ..errors import InputError

Ends = Callable[[str, str], tuple[float, float]]
MOST = 10_000_000  # values, or collisions of a map at 130 bytes each; a larger count is probably a typing error
MOST_STORED = 10**10  # the same for a map that is written to disk as it is computed


def parse_range(text: str, label: str, read: Ends, *, unit: str = "", most: int = MOST) -> list[float]:
    """Return the values of a range, evenly spaced, or evenly in the logarithm; InputError for anything else.

    Arguments:
        text: `LO:HI:N` or `log:LO:HI:N`, N = 1 only with LO = HI; or a single value.
        label: option that the range belongs to, for the error.
        read: converts both ends to SI numbers, or raises InputError.
        unit: unit of LO and HI for the error (`in degrees`).
        most: largest number of values.
    """
    accepted = (
        f"LO:HI:N or log:LO:HI:N{' ' + unit if unit else ''}, LO < HI and N >= 2 (or LO = HI and N = 1), or one value"
    )
    parts = text.split(":")
    logarithmic = parts[0].strip() == "log"
    if logarithmic:
        parts = parts[1:]
    if len(parts) == 1 and not logarithmic and parts[0].strip():
        try:
            return [read(parts[0], parts[0])[0]]
        except InputError as error:
            raise InputError(label, text, f"{error.accepted}, or a range LO:HI:N, log:LO:HI:N", error.problem) from None
    if len(parts) != 3 or not re.fullmatch(r"\s*[0-9]{1,30}\s*", parts[2], re.ASCII):
        raise InputError(label, text, accepted, "is not a range")
    low, high = read(parts[0], parts[1])
    count = int(parts[2])
    if count > most:
        raise InputError(label, text, f"{accepted}, N at most {most}", "has too many values")
    if low > high or count < 1 or (count == 1) != (low == high):
        raise InputError(label, text, accepted, "is not a range")
    if logarithmic and low <= 0:
        raise InputError(label, text, accepted + ", LO > 0 for log", "has no logarithm")
    if count == 1:
        return [low]
    steps = (i / (count - 1) for i in range(1, count - 1))
    if logarithmic:
        log_low, log_high = math.log(low), math.log(high)
        inner = [math.exp(log_low + s * (log_high - log_low)) for s in steps]
    else:
        inner = [low + s * (high - low) for s in steps]
    return [low, *inner, high]  # the ends exactly as given, without rounding


def check_cells(ranges: Mapping[str, str | None], most: int = MOST) -> None:
    """Raise InputError if the product of the ranges' counts exceeds what a map can hold, before allocating any.

    Arguments:
        ranges: option -> its range; malformed ranges are ignored here and reported by `parse_range`.
        most: collisions in all.
    """
    cells, sizes = 1, []
    for label, text in ranges.items():
        count = re.search(r":\s*([0-9]{1,9})\s*$", text or "", re.ASCII)
        if text is None or count is None:
            continue
        cells *= max(1, int(count[1]))
        sizes.append(count[1])
        if cells > most >= int(count[1]):
            problem = f"makes {' x '.join(sizes)} collisions"
            raise InputError(label, text, most_collisions(most), problem)


def most_collisions(most: int) -> str:
    """What is accepted as the size of a map, in words."""
    return f"at most {most} collisions in all" + ("" if most > MOST else ", or more without a picture in a .zarr")
