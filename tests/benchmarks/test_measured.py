"""The benchmark measures what it says: peers solve the same problem, the record is complete. No time is asserted."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import ComputationError, Scene, collide, collide_many
from wetdoublet.solvers.engines.casadi import locate as locating
from wetdoublet.solvers.formatting.markdown import table
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.model.dimensionless import numbers
from wetdoublet.solvers.model.model import choose, load
from wetdoublet.solvers.verify.stress.answers import Answer, Impact, answer

from .measured import features, lines, needs
from .measured import growth as growing
from .measured import reference as references
from .measured import run as running
from .measured import work as working
from .measured.cold import COMMANDS
from .measured.features import HORIZON, certificate
from .measured.page.record import write
from .measured.page.tables import equal_error, failures, report
from .measured.peers.engines import Engine, engines
from .measured.reference import Reference, reference
from .measured.tasks import TASKS, Task
from .measured.work import work

OURS = ("cvodes", "rosenbrock", "rosenbrock, compiled", "taylor", "taylor, kernel alone")
TINY = (Task("granulation", 3, (0.02, 0.5), 85.0), Task("pendulum", 2, (1.0, 3.0), 80.0))


@pytest.fixture(scope="module")
def record() -> dict[str, Any]:
    """A benchmark of six collisions at two tolerances."""
    pytest.importorskip("scipy")
    which = [each for each in engines() if each.name in (*OURS, "scipy LSODA")]
    absent = Engine("gone", missing="gone is not installed")
    with pytest.MonkeyPatch.context() as patch:  # fewer copies: nothing is timed, and nothing compiled
        patch.setattr(working, "SETS", 2)
        patch.setattr(features, "IN_BULK", {})
        cold = {name: [0.2, 0.1] for name in COMMANDS}
        return running.bench(TINY, (1e-5, 1e-7), 1, lambda: cold, [*which, absent], (), fine=(1e-7, 1e-9))


def _numbers(case: dict[str, Any]) -> tuple[Any, Any]:
    scene = Scene.from_dict(case["scene"]).with_impact(stokes=case["impact"]["stokes"], angle=case["impact"]["angle"])
    n = numbers(scene, *scene.need_impact())
    return load(choose(scene, n.oblique)), n.groups


@pytest.mark.parametrize(("method", "rtol", "within"), [("LSODA", 1e-10, 1e-7), ("Radau", 1e-7, 1e-5)])
def test_peers_solve_the_same_problem(reference: dict[str, Any], method: str, rtol: float, within: float) -> None:
    """Scipy's methods reach the reference's outcome, restitution and first criterion."""
    pytest.importorskip("scipy")
    from wetdoublet.solvers.verify.stress.scipy_engine import fly

    path = fly(*_numbers(reference), rtol, method)
    expected = reference["results"]
    assert path.outcome == expected["outcome"]
    if expected["outcome"] == "stick":
        return
    assert answer(path).restitution == pytest.approx(expected["restitution"], rel=within)
    assert path.reversal == expected["reversal"]
    assert path.kinds == [event["kind"] for event in expected["events"]]


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


def test_a_hidden_graze_is_found_by_the_peers() -> None:
    """A glass criterion that is met and left within one step is met: its minimum is looked for between the ends."""
    pytest.importorskip("scipy")
    from wetdoublet.solvers.verify.stress.scipy_engine import fly

    scene = Scene.load("granulation")
    angle = np.radians(60.0)
    low, high = 0.03, 0.3  # stick-rotate-separate and bounce: the change between them is a graze
    for _ in range(30):
        middle = (low * high) ** 0.5
        met = collide(scene, stokes=middle, angle=angle, engine="rosenbrock", ledger=False).reversal is not None
        low, high = (low, middle) if met else (middle, high)
    for stokes, kind in ((high * (1 + 1e-5), "glass"), (low * (1 - 1e-5), None)):
        n = numbers(scene, scene.speed_of(stokes), angle)
        assert fly(load(choose(scene, True)), n.groups, 1e-8, "LSODA").reversal == kind


def test_impacts_are_the_same_in_every_run() -> None:
    """The draw is fixed by its seed, and within its ranges."""
    for task in TASKS:
        impacts = task.impacts()
        assert impacts == task.impacts()
        assert len(impacts) == task.count
        assert all(task.stokes[0] <= each.stokes <= task.stokes[1] for each in impacts)
        assert all(0 <= each.angle <= np.radians(task.degrees) for each in impacts)


def test_record_is_complete(record: dict[str, Any]) -> None:
    """Every engine that is there, at every tolerance, on every collision that counts, without a wrong outcome."""
    assert {"environment", "settings", "engines", "tasks", "cold_start", "wall", *running.MORE} == set(record)
    assert {"date", "cpu", "cores", "system", "python", "casadi", "numpy", "scipy"} <= set(record["environment"])
    there = [each["name"] for each in record["engines"] if not each["missing"]]
    assert {"cvodes", "rosenbrock", "scipy LSODA"} <= set(there)
    for task in record["tasks"]:
        counted = [each for each in task["collisions"] if not each["decided_at_first_touch"]]
        assert counted
        fast = ("taylor", "taylor, kernel alone")
        asked = [(name, rtol) for name in there for rtol in ((1e-7, 1e-9) if name in fast else (1e-5, 1e-7))]
        assert [(p["engine"], p["rtol"]) for p in task["points"]] == asked
        for point in task["points"]:
            assert len(point["runs"]) == len(counted)
            assert point["summary"]["wrong"] == point["summary"]["failed"] == 0
            assert all(run["cpu"] > 0 and run["runs"] == 1 for run in point["runs"])
        tight = [p["summary"]["error_largest"] for p in task["points"] if p["rtol"] == 1e-7]
        assert all(error is None or error < 1e-5 for error in tight)
        assert {tuple(cost["on"]) for cost in task["costs"]} >= {(), ("ledger",), ("trajectory",)}
        assert all(cost["changed"] == 0 for cost in task["costs"])
    json.dumps(record, allow_nan=False)


def test_files_are_written(record: dict[str, Any], tmp_path: Path) -> None:
    """JSON that reads back as the record, the tables, and two pictures."""
    text, files = write(record, tmp_path / "new" / "folder")
    assert sorted(file.name for file in files) == ["bench.json", "bench.md", "cost.png", "work.png"]
    assert json.loads(files[0].read_text()) == json.loads(json.dumps(record))
    assert files[1].read_text() == text == report(record)
    assert all(file.read_bytes()[:4] == b"\x89PNG" for file in files[2:])
    for word in ("scipy LSODA", "gone is not installed", "certificate", "import casadi", "No failures"):
        assert word in text


def test_failures_and_wrong_outcomes_are_counted_and_told() -> None:
    """An engine that fails on one collision and errs on another is measured, counted and named with both."""
    task = TINY[1]
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
    entry = {"collisions": [running._truth(each) for each in truth], "points": [running._point(point)]}
    assert "gave up" in failures(entry)
    assert "stick instead of bounce" in failures(entry)
    assert "odd" in equal_error(entry)


def test_peers_that_are_absent_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing of the extra installed: every peer says so, and the reference is Rosenbrock's beside CVODES'."""
    from .measured.peers import engines as listing

    monkeypatch.setattr(listing, "find_spec", lambda _: None)
    monkeypatch.setattr(references, "find_spec", lambda _: None)
    missing = [each.name for each in engines() if "not installed" in each.missing]
    assert missing == ["heyoka, batch of 8", "sundae CVODE, numba", "diffrax Tsit5", "scipy LSODA", "scipy Radau"]
    found = reference(Scene.load("granulation"), Impact(0.05, 1.0))
    assert list(found.computed) == ["rosenbrock", "cvodes"]


