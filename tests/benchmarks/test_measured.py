"""The benchmark measures what it says: peers solve the same problem, the record is complete. No time is asserted."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import ComputationError, Scene, collide
from wetdoublet.solvers.formatting.markdown import table

from .measured import lines, needs
from .measured import reference as references
from .measured.answers import Answer, Impact
from .measured.cold import COMMANDS
from .measured.page import document
from .measured.page.record import write
from .measured.page.tables import equal_error, failures, surroundings
from .measured.peers.engines import Engine, engines
from .measured.reference import Reference, reference
from .measured.run import MORE, bench, task_record
from .measured.tasks import TASKS, Task
from .measured.work import work

OURS = ("cvodes", "rosenbrock", "rosenbrock, compiled", "taylor", "taylor, kernel alone")
TINY = Task("granulation", 3, (0.02, 0.5), 85.0)


@pytest.fixture(scope="module")
def record() -> dict[str, Any]:
    """A benchmark of three collisions at two tolerances."""
    pytest.importorskip("scipy")
    which = [each for each in engines() if each.name in (*OURS, "scipy LSODA")]
    which.append(Engine("gone", missing="gone is not installed"))
    cold = {name: [0.2, 0.1] for name in COMMANDS}
    few: dict[str, Any] = {"repeats": 1, "sets": 2, "featured": ("rosenbrock",)}  # nothing is timed, nothing compiled
    return bench([TINY], (1e-5, 1e-7), cold=lambda: cold, which=which, more=(), fine=(1e-7, 1e-9), **few)


def test_reference_values_equal_the_independent_ones(reference: dict[str, Any]) -> None:
    """What errors are measured against agrees with the 80-bit Taylor series to 1e-11, and knows its own error."""
    pytest.importorskip("scipy")
    impact = reference["impact"]
    scene = Scene.from_dict(reference["scene"])
    asked = scene.with_impact(stokes=impact["stokes"], angle=impact["angle"])
    found = references.reference(scene, Impact(float(impact["stokes"]), asked.need_impact()[1]))
    expected = reference["results"]
    assert not found.problem
    assert found.outcome == expected["outcome"]
    assert found.restitution == pytest.approx(expected["restitution"], abs=1e-11 * max(1.0, reference["kappa"] or 1.0))
    assert found.difference < 1e-8


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
    assert {tuple(cost["on"]) for cost in task["costs"]} == {(), ("ledger",), ("trajectory",), ("ledger", "trajectory")}


@pytest.mark.slow
def test_files_are_written(record: dict[str, Any], tmp_path: Path) -> None:
    """JSON that reads back as the record, a row a line, and two pictures."""
    data, *pictures = write(record, tmp_path / "new" / "folder")
    assert json.loads(data.read_text()) == json.loads(json.dumps(record))
    assert len(data.read_text().splitlines()) < 80
    assert [file.name for file in pictures] == ["work.png", "cost.png"]
    assert all(file.read_bytes()[:4] == b"\x89PNG" for file in pictures)


def test_the_page_is_that_of_its_records() -> None:
    """docs/engineering/performance.md, and the figures of README.md, are what the committed records give."""
    folder = document.README.parent / "docs" / "engineering" / "performance"
    records = [json.loads((folder / f"{name}.json").read_text()) for name in document.RECORDS]
    stress = json.loads((folder / "stress.json").read_text())
    law = json.loads((folder / "law_in_c.json").read_text())
    assert document.page(*records, stress, folder.name, law) == folder.with_suffix(".md").read_text()
    front = document.README.read_text()
    assert document.fronted(front, records[0]) == front


@pytest.mark.slow
def test_what_is_missing_is_named_on_the_page(record: dict[str, Any]) -> None:
    """A peer that is not installed is in the list of what the benchmark was run with."""
    assert "gone is not installed" in surroundings(record)


def test_failures_and_wrong_outcomes_are_counted_and_told() -> None:
    """An engine that fails on one collision and errs on another is measured, counted and named with both."""
    task = Task("pendulum", 2, (1.0, 3.0), 80.0)
    truth = [Reference(impact, "bounce", 0.5, False, 1e-13, {"DOP853": 0.5}) for impact in task.impacts()]

    def prepare(*_: Any) -> Callable[[int], Answer]:
        def one(k: int) -> Answer:
            if k == 0:
                raise ComputationError("gave up")
            return Answer("stick", 0.0)

        return one

    (point,) = work(
        task, truth, [Engine("odd", one=prepare), Engine("gone", one=prepare, missing="not here")], [1e-6], 2
    )
    assert point.summary()["failed"] == point.summary()["wrong"] == 1
    assert point.errors() == [None, None]
    entry = task_record(task, truth, [point])
    assert "gave up" in failures(entry)
    assert "stick instead of bounce" in failures(entry)
    assert "odd" in equal_error(entry)


def test_peers_that_are_absent_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing of the extra installed: every peer says so, and the reference is Rosenbrock's beside CVODES'."""
    from .measured.peers import engines as listing

    monkeypatch.setattr(listing, "find_spec", lambda _: None)
    monkeypatch.setattr(references, "find_spec", lambda _: None)
    missing = [each.name for each in engines() if "not installed" in each.missing]
    assert missing == [
        "heyoka, batch of 8", "heyoka, without callbacks", "sundae CVODE, numba", "diffrax Tsit5", "scipy LSODA",
        "scipy Radau",
    ]  # fmt: skip
    found = reference(Scene.load("granulation"), Impact(0.05, 1.0))
    assert list(found.computed) == ["rosenbrock", "cvodes"]


