"""Tests named on standard input, each run in a fork of this process, which has loaded libraries but not the package."""

import json
import os
import signal
import sys
import tempfile

import casadi  # noqa: F401 -- for the forks, as the next ones
import hypothesis  # noqa: F401
import pint  # noqa: F401
import pytest
import scipy.integrate
import scipy.optimize
import scipy.stats  # noqa: F401
import sympy  # noqa: F401
import xarray  # noqa: F401

PATIENCE = 600  # s
OPTIONS = ("-x", "-o", "addopts=--import-mode=importlib -q", "-p", "no:cacheprovider")


def answer(test: str) -> tuple[int, str]:
    """Exit status and output of pytest on one test."""
    with tempfile.TemporaryFile("w+") as file:
        child = os.fork()
        if not child:
            signal.alarm(PATIENCE)
            os.dup2(file.fileno(), 1)
            os.dup2(file.fileno(), 2)
            status = pytest.main([*OPTIONS, test])
            sys.stdout.flush()
            os._exit(status)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        file.seek(0)
        return status, file.read()


if __name__ == "__main__":
    sys.path.insert(0, sys.argv[1])  # the folder of the package
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"  # hypothesis' would have all of its modules rewritten
    for line in sys.stdin:
        sys.stdout.write(json.dumps(answer(line.strip())) + "\n")
        sys.stdout.flush()
