"""Compile time and run time of the compiled integrators by optimisation level.

    python -m tests.benchmarks.compile_flags [FOLDER]

Writes FOLDER/compile_flags.json (docs/engineering/performance).
"""

import json
import os
import sys
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any
from unittest import mock

from wetdoublet.solvers.engines.casadi import integrators
from wetdoublet.solvers.engines.casadi.locate import locate
from wetdoublet.solvers.host import compiled
from wetdoublet.solvers.host.environment import environment
from wetdoublet.solvers.model.model import load, select_model

from .measured.answers import dimensionless
from .measured.tasks import TASKS, Task

LEVELS = ("-O1", "-O2", "-O3")
RTOL, ROUNDS, REPEATS = 1e-8, 3, 5


class Clock:
    """CPU time spent inside the integrators."""

    def __init__(self) -> None:
        self.spent = 0.0
        self._call = integrators._call

    def __call__(self, *arguments: Any, **options: Any) -> Any:
        start = time.process_time()
        try:
            return self._call(*arguments, **options)
        finally:
            self.spent += time.process_time() - start


def measure(task: Task, level: str) -> dict[str, Any]:
    """Compile everything the task needs in a fresh cache, then integrate it."""
    collisions = [
        (load(select_model(task.scene, True)), dimensionless(task.scene, impact).groups) for impact in task.impacts()
    ]
    with tempfile.TemporaryDirectory() as cache:
        integrators.locator.cache_clear()
        with (
            mock.patch.dict(os.environ, {"WETDOUBLET_CACHE": cache}),
            mock.patch.object(compiled, "FLAGS", (level, *compiled.FLAGS[1:])),
            mock.patch.object(integrators, "_call", Clock()) as clock,
        ):
            start = time.perf_counter()
            _run(collisions)
            first = time.perf_counter() - start
            spent = []
            for _ in range(REPEATS):
                clock.spent = 0.0
                _run(collisions)
                spent.append(clock.spent / len(collisions))
            libraries = len(list(Path(cache).glob("*.so")))
    return {"task": task.preset, "level": level, "libraries": libraries, "first_pass": first, "integrators": min(spent)}


def _run(collisions: list[Any]) -> None:
    for model, groups in collisions:
        locate(model, groups, RTOL, machine_code=True)


def _best(rounds: Iterable[list[dict[str, Any]]]) -> list[dict[str, Any]]:
    """The shortest times of levels that took turns."""
    found = list(rounds)
    return [
        each | {name: min(turn[k][name] for turn in found) for name in ("first_pass", "integrators")}
        for k, each in enumerate(found[0])
    ]


def main() -> None:
    """Measure, and write the record."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/engineering/performance")
    folder.mkdir(parents=True, exist_ok=True)
    measure(TASKS[0], "-O1")  # so that the first one measured does not pay for imports
    rows = [_best([measure(task, level) for level in LEVELS] for _ in range(ROUNDS)) for task in TASKS]
    record = {"environment": environment(), "rtol": RTOL, "rows": [row for each in rows for row in each]}
    (folder / "compile_flags.json").write_text(json.dumps(record, indent=1) + "\n")
    for row in record["rows"]:
        sys.stdout.write(f"{row}\n")


if __name__ == "__main__":
    main()
