"""Interrupts, threads, failures: what a run does when something goes wrong."""

import math
import pickle
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any

import pytest
from wetdoublet.solvers import CheckFailed, ComputationError, InputError, Scene, collide
from wetdoublet.solvers.collision import by_casadi
from wetdoublet.solvers.engines.casadi.integrators import Tolerance, tolerance_for
from wetdoublet.solvers.engines.casadi.locate import EventLocator, EventSequence, locate
from wetdoublet.solvers.engines.casadi.replay import Replay, replay
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import Model

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
@pytest.mark.parametrize("delay", [0.05])
def test_interrupt(delay: float) -> None:
    """Ctrl-C during a collision, wherever it is: exit status 130, one line, no traceback."""
    with subprocess.Popen(
        [sys.executable, "-c", LONG], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as running:
        assert running.stdout is not None
        assert running.stdout.readline() == "begun\n"
        time.sleep(delay)
        running.send_signal(signal.SIGINT)
        _, said = running.communicate(timeout=900)
    assert (said.strip(), running.returncode) == ("interrupted", 130)


def soon(rtol: float, engine: str, groups: Mapping[str, float]) -> Tolerance:
    """What an integrator is told that gives up after three steps."""
    return replace(tolerance_for(rtol, engine, groups), steps=3)


def lost(model: Model, groups: dict[str, float], rtol: float, extras: tuple[str, ...], **_: Any) -> EventSequence:
    """A trajectory whose locators give up so soon."""
    trajectory = EventLocator(model, groups, rtol, extras)
    trajectory.tolerance = replace(trajectory.tolerance, steps=3)
    return trajectory.run()


def found_alone(
    model: Model, groups: dict[str, float], rtol: float, extras: tuple[str, ...], **_: Any
) -> EventSequence:
    """One whose locators do so where they carry something along, as where they are the last resort."""
    return (lost if extras else locate)(model, groups, rtol, extras)


@pytest.mark.parametrize("failing", ["locator", "cvodes", "rosenbrock"])
def test_an_engine_that_gives_up(failing: str) -> None:
    """Too few steps: ComputationError with phase, time in s, state in SI, and advice, all in its one line."""
    engine = "rosenbrock" if failing == "rosenbrock" else "cvodes"
    scene = Scene.load("granulation").with_impact(stokes=0.03, angle="60 deg")
    n, find = nondimensionalise(scene, *scene.need_impact()), lost if failing == "locator" else found_alone
    with pytest.raises(ComputationError) as caught:
        by_casadi.by_casadi(scene, n, 1e-9, engine, True, False, find, soon)
    error = caught.value
    assert failing == "locator" or error.message.startswith(f"{engine} gave up")
    assert error.phase == "closing inside the film"
    assert error.time == 0.0
    assert error.state["gap"] == pytest.approx(8e-6)  # m
    assert error.state["normal velocity"] == pytest.approx(-Scene.load("granulation").speed_of(0.03))  # m/s
    # v0 tan(theta0)/(4a), rad/s
    assert error.state["rotation rate"] == pytest.approx(-error.state["normal velocity"] * math.sqrt(3) / 200e-6)
    assert error.advice.startswith("try --engine rosenbrock" if failing == "cvodes" else "try --rtol")
    line = str(error)
    assert "\n" not in line
    assert all(part in line for part in (error.phase, "gap = 8e-06", error.advice))


def test_an_open_ledger_is_an_error() -> None:
    """A ledger's term off by a hundredth of the energy: the trajectory is refused, the residual is in the message."""

    class Falsified(Replay):
        """A trajectory whose film has taken more than it did."""

        def extra(self, name: str) -> float:
            return super().extra(name) + (0.01 if name == "normal_lubrication" else 0.0)

    def falsified(*given: Any) -> Replay:
        collided = replay(*given)
        return Falsified(**{each.name: getattr(collided, each.name) for each in fields(collided)})

    scene = Scene.load("granulation").with_impact(stokes=0.03, angle="65 deg")
    n = nondimensionalise(scene, *scene.need_impact())
    with pytest.raises(ComputationError, match="energy ledger is open by"):
        by_casadi.by_casadi(scene, n, 1e-9, "cvodes", True, False, replay=falsified)
    lean = by_casadi.by_casadi(scene, n, 1e-9, "cvodes", False, False, replay=falsified)
    assert lean.restitution == pytest.approx(collide(scene).restitution, rel=1e-7)


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
