"""A batch of collisions on the cores of this machine.

The Taylor kernel computes them in blocks. Those of other engines go in blocks to worker processes, and so do those that
it does not complete, for their reasons. A collision that fails is marked and the rest go on.
"""

from collections.abc import Callable

import numpy as np

from ..engines.settings import FEW
from ..errors import InputError
from ..host.cores import usable_cores
from ..host.workers import in_workers
from ..results import FAILED, VALIDITY
from .alone import run
from .by_kernel import collide_by_kernel
from .columns import impact_columns, validity
from .impacts import Impacts
from .results import Block, empty, fill

_BLOCK = 50  # collisions in a block for a worker
_SLOW = 20  # as `FEW`, for collisions that the kernel did not complete; they take up to seconds each

Finished = Callable[[np.ndarray, Block], None]


def complete(
    request: Impacts,
    results: Block,
    which: np.ndarray | None = None,
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
    for where, part in request.by_text() if request.texts else ():
        if isinstance(part, InputError):
            results["outcome"][where], results["reason"][where] = FAILED, str(part)
            continue
        columns = empty(part.size, part.of)
        complete(part, columns, cores=cores)
        fill(results, where, columns)
    if request.texts:
        return
    keep = finished or (lambda where, block: fill(results, where, block))
    _compute(request, np.arange(request.size) if which is None else which, keep, cores or usable_cores())
    results |= impact_columns(request)
    if VALIDITY in request.of:
        results[VALIDITY] = validity(request, results)


def _compute(request: Impacts, which: np.ndarray, finished: Finished, cores: int) -> None:
    size, few = _BLOCK, FEW
    if request.engine == "taylor":
        incomplete = collide_by_kernel(request, which, cores if which.size > FEW else 1, finished)
        if 0 < incomplete.size < which.size:
            size, few = max(1, min(_BLOCK, incomplete.size // (4 * cores))), _SLOW
        which = incomplete
    blocks = [which[k : k + size] for k in range(0, which.size, size)]
    cores = min(len(blocks), cores)
    if which.size <= few or cores == 1:
        for block in blocks:
            finished(block, run(request.part(block)))
        return
    for block, result in in_workers(cores, run, ((block, (request.part(block),)) for block in blocks)):
        finished(block, result)
