"""Many collisions of one scene by the kernel: quantities in SI in, answers out, on several cores.

What the kernel hands over (resting too long, no budget left, beyond its range) is named by its status and is for the
caller to compute by other means.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from ..model import choose
from ..numbers import si_values
from ..scene import Scene
from .library import ANSWER, LARGEST_ORDER, Variant, kernel, knows

BUDGET = 100_000  # steps: nearer than 1e-8 or so to a separatrix a lane creeps, and an L-stable method takes over
PATIENT = 1_000_000  # steps, where that method has failed
_CHUNK = 4096  # collisions a thread takes at a time
_LOOSEST = 1e-6  # as solvers/locate.py has it
RIGID = 1e300  # Pa: a Young's modulus that never reverses anything


@dataclass(frozen=True)
class Impacts:
    """Collisions of one scene: angle (rad) and speed (m/s), and other quantities in SI by the vocabulary's names."""

    scene: Scene
    speed: np.ndarray
    angle: np.ndarray
    others: Mapping[str, np.ndarray]

    def part(self, which: np.ndarray | slice) -> Impacts:
        """Some of them."""
        others = {name: values[which] for name, values in self.others.items()}
        return Impacts(self.scene, self.speed[which], self.angle[which], others)


Fly = Callable[[Impacts, np.ndarray, np.ndarray | None], None]


def order_for(rtol: float) -> int:
    """Order of the series that is cheapest for a tolerance (docs/kernel.md)."""
    return min(max(round(-math.log10(rtol)) + 1, 8), LARGEST_ORDER)


def answers(
    impacts: Impacts, rtol: float, rotation: bool = False, threads: int = 1, budget: int = BUDGET
) -> np.ndarray | None:
    """An array of ANSWER, a collision each; None if there is no kernel here.

    Arguments:
        rotation: also the angle turned.
        budget: steps after which a collision is handed over.
    """
    found = np.zeros(impacts.angle.size, ANSWER)
    for oblique in (True, False):
        which = np.flatnonzero((impacts.angle > 0) == oblique)
        if which.size and not _fill(found, impacts, which, _call(impacts, oblique, rtol, rotation, budget), threads):
            return None
    return found


def flown(
    impacts: Impacts, oblique: bool, rtol: float, rotation: bool, log: np.ndarray | None, budget: int = BUDGET
) -> np.ndarray | None:
    """Answers of impacts that are all oblique, or all head-on; None if there is no kernel here.

    Arguments:
        log: zeros of HAPPENING, MOST_EVENTS a collision, to be filled with what happened.
    """
    fly = _call(impacts, oblique, rtol, rotation, budget)
    if fly is None:
        return None
    made = np.zeros(impacts.angle.size, ANSWER)
    fly(impacts, made, log)
    return made


def _fill(found: np.ndarray, impacts: Impacts, which: np.ndarray, fly: Fly | None, threads: int) -> bool:
    if fly is None:
        return False
    whole = which.size == found.size  # then nothing is copied

    def chunk(first: int) -> None:
        last = min(first + _CHUNK, which.size)
        part = slice(first, last) if whole else which[first:last]
        made = found[first:last] if whole else np.zeros(last - first, ANSWER)
        fly(impacts.part(part), made, None)
        if not whole:
            found[part] = made

    firsts = range(0, which.size, _CHUNK)
    if threads == 1 or len(firsts) == 1:
        for first in firsts:
            chunk(first)
    else:
        with ThreadPoolExecutor(threads) as pool:  # the kernel runs without the interpreter's lock
            list(pool.map(chunk, firsts))
    return True


def _call(those: Impacts, oblique: bool, rtol: float, rotation: bool, budget: int) -> Fly | None:
    """The kernel of these impacts as a function of impacts, answers and a log to be filled.

    The answers are zeros of ANSWER; the log zeros of HAPPENING, MOST_EVENTS a collision, or None.
    """
    rtol, scene = min(rtol, _LOOSEST), those.scene
    own = scene.bridge is not None and scene.bridge.rupture == "own"
    choice = choose(scene, oblique, fold=not those.others)  # what varies may make a partner unequal
    library = kernel(Variant(choice, order_for(rtol), rotation, own)) if knows(scene) else None
    if library is None:
        return None
    wanted = ctypes.string_at(ctypes.addressof(ctypes.c_char.in_dll(library, "quantity_names"))).decode().split()

    def fly(impacts: Impacts, made: np.ndarray, log: np.ndarray | None) -> None:
        given: dict[str, np.ndarray | float] = {"youngs_modulus": RIGID, "poisson_ratio": 0.0}
        given |= si_values(impacts.scene, None, None)
        given |= dict(impacts.others) | {"speed": impacts.speed, "angle": impacts.angle}
        columns = [np.ascontiguousarray(given[name], dtype=float).reshape(-1) for name in wanted]
        pointers = (ctypes.c_void_p * len(columns))(*(column.ctypes.data for column in columns))
        varies = bytes(int(np.ndim(given[name])) for name in wanted)
        into = None if log is None else log.ctypes.data
        size = library.collide(made.size, pointers, varies, rtol, budget, made.ctypes.data, into)
        assert size == ANSWER.itemsize

    return fly
