"""Integration of many collisions of one scene by the kernel: quantities in SI in, answers out, on several cores.

Collisions that the kernel hands over (long resting contact, exhausted budget, out of range) are marked by their status;
the caller computes them by other means.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ....generated.automaton import LOOSEST
from ...errors import InputError
from ...model.dimensionless import Problem, nondimensionalise
from ...model.model import select_model
from ...scene.groups import NEVER_MET, rate_scales, sideways
from ...scene.scene import Scene
from ...scene.schema import FIELDS
from ..settings import KERNEL_STEPS, KERNEL_STEPS_IN_SPACE
from .build import kernel
from .headers import books_own
from .layout import ANSWER, ANSWER_IN_SPACE, LEDGER, OWN_LEDGER, Task, names
from .orders import order_for
from .source import Variant

CHUNK = 4096  # collisions in a block for a thread


@dataclass(frozen=True)
class KernelImpacts:
    """Collisions of one scene as kernels take them, in SI.

    Arguments:
        speed, angle: normal speeds (m/s), angles (rad); in space no angle is read.
        others: columns of quantities by their names in the vocabulary, in place of the scene's.
        small: they are of a request of few collisions, as of `Variant`.
    """

    scene: Scene
    speed: np.ndarray
    angle: np.ndarray
    others: Mapping[str, np.ndarray] = field(default_factory=dict)
    small: bool = False

    @classmethod
    def single(cls, problem: Problem) -> KernelImpacts:
        """One collision."""
        return cls(problem.scene, np.array([problem.speed]), np.array([problem.angle]), small=True)

    @property
    def size(self) -> int:
        return int(self.speed.size)

    @property
    def values(self) -> dict[str, Any]:
        """All quantities by name: columns, and numbers of the scene where they are alike."""
        return {**self.scene.material, **self.others, "speed": self.speed, "angle": self.angle}

    @property
    def oblique(self) -> np.ndarray:
        return sideways(self.scene, self.angle, self.others)

    @property
    def rates(self) -> np.ndarray:
        """The scale of angular velocities of each collision, rad/s."""
        return rate_scales(self.scene, self.values, self.in_space)

    @property
    def in_space(self) -> bool:
        """True if these are pairs with vectors."""
        return "initial_normal_x" in self.others

    def by_kind(self) -> Iterator[tuple[bool, np.ndarray]]:
        """The indices of oblique collisions, and of head-on ones, which have a kernel of their own."""
        mask = self.oblique if not self.in_space else np.ones(self.size, bool)
        yield from ((kind, which) for kind in (True, False) if (which := np.flatnonzero(mask == kind)).size)

    def subset(self, which: np.ndarray | slice) -> KernelImpacts:
        others = {name: values[which] for name, values in self.others.items()}
        return KernelImpacts(self.scene, self.speed[which], self.angle[which], others, self.small)

    def problem(self, k: int) -> Problem:
        """Collision k as the scene has it, without columns."""
        return nondimensionalise(self.scene, float(self.speed[k]), float(self.angle[k]))


def variant(
    scene: Scene,
    oblique: bool,
    rtol: float,
    rotation: bool = True,
    ledger: bool = False,
    trajectory: bool = False,
    fold: bool = True,
    space: bool = False,
    small: bool = False,
) -> Variant:
    """The kernel of a scene's collisions at a tolerance; arguments as of `run_recorded`, `select_model`, `Variant`."""
    own_rupture = scene.bridge is not None and scene.bridge.rupture == "own"
    choice = select_model(scene, oblique, ledger, fold, space)
    if scene.package is not None:
        scene.package.check_terms(choice.structure)
    rotation = rotation and not space
    return Variant(choice, order_for(rtol), rotation, own_rupture, ledger=ledger, trajectory=trajectory, small=small)


def run_kernel(
    impacts: KernelImpacts,
    rtol: float,
    rotation: bool = False,
    threads: int = 1,
    budget: int | None = None,
    jumps: int = 0,
    ledgers: np.ndarray | None = None,
) -> np.ndarray:
    """An array of ANSWER, in space of ANSWER_IN_SPACE, one per collision.

    Arguments:
        rotation: also compute the angle through which the line of centres turns.
        budget: number of steps after which a collision is left undecided; None for the most.
        jumps: what the slow manifold may replace: 0 nothing, 1 what follows the turn (times are not needed), 2 the
            approach as well (nor is the smallest gap).
        ledgers: array of OWN_LEDGER for the energy ledgers; what declared events take stays 0 without any.
    """
    scene, space, ledger = impacts.scene, impacts.in_space, ledgers is not None
    answers = np.zeros(impacts.size, ANSWER_IN_SPACE if space else ANSWER)
    steps = budget or (KERNEL_STEPS_IN_SPACE if space else KERNEL_STEPS)
    for oblique, which in impacts.by_kind():
        options = {"fold": not impacts.others, "space": space, "small": impacts.small}
        wanted = variant(scene, oblique, rtol, rotation or ledger, ledger, **options)
        library, terms_of = kernel(wanted), OWN_LEDGER if books_own(wanted.choice) else LEDGER

        def chunk(first: int, library: Any = library, which: np.ndarray = which, terms_of: Any = terms_of) -> None:
            whole, last = which.size == answers.size, min(first + CHUNK, which.size)
            rows = slice(first, last) if whole else which[first:last]  # no copy of the whole
            some, terms = answers[rows], np.zeros(last - first if ledger else 0, terms_of)
            call = task(library, impacts.subset(rows), rtol, steps, some, 0 if ledger else jumps)
            call.buffer("books", terms)
            call.run()
            if not whole:
                answers[rows] = some
            if ledgers is not None:
                for name in terms.dtype.names or ():
                    ledgers[name][rows] = terms[name]

        firsts = range(0, which.size, CHUNK)
        if threads == 1 or len(firsts) == 1:
            for first in firsts:
                chunk(first)
        else:
            from concurrent.futures import ThreadPoolExecutor  # slow import

            with ThreadPoolExecutor(threads) as pool:  # the call releases the interpreter's lock
                list(pool.map(chunk, firsts))
    return answers


def task(
    library: ctypes.CDLL, impacts: KernelImpacts, rtol: float, budget: int, answers: np.ndarray, jumps: int = 0
) -> Task:
    """The task of a kernel for impacts all oblique or all head-on, as the kernel is.

    Arguments:
        answers: array for the answers, zeros of ANSWER.
        budget, jumps: as for `run_kernel`.

    Raises:
        InputError: the scene lacks a quantity.
    """
    call = Task(library, impacts.size, min(rtol, LOOSEST), budget)
    call.number("jumps", jumps)
    values = {"poisson_ratio": 0.0, **NEVER_MET, **impacts.values}
    needed = names(library, "quantity_names")
    for name in needed:
        if name not in values:  # of a table that the scene has not, read by a model's law or term
            entry = next(entry for entry in FIELDS.values() if entry.quantity == name)
            raise InputError(entry.name, None, f"{entry.accepts}, which the model reads")
    call.columns([_column(values[name]) for name in needed])
    call.buffer("answers", answers)
    return call


def _column(values: np.ndarray | float) -> np.ndarray | float:
    if isinstance(values, float):
        return values
    column = np.ascontiguousarray(values, dtype=float).reshape(-1)
    return column.item() if column.size == 1 else column
