"""What whole processes take: a cold start, a first use, and how a call grows with the number of collisions."""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from typing import Any

from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.host.workers import usable_cores

from .timing import Tell

Record = dict[str, Any]
Process = Callable[[list[str], Mapping[str, str]], float]

IMPORTS = "import wetdoublet.solvers.many, xarray"
CALL = "from wetdoublet.solvers import collide_many; collide_many('{preset}', stokes=0.5, angle=1.0, engine='taylor')"
PRESETS = ("granulation", "pendulum")
SIZES = (1, 10, 100, 1_000, 10_000, 100_000, 1_000_000)
PATIENCE = 10.0  # s: a size that would take longer, by the one before, is left out
PROGRAM = """
import json, os, resource, sys, time
count, cores = int(sys.argv[1]), int(sys.argv[2])
if hasattr(os, "sched_setaffinity"):
    os.sched_setaffinity(0, set(sorted(os.sched_getaffinity(0))[:cores]))
import numpy as np
from wetdoublet.solvers import collide_many
draw = np.random.default_rng(7)
stokes, angle = 0.005 * 100.0 ** draw.uniform(size=count), np.radians(draw.uniform(0, 85, count))
collide_many("granulation", stokes=stokes[:101] if count > 100 else stokes, angle=angle[:101] if count > 100 else angle)
def memory():
    try:  # the high-water mark of this program, not of the one that started it
        lines = open("/proc/self/status").read().splitlines()
        return 1024 * int(next(line for line in lines if line.startswith("VmHWM")).split()[1])
    except OSError:
        return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
def used():
    both = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in both)
before = memory()
wall = time.perf_counter()
cpu = used()
data = collide_many("granulation", stokes=stokes, angle=angle)
print(json.dumps({"wall": time.perf_counter() - wall, "cpu": used() - cpu, "memory": memory(),
                  "before": before, "failed": int((data["outcome"].values < 0).sum())}))
"""


def spent(arguments: list[str], environment: Mapping[str, str] | None = None) -> float:
    """Wall time (s) of a whole process."""
    start = time.perf_counter()
    subprocess.run([sys.executable, *arguments], check=True, capture_output=True, env=environment)
    return time.perf_counter() - start


def cold_start(repeats: int = 5) -> dict[str, list[float]]:
    """Wall times (s) of a process that imports casadi."""
    return {"import casadi": [spent(["-c", "import casadi"]) for _ in range(repeats)]}


def first_use(repeats: int = 5, process: Process = spent, tell: Tell = lambda _: None) -> list[Record]:
    """Wall times (s) of whole processes that collide by the kernel, of each preset.

    `process` runs one, by its arguments and environment. `first` finds an empty cache and compiles, `second` finds what
    that left, `imports` only imports the same.
    """
    rows: list[Record] = []
    if compiler() is None:
        return rows
    for preset in PRESETS:
        tell(f"first use: {preset}")
        taken: dict[str, list[float]] = {"first": [], "second": [], "imports": []}
        for _ in range(repeats):
            with tempfile.TemporaryDirectory() as folder:
                where = os.environ | {"WETDOUBLET_CACHE": folder}
                call = f"{IMPORTS}\n{CALL.format(preset=preset)}"
                for name, program in (("first", call), ("second", call), ("imports", IMPORTS)):
                    taken[name].append(process(["-c", program], where))
        rows.append({"preset": preset, **taken})
    return rows


def growth(tell: Tell = lambda _: None) -> list[Record]:
    """A fresh process a size and number of cores; a first call of a hundred has built what is needed."""
    found: list[Record] = []
    available = usable_cores()
    for cores in (1, 2)[:available]:
        before = 0.0
        for count in SIZES:
            if 10 * before > PATIENCE:
                break
            tell(f"growth: {cores} cores, {count}")
            command = [sys.executable, "-c", PROGRAM, str(count), str(cores)]
            done = subprocess.run(command, check=True, capture_output=True, text=True)
            measured: Record = json.loads(done.stdout)
            before = measured["wall"]
            found.append({"engine": "taylor", "cores": cores, "collisions": count, **measured})
    return found
