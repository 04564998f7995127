"""A batch of collisions on the cores of this machine.

The Taylor kernel computes them in blocks. Those of other engines go in blocks to worker processes, and so do those that
it does not complete, for their reasons. A collision that fails is marked and the rest go on.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..collision.collide import integrated
from ..engines.settings import FEW
from ..errors import InputError, WetDoubletError
from ..host.workers import in_workers, usable_cores
from ..model.dimensionless import nondimensionalise
from ..model.validity import flags
from ..results import FAILED, INTEGRATED, LEDGER, NONE, OF_IMPACT, REVERSALS, VALIDITY
from .by_kernel import collide_by_kernel
from .impacts import Block, Impacts, empty, fill

_BLOCK = 50  # collisions in a block for a worker
_SLOW = 20  # as `FEW`, for collisions that the kernel did not complete; they take up to seconds each

Finished = Callable[[np.ndarray, Block], None]


def complete(
    request: Impacts,
    results: Block,
    which: np.ndarray | range | None = None,
    finished: Finished | None = None,
    cores: int | None = None,
) -> None:
    """Fill the columns of a request, on all cores if its collisions are many.

    Arguments:
        which: the collisions that are missing; None for all.
        finished: called with indices and results of every block, in place of filling the columns with them; finished
            blocks are kept if a later one is interrupted.
        cores: how many it may use; None for all of this process.
    """
    for where, group in request.by_text() if request.texts else ():
        if isinstance(group, InputError):
            results["outcome"][where], results["reason"][where] = FAILED, str(group)
            continue
        columns = empty(group.size, group.of)
        complete(group, columns, cores=cores)
        fill(results, where, columns)
    if request.texts:
        return
    keep = finished or (lambda where, block: fill(results, where, block))
    _compute(request, range(request.size) if which is None else which, keep, cores or usable_cores())
    results |= impact_columns(request)
    if VALIDITY in request.of:
        results[VALIDITY] = validity(request, results)


def _compute(request: Impacts, which: np.ndarray | range, finished: Finished, cores: int) -> None:
    size, few = _BLOCK, FEW
    if request.engine == "taylor":
        incomplete = collide_by_kernel(request, which, cores if len(which) > FEW else 1, finished)
        if 0 < incomplete.size < len(which):
            size, few = max(1, min(_BLOCK, incomplete.size // (4 * cores))), _SLOW
        which = incomplete
    which = np.asarray(which)
    blocks = [which[k : k + size] for k in range(0, which.size, size)]
    cores = min(len(blocks), cores)
    if which.size <= few or cores == 1:
        for block in blocks:
            finished(block, run(request.subset(block)))
        return
    for block, result in in_workers(cores, run, ((block, (request.subset(block),)) for block in blocks)):
        finished(block, result)


def run(request: Impacts) -> Block:
    """Compute the collisions of a batch one after another."""
    block = empty(request.size, request.of)
    for k in range(request.size):
        try:
            values = _results(request, k)
        except WetDoubletError as error:
            values = {"outcome": FAILED, "reason": str(error)}
        except Exception as error:  # noqa: BLE001 # a defect of ours spoils one collision, not the others
            reason = " ".join(f"internal error: {type(error).__name__}: {error}".split())
            values = {"outcome": FAILED, "reason": reason}
        for name, value in values.items():
            block[name][k] = value
    return block


def _results(request: Impacts, k: int) -> dict[str, Any]:
    ledger = any(name in LEDGER for name in request.of)
    result = integrated(nondimensionalise(*request.impact(k)), request.rtol, request.engine, ledger, False)
    values: dict[str, Any] = {"outcome": OUTCOMES.index(result.outcome), "certified": result.certified}
    for name in ("restitution", *(name for name in request.of if name in INTEGRATED)):
        table, _, term = name.rpartition(".")
        value = getattr(getattr(result, table) if table else result, term)
        if name == "reversal":
            values[name] = NONE if value is None else REVERSALS.index(value)
        else:
            values[name] = math.nan if value is None else value
    return values


def impact_columns(request: Impacts) -> Block:
    """Columns of `OF_IMPACT`; NaN where a scene has no such number, or where its collision is impossible."""
    columns = {name: np.full(request.size, np.nan) for name in OF_IMPACT if name in request.of}
    for k in range(request.size if columns else 0):
        try:
            scene, speed, angle = request.impact(k)
            n = nondimensionalise(scene, speed, angle)
        except WetDoubletError:  # the collision is marked as failed
            continue
        for name, column in columns.items():
            value = getattr(n, name)
            column[k] = np.nan if value is None else value
    return columns


def validity(request: Impacts, results: Block) -> np.ndarray:
    """Bits for the limits of the model that each collision passes; 0 for one that failed."""
    passed = flags(request.scene, request.all_quantities | results, request.size)
    return np.where(results["outcome"] == FAILED, np.int16(0), passed)
