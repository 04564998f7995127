"""The chunks of a request: blocks of its collisions, cut by its shape alone.

Neither the number of cores or workers nor what an earlier run has finished moves them, so that a chunk holds the same
collisions wherever and whenever it is computed.
"""

import math

import numpy as np

LARGEST = 65536  # collisions in a chunk: some 0.1 s by the kernel, some 10 MB
_SHARES = 64  # chunks of a smaller request, for as many workers
_LEAST = {"taylor": 2048}  # collisions in a chunk that outweigh sending it
_LEAST_SLOW = 64


def chunks(shape: tuple[int, ...], engine: str, most: int = LARGEST) -> list[tuple[slice, ...]]:
    """Where the chunks of a request of this shape lie: of equal extent along all dimensions, as far as these reach.

    Those at the far ends are smaller; the last dimension varies fastest.

    Arguments:
        most: collisions in a chunk.

    Example:
        >>> from wetdoublet.solvers.many.chunks import chunks
        >>> chunks((1, 100), "rosenbrock")
        [(slice(0, 1, None), slice(0, 64, None)), (slice(0, 1, None), slice(64, 100, None))]
    """
    left = min(max(math.prod(shape) // _SHARES, _LEAST.get(engine, _LEAST_SLOW)), most)
    block = [1] * len(shape)
    by_length = sorted(range(len(shape)), key=lambda axis: shape[axis])
    for place, axis in enumerate(by_length):  # what a short dimension cannot take falls to the longer ones
        share = math.floor(left ** (1 / (len(shape) - place)) + 1e-9)
        block[axis] = max(1, min(shape[axis], share))
        left //= block[axis]
    corners = np.ndindex(*(-(-size // length) for size, length in zip(shape, block, strict=True)))
    return [
        tuple(slice(i * length, min((i + 1) * length, size)) for i, length, size in zip(corner, block, shape))
        for corner in corners
    ]
