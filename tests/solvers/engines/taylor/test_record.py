"""What the kernel's variants write beside answers: the energy ledger, and the steps' own series as a trajectory."""

from typing import Any

import numpy as np
import pytest
from wetdoublet.generated.automaton import LAST_ANSWER
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.engines.taylor import build as library
from wetdoublet.solvers.engines.taylor import call as engine
from wetdoublet.solvers.engines.taylor import layout, record
from wetdoublet.solvers.engines.taylor.undecided import undecided
from wetdoublet.solvers.host.compiler import compiler

pytestmark = [pytest.mark.skipif(compiler() is None, reason="no C compiler"), pytest.mark.slow]
RTOL = 1e-9
# Every variant is compiled once for all tests here.
IMPACTS: dict[str, tuple[str, dict[str, Any]]] = {
    "separates": ("granulation", {"stokes": 0.02, "angle": "75 deg"}),
    "bounces": ("granulation", {"stokes": 0.14, "angle": "40 deg"}),
    "on strings": ("pendulum", {"stokes": 1.3, "angle": "45 deg"}),
    "film alone": ("granulation-dry-bridge", {"stokes": 0.2, "angle": 0.0}),
    "ends at contact": ("granulation-dry-bridge", {"stokes": 0.3, "angle": "70 deg"}),
    "proved at contact": ("granulation", {"stokes": 0.01, "angle": "50 deg"}),
}


@pytest.mark.parametrize("name", IMPACTS)
def test_the_trajectory_is_that_of_rosenbrock(name: str):
    """At 65 times in each phase, which no step of the kernel ends at, all is as by an independent integration.

    What initial contact decides is one state, after the rebound if there is one.
    """
    scene, impact = IMPACTS[name]
    found = collide(scene, engine="taylor", trajectory=True, rtol=RTOL, **impact)
    mine, other = (
        found.trajectory,
        collide(scene, engine="rosenbrock", trajectory=True, rtol=1e-11, **impact).trajectory,
    )
    assert (mine.sizes == {"time": 1}) == (other.sizes == {"time": 1}) == ("contact" in name)
    assert list(mine.data_vars) == list(other.data_vars)
    assert mine.phase.values.tolist() == other.phase.values.tolist()
    for variable in (*other.data_vars, "time"):
        expected = other[variable].values
        bound = max(found.steps, 1) * RTOL * np.max(np.abs(expected))
        np.testing.assert_allclose(mine[variable], expected, rtol=0, atol=bound, err_msg=variable)
        assert mine[variable].attrs == other[variable].attrs


def collided(room: tuple[int, int], keep: bool = True, **options: int) -> record.Recorded:
    """Chatter on a rough pendulum, and a short trajectory beside it, with this room for events and steps at first."""
    scene = Scene.load("pendulum").with_entries({"particles.roughness": "208.57911437038672 um"})
    speeds = np.array([scene.speed_of(0.06760659), scene.speed_of(3.0)])
    impacts = record.KernelImpacts(scene, speeds, np.full(2, 0.7759), {})
    found = record.run_recorded(impacts, True, RTOL, trajectory=True, keep=keep, room=room, **options)
    assert found is not None
    return found


@pytest.mark.parametrize("room", [(1, 256), (64, 3), (1, 3), (0, 0)])
def test_too_little_room_is_asked_for_again(room: tuple[int, int]):
    """A log of one event, rows for three steps, or no room at all give what ample room gives."""
    found, ample = collided(room), collided((1000, 5000))
    np.testing.assert_array_equal(found.answers, ample.answers)
    for mine, whole, count in zip(found.events, ample.events, found.answers["events"], strict=True):
        np.testing.assert_array_equal(mine[:count], whole[:count])
    assert found.steps is not None
    assert ample.steps is not None
    np.testing.assert_array_equal(found.steps.rows, ample.steps.rows)


@pytest.mark.parametrize("budget", [50, 51, 58])
def test_an_undecided_collision_is_in_the_phase_after_its_last_event(budget: int):
    """Where the log has no room for all events, its last row has the last, and the message the phase that followed."""
    found, ample = collided((5, 256), budget=budget), collided((1000, 5000), budget=budget)
    answer, count = found.answers[0], int(found.answers["events"][0])
    assert answer["status"] > LAST_ANSWER
    assert count > 5
    last, words = ample.events[0, count - 1], {1: "closing", 0: "opening"}
    assert found.events[0, -1] == last
    phase = f"{words[int(last['closing'])]} {'inside' if last['film'] else 'beyond'} the film"
    assert f"in phase {phase} at" in str(undecided(answer, ("gap", "normal_velocity"), found.events[0, -1]))


def test_steps_that_are_not_kept_are_not_written():
    """A kernel that could write its steps runs without a place for them, also where the log was too small at first."""
    found = collided((1, 256), keep=False)
    assert found.steps is None
    assert found.answers["events"].max() > 64
    np.testing.assert_array_equal(found.answers["outcome"], collided((1000, 5000)).answers["outcome"])


@pytest.mark.parametrize("short", ["answers", "books", "quantities", "peaks"])
def test_a_buffer_that_is_too_small_is_refused(short: str):
    """The kernel is given the size of every buffer, and writes nothing where one does not hold what it would write."""
    scene = Scene.load("granulation")
    kernel = library.kernel(engine.variant(scene, True, RTOL, ledger=True, trajectory=True, fold=False))
    assert kernel is not None
    impacts = record.KernelImpacts(scene, np.full(9, scene.speed_of(0.02)), np.full(9, 1.3), {})
    answers = np.zeros(9, layout.ANSWER)
    task = engine.task(kernel, impacts, RTOL, 1000, answers)
    task.buffer("books", np.zeros(9, layout.LEDGER))
    small = {
        "answers": answers[:8],
        "books": np.zeros(8, layout.LEDGER),
        "quantities": np.zeros(3, layout.BUFFER),
        "peaks": np.zeros(8),
    }
    task.buffer(short, small[short])
    with pytest.raises(MemoryError, match=f"{short}: too small"):
        task.run()
    assert (answers == np.zeros(9, layout.ANSWER)).all()
