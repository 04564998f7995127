"""CPU time of `collide_many` and of the kernel in this tree over that of another commit, in turns in one run.

    python -m tests.benchmarks.paired PYTHON

PYTHON is the interpreter of an environment with the other commit (b16ea5f or later). Both get the same impacts of the
tasks, drawn on from their sequence, without those that this tree decides at initial contact; one core; the least of
several turns counts, and the median of their ratios is printed beside it.
"""

# ruff: noqa: T201 -- a script that prints
import json
import os
import subprocess
import sys
from itertools import islice
from statistics import median
from typing import Any

import numpy as np
from wetdoublet.solvers.engines.taylor.call import Impacts, run_kernel

from .measured.tasks import TASKS

TURNS, SETS = 15, {"granulation": 40, "pendulum": 100}
_WORKER = """
import json, sys, time
import numpy as np
preset, stokes, angle = json.loads(sys.stdin.readline())
stokes, angle = np.array(stokes), np.array(angle)
try:
    import wetdoublet.solvers as wd
    from wetdoublet.solvers.scene import Scene
    from wetdoublet.solvers.taylor.engine import Impacts, answers
except ImportError:
    import wetdoublet as wd
    from wetdoublet.solvers import Scene
    from wetdoublet.solvers.engines.taylor.call import Impacts, run_kernel as answers
scene = Scene.load(preset)
impacts = Impacts(scene, scene.speed_of(stokes), angle, {})
tasks = {
    "kernel": lambda rtol: answers(impacts, rtol),
    "collide_many": lambda rtol: wd.collide_many(
        preset, stokes=stokes, angle=angle, of=("outcome", "restitution"), rtol=rtol
    ),
}
for line in sys.stdin:
    name, rtol, count = json.loads(line)
    start = time.process_time()
    for _ in range(count):
        tasks[name](rtol)
    print((time.process_time() - start) / count / stokes.size * 1e6, flush=True)
"""


class Process:
    """An interpreter that measures on request."""

    def __init__(self, python: str, impacts: list[Any]) -> None:
        environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"}
        pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        self._child = subprocess.Popen([python, "-c", _WORKER], **pipes, text=True, env=environment)
        self._send(impacts)

    def _send(self, message: list[Any]) -> None:
        self._child.stdin.write(json.dumps(message) + "\n")
        self._child.stdin.flush()

    def time(self, name: str, rtol: float, count: int) -> float:
        """CPU time of a collision, us."""
        self._send([name, rtol, count])
        return float(self._child.stdout.readline())


def main() -> None:
    """Measure and print."""
    for task in TASKS:
        drawn = [each for impacts in islice(task.drawn(), SETS[task.preset]) for each in impacts]
        stokes, angle = (np.array([getattr(each, word) for each in drawn]) for word in ("stokes", "angle"))
        answers = run_kernel(Impacts(task.scene, task.scene.speed_of(stokes), angle, {}), 1e-9)
        assert answers is not None
        live = answers["steps"] > 0
        impacts = [task.preset, stokes[live].tolist(), angle[live].tolist()]
        both = [Process(python, impacts) for python in (sys.argv[1], sys.executable)]
        for name in ("kernel", "collide_many"):
            for rtol in (1e-9, 1e-8):
                for each in both:
                    each.time(name, rtol, 2)  # compiled, loaded
                turns = [[each.time(name, rtol, 8) for each in both] for _ in range(TURNS)]
                old, new = map(min, zip(*turns))
                middle = median(b / a for a, b in turns)
                print(
                    f"{task.preset}, {name}, rtol {rtol:g}: {old:.2f}, now {new:.2f} us: {new / old:.2f} ({middle:.2f})"
                )


if __name__ == "__main__":
    main()
