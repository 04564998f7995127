"""CPU times as ratios, which depend little on machine and load, and the errors beside them."""

import ctypes
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
import wetdoublet as wd

_ROUNDS = 7
_LOOP = """
double loop(long count)
{
    double x = 1.0;
    for (long k = 0; k < count; k++)
        x = 0.5*(x + 2.0/x) + 1e-9*k;
    return x;
}
"""
_COUNT = 1_000_000  # some 5 ms
_COLLIDE = "import wetdoublet as wd; wd.collide('granulation', stokes=0.3, angle=0.5)"
_DRAW = np.random.default_rng(17)
_MANY: dict[str, Any] = {"stokes": 0.005 * 100 ** _DRAW.uniform(size=1000), "angle": _DRAW.uniform(0, 1.4, 1000)}
_AXES: dict[str, Any] = {"stokes": np.geomspace(0.005, 0.5, 30), "angle": np.linspace(0, 1.4, 30)}
_ENTRIES = ("impact.speed", "impact.angle", "liquid.viscosity", "bridge.volume")


def _gradients(rtol: float) -> Any:
    return wd.gradients_many("granulation", **_MANY, wrt=_ENTRIES, rtol=rtol).elasticity.values


TASKS: dict[str, Callable[[float], Any]] = {
    "collide": lambda rtol: wd.collide("granulation", stokes=0.3, angle=0.5, rtol=rtol).restitution,
    "collide_many, 1000": lambda rtol: wd.collide_many("granulation", **_MANY, rtol=rtol).restitution.values,
    "gradients_many, 1000 by 4": _gradients,
    "regime_map, 30 x 30": lambda rtol: wd.regime_map("granulation", **_AXES, rtol=rtol).restitution.values,
}


class OverLoop:
    """Tasks of a process that has its kernels, in runs of a fixed loop in C."""

    params = tuple(TASKS)
    param_names = ("task",)
    timeout = 600

    def setup(self, task: str) -> None:
        """The loop is compiled; the task has what it compiles and loads."""
        with tempfile.TemporaryDirectory() as folder:
            source, library = Path(folder, "loop.c"), Path(folder, "loop.so")
            source.write_text(_LOOP)
            subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", library, source], check=True)
            self.loop = ctypes.CDLL(str(library)).loop
        self.loop.argtypes, self.loop.restype = [ctypes.c_long], ctypes.c_double
        self.task = TASKS[task]
        self.task(1e-9)

    def track_cpu(self, task: str) -> float:
        """CPU time over the loop's."""
        return _ratio(lambda: _spent(lambda: self.task(1e-9)), lambda: _spent(lambda: self.loop(_COUNT)))

    def track_error(self, task: str) -> float:
        """Largest difference to rtol 1e-12, over the largest value where that is above 1; 1 where outcomes differ."""
        found, tight = (np.atleast_1d(self.task(rtol)) for rtol in (1e-9, 1e-12))
        both = np.isfinite(found) & np.isfinite(tight)
        if (np.isfinite(found) != np.isfinite(tight)).any():
            return 1.0
        return float(np.max(np.abs(found - tight)[both]) / max(1.0, np.max(np.abs(tight[both]))))

    track_cpu.unit = "loops"  # type: ignore[attr-defined]
    track_error.unit = "1"  # type: ignore[attr-defined]


class FirstCollision:
    """A fresh process, of which a compiler is no part: its kernel was compiled before."""

    timeout = 600

    def setup(self) -> None:
        """The kernel is in the cache, and modules are compiled."""
        _process(_COLLIDE)

    def track_cpu(self) -> float:
        """CPU time of the process over that of `import casadi`."""
        return _ratio(lambda: _process(_COLLIDE), lambda: _process("import casadi"))

    track_cpu.unit = "import casadi"  # type: ignore[attr-defined]


def _ratio(task: Callable[[], float], reference: Callable[[], float]) -> float:
    """The median ratio of pairs taken in turns."""
    return median(task() / reference() for _ in range(_ROUNDS))


def _spent(run: Callable[[], object]) -> float:
    """CPU time (s) a call, of as many as take 50 ms."""
    count, start = 0, time.process_time()
    while (taken := time.process_time() - start) < 0.05:
        run()
        count += 1
    return taken / count


def _process(program: str) -> float:
    """CPU time (s) of a process."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    before = _of_children()
    subprocess.run([sys.executable, "-c", program], check=True, env=environment)
    return _of_children() - before


def _of_children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
