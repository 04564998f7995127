"""Results of a batch as columns that are filled block by block."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..model.validity import flags
from .batch import Batch
from .columns import with_impacts
from .results import FAILED, INTEGRATED, OF_IMPACT, VALIDITY, Block
from .results import blank as blank_column


def empty(size: int, of: Sequence[str]) -> Block:
    """Result columns before anything is computed: outcome -2."""
    columns: Block = {"outcome": np.full(size, -2, dtype=np.int8)}
    columns["certified"] = np.zeros(size, dtype=bool)
    columns["reason"] = np.empty(size, dtype=object)  # None: has not failed
    for name in dict.fromkeys(("restitution", *of)):
        if name in INTEGRATED or name in OF_IMPACT:
            columns[name] = blank_column(name, size)
    return columns


def blank(size: int, of: Sequence[str]) -> Block:
    """All columns of a chunk, of the kinds that they have when it is computed."""
    results = empty(size, of)
    results["reason"] = as_text(results)
    return results | ({VALIDITY: np.zeros(size, dtype=np.int16)} if VALIDITY in of else {})


def fill(results: Block, where: np.ndarray, block: Block) -> None:
    """Copy a finished block into the result columns."""
    for name, values in block.items():
        results[name][where] = values


def validity(request: Batch, results: Block) -> np.ndarray:
    """Flags of where each collision leaves the model's range; none of one that failed."""
    found = flags(request.scene, with_impacts(request) | results, request.size)
    return np.where(results["outcome"] == FAILED, np.int16(0), found)


def as_text(results: Block) -> np.ndarray:
    """The reasons as a numpy array of text, empty where nothing failed."""
    failed = results["outcome"] == FAILED
    if not failed.any():
        return np.zeros(failed.size, "<U1")
    return np.where(failed, results["reason"], "").astype(str)
