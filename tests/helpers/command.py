"""The command line, run in this process."""

from click.testing import CliRunner, Result
from wetdoublet.solvers.commands.cli import cli


def run(*arguments: object) -> Result:
    """`wetdoublet` with these arguments, each as its text."""
    return CliRunner().invoke(cli, [str(argument) for argument in arguments])


PATIENCE = 900  # s: of a test that waits for a process; none shall fail because the machine is slow
