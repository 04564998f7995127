"""Cold start and first use: what the first result costs in a fresh process, with and without something compiled."""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from typing import Any

from wetdoublet.solvers.host.compiler import compiler

Record = dict[str, Any]
Process = Callable[[list[str], Mapping[str, str]], float]

COMMANDS = {
    "python": ["-c", "pass"],
    "import casadi": ["-c", "import casadi"],
    "collide granulation": ["-m", "wetdoublet.solvers", "collide", "granulation", "--json"],
}
IMPORTS = "import wetdoublet.solvers.many, xarray"
CALL = "from wetdoublet.solvers import collide_many; collide_many('{preset}', stokes=0.5, angle=1.0, engine='taylor')"
PRESETS = ("granulation", "pendulum")


def cold_start(repeats: int = 5) -> dict[str, list[float]]:
    """Wall times (s) of each command, in turns."""
    taken: dict[str, list[float]] = {name: [] for name in COMMANDS}
    for _ in range(repeats):
        for name, arguments in COMMANDS.items():
            taken[name].append(spent(arguments))
    return taken


def spent(arguments: list[str], environment: Mapping[str, str] | None = None) -> float:
    """Wall time (s) of a whole process."""
    start = time.perf_counter()
    subprocess.run([sys.executable, *arguments], check=True, capture_output=True, env=environment)
    return time.perf_counter() - start


def first_use(repeats: int = 5, process: Process | None = None) -> list[Record]:
    """Wall times (s) of whole processes that collide by the kernel, of each preset.

    `process` runs one, by its arguments and environment. `first` finds an empty cache and compiles, `second` finds what
    that left, `imports` only imports the same.
    """
    rows: list[Record] = []
    if compiler() is None:
        return rows
    for preset in PRESETS:
        taken: dict[str, list[float]] = {"first": [], "second": [], "imports": []}
        for _ in range(repeats):
            with tempfile.TemporaryDirectory() as folder:
                where = os.environ | {"WETDOUBLET_CACHE": folder}
                call = f"{IMPORTS}\n{CALL.format(preset=preset)}"
                for name, program in (("first", call), ("second", call), ("imports", IMPORTS)):
                    taken[name].append((process or spent)(["-c", program], where))
        rows.append({"preset": preset, **taken})
    return rows
