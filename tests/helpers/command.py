"""The command line, run in this process, and what its processes leave behind."""

import json
from pathlib import Path

import numpy as np
from click.testing import CliRunner, Result
from wetdoublet.solvers.commands.cli import cli


def run(*arguments: object) -> Result:
    """`wetdoublet` with these arguments, each as its text."""
    return CliRunner().invoke(cli, [str(argument) for argument in arguments])


PATIENCE = 900  # s: of a test that waits for a process; none shall fail because the machine is slow


def finished(journal: Path) -> list[np.ndarray]:
    """Which collisions each whole line of a journal holds."""
    lines = [line for line in journal.read_bytes().split(b"\n")[:-1] if line] if journal.exists() else []
    return [np.array(json.loads(line.split(b" ", 2)[2])["where"]) for line in lines]
