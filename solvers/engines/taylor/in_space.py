"""Collisions of two spheres in space by the kernel, with vectors in the laboratory's axes."""

from collections.abc import Mapping

import numpy as np

from ....generated.automaton import LOOSEST
from ...model.model import select_model
from ...scene.contact import NEVER_MET
from ...scene.groups import si_values
from ...scene.scene import Scene
from ..settings import KERNEL_STEPS_IN_SPACE
from .build import kernel
from .call import CHUNK, in_chunks, variant
from .layout import ANSWER_IN_SPACE, LEDGER, Task, names
from .source import Variant

AXES = "xyz"


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
) -> tuple[np.ndarray, np.ndarray | None] | None:
    """An array of ANSWER_IN_SPACE, one per collision, and with `ledger` one of LEDGER; None if no kernel is available.

    Arguments:
        vectors: `initial_normal`, `impact_turning`, `impact_spin` and `impact_partner_spin`, each (collisions, 3), SI.
        speed: normal approach speeds, m/s.
    """
    library = kernel(variant_in_space(scene, rtol, ledger))
    if library is None:
        return None
    values: dict[str, np.ndarray | float] = {"poisson_ratio": 0.0, **NEVER_MET, **si_values(scene, None, None)}
    for name, rows in vectors.items():
        values |= {f"{name}_{axis}": np.ascontiguousarray(rows[:, k]) for k, axis in enumerate(AXES)}
    values["speed"] = np.ascontiguousarray(speed)
    answers = np.zeros(speed.size, ANSWER_IN_SPACE)
    books = np.zeros(speed.size, LEDGER) if ledger else None

    def chunk(first: int) -> None:
        part = slice(first, min(first + CHUNK, speed.size))
        one = Task(library, part.stop - first, min(rtol, LOOSEST), KERNEL_STEPS_IN_SPACE)
        columns = (values[name] for name in names(library, "quantity_names"))
        one.columns([column if isinstance(column, float) else column[part] for column in columns])
        one.buffer("answers", answers[part])
        if books is not None:
            one.buffer("books", books[part])
        one.run()

    in_chunks(speed.size, chunk, threads)
    return answers, books