def test_certificate_can_be_taken_away() -> None:
    """Without it a stick ends unproved after the stated time; afterwards it is there again."""
    scene, impact = Scene.load("granulation"), {"stokes": 0.012, "angle": "50 deg"}
    usual = locating.proof_for
    with certificate(False):
        bare = collide(scene, **impact, ledger=False)
    assert locating.proof_for is usual
    proved = collide(scene, **impact, ledger=False)
    assert (bare.outcome, bare.certified) == ("stick", False)
    assert (proved.outcome, proved.certified) == ("stick", True)
    with certificate(False):
        by_kernel = collide_many(scene, **impact, rtol=1e-9, engine="taylor")
    assert (int(by_kernel.outcome[0]), bool(by_kernel.certified[0])) == (0, False)
    assert bool(collide_many(scene, **impact, rtol=1e-9, engine="taylor").certified[0])
    scale = scene.liquid.film_thickness / bare.speed
    assert bare.until is not None
    assert proved.until is not None
    assert bare.until >= HORIZON * scale > proved.until


def test_tables_line_up() -> None:
    """A Markdown table whose columns are as wide as their widest cell."""
    assert table(["a", "long"], [["bcd", "1"]]) == "| a   | long |\n| --- | ---: |\n| bcd |    1 |"


def test_what_a_gradient_costs(monkeypatch: pytest.MonkeyPatch) -> None:
    """1, 4 and 12 parameters by both methods, on the collision's own engine; and by the kernel, over its own value."""
    monkeypatch.setattr(needs, "REPEATS", 1)
    many: list[tuple[int, str]] = []
    monkeypatch.setattr(needs, "gradients_many", lambda *_, wrt, engine, **__: many.append((len(wrt), engine)))
    monkeypatch.setattr(needs, "differences", lambda *_, **__: {})
    asked: list[tuple[str, int]] = []
    engines: set[str] = set()

    def gradient(*_: object, method: str, wrt: list[str], engine: str, **__: object) -> None:
        asked.append((method, len(wrt)))
        engines.add(engine)

    monkeypatch.setattr(needs, "sensitivities", gradient)
    rows = needs.gradients()
    assert set(asked) == {(method, count) for method in ("forward", "adjoint") for count in (1, 4, 12)}
    assert engines == {"rosenbrock"}
    assert "central differences" in [row["method"] for row in rows]
    assert rows[0]["ratio"] == 1.0
    if compiler() is not None:
        assert set(many) == {(count, "taylor") for count in (1, 4, 12)}
        assert [row["parameters"] for row in rows[-4:]] == [0, 1, 4, 12]
        assert rows[-4]["ratio"] == 1.0


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


def test_growth_is_measured_in_fresh_processes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Wall and CPU time, memory and failures of a call, by its size; none is left out that is quick."""
    monkeypatch.setattr(growing, "SIZES", (2,))
    monkeypatch.setattr(growing, "ENGINES", ("rosenbrock",))
    rows = growing.growth()
    assert [row["collisions"] for row in rows if row["cores"] == 1] == [2]
    assert all(row["failed"] == 0 and row["wall"] > 0 and row["memory"] >= row["before"] > 0 for row in rows)


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
@pytest.mark.parametrize("name", ["heyoka, batch of 8", "sundae CVODE, numba"])
def test_compiled_peers_solve_the_same_problem(name: str, preset: str) -> None:
    """Where they are installed, their outcomes are Rosenbrock's and e_n agrees to what their tolerance allows."""
    engine = next(each for each in engines() if each.name == name)
    if engine.missing:
        pytest.skip(engine.missing)
    scene = Scene.load(preset)
    impacts = [Impact(st, np.radians(angle)) for st, angle in ((0.6, 50.0), (0.05, 70.0), (2.0, 60.0), (0.02, 80.0))]
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
