"""A replay notices a record of the kernel that is wrong, for each kind of event; the Dataset of a trajectory."""

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from importlib.metadata import version
from typing import Any

import numpy as np
import pytest
import xarray
from wetdoublet.generated.automaton import KINDS
from wetdoublet.solvers import ComputationError, Scene, collide
from wetdoublet.solvers.collision.by_kernel import followed, sequence_in, sequence_of
from wetdoublet.solvers.engines.casadi import trajectory
from wetdoublet.solvers.engines.casadi.confirm import Confirmation
from wetdoublet.solvers.engines.casadi.integrators import IntegrationFailed, tolerance_for
from wetdoublet.solvers.engines.casadi.replay import PHASES, Run, Stopped
from wetdoublet.solvers.engines.casadi.sequence import EventSequence
from wetdoublet.solvers.engines.steps import Steps
from wetdoublet.solvers.model.dimensionless import Problem, nondimensionalise

from ....helpers.data import DATA

RTOL = 1e-9
HARD = json.loads((DATA / "hard_scenes.json").read_text())
PARTS = ("granulation", 0.02, "75 deg")  # turned, film edge, rupture
SCENES: dict[str, Callable[[], Scene]] = {
    "parts": lambda: impact(*PARTS),
    "glass": lambda: impact("granulation", 0.3, "10 deg"),
    "elastic": lambda: impact("granulation", 2.0, "10 deg", {"liquid.glass_transition_pressure": "1e9 GPa"}),
    "rough": lambda: impact("granulation", 0.6, "50 deg", {"particles.roughness": "4 um"}),
    "half turn": lambda: impact("pendulum", 0.8, "30 deg", {"pendulum.length": "5 m"}),
    "rotation reverses": lambda: hard("grazing incidence pulled in by strings"),
    "tangential edge": lambda: hard("tangential force ends at two reduced radii"),
    "rolls": lambda: hard("rolls and slides at rest on strings"),
    "slides": lambda: hard("slides at rest and is released"),
    "fell back": lambda: hard("slide that begins with no slip"),
}


def impact(preset: str, stokes: float, angle: str, entries: dict[str, Any] | None = None) -> Scene:
    """A preset with other entries, and its impact."""
    return Scene.load(preset).with_entries(entries or {}).with_impact(stokes=stokes, angle=angle)


def hard(name: str) -> Scene:
    """A scene of the data file."""
    row = HARD[name]
    return Scene.load(row["preset"]).with_entries(row["scene"]) if "preset" in row else Scene.from_dict(row["scene"])


def recorded(scene: Scene) -> tuple[Problem, EventSequence]:
    """The groups of a scene's collision, and its phases as the kernel finds them."""
    n = nondimensionalise(scene, *scene.need_impact())
    return n, sequence_of(n, RTOL)


def without(path: EventSequence, k: int) -> EventSequence:
    """The record without the event that ends phase k, whose mode goes on up to the next."""
    steps = list(path.steps)
    if k + 1 == len(steps):
        steps[k] = replace(steps[k], event=None, kinds=(), rebounds=False, holds=False, own="")
    else:
        both = steps[k].duration + steps[k + 1].duration
        steps[k : k + 2] = [replace(steps[k + 1], phase=steps[k].phase, duration=both)]
    return replace(path, steps=tuple(steps))


def moved(path: EventSequence, k: int) -> EventSequence:
    """The record with the event that ends phase k a thousandth of the phase later."""
    steps = list(path.steps)
    steps[k] = replace(steps[k], duration=steps[k].duration * 1.001)
    return replace(path, steps=tuple(steps))


def exchanged(path: EventSequence, k: int) -> EventSequence:
    """The record with the events that end phases k and k + 1 in each other's place."""
    steps = list(path.steps)
    first, second = steps[k : k + 2]
    steps[k] = replace(second, phase=first.phase, duration=first.duration)
    steps[k + 1] = replace(first, phase=second.phase, duration=second.duration)
    return replace(path, steps=tuple(steps))


