"""The stress test finds what is wrong with an engine, and explains what is not: small samples, no time is asserted."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Scene, boundary, collide, collide_many
from wetdoublet.solvers.commands.cli import main
from wetdoublet.solvers.commands.verify import command as verify
from wetdoublet.solvers.engines.taylor.undecided import CHATTERS
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.host.emitted import LAWS
from wetdoublet.solvers.verify.stress import judge as checking
from wetdoublet.solvers.verify.stress import run as stress_test
from wetdoublet.solvers.verify.stress.judge import judge
from wetdoublet.solvers.verify.stress.sample import DISTANCES, SEED, sample
from wetdoublet.solvers.verify.stress.verdict import FAST, RTOL, Case, Result

from ...helpers.command import quiet

pytestmark = pytest.mark.slow


def run(*arguments: str) -> int:
    """Exit status of the command, in this process."""
    with pytest.raises(SystemExit) as exited:
        main(list(arguments))
    return int(exited.value.code or 0)


def test_a_small_sample_passes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`verify --stress 8` exits 0, its last line is the summary, and its record, tables and scenes are there."""
    assert run("verify", "--stress", "8", "--out", str(tmp_path / "new")) == 0
    out, err = capsys.readouterr()
    last = out.strip().splitlines()[-1]
    assert last.startswith("stress: 8 scenes, 0 unexplained disagreements")
    assert all(line.startswith("at work for ") for line in err.splitlines())
    record = json.loads((tmp_path / "new" / "stress.json").read_text())
    assert record["summary"] == last
    assert len(record["cases"]) == 8
    assert {"stick", "bounce"} <= set(record["outcomes"])
    assert last in (tmp_path / "new" / "stress.md").read_text()
    scenes = list((tmp_path / "new" / "worst").glob("*.toml"))
    assert scenes
    for file in scenes:
        Scene.load(file).need_impact()


def off_by(shift: float) -> Any:
    """The fast engine with an error in every e_n of a doublet that separates."""
    usual = checking.fast

    def broken(scene: Scene, rtol: float) -> Result:
        found = usual(scene, rtol)
        if found.outcome != "stick":
            found.restitution += shift
        return found

    return broken


def upside_down(scene: Scene, rtol: float) -> Result:
    """An engine to which nothing ever sticks."""
    found = checking.chained(scene, rtol)
    return Result("bounce", 0.5) if found.outcome == "stick" else found


