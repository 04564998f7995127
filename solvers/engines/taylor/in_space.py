"""Collisions of two spheres in space by the kernel, with vectors in the laboratory's axes."""

import ctypes
from collections.abc import Mapping
from typing import Any

import numpy as np

from ....generated.automaton import LOOSEST
from ...model.model import select_model
from ...scene.contact import NEVER_MET
from ...scene.groups import si_values
from ...scene.scene import Scene
from ..settings import KERNEL_STEPS_IN_SPACE
from .build import kernel
from .call import CHUNK, in_chunks, variant
from .layout import ANSWER_IN_SPACE, HAPPENING, LEDGER, Task, names
from .source import Variant

AXES = "xyz"
_ROOM = 256  # events of a recorded collision


def variant_in_space(scene: Scene, rtol: float, ledger: bool = False) -> Variant:
    """The variant that `run_in_space` takes."""
    return variant(scene, select_model(scene, True, full=ledger, space=True), rtol, rotation=False, ledger=ledger)


def run_in_space(
    scene: Scene,
    vectors: Mapping[str, np.ndarray],
    speed: np.ndarray,
    rtol: float,
    threads: int = 1,
    ledger: bool = False,
) -> tuple[np.ndarray, np.ndarray | None]:
    """An array of ANSWER_IN_SPACE, one per collision, and with `ledger` one of LEDGER.

    Arguments:
        vectors: `initial_normal`, `impact_turning`, `impact_spin` and `impact_partner_spin`, each (collisions, 3), SI.
        speed: normal approach speeds, m/s.
    """
    library = kernel(variant_in_space(scene, rtol, ledger))
    values = _values(scene, vectors, speed)
    answers = np.zeros(speed.size, ANSWER_IN_SPACE)
    books = np.zeros(speed.size, LEDGER) if ledger else None

    def chunk(first: int) -> None:
        part = slice(first, min(first + CHUNK, speed.size))
        call = _task(library, values, part, rtol, answers[part])
        if books is not None:
            call.buffer("books", books[part])
        call.run()

    in_chunks(speed.size, chunk, threads)
    return answers, books


def recorded_in_space(
    scene: Scene, vectors: Mapping[str, np.ndarray], speed: np.ndarray, rtol: float
) -> tuple[Any, np.ndarray]:
    """The answer of one collision, and its events with the modes between them (`HAPPENING`)."""
    library, room = kernel(variant_in_space(scene, rtol)), _ROOM
    while True:
        answers, log = np.zeros(1, ANSWER_IN_SPACE), np.zeros(room, HAPPENING)
        call = _task(library, _values(scene, vectors, speed), slice(0, 1), rtol, answers)
        call.buffer("log", log)
        call.run()
        events = int(answers["events"][0])
        if events <= room:
            return answers[0], log[:events]
        room = events


def _values(scene: Scene, vectors: Mapping[str, np.ndarray], speed: np.ndarray) -> dict[str, np.ndarray | float]:
    values: dict[str, np.ndarray | float] = {"poisson_ratio": 0.0, **NEVER_MET, **si_values(scene, None, None)}
    for name, rows in vectors.items():
        values |= {f"{name}_{axis}": np.ascontiguousarray(rows[:, k]) for k, axis in enumerate(AXES)}
    return values | {"speed": np.ascontiguousarray(speed)}


def _task(
    library: ctypes.CDLL, values: Mapping[str, np.ndarray | float], part: slice, rtol: float, answers: np.ndarray
) -> Task:
    task = Task(library, answers.size, min(rtol, LOOSEST), KERNEL_STEPS_IN_SPACE)
    columns = (values[name] for name in names(library, "quantity_names"))
    task.columns([column if isinstance(column, float) else column[part] for column in columns])
    task.buffer("answers", answers)
    return task
