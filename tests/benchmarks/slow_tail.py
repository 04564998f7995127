"""How long single calls of the exported law in space take: medians, means and the slow tail, and what a budget does.

    python -m tests.benchmarks.slow_tail     measures and prints (the table is in docs/how-to/c-law.md)

Granulation pairs with relative speeds V from 0.1 to 10 m/s in any direction; both spin about any axis, by a given part
of V/a. Plain doubles, CPU time of the thread for each call, in a loop in C.
"""

import ctypes
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from wetdoublet.solvers import Scene

from ..helpers.exported_law import Law, written
from .law_in_c import FLAGS
from .measured.digits import of_rows

COUNT, SPINS, RTOL, BUDGET = 20_000, (0.3, 1.0, 5.0), 1e-8, 1000
LOOP = """
#define _POSIX_C_SOURCE 199309L
#include "{name}.h"
#include <time.h>
static double now(void)
{{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9*(double)t.tv_nsec;
}}
void timed(const {name}_material *m, const {name}_pair *pairs, long count, double rtol, int budget,
           {name}_pair_after *after, double *seconds)
{{
    for (long k = 0; k < count; k++) {{
        double start = now();
        {name}_collide_pair(m, pairs + k, rtol, budget, after + k);
        seconds[k] = now() - start;
    }}
}}
"""


def pairs(scene: Scene, spin: float, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normals, velocities and spins; every pair approaches."""
    draw = np.random.default_rng(7)
    normal, moving, axes = (draw.normal(size=(count, *shape, 3)) for shape in ((), (), (2,)))
    normal, moving, axes = (each / np.linalg.norm(each, axis=-1, keepdims=True) for each in (normal, moving, axes))
    moving *= -np.sign(np.sum(normal * moving, axis=-1, keepdims=True))
    speed = 10 ** draw.uniform(-1.0, 1.0, count)
    spins = spin * speed[:, None, None] / float(scene.material["reduced_radius"]) * axes
    return normal, np.stack([0.0 * moving, speed[:, None] * moving], axis=1), spins


def main() -> None:
    """Measure all spins."""
    scene, rows = Scene.load("granulation"), []
    with tempfile.TemporaryDirectory() as name:
        folder = written(scene, Path(name))
        flags = (*FLAGS, "-DGRANULATION_LANES=1")
        law = Law(scene, folder, *flags)
        (folder / "loop.c").write_text(LOOP.format(name=law.name))
        command = ["gcc", "-std=c99", *flags, "-fPIC", "-shared", "-o", "loop.so", "loop.c", f"{law.name}.c", "-lm"]
        subprocess.run(command, cwd=folder, check=True)
        timed = ctypes.CDLL(str(folder / "loop.so")).timed
        for spin in SPINS:
            given, row = law.pairs(*pairs(scene, spin, COUNT)), {"spins, of V/a": f"{spin:g}"}
            calls = []
            for budget, word in ((0, ""), (BUDGET, f"budget {BUDGET}: ")):
                after, seconds = np.zeros(COUNT, law.dtype("pair_after")), np.zeros(COUNT)
                pointers = [ctypes.c_void_p(each.ctypes.data) for each in (law.material(), given, after, seconds)]
                settings = ctypes.c_long(COUNT), ctypes.c_double(RTOL), ctypes.c_int(budget)
                timed(*pointers[:2], *settings, *pointers[2:])
                row |= {f"{word}median ms": f"{1e3 * np.median(seconds):.3f}"}
                row |= {f"{word}mean": f"{1e3 * seconds.mean():.3f}"}
                row |= {f"{word}above {limit} ms": f"{np.mean(seconds > 1e-3 * limit):.3%}" for limit in (1, 10)}
                row |= {f"{word}99.9 %": f"{1e3 * np.quantile(seconds, 0.999):.3g}"}
                row |= {f"{word}longest": f"{1e3 * seconds.max():.3g}"}
                row |= {f"{word}undecided": f"{np.mean(after['status'] != 0):.2%}"}
                calls.append(after)
            whole, late = calls[0], calls[1]["status"] != 0
            row["of these part"] = f"{np.mean(whole['outcome'][late] > 0):.0%}"
            row["their times, s"] = str(np.quantile(whole["time"][late & (whole["outcome"] > 0)], [0.1, 0.9]).round(3))
            rows.append(row)
    sys.stdout.write(of_rows(rows) + "\n")


if __name__ == "__main__":
    main()
