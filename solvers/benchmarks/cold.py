"""Cold start: what the first result costs in a fresh process."""

from __future__ import annotations

import subprocess
import sys
import time

COMMANDS = {
    "python": ["-c", "pass"],
    "import casadi": ["-c", "import casadi"],
    "collide granulation": ["-m", "wetdoublet.solvers", "collide", "granulation", "--json"],
}


def cold_start(repeats: int = 5) -> dict[str, list[float]]:
    """Wall times (s) of each command, in turns."""
    taken: dict[str, list[float]] = {name: [] for name in COMMANDS}
    for _ in range(repeats):
        for name, arguments in COMMANDS.items():
            start = time.perf_counter()
            subprocess.run([sys.executable, *arguments], check=True, capture_output=True)
            taken[name].append(time.perf_counter() - start)
    return taken
