"""The command line, run in this process."""

from __future__ import annotations

from click.testing import CliRunner, Result
from wetdoublet.solvers.cli import cli


def run(*arguments: object) -> Result:
    """`wetdoublet` with these arguments, each as its text."""
    return CliRunner().invoke(cli, [str(argument) for argument in arguments])
