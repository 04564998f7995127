"""The benchmark measures what it says: peers solve the same problem, the record is complete. No time is asserted."""

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide

from .measured.page import document
from .measured.peers.engines import engines
from .measured.run import MORE, bench
from .measured.tasks import TASKS, Impact, Task
from .measured.timing import Engine
from .measured.work import reference

OURS = ("cvodes", "rosenbrock", "taylor", "taylor, kernel alone")
TINY = Task("granulation", 3, (0.02, 0.5), 85.0)


@pytest.fixture(scope="module")
def record() -> dict[str, Any]:
    """A benchmark of three collisions at two tolerances."""
    pytest.importorskip("scipy")
    which = [replace(each, tolerances=(1e-7, 1e-9) if each.many else (1e-5, 1e-7)) for each in engines()
             if each.name in (*OURS, "scipy LSODA")]  # fmt: skip
    which.append(Engine("gone", lambda *_: None, missing="gone is not installed"))  # type: ignore[arg-type, return-value]
    return bench([TINY], repeats=1, cold=dict, which=which, more=(), call=6)  # nothing is timed


def test_impacts_are_the_same_in_every_run() -> None:
    """The draw is fixed by its seed, and within its ranges."""
    for task in TASKS:
        impacts = task.impacts()
        assert impacts == task.impacts()
        assert len(impacts) == task.count
        assert all(task.stokes[0] <= each.stokes <= task.stokes[1] for each in impacts)
        assert all(0 <= each.angle <= np.radians(task.degrees) for each in impacts)


@pytest.mark.slow
def test_record_is_complete(record: dict[str, Any]) -> None:
    """Every engine that is there, at every tolerance, on the collisions that count, without a wrong outcome."""
    assert {"environment", "settings", "engines", "tasks", "cold_start", "wall", *MORE} == set(record)
    assert {"date", "cpu", "cores", "system", "python", "casadi", "numpy", "scipy"} <= set(record["environment"])
    there = [each["name"] for each in record["engines"] if not each["missing"]]
    assert {"cvodes", "rosenbrock", "scipy LSODA"} <= set(there)
    (task,) = record["tasks"]
    assert task["collisions"]["counted"] >= task["collisions"]["separate"] > 0
    fast = ("taylor", "taylor, kernel alone")
    asked = [(name, rtol) for name in there for rtol in ((1e-7, 1e-9) if name in fast else (1e-5, 1e-7))]
    assert [(p["engine"], p["rtol"]) for p in task["points"]] == asked
    for point in task["points"]:
        summary = point["summary"]
        assert summary["wrong"] == summary["failed"] == 0
        assert not point["said"]
        assert summary["cpu_mean"] > 0
        assert point["rtol"] > 1e-7 or summary["error_largest"] < 1e-5


def test_the_page_is_that_of_its_records() -> None:
    """docs/engineering/performance.md, and the figures of README.md, are what the committed records give."""
    folder = document.README.parent / "docs" / "engineering" / "performance"
    bench = json.loads((folder / "bench.json").read_text())
    stress = json.loads((folder / "stress.json").read_text())
    law = json.loads((folder / "law_in_c.json").read_text())
    assert document.page(bench, stress, folder.name, law) == folder.with_suffix(".md").read_text()
    front = document.README.read_text()
    assert document.fronted(front, bench) == front


@pytest.mark.parametrize("name", ["heyoka, batch of 8", "heyoka, without callbacks"])
def test_compiled_peers_solve_the_same_problem(name: str) -> None:
    """Where they are installed, their outcomes are Rosenbrock's and e_n agrees to what their tolerance allows."""
    engine = next(each for each in engines() if each.name == name)
    if engine.missing:
        pytest.skip(engine.missing)
    scene = Scene.load("granulation")
    drawn = ((0.6, 50.0), (0.05, 70.0), (2.0, 60.0), (0.02, 80.0), (1.369, 53.81))
    impacts = [Impact(st, np.radians(angle)) for st, angle in drawn]
    ours = [collide(scene, stokes=i.stokes, angle=i.angle, rtol=1e-11, engine="rosenbrock") for i in impacts]
    found = engine.prepare((scene, impacts), 1, 1e-9)()
    assert [each.outcome for each in found] == [each.outcome for each in ours]
    assert [each.restitution for each in found] == pytest.approx([each.restitution for each in ours], abs=1e-6)


def test_where_peers_have_no_proof_the_reference_is_our_own() -> None:
    """On strings, by Rosenbrock."""
    found = reference(Scene.load("pendulum"), Impact(2.5, 0.4))
    assert [*found.computed] == ["rosenbrock", "cvodes"]
    assert found.counts
