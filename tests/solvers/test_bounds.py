"""Boundaries between outcomes: against the reference, against dense grids of outcomes, and on other structures."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Boundaries, ComputationError, InputError, Scene, boundary, collide, collide_many
from wetdoublet.solvers.boundary_plot import draw
from wetdoublet.solvers.bounds import closed
from wetdoublet.solvers.probe import Line

from .command import run

PRESETS = ("granulation", "pendulum")
OUTCOMES = ("stick", "stick-rotate-separate", "bounce")
SRS_B = ("stick-rotate-separate", "bounce")


def pairs(found: Boundaries, line: int = 0) -> list[tuple[str, str]]:
    """(before, after) of a line's changes."""
    return [(one.before, one.after) for one in found.changes[line]]


def holds_on_both_sides(scene: Scene, found: Boundaries, distance: float = 1e-6) -> None:
    """Single collisions just below and above every change have its outcomes (the other engine, the other code path)."""
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


@pytest.mark.parametrize(("name", "most"), [("granulation", 10), ("pendulum", 12)])
def test_cost_of_a_point(name: str, most: float) -> None:
    """A boundary's point takes about ten collisions on average, where bisection takes thirty.

    The pendulum's takes one more: its S/SRS boundary starts with a steep stretch that cannot be predicted.
    """
    found = boundary(name, angle=np.radians(np.linspace(20, 70, 26)))
    points = sum(len(line) for line in found.changes)
    assert not found.failed
    assert points >= 26
    assert found.collisions <= most * points


@pytest.mark.parametrize(("name", "span"), [("granulation", (0.005, 0.5)), ("pendulum", (0.05, 10.0))])
def test_no_change_is_missed(name: str, span: tuple[float, float]) -> None:
    """Thirty random angles: the outcome at each of 150 Stokes numbers is the one that the changes below it say."""
    random = np.random.default_rng(4)
    angles, grid = np.radians(random.uniform(0, 85, 30)), np.geomspace(*span, 150)
    found = boundary(name, angle=angles, stokes=span)
    assert not found.failed
    dense = collide_many(name, stokes=np.tile(grid, angles.size), angle=np.repeat(angles, grid.size), rtol=1e-7)
    outcomes = dense.outcome.values.reshape(angles.size, grid.size)
    assert (outcomes >= 0).all()
    for line, seen in zip(found.changes, outcomes, strict=True):
        at = np.array([one.stokes for one in line])
        below = np.searchsorted(at, grid)
        expected = [line[k - 1].after if k else (line[0].before if line else OUTCOMES[seen[0]]) for k in below]
        # the grid is integrated at 1e-7
        clear = np.array([not at.size or np.min(np.abs(at / stokes - 1)) > 1e-5 for stokes in grid])
        assert [OUTCOMES[one] for one in seen[clear]] == np.array(expected)[clear].tolist()


# ---- numbers of an independent prototype (80 bits), other structures


@pytest.mark.parametrize(
    ("arm", "expected"), [("surface", (4.266, 4.205, 4.149, 4.081)), ("midgap", (4.187, 4.121, 4.063, 3.995))]
)
def test_critical_centrifugal_number(arm: str, expected: tuple[float, ...]) -> None:
    """Ce* on S/SRS at 30, 45, 60, 75 deg, as the independent prototype has it for both arms."""
    scene = Scene.load("granulation").with_entries({"model.arm": arm})
    found = boundary(scene, angle=np.radians([30, 45, 60, 75]))
    for line, number in zip(found.changes, expected, strict=True):
        assert (line[0].before, line[0].after) == OUTCOMES[:2]
        assert line[0].centrifugal == pytest.approx(number, abs=6e-4)  # four digits printed


def test_critical_centrifugal_number_scales() -> None:
    """Ce* at 45 deg, glass off, when V, x0, mu, sigma, m, a is doubled: the independent prototype's factors."""
    scene = Scene.load("granulation").with_entries({"liquid.glass_transition_pressure": "1e6 GPa"})

    def critical(one: Scene) -> float:
        (change, *_) = boundary(one, angle=math.pi / 4, stokes=(0.01, 1.0)).changes[0]
        assert (change.before, change.after) == OUTCOMES[:2]
        assert change.centrifugal is not None
        return change.centrifugal

    base, factors = critical(scene), []
    for entry in ("bridge.volume", "liquid.film_thickness", "liquid.viscosity", "bridge.surface_tension",
                  "particles.reduced_mass", "particles.reduced_radius"):  # fmt: skip
        value = scene.entries[entry]
        assert isinstance(value, float)
        factors.append(critical(scene.with_entries({entry: 2 * value})) / base)
    assert factors == pytest.approx([1.038, 0.762, 0.983, 1.010, 1.010, 1.136], abs=6e-4)


