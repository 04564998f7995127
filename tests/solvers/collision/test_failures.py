"""Interrupts, threads, failures: what a run does when something goes wrong."""

import math
import pickle
import signal
import subprocess
import sys
import time
from dataclasses import replace

import pytest
from wetdoublet.solvers import CheckFailed, ComputationError, InputError, collide

from ...helpers.command import quiet

# the command, made to collide the same spheres for ever, and to say when it has begun
LONG = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # a job in the background may have been begun without it
from wetdoublet.solvers.collision import collide as simulate
from wetdoublet.solvers.commands.cli import main
once = simulate.collide
def collide(*args, **options):
    once(*args, **options)
    print("begun", flush=True)
    while True:
        once(*args, **options)
simulate.collide = collide
main(["collide", "granulation", "--stokes", "0.0342316", "--angle", "55 deg", "--rtol", "1e-13", "--engine", "cvodes"])
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent as on POSIX")
def test_interrupt() -> None:
    """Ctrl-C during a collision, wherever it is: exit status 130, one line, no traceback."""
    with subprocess.Popen(
        [sys.executable, "-c", LONG], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as running:
        assert running.stdout is not None
        assert running.stdout.readline() == "begun\n"
        time.sleep(0.05)
        running.send_signal(signal.SIGINT)
        _, said = running.communicate(timeout=900)
    assert (quiet(said).strip(), running.returncode) == ("interrupted", 130)


def test_an_open_ledger_is_an_error() -> None:
    """A term off by a hundredth of the energy: the trajectory is refused, the residual is in the message."""
    found = collide("granulation", stokes=0.03, angle="65 deg", engine="cvodes")
    assert found.energy is not None
    found.energy.check(1e-9)
    wrong = replace(found.energy, normal_lubrication=found.energy.normal_lubrication + 0.01 * found.energy.largest)
    for energy in (wrong, replace(found.energy, capillary=math.nan)):
        with pytest.raises(ComputationError, match="energy ledger is open by"):
            energy.check(1e-9)


@pytest.mark.parametrize(
    "error",
    [
        InputError("impact.angle", "91 deg", "0 <= angle < 90 deg", "is too large"),
        ComputationError("gave up", "closing", 1e-3, {"gap": 1e-6}, "try --rtol 1e-8"),
        CheckFailed("one of two"),
    ],
)
def test_errors_pickle(error: Exception) -> None:
    """Errors cross between processes: type, text and parts survive."""
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error)
    assert str(again) == str(error)
    assert vars(again) == vars(error)
