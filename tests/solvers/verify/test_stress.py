"""The stress test finds what is wrong with an engine, and explains what is not: small samples, no time is asserted."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from wetdoublet.solvers import Scene, boundary
from wetdoublet.solvers.commands.cli import main
from wetdoublet.solvers.engines.taylor.undecided import CHATTERS
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.verify.stress import judge as checking
from wetdoublet.solvers.verify.stress import run as stress_test
from wetdoublet.solvers.verify.stress.judge import judge
from wetdoublet.solvers.verify.stress.verdict import FAST, Case, Result

from ...helpers.command import quiet

pytestmark = pytest.mark.slow


def run(*arguments: str) -> int:
    """Exit status of the command, in this process."""
    with pytest.raises(SystemExit) as exited:
        main(list(arguments))
    return int(exited.value.code or 0)


def test_a_small_sample_passes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`verify --stress 8` exits 0, its last line is the summary, and its record and scenes are there."""
    assert run("verify", "--stress", "8", "--out", str(tmp_path / "new")) == 0
    out, err = capsys.readouterr()
    last = out.strip().splitlines()[-1]
    assert last.startswith("stress: 8 scenes, 0 unexplained disagreements")
    assert all(line.startswith("at work for ") for line in err.splitlines())
    record = json.loads((tmp_path / "new" / "stress.json").read_text())
    assert record["summary"] == last
    assert len(record["cases"]) == 8
    assert {"stick", "bounce"} <= set(record["outcomes"])
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