@pytest.mark.parametrize(
    ("law", "expected"),
    [("willett", 3.95), ("willett-simple", 4.70), ("soulie", 4.12), ("rabinovich", 5.78), ("lambert", 4.65),
     ("constant", 6.8)],
)  # fmt: skip
def test_other_bridges(law: str, expected: float) -> None:
    """Ce* at 45 deg, surface arm, other bridge laws, by the prototype; `constant` has its barrier at x_f."""
    scene = Scene.load("granulation").with_entries({"bridge.law": law, "model.arm": "surface"})
    found = boundary(scene, angle=math.pi / 4)
    # as printed: half a unit of the last digit
    assert found.changes[0][0].centrifugal == pytest.approx(expected, abs=0.05 if law == "constant" else 0.0055)
    if law == "constant":  # a doublet that L's drift leaves circling beyond the film is not decided: midgap instead
        scene = scene.with_entries({"model.arm": "midgap"})
        found = boundary(scene, angle=math.pi / 4)
    holds_on_both_sides(scene, found)


def test_without_a_bridge() -> None:
    """No capillary force: head-on S/B alone, obliquely SRS/B alone, and no Ce."""
    found = boundary("granulation-dry-bridge", angle=np.radians([0.0, 30.0, 60.0]))
    assert [pairs(found, k) for k in range(3)] == [[("stick", "bounce")], [SRS_B], [SRS_B]]
    assert {one.centrifugal for line in found.changes for one in line} == {None}
    holds_on_both_sides(Scene.load("granulation-dry-bridge"), found)


def test_strings_and_a_bridge() -> None:
    """Strings and a bridge at once: single collisions on both sides of every change agree, as does a coarse grid."""
    tables = Scene.load("granulation").to_dict()
    tables["pendulum"] = {"length": "0.01 m"}
    scene = Scene.from_dict(tables)
    angles = np.radians([0.0, 40.0, 65.0])
    found = boundary(scene, angle=angles, stokes=(0.01, 1.0))
    assert not found.failed
    holds_on_both_sides(scene, found)
    grid = np.geomspace(0.01, 1.0, 40)
    for angle, line in zip(found.angles, found.changes, strict=True):
        seen = [OUTCOMES[k] for k in collide_many(scene, stokes=grid, angle=angle).outcome.values]
        changes = [(seen[k], seen[k + 1]) for k in range(39) if seen[k] != seen[k + 1]]
        assert changes == [(one.before, one.after) for one in line]


# ---- the interface


def test_order_of_the_angles() -> None:
    """Angles are traced in ascending order and come back in the order given, doubled ones too."""
    degrees = [60.0, 25.0, 60.0, 40.0]
    found = boundary("granulation", angle=np.radians(degrees), stokes=(0.01, 1.0))
    assert found.angles == pytest.approx(np.radians(degrees).tolist())
    assert [line[0].stokes for line in found.changes] == pytest.approx(
        [boundary("granulation", angle=math.radians(one), stokes=(0.01, 1.0)).changes[0][0].stokes for one in degrees],
        rel=3e-9,  # both located to 1e-9
    )


@pytest.mark.parametrize(
    "options",
    [
        {"angle": 1.6},
        {"angle": -0.1},
        {"angle": math.nan},
        {"angle": 0.5, "stokes": (1.0, 0.1)},
        {"angle": 0.5, "stokes": (0.1, 0.1)},
        {"angle": 0.5, "stokes": (0.0, 1.0)},
        {"angle": 0.5, "stokes": (0.1, math.inf)},
        {"angle": 0.5, "rtol": 1.0},
    ],
)
def test_bad_ranges(options: dict[str, Any]) -> None:
    """An angle, a range of Stokes numbers or a tolerance that cannot be is an InputError."""
    with pytest.raises(InputError):
        boundary("granulation", **options)


