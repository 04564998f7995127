"""Integration of many collisions of one scene by the kernel: quantities in SI in, answers out, on several cores.

Collisions that the kernel hands over (long resting contact, exhausted budget, out of range) are marked by their status;
the caller computes them by other means.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ....generated.automaton import LOOSEST
from ...model.key import ModelKey
from ...model.model import select_model
from ...scene.contact import NEVER_MET
from ...scene.groups import si_values, sideways
from ...scene.scene import Scene
from ..settings import KERNEL_STEPS
from .build import kernel
from .layout import ANSWER, Task, names
from .orders import order_for
from .source import Variant

CHUNK = 4096  # collisions in a block for a thread


@dataclass(frozen=True)
class Impacts:
    """Collisions of one scene: angles (rad), speeds (m/s), other quantities in SI by their names in the vocabulary."""

    scene: Scene
    speed: np.ndarray
    angle: np.ndarray
    others: Mapping[str, np.ndarray]

    @property
    def oblique(self) -> np.ndarray:
        return sideways(self.scene, self.angle, self.others)

    def part(self, which: np.ndarray | slice) -> Impacts:
        others = {name: values[which] for name, values in self.others.items()}
        return Impacts(self.scene, self.speed[which], self.angle[which], others)


RunKernel = Callable[[Impacts, np.ndarray], None]
"""A kernel as a function that computes impacts into an array of answers (zeros of ANSWER)."""


def variant(
    scene: Scene, choice: ModelKey, rtol: float, rotation: bool, ledger: bool = False, trajectory: bool = False
) -> Variant:
    """The variant of the kernel for a scene at a tolerance."""
    own_rupture = scene.bridge is not None and scene.bridge.rupture == "own"
    return Variant(choice, order_for(rtol), rotation, own_rupture, ledger=ledger, trajectory=trajectory)


def variant_for_many(scene: Scene, oblique: bool, rtol: float, rotation: bool, fold: bool = True) -> Variant:
    """The variant that `run_kernel` takes; with `fold` no quantity varies: a partner equal to the sphere stays so."""
    return variant(scene, select_model(scene, oblique, fold=fold), rtol, rotation)


def run_kernel(
    impacts: Impacts, rtol: float, rotation: bool = False, threads: int = 1, budget: int = KERNEL_STEPS, jumps: int = 0
) -> np.ndarray:
    """An array of ANSWER, one per collision.

    Arguments:
        rotation: also compute the angle through which the line of centres turns.
        budget: number of steps after which a collision is left undecided.
        jumps: what the slow manifold may replace: 0 nothing, 1 what follows the turn (times are not needed), 2 the
            approach as well (nor is the smallest gap).
    """
    answers, oblique_ones = np.zeros(impacts.angle.size, ANSWER), impacts.oblique
    for oblique, which in ((True, np.flatnonzero(oblique_ones)), (False, np.flatnonzero(~oblique_ones))):
        if which.size == 0:
            continue
        library = kernel(variant_for_many(impacts.scene, oblique, rtol, rotation, fold=not impacts.others))
        run, whole = bind_kernel(library, rtol, budget, jumps), which.size == answers.size  # no copy in this case

        def chunk(first: int, run: RunKernel = run, which: np.ndarray = which, whole: bool = whole) -> None:
            part = slice(first, min(first + CHUNK, which.size)) if whole else which[first : first + CHUNK]
            some = answers[part]
            run(impacts.part(part), some)
            if not whole:
                answers[part] = some

        in_chunks(which.size, chunk, threads)
    return answers


def in_chunks(count: int, run: Callable[[int], None], threads: int) -> None:
    """Run a kernel on the collisions from each first one on, `CHUNK` at a time, on several threads."""
    firsts = range(0, count, CHUNK)
    if threads == 1 or len(firsts) == 1:
        for first in firsts:
            run(first)
    else:
        from concurrent.futures import ThreadPoolExecutor  # slow import

        with ThreadPoolExecutor(threads) as pool:  # the call releases the interpreter's lock
            list(pool.map(run, firsts))


def task(library: ctypes.CDLL, impacts: Impacts, rtol: float, budget: int, answers: np.ndarray, jumps: int = 0) -> Task:
    """The task of a kernel for impacts all oblique or all head-on, as the kernel is.

    Arguments:
        answers: array for the answers, zeros of ANSWER.
        budget, jumps: as for `run_kernel`.
    """
    one = Task(library, impacts.angle.size, min(rtol, LOOSEST), budget)
    one.number("jumps", jumps)
    values: dict[str, np.ndarray | float] = {"poisson_ratio": 0.0, **NEVER_MET}
    values |= si_values(impacts.scene, None, None)
    values |= dict(impacts.others) | {"speed": impacts.speed, "angle": impacts.angle}
    one.columns([_column(values[name]) for name in names(library, "quantity_names")])
    one.buffer("answers", answers)
    return one


def _column(values: np.ndarray | float) -> np.ndarray | float:
    if isinstance(values, float):
        return values
    column = np.ascontiguousarray(values, dtype=float).reshape(-1)
    return column.item() if column.size == 1 else column


def bind_kernel(library: ctypes.CDLL, rtol: float, budget: int, jumps: int = 0) -> RunKernel:
    """The kernel as a function of impacts all oblique or all head-on, as it is; other arguments as of `run_kernel`."""

    def run(impacts: Impacts, answers: np.ndarray) -> None:
        task(library, impacts, rtol, budget, answers, jumps).run()

    return run
