"""The speed up to which particles stick."""

import io
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, collide, critical
from wetdoublet.solvers.sensitivity.critical import Critical, CriticalSpeed
from wetdoublet.solvers.sensitivity.materials import materials_of
from wetdoublet.solvers.sensitivity.plots import draw_critical

from tests.helpers.command import run

FILM = {  # no attraction, no criterion but the roughness
    "particles": {"diameter": "1 mm", "density": "2500 kg/m^3", "roughness": "2 um", "dry_restitution": 0.8},
    "liquid": {"viscosity": "20 mPa s", "film_thickness": "30 um"},
    "model": {"film": "infinite"},
}


def test_head_on_it_is_the_closed_form() -> None:
    """A film alone, head-on: St* = (1 + 1/e) ln(x0/x_b), so that the speed is proportional to the viscosity."""
    film = Scene.from_dict(FILM)
    [one] = critical(film, angle=0.0, wrt=["liquid.viscosity"]).rows
    assert one.stokes == pytest.approx((1 + 1 / 0.8) * math.log(30 / 2), rel=1e-7)
    assert one.speed == pytest.approx(film.speed_of(one.stokes), rel=1e-14)
    assert (one.relative_speed, one.bounces_above) == pytest.approx((one.speed, one.speed), rel=1e-15)
    assert one.to == "bounce"
    # gradients are taken at 1e-8 and 4e-8 of the speed beside it
    assert one.elasticity["liquid.viscosity"] == pytest.approx(1.0, abs=1e-7)
    assert one.gradient["liquid.viscosity"] == pytest.approx(one.speed / 0.02, rel=1e-7)


@pytest.mark.parametrize("name", ["granulation", pytest.param("pendulum", marks=pytest.mark.slow)])
def test_rosenbrock_agrees_on_both_sides(name: str) -> None:
    """An engine that did not trace the boundary sticks just below, and has the outcome named just above."""
    found = critical(name, angle=["10 deg", "55 deg"])
    for one in found.rows:
        speeds = [one.relative_speed * (1 + side * 1e-5) for side in (-1, 1)]
        seen = [collide(name, relative_speed=v, angle=one.angle, engine="rosenbrock", ledger=False) for v in speeds]
        assert [each.outcome for each in seen] == ["stick", one.to]


@pytest.mark.slow
def test_the_interval_holds_what_other_draws_give() -> None:
    """Head-on the speed is known in closed form: the quantiles of many draws of it are the ends of the interval."""
    spread = {"liquid.viscosity": "10 %", "particles.roughness": "0.3 um", "particles.dry_restitution": 0.03}
    [one] = critical(Scene.from_dict(FILM), angle=0.0, uncertainty=spread, samples=1024).rows
    random = np.random.default_rng(1)
    viscosity, roughness, dry = (c + s * random.standard_normal(100_000) for c, s in ((1, 0.1), (2, 0.3), (0.8, 0.03)))
    speed = one.speed * viscosity * (1 + 1 / dry) * np.log(30 / roughness) / one.stokes
    # 1024 quasi-random draws: standard error of a quantile of independent ones is sqrt(0.025 * 0.975/1024) = 0.5 %
    share = [(speed < end).mean() for end in one.interval]
    assert share == pytest.approx([0.025, 0.975], abs=0.01)


def test_none_in_the_range_is_said_with_the_range() -> None:
    """All stick, or the slowest do not: no number, and a sentence with the Stokes numbers and speeds searched."""
    [one] = critical("pendulum", stokes=(1e-3, 0.1)).rows
    assert one.relative_speed is one.speed is one.stokes is one.to is None
    assert "stick for all of St 0.001 to 0.1 (normal speed 0.000264 to 0.0264 m/s)" in one.sentences[0]
    spinning = Scene.from_dict(FILM | {"impact": {"spin": "2000 rad/s"}})
    [fast] = critical(spinning, angle="30 deg").rows
    assert fast.relative_speed is None
    assert fast.slowest == "stick-rotate-separate"
    assert "the slowest do not stick" in fast.sentences[0]


def test_an_interval_may_be_open() -> None:
    """If many draws stick throughout the range, the upper end is not in it, and that is said."""
    scene = Scene.from_dict(FILM)
    [one] = critical(scene, angle=0.0, stokes=(1.0, 6.3), uncertainty={"particles.roughness": "20 %"}).rows
    assert one.interval[0] < one.relative_speed
    assert one.interval[1] is None
    assert "all stick in the range" in one.sentences[0]


TABLE = """size;particles.diameter [um];liquid.coating_thickness [um];liquid.viscosity [P];liquid.viscosity_sd [%];scene
fine;150;3;0.07;5;lactose-pvp
coarse;600;12;0.4;;lactose-pvp
"""

SOFT = """from wetdoublet.derive.user import *
layer = quantity("layer", unit="m", bounds=">= 0", meaning="thickness of a soft layer")
criterion("soft contact", gap=layer, meaning="the thickness of the soft layer")
"""


@pytest.mark.parametrize(
    ("before", "after", "where"),
    [("coarse;600", "coarse;-600", "coarse (line 3), particles.diameter"), ("viscosity [P]", "viscosity", "header")],
)
def test_a_wrong_material_is_named_with_its_file(tmp_path: Path, before: str, after: str, where: str) -> None:
    """The row that makes no scene, or the header, of the file."""
    file = tmp_path / "materials.csv"
    file.write_text(TABLE.replace(before, after), encoding="utf-8")
    with pytest.raises(InputError) as refused:
        critical(str(file))
    assert refused.value.field == f"materials {file}, {where}"


