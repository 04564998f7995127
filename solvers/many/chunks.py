"""The chunks of a request: blocks of its collisions, cut by its shape alone.

Neither the number of cores or workers nor what an earlier run has finished moves them, so that a chunk holds the same
collisions wherever and whenever it is computed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

LARGEST = 65536  # collisions in a chunk: some 0.1 s by the kernel, some 10 MB
_SHARES = 64  # chunks of a smaller request, for as many workers
_LEAST = {"taylor": 2048}  # collisions in a chunk that outweigh sending it
_LEAST_SLOW = 64


@dataclass(frozen=True)
class Chunks:
    """An array of collisions cut into blocks of one shape, smaller at the far ends.

    Arguments:
        shape: of the array.
        block: largest size of a chunk along each dimension.

    Example:
        >>> from wetdoublet.solvers.many.chunks import Chunks
        >>> cut = Chunks((3, 4), (2, 4))
        >>> len(cut), cut.slices(1)
        (2, (slice(2, 3, None), slice(0, 4, None)))
    """

    shape: tuple[int, ...]
    block: tuple[int, ...]

    @cached_property
    def _counts(self) -> tuple[int, ...]:
        return tuple(-(-size // length) for size, length in zip(self.shape, self.block, strict=True))

    def __len__(self) -> int:
        return math.prod(self._counts)

    def slices(self, k: int) -> tuple[slice, ...]:
        """Where chunk k lies; the last dimension varies fastest."""
        corner = np.unravel_index(k, self._counts)
        return tuple(
            slice(int(i) * length, min((int(i) + 1) * length, size))
            for i, length, size in zip(corner, self.block, self.shape, strict=True)
        )

    def extent(self, k: int) -> tuple[int, ...]:
        """The shape of chunk k."""
        return tuple(part.stop - part.start for part in self.slices(k))

    def flat(self, k: int) -> np.ndarray:
        """Flat indices of the collisions of chunk k, in order."""
        axes = [np.arange(part.start, part.stop) for part in self.slices(k)]
        found: np.ndarray = np.ravel_multi_index(np.ix_(*axes), self.shape).ravel()
        return found


def chunks(shape: tuple[int, ...], engine: str, most: int = LARGEST) -> Chunks:
    """The chunks of a request of this shape: of equal extent along all dimensions, as far as these are long enough.

    Arguments:
        most: collisions in a chunk.
    """
    shape = shape or (1,)
    target = min(max(math.prod(shape) // _SHARES, _LEAST.get(engine, _LEAST_SLOW)), most)
    block = [1] * len(shape)
    left = target
    by_length = sorted(range(len(shape)), key=lambda axis: shape[axis])
    for place, axis in enumerate(by_length):  # what a short dimension cannot take falls to the longer ones
        share = math.floor(left ** (1 / (len(shape) - place)) + 1e-9)
        block[axis] = max(1, min(shape[axis], share))
        left //= block[axis]
    return Chunks(shape, tuple(block))