def mutants(path: EventSequence) -> Iterator[tuple[str, EventSequence]]:
    """Wrong records, but for events that are too near to the one before to be told apart."""
    lasting = [k for k, step in enumerate(path.steps) if step.kinds and step.duration > 1e-6]
    for k in lasting:
        yield f"without {path.steps[k].kinds}", without(path, k)
        yield f"{path.steps[k].kinds} moved", moved(path, k)
        if k + 1 in lasting and path.steps[k].kinds != path.steps[k + 1].kinds:
            yield f"{path.steps[k].kinds} exchanged", exchanged(path, k)


@pytest.mark.parametrize(
    ("plugin", "name"),
    [
        *(("rosenbrock", name) for name in SCENES if name != "fell back"),
        *(("cvodes", name) for name in ("parts", "rough", "rolls")),
        pytest.param("rosenbrock", "fell back", marks=pytest.mark.slow),
    ],
)
def test_a_wrong_record_is_noticed(name: str, plugin: str) -> None:
    """The record is followed as it is; with an event taken out, moved or exchanged the replay stops there."""
    scene = SCENES[name]()
    n, path = recorded(scene)
    choice, tolerance = n.key(full=True), tolerance_for(RTOL, plugin, n.groups)
    assert Run(path, choice, (), plugin, tolerance, RTOL).run().events
    followed_all_the_same = []
    for what, wrong in mutants(path):
        try:
            Run(wrong, choice, (), plugin, tolerance, RTOL).run()
            followed_all_the_same.append(what)
        except Stopped:
            pass
    assert not followed_all_the_same


@pytest.mark.parametrize("plugin", ["cvodes", "rosenbrock"])
def test_a_barrier_that_does_not_hold_is_noticed(plugin: str) -> None:
    """A stick is replayed to its proof; a pair that escapes is no stick, wherever the record says that it is proved."""
    n, path = recorded(impact("granulation", 0.05, "30 deg"))
    assert path.certified
    Run(path, n.key(full=True), (), plugin, tolerance_for(RTOL, plugin, n.groups), RTOL).run()
    n, path = recorded(impact(*PARTS))
    tolerance, done = tolerance_for(RTOL, plugin, n.groups), 0.0
    for k, step in enumerate(path.steps):
        last = replace(step, duration=step.duration * 0.9, event=None, kinds=())
        proved = replace(
            path, steps=(*path.steps[:k], last), separated=False, certified=True, time=done + last.duration
        )
        with pytest.raises(Stopped, match="above the barrier"):
            Run(proved, n.key(full=True), (), plugin, tolerance, RTOL).run()
        done += step.duration


