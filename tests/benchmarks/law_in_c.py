"""The exported law beside our kernel: speed of single calls and of batches.

    python -m tests.benchmarks.law_in_c [FOLDER]     measures, prints, writes law_in_c.json
    python -m tests.benchmarks.law_in_c --print      only prints

FOLDER is docs/engineering/performance. The law is compiled with its Makefile's flags; single calls are made from a loop
in C. All take turns in one process, CPU time, the best of several rounds.
"""

import ctypes
import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from wetdoublet.solvers import Scene
from wetdoublet.solvers.engines.settings import KERNEL_STEPS
from wetdoublet.solvers.engines.taylor.build import kernel
from wetdoublet.solvers.engines.taylor.call import KernelImpacts, run_kernel, task
from wetdoublet.solvers.engines.taylor.layout import ANSWER
from wetdoublet.solvers.export.law.kernels import PLANE, kernels
from wetdoublet.solvers.formatting.tables import table
from wetdoublet.solvers.host.environment import environment

from ..helpers.exported_law import Law, written
from .measured.timing import Call, Least

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "engineering" / "performance"
PRESETS = ("granulation", "pendulum", "granulation-dry-bridge", "lactose-pvp")
RTOL, ROUNDS, TIMED = 1e-9, 7, 2000
FLAGS = ("-O2", "-march=native", "-fno-math-errno", "-ffp-contract=fast", "-funroll-loops")  # of the Makefile
LOOP = """
#include "{name}.h"
void one_by_one(const {name}_material *m, const {name}_impact *impacts, long count, {name}_collision *found)
{{
    for (long k = 0; k < count; k++)
        {name}_collide(m, impacts + k, 1e-9, 0, found + k);
}}
"""


def impacts(law: Law, scene: Scene, count: int, spinning: bool) -> np.ndarray:
    """Random impacts of a scene: speeds over three decades about the Stokes number 0.1, angles to 85 degrees."""
    draw = np.random.default_rng(5)
    speed = 10 ** draw.uniform(-2.5, 1.0, count) / scene.stokes_per_speed
    spins = draw.normal(size=(2, count)) * speed / (2 * scene.reduced_radius) if spinning else np.zeros((2, count))
    return law.impacts(speed=speed, angle=draw.uniform(0.02, 1.48, count), spin=spins[0], partner_spin=spins[1])


def best(calls: dict[str, Callable[[], object]], count: int) -> dict[str, float]:
    """Microseconds of each, taking turns."""
    ready = {name: Least(Call(call), count) for name, call in calls.items()}
    for least in [*ready.values()] * ROUNDS:
        least.run()
    return {name: least.cpu * 1e6 for name, least in ready.items()}


def same_kernel(scene: Scene, rows: np.ndarray) -> Callable[[], np.ndarray]:
    """Our kernel of the law's own variant, in a plane."""
    own = next(each for each in kernels(scene, RTOL) if each.prefix == PLANE)
    library = kernel(own.variant)
    assert library is not None
    others = {"impact_spin": rows["spin"].copy(), "impact_partner_spin": rows["partner_spin"].copy()}
    given = KernelImpacts(own.scene, rows["speed"].copy(), rows["angle"].copy(), others)

    def call() -> np.ndarray:
        found = np.zeros(rows.size, ANSWER)
        task(library, given, RTOL, KERNEL_STEPS, found).run()
        return found

    return call


def speed(scene: Scene, law: Law, loops: dict[str, ctypes.CDLL], spinning: bool) -> dict[str, float]:
    """Microseconds a collision, each way."""
    rows, material = impacts(law, scene, TIMED, spinning), law.material()
    found = np.zeros(TIMED, law.dtype("collision"))
    given = [ctypes.c_void_p(each.ctypes.data) for each in (material, rows)]
    calls: dict[str, Callable[[], object]] = {
        name: partial(loop.one_by_one, *given, ctypes.c_long(TIMED), ctypes.c_void_p(found.ctypes.data))
        for name, loop in loops.items()
    }
    calls |= {"batch": lambda: law.collide(rows), "kernel": same_kernel(scene, rows)}
    if not spinning:
        plain = KernelImpacts(scene, rows["speed"].copy(), rows["angle"].copy(), {})
        calls["for maps"] = lambda: run_kernel(plain, RTOL, jumps=2)
    return best(calls, TIMED)


def measured(preset: str, folder: Path) -> dict[str, Any]:
    """The row of a preset."""
    scene = Scene.load(preset)
    written(scene, folder)
    law = Law(scene, folder, *FLAGS)
    (folder / "loop.c").write_text(LOOP.format(name=law.name))
    loops = {}
    for name, more in (("single", ()), ("single, in one lane", (f"-D{law.name.upper()}_LANES=1",))):
        command = ["gcc", "-std=c99", *FLAGS, *more, "-fPIC", "-shared", "-o", f"{len(more)}.so", "loop.c"]
        subprocess.run([*command, f"{law.name}.c", "-lm"], cwd=folder, check=True)
        loops[name] = ctypes.CDLL(str(folder / f"{len(more)}.so"))
    row: dict[str, Any] = {"preset": preset, "plain": speed(scene, law, loops, spinning=False)}
    if scene.pendulum is None and not scene.wall:
        row["spinning"] = speed(scene, law, loops, spinning=True)
    return row


def section(record: dict[str, Any]) -> str:
    """The part of the page."""
    columns = {"single": "single call", "single, in one lane": "with `-DLAW_LANES=1`", "batch": "batch",
               "kernel": "our kernel, same variant", "for maps": "for maps"}  # fmt: skip
    speeds = []
    for row in record["rows"]:
        for kind in ("plain", "spinning"):
            if kind in row:
                cells = (f"{row[kind][way]:.2g}" if way in row[kind] else "-" for way in columns)
                speeds.append([row["preset"] + ", spinning" * (kind == "spinning"), *cells])
    said = (
        f"`python -m tests.benchmarks.law_in_c`: `export --to c` with the flags of its Makefile, rtol "
        f"{record['rtol']:g}; random impacts over three decades of the speed. The law has a spin for each sphere, "
        "rotation and times. The kernel for maps has none of these, and jumps along the slow manifold. A single call "
        "fills one lane, and is faster where there is only one."
    )
    return "\n\n".join(["## The exported law", table(["CPU us a collision", *columns.values()], speeds), said])


def main() -> None:
    """Measure all presets."""
    asked = [each for each in sys.argv[1:] if each != "--print"]
    rows = []
    for preset in PRESETS:
        with tempfile.TemporaryDirectory() as folder:
            rows.append(measured(preset, Path(folder)))
    record = {"environment": environment(), "rtol": RTOL, "rows": rows}
    sys.stdout.write(section(record) + "\n")
    if "--print" not in sys.argv:
        target = Path(asked[0]) if asked else FOLDER
        (target / "law_in_c.json").write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
