"""Boundaries between outcomes: against the reference, against dense grids of outcomes, and on other structures."""

import json
import math
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Boundaries, InputError, Scene, boundary, collide

from ...helpers.command import run
from ...helpers.own_arm import surface

pytestmark = pytest.mark.slow

PRESETS = ("granulation", "pendulum")
OUTCOMES = ("stick", "stick-rotate-separate", "bounce")


def holds_on_both_sides(scene: Scene, found: Boundaries, distance: float = 1e-6) -> None:
    """Single collisions just below and above every change have its outcomes (another kernel, the other code path)."""
    for angle, line in zip(found.angles, found.changes, strict=True):
        for one in line:
            for sign, outcome in ((-1, one.before), (1, one.after)):
                other = collide(scene, stokes=one.stokes * (1 + sign * distance), angle=angle, ledger=False)
                assert other.outcome == outcome, (math.degrees(angle), one)


@pytest.mark.parametrize("name", PRESETS)
def test_reference_boundaries(name: str, reference_boundaries: dict[str, Any]) -> None:
    """Every change at the reference's four angles, its Ce and its outcomes."""
    entry = reference_boundaries[name]
    found = boundary(Scene.from_dict(entry["scene"]), angle=np.radians(entry["angles_deg"]))
    assert not found.failed
    # located to 1e-9, the reference to 7e-11, and integrated at 1e-10 with an error in St* of some ten times that
    for mine, theirs in zip(found.changes, entry["changes"], strict=True):
        assert [(one.before, one.after) for one in mine] == [(one["from"], one["to"]) for one in theirs]
        for one, other in zip(mine, theirs, strict=True):
            assert one.stokes == pytest.approx(other["stokes"], rel=5e-9)
            if other["centrifugal"] is None:
                assert one.centrifugal is None
            else:
                assert one.centrifugal == pytest.approx(other["centrifugal"], rel=1e-8)  # Ce ~ St^2 along a line


# ---- numbers of an independent prototype (80 bits), other structures


@pytest.mark.parametrize(
    ("arm", "expected"), [("surface", (4.266, 4.205, 4.149, 4.081)), ("midgap", (4.187, 4.121, 4.063, 3.995))]
)
def test_critical_centrifugal_number(arm: str, expected: tuple[float, ...]) -> None:
    """Ce* on S/SRS at 30, 45, 60, 75 deg, as the independent prototype has it for both arms."""
    scene = surface("granulation") if arm == "surface" else Scene.load("granulation")
    found = boundary(scene, angle=np.radians([30, 45, 60, 75]))
    for line, number in zip(found.changes, expected, strict=True):
        assert (line[0].before, line[0].after) == OUTCOMES[:2]
        assert line[0].centrifugal == pytest.approx(number, abs=6e-4)  # four digits printed


# ---- the interface


@pytest.mark.parametrize("options", [{"angle": 1.6}, {"angle": -0.1}, {"stokes": (0.1, 0.1)}, {"stokes": (0.0, 1.0)},
                                     {"stokes": (0.1, math.inf)}, {"rtol": 1.0}])  # fmt: skip
def test_bad_ranges(options: dict[str, Any]) -> None:
    """An angle, a range of Stokes numbers or a tolerance that cannot be is an InputError."""
    with pytest.raises(InputError):
        boundary("granulation", **{"angle": 0.5} | options)


def test_a_line_that_fails_is_marked() -> None:
    """Beyond the obliquity that doubles resolve nothing is computed: that line has its reason, the other is right."""
    angles = [math.radians(55.0), math.pi / 2 - 1e-9]
    told: list[int] = []
    found = boundary("granulation", angle=angles, stokes=(0.01, 1.0), progress=told.append)
    assert max(told) == 2  # what fails is done as well
    ((angle, reason),) = found.failed
    assert angle == angles[1]
    assert "the rotation reverses the approach" in reason
    assert found.changes[1] == ()
    assert "the rotation reverses the approach" in str(found)
    whole = boundary("granulation", angle=angles[:1], stokes=(0.01, 1.0))
    assert [one.stokes for one in found.changes[0]] == [one.stokes for one in whole.changes[0]]


@pytest.mark.parametrize("name", PRESETS)
def test_json_of_the_command(name: str, reference_boundaries: dict[str, Any]) -> None:
    """`wetdoublet boundary --json`: angles in rad, changes ascending; Ce null without a bridge."""
    outcome = run("boundary", name, "--angle", "35:65:3", "--stokes", "0.02:5", "--json")
    assert outcome.exit_code == 0, outcome.output
    found = json.loads(outcome.stdout)
    assert set(found) == {"angles", "changes", "rtol", "searched", "units", "version", "scene"}
    assert found["searched"] == [0.02, 5.0]
    scene = Scene.load(name)
    assert found["angles"] == pytest.approx(np.radians([35, 50, 65]).tolist(), rel=1e-14)
    for line in found["changes"]:
        assert [one["stokes"] for one in line] == sorted(one["stokes"] for one in line)
        for one in line:
            assert set(one) == {"stokes", "centrifugal", "from", "to", "angle", "speed", "relative_speed"}
            assert one["speed"] == pytest.approx(scene.speed_of(one["stokes"]), rel=1e-14)
            assert one["relative_speed"] == pytest.approx(one["speed"] / math.cos(one["angle"]), rel=1e-14)
            assert (one["centrifugal"] is None) == (name == "pendulum")
            assert {one["from"], one["to"]} <= set(OUTCOMES)
    theirs = reference_boundaries[name]["changes"][3]
    assert [one["stokes"] for one in found["changes"][2]] == pytest.approx([one["stokes"] for one in theirs], rel=5e-9)


def test_creeping_pairs_are_traced() -> None:
    """Nearly head-on, unequal spheres creep out of an infinite film: their line is traced all the same."""
    tables = Scene.load("granulation-dry-bridge").to_dict()
    tables["partner"] = {"radius": 3e-4, "density": 2500.0}
    tables["model"] = {"film": "infinite"}
    found = boundary(Scene.from_dict(tables), angle=0.02, stokes=(0.02, 2.0))
    assert not found.failed
    holds_on_both_sides(Scene.from_dict(tables), found)