def test_a_replay_ends_when_its_steps_are_spent() -> None:
    """The error has phase, time and state, and what to try, however often the engine begins again."""
    n, path = recorded(impact(*PARTS))
    tolerance = tolerance_for(RTOL, "rosenbrock", n.groups)
    whole = Run(path, n.key(full=True), (), "rosenbrock", tolerance, RTOL).run()
    spent = Run(path, n.key(full=True), (), "rosenbrock", tolerance, RTOL, most=whole.steps // 2)
    with pytest.raises(Stopped, match=r"has not replayed the record in \d+ steps") as raised:
        spent.run()
    error = raised.value.error("rosenbrock", n.model(full=True))
    assert 0 < error.time < whole.time
    assert error.state["gap"] > 0
    assert error.advice == "try the default engine, or another impact"
    assert spent.at.steps < whole.steps


def test_more_phases_than_it_takes_are_refused_at_once() -> None:
    """The error has the phase and time at which the budget ends, and what to try."""
    scene = impact(*PARTS)
    n, path = recorded(scene)
    many = replace(path, steps=path.steps[:1] * (PHASES + 1), separated=False)
    with pytest.raises(Stopped, match=f"at most {PHASES} phases, and the record has {PHASES + 1}") as raised:
        Run(many, n.key(full=True), (), "cvodes", tolerance_for(RTOL, "cvodes", n.groups), RTOL).run()
    error = raised.value.error("cvodes", n.model(full=True))
    assert (error.phase, error.advice) == (str(path.steps[0].phase), "try --engine rosenbrock")
    assert error.time == pytest.approx(PHASES * path.steps[0].duration, rel=1e-9)


def test_every_kind_of_event_is_among_them() -> None:
    """The scenes of the test above have all events of the automaton that end a phase."""
    met = {kind for make in SCENES.values() for kind in recorded(make())[1].kinds}
    assert met == set(KINDS)


def misled(path: EventSequence, steps: Steps) -> Iterator[tuple[str, EventSequence, Steps]]:
    """Wrong records with the kernel's steps: without an event, with one a step early, without a rebound."""
    for k, phase_run in enumerate(path.steps):
        mode, rows = phase_run.kinds, steps.rows.copy()
        if k + 1 < len(path.steps):
            rows["phase"] -= rows["phase"] > k
            yield f"without {mode}", without(path, k), replace(steps, rows=rows)
        if phase_run.rebounds:
            smooth = (*path.steps[:k], replace(phase_run, rebounds=False, holds=False), *path.steps[k + 1 :])
            yield f"{mode} without its rebound", replace(path, steps=smooth), steps
        inside = np.flatnonzero(steps.rows["phase"] == k)
        if inside.size > 1:
            shorter = replace(phase_run, duration=phase_run.duration - float(steps.rows["length"][inside[-1]]))
            early = replace(path, steps=(*path.steps[:k], shorter, *path.steps[k + 1 :]))
            yield f"{mode} a step early", early, replace(steps, rows=np.delete(steps.rows, inside[-1]))


@pytest.mark.parametrize("name", ["parts", "glass", "rolls"])
def test_the_kernels_steps_are_confirmed_and_wrong_ones_are_not(name: str) -> None:
    """The kernel's own trajectory agrees with CVODES step by step; a wrong one does not."""
    scene = SCENES[name]()
    n = nondimensionalise(scene, *scene.need_impact())
    ran = followed(n, RTOL, None, ledger=True, trajectory=True)
    path, steps = sequence_in(n, ran), ran.steps
    assert steps is not None
    choice = n.key(full=True)
    Confirmation(path, steps, choice, "cvodes", RTOL).run()
    confirmed = []
    for what, wrong, its_steps in misled(path, steps):
        try:
            Confirmation(wrong, its_steps, choice, "cvodes", RTOL).run()
            confirmed.append(what)
        except Stopped:
            pass
    assert not confirmed


def test_where_an_engine_cannot_follow_the_kernel_answers() -> None:
    """Chatter amplifies CVODES' errors until it misses an event: the result is the kernel's, confirmed, and says so."""
    scene = hard("chatters and slides at rest")
    found = collide(scene, engine="cvodes")
    assert found.engine == "taylor"
    assert found == collide(scene)


def test_attributes_of_a_file_suffice_to_repeat_the_collision(tmp_path):
    """A NetCDF file carries scene, outcome, engine, tolerance and version: enough to compute it again."""
    first = collide("granulation", stokes=0.14, angle="40 deg", rtol=1e-8, engine="rosenbrock", trajectory=True)
    first.trajectory.to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as read:
        attrs = read.attrs
    assert attrs["outcome"] == "bounce" and attrs["version"] == version("wetdoublet")
    again = collide(Scene.from_toml(attrs["scene"]), rtol=attrs["rtol"], engine=attrs["engine"])
    assert again.to_dict() == first.to_dict()


def test_a_trajectory_that_fails_is_an_answer(monkeypatch):
    """An integrator that gives up on the way is an error that names phase, time, state and what to try, in SI."""

    def fails(*_):
        raise IntegrationFailed("Evaluation failed")

    monkeypatch.setattr(trajectory, "plain", lambda *_: fails)
    with pytest.raises(
        ComputationError, match=r"rosenbrock gave up .* in phase closing .*gap = 8e-06.*--engine"
    ) as found:
        collide("granulation", engine="rosenbrock", trajectory=True)
    assert found.value.time == 0.0
