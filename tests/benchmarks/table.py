"""Tables of the presets: size, error found by ten million queries, time of a query beside the kernel's collision.

    python -m tests.benchmarks.table [QUERIES] [FILE]

QUERIES (1e7) in the attack of the first table, a tenth of it of the others. Times are CPU times of one
thread, the least of several runs, table and kernel in turn. The tables are written into FILE
(docs/engineering/table-figures.md) between its marks.
"""

# ruff: noqa: T201 -- a script that prints
import ctypes
import shlex
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.solvers import Scene, Table, gradients_many, table
from wetdoublet.solvers.engines.taylor.call import run_kernel
from wetdoublet.solvers.export.equations import file_name
from wetdoublet.solvers.many.batch import validated_batch
from wetdoublet.solvers.many.by_kernel import impacts_of

CASES: tuple[tuple[str, dict[str, Any], float], ...] = (
    ("granulation", {"stokes": (0.005, 1.0), "angle": ("0 deg", "84 deg")}, 1e-4),
    ("pendulum", {"stokes": (0.5, 40.0), "angle": ("0 deg", "80 deg")}, 1e-4),
    ("granulation-dry-bridge", {"stokes": (0.005, 1.0), "angle": ("1 deg", "84 deg")}, 1e-4),
    ("granulation", {"stokes": (0.01, 0.3), "angle": ("30 deg", "70 deg"),
                     "liquid.viscosity": ("1.5 Pa s", "2.5 Pa s")}, 1e-3),
)  # fmt: skip
COLUMNS = (
    "scene", "variables", "error asked for", "largest found", "queries", "kB", "patches", "CPU s to build",
    "C, ns a query", "with derivatives", "kernel, ns a collision", "median difference of de_n/dSt from the kernel's",
)  # fmt: skip
_QUERIES, _RUNS, _GRADIENTS = 100_000, 7, 500
_COMPILER = "cc -std=c99 -O3 -march=native -shared -fPIC"
_MARKS = "<!-- measured -->", "<!-- end of measured -->"


def main(queries: int, file: Path | None) -> None:
    """Measure every case, print the rows, and write them."""
    rows = [f"| {' | '.join(COLUMNS)} |", "|" + "---|" * len(COLUMNS)]
    for name, over, error in CASES:
        scene, three = Scene.load(name), len(over) > 2
        started = time.process_time()
        law = table(scene, over=over, error=error, attack=queries if len(rows) == 2 else queries // 10)
        spent = time.process_time() - started
        stokes, angle, third = _impacts(law, _QUERIES)
        quick, sloped = _reader(law, stokes, angle, third)
        kernel = _kernel(scene, law, stokes, angle, third)
        times = _least((quick, sloped, kernel), _QUERIES)
        rows.append(
            f"| {name} | {', '.join(over)} | {error:g} | {law.found.largest:.2g} | {law.found.queries:.0e} |"
            f" {law.data.bytes / 1000:.0f} | {len(law.data.results.size)} | {spent:.0f} | {times[0]:.0f} |"
            f" {times[1]:.0f} | {times[2]:.0f} | {'-' if three else f'{_slopes(law):.1e}'} |"
        )
        print(rows[-1], flush=True)
        if file is not None:
            _write(file, rows)


def _write(file: Path, rows: list[str]) -> None:
    """Put the rows between the marks of a file."""
    before, _, rest = file.read_text().partition(_MARKS[0])
    after = rest.partition(_MARKS[1])[2]
    file.write_text(before + "\n".join([_MARKS[0], *rows, _MARKS[1]]) + after)


def _impacts(law: Table, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    random = np.random.default_rng(17)
    stokes = np.exp(random.uniform(*np.log(law.range.stokes), count))
    return stokes, random.uniform(*law.range.angle, count), random.uniform(*law.range.ends, count)


def _reader(law: Table, *columns: np.ndarray) -> tuple[Callable[[], Any], Callable[[], Any]]:
    """Queries by the header in C, without and with derivatives."""
    name, given = file_name(law.scene), len(law.variables)
    arguments = ", ".join(f"{one}[k]" for one in ("a", "b", "c")[:given])
    lines = [
        '#include "law.h"',
        "double quick(int n, const double *a, const double *b, const double *c) {",
        f"  double sum = 0; int k; {name}_answer one; (void)c;",
        f"  for (k = 0; k < n; ++k) {{ {name}_table({arguments}, &one); sum += one.outcome + one.value[1]; }}",
        "  return sum; }",
        "double sloped(int n, const double *a, const double *b, const double *c) {",
        f"  double sum = 0; int k; {name}_answer one; {name}_slopes by; (void)c;",
        f"  for (k = 0; k < n; ++k) {{ {name}_table_slopes({arguments}, &one, &by); sum += by.by[0][0]; }}",
        "  return sum; }",
    ]
    folder = Path(tempfile.mkdtemp())
    law.save(folder / "law.h")
    (folder / "query.c").write_text("\n".join(lines))
    subprocess.run([*shlex.split(_COMPILER), "query.c", "-o", "query.so", "-lm"], cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "query.so"))
    places = [one.ctypes.data_as(ctypes.c_void_p) for one in columns]
    return tuple(lambda run=run: run(columns[0].size, *places) for run in (library.quick, library.sloped))


def _kernel(scene: Scene, law: Table, stokes: np.ndarray, angle: np.ndarray, third: np.ndarray) -> Callable[[], Any]:
    """The same collisions by the kernel, outcome and restitutions only."""
    vary = {} if law.range.third is None else {law.range.third: third}
    impact = {"stokes": stokes, "angle": angle, "speed": None, "relative_speed": None}
    impacts, _ = impacts_of(validated_batch(scene, impact, vary, law.rtol, "taylor", ("outcome",)))
    return lambda: run_kernel(impacts, law.rtol, jumps=2)


def _least(calls: tuple[Callable[[], Any], ...], count: int) -> list[float]:
    """Least CPU time of each call, ns a query, taken in turn."""
    least = [np.inf] * len(calls)
    for _ in range(_RUNS):
        for k, call in enumerate(calls):
            started = time.process_time()
            call()
            least[k] = min(least[k], time.process_time() - started)
    return [1e9 * one / count for one in least]


def _slopes(law: Table) -> float:
    """Median of |difference of de_n/dSt| over its magnitude, of collisions that separate."""
    stokes, angle, _ = _impacts(law, _GRADIENTS)
    right = gradients_many(law.scene, stokes=stokes, angle=angle, wrt=["impact.stokes"]).gradient.values.reshape(-1)
    said = law(stokes, angle, slopes=True)
    own = said["d_restitution"].values[:, 0]
    free = (said.outcome.values > 0) & np.isfinite(right) & (np.abs(right) > 1e-6)
    return float(np.median(np.abs(own[free] - right[free]) / np.abs(right[free])))


if __name__ == "__main__":
    main(int(float(sys.argv[1])) if len(sys.argv) > 1 else 10**7, Path(sys.argv[2]) if len(sys.argv) > 2 else None)
