"""A batch of collisions on the cores of this machine.

The Taylor kernel computes them in blocks; those that it does not complete, and those of other engines, go in blocks to
worker processes. A collision that fails is marked with its reason and the rest go on.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..errors import InputError
from ..host.compiler import compiler
from ..host.cores import usable_cores
from ..host.workers import in_workers
from ..settings import FEW
from .batch import Batch
from .by_casadi import run
from .by_kernel import collide_by_kernel
from .columns import of_impact
from .dataset import as_text, empty, fill, validity
from .results import FAILED, OF_IMPACT, VALIDITY, Block

_BLOCK = 50  # collisions in a block for a worker
_ALONE = FEW
_SLOW_ALONE = 20  # the same for collisions that the kernel did not complete; they take up to seconds each

Finished = Callable[[np.ndarray, Block], None]
Slow = Callable[[int], None]


def computed_chunk(request: Batch, cores: int) -> Block:
    """All columns of a chunk of a request, computed in this process.

    Arguments:
        cores: that it may use.
    """
    results = empty(request.size, request.of)
    complete(request, results, cores=cores)
    results["reason"] = as_text(results)
    return results


def complete(
    request: Batch,
    results: Block,
    which: np.ndarray | None = None,
    finished: Finished | None = None,
    slow: Slow | None = None,
    cores: int | None = None,
) -> None:
    """Fill the columns of a request.

    Arguments:
        which: the collisions that are missing; None for all.
        finished: called with indices and results of every block, in place of filling the columns with them.
        slow, cores: as of `compute`.
    """
    if VALIDITY in request.of:
        results[VALIDITY] = np.zeros(request.size, dtype=np.int16)
    if request.texts:
        for where, part in request.by_text():
            if isinstance(part, InputError):
                results["outcome"][where], results["reason"][where] = FAILED, str(part)
                continue
            its = empty(part.size, part.of)
            complete(part, its, cores=cores)
            fill(results, where, its)
        return
    everything = np.arange(request.size)
    keep = finished or (lambda where, block: fill(results, where, block))
    compute(request, everything if which is None else which, keep, slow or (lambda _count: None), cores)
    if any(name in OF_IMPACT for name in request.of):
        fill(results, everything, of_impact(request))
    if VALIDITY in request.of:
        results[VALIDITY] = validity(request, results)


def compute(
    request: Batch,
    which: np.ndarray,
    finished: Finished,
    slow: Slow = lambda _count: None,
    cores: int | None = None,
) -> None:
    """Compute the collisions `which`, on all cores if they are many.

    Calls `finished` after every block; results of finished blocks are kept if a later one is interrupted.

    Arguments:
        slow: called with the number of collisions left to slower engines, before those start.
        cores: how many it may use; None for all of this process.
    """
    size, alone = _BLOCK, _ALONE
    most = usable_cores() if cores is None else cores
    if request.engine == "taylor":
        left = collide_by_kernel(request, which, most if which.size > _ALONE else 1, finished)
        if 0 < left.size < which.size:
            slow(left.size)
            size, alone = max(1, min(_BLOCK, left.size // (4 * most))), _SLOW_ALONE
        which = left
    blocks = [which[k : k + size] for k in range(0, which.size, size)]
    cores = min(len(blocks), most)
    many = which.size > _ALONE
    if which.size <= alone or cores == 1:
        for block in blocks:
            finished(block, run(request.part(block), many))
        return
    if request.engine != "cvodes":
        compiler()  # a missing compiler is reported here and not by a worker
    if many:
        run(request.part(blocks[0][:1]), True)  # compile once, before the workers need it
    for block, result in in_workers(cores, run, ((block, (request.part(block), many)) for block in blocks)):
        finished(block, result)