@pytest.mark.parametrize(("broken", "kind"), [(off_by(1e-4), "restitution"), (upside_down, "outcome")])
def test_a_broken_engine_is_caught(
    broken: Any, kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """An error of 1e-4 in e_n, or a wrong outcome, is an unexplained disagreement: named, kept as a scene, exit 1."""
    monkeypatch.setattr(checking, "fast", broken)
    assert run("verify", "--stress", "4", "--out", str(tmp_path)) == 1
    out, err = capsys.readouterr()
    assert f"unexplained ({kind}): " in out
    assert " 0 unexplained" not in out.strip().splitlines()[-1]
    assert "unexplained disagreements; see" in err
    assert len(quiet(err).strip().splitlines()) == 1
    assert list((tmp_path / "worst").glob("disagreement-*.toml"))


def test_a_disagreement_at_a_graze_is_explained() -> None:
    """Engines that differ within their error of a graze are said to lie beside a change, not to be wrong."""
    scene = Scene.load("granulation").with_impact(angle="45 deg")
    changes = boundary(scene, stokes=(0.05, 0.5), rtol=1e-10).changes[0]
    (graze,) = [each.stokes for each in changes if each.after == "bounce"]
    engines = {"first": checking.fast, "second": checking.chained}
    assert "a change of outcome lies within" in checking.change_nearby(_case(scene, graze), engines, "first", "second")
    assert not checking.change_nearby(_case(scene, graze * 0.99), engines, "first", "second")


def _case(scene: Scene, stokes: float) -> Case:
    return Case("one", scene.with_impact(stokes=stokes))


def test_a_wrong_spin_is_caught() -> None:
    """An engine whose final spin is off by 1e-4 disagrees, also where its restitution is right."""
    entries = {"particles.friction": 0.2, "particles.roughness": "4 um", "impact.spin": 3e3}
    scene = Scene.load("granulation").with_entries(entries).with_impact(stokes=0.3, angle="45 deg")

    def turned(scene: Scene, rtol: float) -> Result:
        right = checking.chained(scene, rtol)
        return replace(right, spins=(right.spins[0] + 1e-4,))

    engines = {"rosenbrock": checking.runs()["rosenbrock"], "cvodes": checking.chained, "turned": turned}
    (wrong,) = judge(Case("one", scene), engines).issues
    assert (wrong.kind, wrong.between, wrong.explained) == ("spin", ("rosenbrock", "turned"), "")


def test_a_wrong_certificate_is_caught() -> None:
    """A stick that is said to be proved is continued without its proof, and found to separate."""
    scene = Scene.load("granulation").with_impact(stokes=0.1, angle="60 deg")
    engines = checking.runs() | {FAST: lambda *_: Result("stick", 0.0, certified=True)}
    kinds = {issue.kind for issue in judge(Case("one", scene), engines).issues if not issue.explained}
    assert kinds == {"certificate", "outcome"}


def test_failures_are_told_apart() -> None:
    """Chatter has a physical reason, a defect has none."""
    scene = Scene.load("granulation")

    def failing(words: str) -> Any:
        def run(*_: Any) -> Result:
            raise ComputationError(words)

        return run

    engines = checking.runs() | {FAST: failing(f"20 phases: {CHATTERS}")}
    (chatter,) = judge(Case("one", scene), engines).issues
    assert chatter.kind == "failure"
    assert chatter.explained
    engines |= {FAST: failing("gave up")}
    kinds = [(issue.kind, issue.explained) for issue in judge(Case("one", scene), engines).issues]
    assert kinds == [("failure", "")]


def test_the_sample_is_the_same_again_and_covers_its_ranges() -> None:
    """Fixed by its seed; every law, e_dry from 0 to 1, and both sides of a boundary at all its distances."""
    cases = sample(240, SEED)
    assert [case.scene for case in cases[::20]] == [case.scene for case in sample(240, SEED)[::20]]
    drawn = [case.scene for case in cases if case.kind == "sampled"]
    stokes = np.array([scene.stokes for scene in drawn], dtype=float)
    assert stokes.min() < 1e-5
    assert stokes.max() > 1e3
    assert {scene.bridge.law if scene.bridge else None for scene in drawn} >= {None, "mikami", "lambert", "constant"}
    assert {scene.pendulum is None for scene in drawn} == {True, False}
    assert {scene.particles.dry_restitution for scene in drawn} >= {0.0, 1.0}
    assert any(scene.angle == 0 for scene in drawn)
    assert {(scene.wall, scene.pair) for scene in drawn} >= {(True, False), (False, True), (False, False)}
    assert {scene.model.film for scene in drawn} == set(LAWS["film"])
    for part in ("particles.friction", "impact.spin", "impact.partner_spin", "attraction.hamaker"):
        assert {part in dict(scene.given) for scene in drawn} == {True, False}
    beside = [case for case in cases if case.kind == "beside"]
    assert {case.distance for case in beside} == set(DISTANCES)
    assert len({case.expected for case in beside}) > 1


def test_without_a_count_there_are_as_many_scenes_as_the_help_says() -> None:
    """The value of a bare `--stress` stands in its line of the help, and is one that a person waits for."""
    option = next(each for each in verify.params if each.name == "stress")
    assert f"[{option.flag_value}]" in option.help and int(option.flag_value) == 500


WEAK = {"model.glass": "film-corrected"}  # its pressure starts at 0 at x0
PULLING = {  # let go almost at rest: together in a quarter of the pendulum's period, the film takes little
    "particles": {"reduced_radius": 2.78663e-3, "density": 12787.3, "roughness": 3.84872e-9, "dry_restitution": 0.3826},
    "liquid": {"viscosity": 5.81449e-05, "film_thickness": 0.00184799, "glass_transition_pressure": 67044200.0},
    "pendulum": {"length": 10.2548, "gravity": 2.76018, "law": "small-angle"},
    "impact": {"stokes": 0.000165219, "angle": 0.175441},
}
TURNING = {  # at rest on each other on strings, turned by more than half a turn in one step
    "particles": {"reduced_radius": 1.43708e-6, "density": 5703.26, "roughness": 6.49216e-11, "dry_restitution": 0.024},
    "liquid": {"viscosity": 260.591, "film_thickness": 5.19487e-08, "glass_transition_pressure": 32925200.0},
    "bridge": {"surface_tension": 0.326788, "volume": 0.000536649, "contact_angle": 1.23736, "law": "willett"},
    "pendulum": {"length": 0.00351029, "gravity": 5.17709, "law": "small-angle"},
    "impact": {"stokes": 3.57656e-06, "angle": 1.54463},
}


def test_scenes_at_the_edge_of_what_doubles_hold() -> None:
    """Each was found by the stress test: a pull of 1e13 m v0^2/x0, a long step."""
    first = collide(Scene.from_dict(PULLING), engine="rosenbrock").events[0]
    assert (first.kind, first.time) == ("rough", pytest.approx(math.pi / 2 * math.sqrt(10.2548 / 2.76018), rel=1e-3))
    turned = collide(Scene.from_dict(TURNING), engine="rosenbrock")
    assert turned.outcome == "stick"
    assert [event.kind for event in turned.events][-2:] == ["rests", "half turn"]


@pytest.mark.parametrize(("preset", "glass"), [("granulation", "1e-8 Pa"), ("granulation-dry-bridge", "1e-12 Pa")])
def test_a_weak_glass_just_after_first_touch(preset: str, glass: str) -> None:
    """The film-corrected pressure meets a tiny p_gt within rounding of x0: no engine loses it.

    There 1/x^2 - 1/x0^2 is what rounding leaves of it, so that it can be met no closer than that.
    """
    scene = Scene.load(preset).with_entries(WEAK | {"liquid.glass_transition_pressure": glass})
    located = collide_many(scene, stokes=3.0, angle=math.radians(50)).restitution.values[0]
    found = collide(scene, stokes=3.0, angle="50 deg", engine="rosenbrock")
    assert found.reversal == "glass"
    assert found.restitution == pytest.approx(located, rel=1e3 * RTOL)


def test_an_interrupt_keeps_what_is_judged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Ctrl-C before the last case: earlier blocks are in the report, the last line counts them, the status is 130."""
    usual, verdicts = stress_test.judge, []

    def interrupted(case: Any) -> Any:
        if len(verdicts) == 11:
            raise KeyboardInterrupt
        verdicts.append(replace(verdicts[0], case=case) if verdicts else usual(case))
        return verdicts[-1]

    monkeypatch.setattr(stress_test, "judge", interrupted)
    assert run("verify", "--stress", "12", "--out", str(tmp_path)) == 130
    out, err = capsys.readouterr()
    assert " of 12 scenes, " in out.strip().splitlines()[-1]
    assert "interrupted" in err
    assert 1 <= len(json.loads((tmp_path / "stress.json").read_text())["cases"]) <= 11


def test_ranges_that_laws_leave_are_counted_once(recwarn: pytest.WarningsRecorder) -> None:
    """A case outside the range of its bridge law says so in its verdict, without the value, and warns of nothing."""
    scene = Scene.load("granulation").with_entries({"bridge.law": "willett-simple"}).with_impact(angle="60 deg")
    verdict = judge(Case("one", scene), {"rosenbrock": lambda s, r: checking.chained(s, r, "rosenbrock")})
    assert verdict.remarks == ("bridge.volume above 0.001, outside the range of the law willett-simple",)
    assert not recwarn.list
