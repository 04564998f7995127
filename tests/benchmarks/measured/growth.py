"""How cost grows with the number of collisions: wall time, CPU time and memory, on one core and on two."""

import json
import subprocess
import sys
from collections.abc import Callable
from typing import Any

from wetdoublet.solvers.host.cores import usable_cores

Record = dict[str, Any]

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


def growth(tell: Callable[[str], None] = lambda _: None) -> list[Record]:
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
