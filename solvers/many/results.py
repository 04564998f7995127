"""Columns of results of many collisions, by name."""

from collections.abc import Sequence

import numpy as np

from ..results import ALWAYS, NONE, VALIDITY

Block = dict[str, np.ndarray]  # columns of results, by name


def empty(size: int, of: Sequence[str]) -> Block:
    """All columns of a result before anything is computed: outcome -2, reasons empty."""
    columns: Block = {"outcome": np.full(size, -2, np.int8), "certified": np.zeros(size, bool)}
    columns["reason"] = np.full(size, "", object)
    for name in dict.fromkeys(("restitution", *of)):
        if name == "reversal":
            columns[name] = np.full(size, NONE, np.int8)
        elif name == VALIDITY:
            columns[name] = np.zeros(size, np.int16)
        elif name not in ALWAYS:
            columns[name] = np.full(size, np.nan)
    return columns


def fill(results: Block, where: np.ndarray, block: Block) -> None:
    """Copy a finished block into the result columns."""
    for name, values in block.items():
        results[name][where] = values
