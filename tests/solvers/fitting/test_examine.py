"""Measurements looked through before a fit."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.generated.automaton import OUTCOMES
from wetdoublet.solvers import Scene, check_data, collide, fit
from wetdoublet.solvers.fitting.data_table import read_data
from wetdoublet.solvers.fitting.measurements import UNKNOWN, Measurements

from tests.helpers.command import run
from tests.helpers.synthetic import drawn

PENDULUM = Scene.load("pendulum")
MESSY = """date;run;v (cm/s);v err (%);theta (°);COR;COR std;Regime;operator
2026-01-02;1;24,5;3;54,9;0,078;0,02;SRS;KB
2026-01-02;2;61,2;3;36,0;0,611;0,02;bounce;KB
2026-01-02;3;16,9;3;24,0;-;;stick;KB
"""
CLEAN = """speed [m/s],speed_sd [%],angle [deg],restitution,restitution_sd,outcome
0.245,3,54.9,0.078,0.02,stick-rotate-separate
0.612,3,36.0,0.611,0.02,bounce
0.169,3,24.0,,,stick
"""


def impacts(size: int = 40, seed: int = 2, scene: Scene = PENDULUM) -> Measurements:
    """Synthetic impacts about the changes of outcome, with results."""
    random = np.random.default_rng(seed)
    speed = np.exp(random.uniform(*np.log([0.4, 6.0]), size)) / scene.stokes_per_speed
    plan = Measurements(
        speed, random.uniform(0.1, 1.0, size), 0.02 * speed, np.full(size, 0.01), np.full(size, UNKNOWN),
        {"restitution": (np.ones(size), np.full(size, 0.02))}, labels=tuple(f"row {k + 1}" for k in range(size)),
    )  # fmt: skip
    return drawn(scene, plan, seed)


def test_columns_as_people_name_them(tmp_path: Path) -> None:
    """Semicolons, decimal commas, units in parentheses and usual names give what the documented table gives."""
    (tmp_path / "messy.csv").write_text(MESSY, encoding="utf-8")
    (tmp_path / "clean.csv").write_text(CLEAN, encoding="utf-8")
    messy, clean = (read_data(tmp_path / name, PENDULUM) for name in ("messy.csv", "clean.csv"))
    for name in ("speed", "speed_sd", "angle", "outcome"):
        np.testing.assert_allclose(getattr(messy, name), getattr(clean, name), rtol=1e-15)
    np.testing.assert_array_equal(messy.observed["restitution"], clean.observed["restitution"])
    assert "Columns that are not used: date, run, operator." in messy.remarks
    assert 'Column "COR" is read as restitution.' in messy.remarks
    assert any("name it relative_speed" in remark for remark in messy.remarks)


@pytest.mark.parametrize("seed", range(3))
def test_good_data_have_nothing_odd(seed: int) -> None:
    """Impacts drawn from the model with their own scatter are not suspected."""
    assert check_data(impacts(seed=seed), PENDULUM).findings == ()


@pytest.mark.parametrize(
    ("change", "question"),
    [
        (lambda data: {"speed": data.speed * 1000, "speed_sd": data.speed_sd * 1000}, "Are these speeds in mm/s?"),
        (lambda data: {"speed": data.speed * 100, "speed_sd": data.speed_sd * 100}, "Are these speeds in cm/s?"),
        (lambda data: {"speed": data.speed / 1000, "speed_sd": data.speed_sd / 1000}, "m/s, not in mm/s"),
        (lambda data: {"angle": np.pi / 2 - data.angle}, "Are they measured from the tangent?"),
    ],
)
def test_wrong_units_are_asked_about(change, question: str) -> None:
    """The factor with which the data agree with the scene is found, and no other question is asked."""
    data = impacts()
    units, *others = check_data(replace(data, **change(data)), PENDULUM).findings
    assert units.kind == "units"
    assert question in units.text
    assert {one.kind for one in others} <= {"restitution"}


def table_of(data: Measurements, name: str) -> dict[str, list]:
    """Columns in SI, the normal speed or the magnitude under this name."""
    speed = data.speed / np.cos(data.angle) if "rel" in name or name == "v" else data.speed
    outcome = [OUTCOMES[code] for code in data.outcome]
    restitution = data.observed["restitution"][0]
    return {name: list(speed), "angle": list(data.angle), "restitution": list(restitution), "outcome": outcome}


@pytest.mark.usefixtures("optimized")
@pytest.mark.slow
def test_the_kind_of_speed_is_asked_about_where_its_name_does_not_say() -> None:
    """Magnitudes in a column `v` are read as normal speeds: `check` and `fit` say that the other kind agrees better."""
    data = impacts(30)
    [kind] = [one for one in check_data(table_of(data, "v"), PENDULUM).findings if one.kind == "speed"]
    assert "Name the column v_n or v_rel" in kind.text
    for name in ("v_rel", "v_n", "relative_speed"):
        found = check_data(table_of(data, name), PENDULUM)
        assert not [one for one in found.findings if one.kind in ("speed", "units", "contradiction")]
        assert not any("name it relative_speed" in each for each in found.notes)
    found = fit(PENDULUM, table_of(data, "v"), ["liquid.viscosity"], starts=0)
    assert any("Name the column v_n or v_rel" in each for each in str(found).split("\n"))


def test_what_does_not_come_out_is_named_and_no_contradiction_is_nothing_odd() -> None:
    """A row that the scene contradicts is named; where most are, `Nothing odd` is not said."""
    seen = {
        "speed": [0.1, 0.2, 3.0, 4.0, 5.0],
        "angle": [0.0] * 5,
        "outcome": ["stick"] * 2 + ["bounce"] * 2 + ["stick"],
    }
    one = check_data(seen, "granulation")
    assert one.differing == ("row 5",)
    assert "Others do not: row 5." in str(one)
    none = check_data(seen | {"outcome": ["bounce"] * 2 + ["stick"] * 3}, "granulation")
    assert none.agreement == 0
    assert none.findings[-1].kind == "contradiction"
    assert "Nothing odd was found." not in str(none)


def test_restitution_that_no_speed_gives() -> None:
    """Head-on nothing exceeds the dry restitution: 0.9 is impossible with 0.7, and a row below is not named."""
    scene = Scene.load("lactose-pvp").with_entries({"particles.dry_restitution": 0.7})
    seen = {"speed": [3.0, 4.0, 5.0], "angle": [0.0] * 3, "angle_sd": [0.0] * 3, "restitution": [0.3, 0.9, 0.4]}
    [finding] = [one for one in check_data(seen, scene).findings if one.kind == "restitution"]
    assert finding.rows == ("row 2",)
    most = max(collide(scene, speed=v, angle=0.0).restitution for v in np.geomspace(1, 1e4, 40))
    assert most < 0.7
    assert float(finding.text.rpartition(" ")[2]) == pytest.approx(0.7, abs=0.01)


def test_outliers_and_duplicates_are_named() -> None:
    """A misread outcome, a misread restitution and a copied row are found, each by its row."""
    data = impacts(60)
    outcome, values = data.outcome.copy(), data.observed["restitution"][0].copy()
    fast = np.flatnonzero((data.outcome == 2) & (values > 0.5))
    misread, wrong, copied = (fast[np.argsort(data.speed[fast])[k]] for k in (fast.size // 2, fast.size // 2 - 2, 1))
    outcome[misread], values[misread] = 0, np.nan
    values[wrong] -= 0.3
    changed = replace(data, outcome=outcome, observed={"restitution": (values, data.observed["restitution"][1])})
    rows = np.append(np.arange(60), copied)
    changed = replace(changed.subset(rows), labels=tuple(f"row {k + 1}" for k in range(61)))
    found = {(one.kind, row) for one in check_data(changed, PENDULUM).findings for row in one.rows}
    assert ("outlier", f"row {misread + 1}") in found
    assert ("outlier", f"row {wrong + 1}") in found
    assert {("duplicate", f"row {copied + 1}"), ("duplicate", "row 61")} <= found
    assert len(found) == 4


def test_entries_that_a_contact_time_tells() -> None:
    """As many impacts as last visibly longer or shorter, by single collisions, at half or twice the entry."""
    speeds = np.linspace(0.42, 1.2, 8)
    expected = [collide(PENDULUM, speed=speed, angle=0.0).contact_time for speed in speeds]
    data = {"speed": speeds, "angle": np.zeros(8), "contact_time": expected, "contact_time_sd": np.full(8, 2e-4)}
    telling = check_data(data, PENDULUM).telling
    for name in ("liquid.viscosity", "liquid.film_thickness", "particles.roughness"):
        value = float(PENDULUM.entries[name])
        differ = np.zeros(8, bool)
        for factor in (0.5, 2.0):
            scene = PENDULUM.with_entries({name: factor * value})
            for k, speed in enumerate(speeds):
                other = collide(scene, speed=speed, angle=0.0)
                differ[k] |= other.outcome == "stick" or abs(other.contact_time - expected[k]) > 2e-4
        assert telling[name] == differ.sum()
    assert telling["liquid.viscosity"] > 0


@pytest.mark.usefixtures("optimized")
@pytest.mark.slow
def test_a_distant_first_guess_is_no_contradiction() -> None:
    """A viscosity 30 times the first guess is found, although all impacts contradict the first guess."""
    true = Scene.load("lactose-pvp").with_entries({"liquid.viscosity": "210 mPa s"})
    random = np.random.default_rng(5)
    speed = np.exp(random.uniform(*np.log([1.0, 12.0]), 10)) / true.stokes_per_speed
    plan = Measurements(speed, random.uniform(0, 0.9, 10), 0.02 * speed, np.full(10, 0.01), np.full(10, UNKNOWN),
                        {"restitution": (np.ones(10), np.full(10, 0.02))})  # fmt: skip
    found = fit("lactose-pvp", drawn(true, plan, 2), ["liquid.viscosity"])
    assert not found.rows.contradicted
    one = found.estimates["liquid.viscosity"]
    assert one.low < 0.21 < one.high


def test_the_command(tmp_path: Path) -> None:
    """Either order; status 1 with the first finding; JSON has the findings."""
    file = tmp_path / "impacts.csv"
    file.write_text(CLEAN, encoding="utf-8")
    for words in ((file, "pendulum"), ("pendulum", file)):
        done = run("check", *words)
        assert done.exit_code == 0, done.output
        assert "Nothing odd was found." in done.stdout
    file.write_text(CLEAN + CLEAN.split("\n")[2] + "\n", encoding="utf-8")
    done = run("check", file, "pendulum", "--json")
    assert done.exit_code == 1
    assert "row 2 (line 3), row 4 (line 5): the same to the last digit" in done.stderr
    assert [one["kind"] for one in json.loads(done.stdout)["findings"]] == ["duplicate"]
