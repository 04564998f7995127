"""The command line, run in this process."""

import re

from click.testing import CliRunner, Result
from wetdoublet.solvers.commands.cli import cli

AT_WORK = re.compile(rb"^at work for .*\n", re.MULTILINE)


def run(*arguments: object) -> Result:
    """`wetdoublet` with these arguments, each as its text; without what it says where the machine is slow."""
    result = CliRunner().invoke(cli, [str(argument) for argument in arguments])
    result.stderr_bytes = AT_WORK.sub(b"", result.stderr_bytes or b"")
    result.output_bytes = AT_WORK.sub(b"", result.output_bytes)
    return result


def quiet(stderr: str) -> str:
    """What a process said on standard error, without what it says where the machine is slow."""
    return AT_WORK.sub(b"", stderr.encode()).decode()


PATIENCE = 900  # s: of a test that waits for a process; none shall fail because the machine is slow