def test_a_line_that_fails_is_marked(monkeypatch: pytest.MonkeyPatch) -> None:
    """One line fails, whatever is tried: its reason is kept, its changes are empty, the other lines are as before."""
    angles = np.radians([35.0, 45.0, 55.0])
    whole = boundary("granulation", angle=angles, stokes=(0.01, 1.0))
    path = Line._seen

    def fails(line: Line, stokes: float) -> Any:
        if line.angle == angles[1]:
            raise ComputationError("no luck", phase="closing", time=1.0, state={"gap": 0.5, "opening": -0.1})
        return path(line, stokes)

    monkeypatch.setattr(Line, "_seen", fails)
    told: list[int] = []
    found = boundary("granulation", angle=angles, stokes=(0.01, 1.0), progress=told.append)
    assert sorted(set(told)) == [1, 2, 3]  # what fails is done as well
    ((angle, reason),) = found.failed
    assert angle == angles[1]
    assert "no luck" in reason
    assert "gap = 4e-06" in reason  # x0/2 in m
    assert found.changes[1] == ()
    assert "no luck" in str(found)
    for k in (0, 2):
        assert [one.stokes for one in found.changes[k]] == pytest.approx(
            [one.stokes for one in whole.changes[k]], rel=3e-9
        )


@pytest.mark.parametrize("name", PRESETS)
def test_json_of_the_command(name: str, reference_boundaries: dict[str, Any]) -> None:
    """`wetdoublet boundary --json`: angles in rad, changes ascending; Ce null without a bridge."""
    outcome = run("boundary", name, "--angle", "35:65:3", "--stokes", "0.02:5", "--json")
    assert outcome.exit_code == 0, outcome.output
    found = json.loads(outcome.stdout)
    assert set(found) == {"angles", "changes"}
    assert found["angles"] == pytest.approx(np.radians([35, 50, 65]).tolist(), rel=1e-14)
    for line in found["changes"]:
        assert [one["stokes"] for one in line] == sorted(one["stokes"] for one in line)
        for one in line:
            assert set(one) == {"stokes", "centrifugal", "from", "to"}
            assert (one["centrifugal"] is None) == (name == "pendulum")
            assert {one["from"], one["to"]} <= set(OUTCOMES)
    theirs = reference_boundaries[name]["changes"][3]
    assert [one["stokes"] for one in found["changes"][2]] == pytest.approx([one["stokes"] for one in theirs], rel=5e-9)


def test_a_span_cuts_the_line() -> None:
    """Only changes within `stokes` are reported; a span between two changes has none."""
    angle = math.radians(55)
    whole = boundary("granulation", angle=angle).changes[0]
    assert len(whole) == 2
    first, second = (one.stokes for one in whole)
    assert boundary("granulation", angle=angle, stokes=(first * 1.01, second * 0.99)).changes == ((),)
    (only,) = boundary("granulation", angle=angle, stokes=(first * 1.01, second * 1.01)).changes[0]
    assert only.stokes == pytest.approx(second, rel=3e-9)


def test_the_picture_closes_where_curves_meet() -> None:
    """Between an angle with one change and one with two, more are traced: the curves end where they meet.

    Six halvings leave 1/64 of the step in angle; the curves are apart there by no more than their slope over it.
    """
    scene, span = Scene.load("granulation"), (0.05, 0.2)
    found = boundary(scene, angle=np.radians([22.0, 25.0]), stokes=span)
    whole = closed(scene, found, span)
    assert [len(line) for line in found.changes] == [1, 2]
    assert len(whole.angles) == 8 and sorted(whole.angles) == list(whole.angles)
    first = next(k for k, line in enumerate(whole.changes) if len(line) == 2)
    assert math.degrees(whole.angles[first] - whole.angles[first - 1]) == pytest.approx(3 / 64)
    assert whole.changes[first - 1][0].stokes == pytest.approx(whole.changes[first][1].stokes, rel=1e-4)
    apart = [math.log(line[1].stokes / line[0].stokes) for line in whole.changes[first:]]
    slope = (apart[-1] - apart[0]) / (whole.angles[-1] - whole.angles[first])
    assert 0 < apart[0] < 1.2 * slope * math.radians(3 / 64)  # the slope falls by a few percent on the way
    figure = draw(scene, whole)
    names = {text.get_text().replace("\n", "") for text in figure.axes[0].texts}
    assert names == set(OUTCOMES)