def test_tables_line_up() -> None:
    """A Markdown table whose columns are as wide as their widest cell."""
    assert table(["a", "long"], [["bcd", "1"]]) == "| a   | long |\n| --- | ---: |\n| bcd |    1 |"


def test_central_differences_agree_with_a_chord() -> None:
    """Head-on, far above St*, e_n is nearly linear in e_dry: its derivative is the slope of a chord of 2 %."""
    scene = Scene.load("granulation")
    slope = needs.differences(["particles.dry_restitution"], stokes=3.0, angle=0.0)["particles.dry_restitution"]
    ends = [
        collide(
            scene.with_entries({"particles.dry_restitution": each}), stokes=3.0, angle=0.0, rtol=1e-12, ledger=False
        ).restitution
        for each in (0.98, 1.0)
    ]
    assert slope == pytest.approx((ends[1] - ends[0]) / 0.02, rel=1e-3)


@pytest.mark.slow
def test_bisection_finds_the_traced_boundaries() -> None:
    """Halving on the outcome, and the roots of smooth functions, agree on every change at an angle."""
    from wetdoublet.solvers import boundary

    scene, angle = Scene.load("granulation"), float(np.radians(60.0))
    traced = [each.stokes for each in boundary(scene, angle=angle, stokes=lines.STOKES).changes[0]]
    outcomes = lines.in_bulk(scene, 1e-9)
    for parts, least in ((2, 20), (9, 40)):
        (found,), taken = lines.searched(outcomes, np.array([angle]), parts, 1e-8)
        assert found == pytest.approx(traced, rel=1e-7)
        assert taken > least * len(found)
    (again,), _ = lines.searched(outcomes, np.array([angle]), 9, 1e-8, [traced])
    assert again == pytest.approx(traced, rel=1e-7)


@pytest.mark.parametrize("preset", ["granulation", "pendulum"])
@pytest.mark.parametrize("name", ["heyoka, batch of 8", "heyoka, without callbacks", "sundae CVODE, numba"])
def test_compiled_peers_solve_the_same_problem(name: str, preset: str) -> None:
    """Where they are installed, their outcomes are Rosenbrock's and e_n agrees to what their tolerance allows."""
    engine = next(each for each in engines() if each.name == name)
    if engine.missing:
        pytest.skip(engine.missing)
    scene = Scene.load(preset)
    drawn = ((0.6, 50.0), (0.05, 70.0), (2.0, 60.0), (0.02, 80.0), (1.369, 53.81))
    impacts = [Impact(st, np.radians(angle)) for st, angle in drawn]
    ours = [collide(scene, stokes=i.stokes, angle=i.angle, rtol=1e-11, engine="rosenbrock") for i in impacts]
    if engine.many is not None:
        found: list[Any] = engine.many(scene, impacts, 1e-9)()
    else:
        assert engine.one is not None
        one = engine.one(scene, impacts, 1e-9)
        found = [one(k) for k in range(len(impacts))]
    assert [each.outcome for each in found] == [each.outcome for each in ours]
    assert [each.restitution for each in found] == pytest.approx([each.restitution for each in ours], abs=1e-6)


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.preset)
def test_variational_equations_of_heyoka_are_our_derivatives(task: Task) -> None:
    """With a saltation of its own at each event it agrees with forward derivatives at 1e-12, through events."""
    pytest.importorskip("heyoka")
    from .measured.gradient_task import Gradients
    from .measured.peers.heyoka_gradient import prepare

    asked = Gradients.of(task, 7)
    batch = prepare(asked.scene, asked.numbers, asked.slopes, 1e-9)
    batch.run()
    assert len(asked.names) == 12
    assert {met for met in batch.criteria if met} == {"glass"}
    assert None in batch.criteria  # an escape by rotation alone
    assert asked.errors(batch.gradient).max() < 1e-8