@pytest.mark.slow
def test_a_table_of_materials(tmp_path: Path) -> None:
    """A row each: as the scene with these entries has it; its own uncertainties; plotted and printed."""
    (tmp_path / "materials.csv").write_text(TABLE, encoding="utf-8")
    plot = tmp_path / "critical.png"
    done = run("critical", tmp_path / "materials.csv", "--angle", "0:20:2", "--json", "--plot", plot)
    assert done.exit_code == 0, done.output
    rows = json.loads(done.stdout)["rows"]
    assert [each["material"] for each in rows] == ["fine", "fine", "coarse", "coarse"]
    entries = {"particles.diameter": "600 um", "liquid.coating_thickness": "12 um", "liquid.viscosity": "40 mPa s"}
    [alone] = critical(Scene.load("lactose-pvp").with_entries(entries), angle=math.radians(20)).rows
    assert rows[3]["relative_speed"] == pytest.approx(alone.relative_speed, rel=1e-7)
    assert [each["interval"] is None for each in rows] == [False, False, True, True]
    assert not rows[3]["sentences"]  # a standard deviation may be left out
    assert plot.stat().st_size > 10_000
    assert "coarse" in run("critical", tmp_path / "materials.csv").stdout


def test_where_the_model_ends_is_said() -> None:
    """The sentences of a collision just above the speed, once for all angles that have them."""
    thick = Scene.load("granulation").with_entries({"liquid.film_thickness": "30 um"})
    found = critical(thick, angle=["0 deg", "40 deg"])
    for row in found.rows:
        faster = collide(thick, relative_speed=1.001 * row.relative_speed, angle=row.angle, ledger=False)
        assert row.validity == faster.validity
    assert str(found).count("\nthroughout: x0/a = 0.6 is above 0.2: ") == 1
    assert critical("granulation", angle=0.0).rows[0].validity == ()


def test_the_picture_names_its_marks() -> None:
    """Speeds are plain numbers on the axis, a legend says what circles, bars and triangles are, names are whole."""
    rows = tuple(
        CriticalSpeed(name, 0.0, (0.1, 1.0), relative_speed=v, interval=(0.9 * v, 1.1 * v), bounces_above=2 * v)
        for name, v in (("$a$_1", 1.0), ("b", 1.3), ("c", 9.0))
    )
    for shown, scale in ((rows, "log"), (rows[:2], "linear")):
        figure = draw_critical(Critical(shown, None, 1e-9))
        figure.savefig(io.BytesIO())
        [axes] = figure.axes
        assert axes.get_yscale() == scale
        assert all(re.fullmatch(r"[\d.]*", text.get_text()) for text in axes.get_yticklabels())
        words = [text.get_text() for text in axes.get_legend().get_texts()]
        assert words == ["sticks up to", "95 % interval", "bounces above"]
        assert axes.get_xticklabels()[0].get_text() == r"\$a\$_1"


def test_a_table_may_have_quantities_of_a_model(tmp_path: Path) -> None:
    """Each row is its scene with the model and that value, with a scene in the table or without."""
    model, plain = tmp_path / "soft.py", Scene.load("granulation")
    model.write_text(SOFT)
    wanted = plain.with_model(model).with_entries({"custom.layer": "3 um"})
    whole = {name: [value] for name, value in plain.given if not name.startswith("impact.")}
    for table in ({"scene": ["granulation"]}, whole):
        [material] = materials_of(table | {"custom.layer": ["3 um"]}, model=model)
        for speed in (0.1, 1.0):
            impact = {"speed": speed, "angle": 0.5}
            assert dict(material.scene.with_impact(**impact).si) == dict(wanted.with_impact(**impact).si)
        assert material.scene.package == wanted.package
    (tmp_path / "materials.csv").write_text("scene,custom.layer\ngranulation,3\n")
    refused = run("critical", str(tmp_path / "materials.csv"), "--model", str(model))
    assert refused.exit_code == 2
    assert "custom.layer [m]" in refused.stderr


def test_an_empty_cell_is_said() -> None:
    """The row has the scene's own value, and a sentence names the entry and the scene."""
    table = {"scene": ["granulation"] * 2, "liquid.viscosity": ["1 Pa s", ""], "grade": ["thin", "as it is"]}
    thin, plain = critical(table, angle=0.0).rows
    [own] = critical("granulation", angle=0.0).rows
    assert (plain.relative_speed, thin.sentences) == (own.relative_speed, ())
    assert plain.sentences == ("empty in the table and left as in granulation: liquid.viscosity",)


def test_a_table_may_have_an_angle_for_each_row(tmp_path: Path) -> None:
    """Each row is its scene at that angle."""
    rows = "scene,impact.angle [deg],particles.dry_restitution\ngranulation,20,0.3\ngranulation,50,0.4\n"
    (tmp_path / "materials.csv").write_text(rows)
    found = json.loads(run("critical", str(tmp_path / "materials.csv"), "--json").stdout)
    plain = Scene.load("granulation")
    for row, (angle, e_dry) in zip(found["rows"], ((20, 0.3), (50, 0.4)), strict=True):
        [alone] = critical(plain.with_entries({"particles.dry_restitution": e_dry}), angle=math.radians(angle)).rows
        assert row["relative_speed"] == pytest.approx(alone.relative_speed, rel=1e-12)
