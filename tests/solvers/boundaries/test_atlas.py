"""The atlas of a scene: its curves against lines and collisions, its points against bisection, its derivatives."""

import json
import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import Atlas, Scene, atlas, collide, collide_many
from wetdoublet.solvers.boundaries.plot import draw
from wetdoublet.solvers.formatting.style import LETTERS

from ...helpers.command import run

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("optimized")]

OUTCOMES = ("stick", "stick-rotate-separate", "bounce")
# about the point where stick-rotate-separate begins
PLANES = {"granulation": (("15 deg", "45 deg"), (0.01, 0.4)), "pendulum": (("35 deg", "65 deg"), (0.1, 5.0))}


@cache
def whole(name: str) -> Atlas:
    """The atlas of a preset, with few lines."""
    span, stokes = PLANES[name]
    return atlas(name, span=span, stokes=stokes, lines=3)


def at_stokes(found: Atlas, before: str, after: str, x: float) -> list[float]:
    """Where curves between two outcomes pass a value of x."""
    return [
        math.exp(float(np.interp(x, one.x, np.log(one.stokes))))
        for one in found.curves
        if (one.before, one.after) == (before, after) and one.x[0] <= x <= one.x[-1]
    ]


@pytest.mark.parametrize("name", list(PLANES))
def test_every_random_collision_lies_in_its_region(name: str) -> None:
    """Random points of the plane, none beside a curve: the region says what `collide_many` computes."""
    found, random = whole(name), np.random.default_rng(11)
    x = random.uniform(found.span[0] + 0.01, found.span[1], 600)
    stokes = np.exp(random.uniform(*np.log(found.window), 600))
    seen = collide_many(name, stokes=stokes, angle=x, of=("outcome",)).outcome.values
    beside = np.array(
        [
            any(abs(math.log(own / st)) < 3e-3 for pair in pairs for own in at_stokes(found, *pair, at))
            for at, st in zip(x, stokes, strict=True)
            for pairs in [{(one.before, one.after) for one in found.curves}]
        ]
    )
    assert (seen[~beside] == found.region(x, stokes)[~beside]).all()
    assert np.count_nonzero(~beside) > 550
    assert not found.unsettled


@pytest.mark.parametrize("name", list(PLANES))
def test_no_curve_dangles(name: str) -> None:
    """Every end of a curve is on the edge of the window, exactly, or at a point that has a name."""
    found = whole(name)
    places = {(one.x, one.stokes) for one in found.points}
    for one in found.curves:
        for x, stokes in ((one.x[0], one.stokes[0]), (one.x[-1], one.stokes[-1])):
            assert x in found.span or stokes in found.window or (x, stokes) in places
        assert (np.diff(one.x) > 0).all()


@pytest.mark.parametrize(("name", "low", "high"), [("granulation", 23.0, 24.0), ("pendulum", 41.0, 42.0)])
def test_where_stick_rotate_separate_begins(name: str, low: float, high: float) -> None:
    """The triple point, where St* meets Ce*: sampled by outcomes, the strip is there above its angle and not below."""
    found = whole(name)
    (point,) = (one for one in found.points if one.kind == "triple point")
    assert low < math.degrees(point.x) < high
    near = point.stokes * np.exp(np.linspace(-4e-6, 4e-6, 801))
    for side, there in ((-1e-6, False), (1e-6, True)):
        seen = collide_many(name, stokes=near, angle=point.x + side, of=("outcome",)).outcome.values
        assert bool((seen == 1).any()) is there
        assert seen[0] == 0 and seen[-1] == 2


def test_a_region_goes_on_beyond_the_last_curve() -> None:
    """Where a curve has left through the lower edge, the outcome above it reaches down to the edge."""
    found = atlas("pendulum", span=("86 deg", "89 deg"), stokes=(2.5e-3, 0.5), lines=3)
    angle, stokes = np.radians(88.9), np.array([3e-3, 0.1, 0.4])
    outcomes = collide_many("pendulum", stokes=stokes, angle=angle).outcome.values
    assert found.region(np.full(3, angle), stokes).tolist() == outcomes.tolist() == [1, 1, 1]


def test_a_plane_of_another_entry() -> None:
    """Roughness across: where the graze passes from the glass criterion to roughness, the approach just meets both.

    It meets neither where both are moved by 1e-6, and either where it alone is moved.
    """
    scene = Scene.load("granulation")
    found = atlas(scene, over="particles.roughness", span=("3 um", "5.5 um"), stokes=(0.06, 0.2), lines=2)
    assert not found.unsettled
    (criterion,) = found.points
    assert criterion.kind == "criterion change"
    glass = float(scene.entries["liquid.glass_transition_pressure"])
    for harder, rougher, reversal in ((1e-6, -1e-6, None), (-1e-6, -1e-6, "glass"), (1e-6, 1e-6, "rough")):
        moved = {
            "liquid.glass_transition_pressure": glass * (1 + harder),
            "particles.roughness": criterion.x * (1 + rougher),
        }
        seen = collide(scene.with_entries(moved), stokes=criterion.stokes, ledger=False)
        assert seen.reversal == reversal


# ---- the interface


def test_json_of_a_plane(tmp_path: Path) -> None:
    """`boundary --angle LO:HI --json --plot`: curves, points and resolution; x in rad, within the span."""
    picture = tmp_path / "atlas.png"
    options = ("--angle", "20:30", "--stokes", "0.05:0.3", "--json", "--plot", str(picture))
    told = run("boundary", "granulation-dry-bridge", *options)
    assert told.exit_code == 0, told.output
    found = json.loads(told.stdout)
    assert {"curves", "points", "resolution"} < set(found)
    (one,) = found["curves"]
    assert set(one) == {"from", "to", "kind", "x", "stokes", "speed", "relative_speed"}
    speeds = [Scene.load("granulation-dry-bridge").speed_of(stokes) for stokes in one["stokes"]]
    assert one["speed"] == pytest.approx(speeds, rel=1e-14)
    assert one["relative_speed"] == pytest.approx([v / math.cos(x) for v, x in zip(speeds, one["x"])], rel=1e-14)
    assert (one["from"], one["to"]) == OUTCOMES[1:]
    assert [one["x"][0], one["x"][-1]] == pytest.approx(np.radians([20, 30]).tolist(), rel=1e-15)
    assert len(one["x"]) == len(one["stokes"])
    assert picture.stat().st_size > 10_000
    points = whole("granulation").to_dict()["points"]
    assert {tuple(point) for point in points} == {("kind", "x", "stokes", "speed", "relative_speed")}


MU = "liquid.viscosity=1 Pa s:2 Pa s"


@pytest.mark.parametrize(
    ("options", "named"),
    [(["--angle", "60:10"], "--angle"), (["--angle", "10:95"], "--angle"), (["--angle", "1:6", "--wrt", "all"],
     "--wrt"), (["--over", "liquid.viscosity"], "--over"), (["--over", MU, "--angle", "10:20"], "--angle"),
     (["--over", "liquid.viscosity=1:2"], "--over liquid.viscosity"), (["--over", "bridge.law=1:2"], "--over"),
     (["--over", "impact.angle=10 deg:20 deg"], "--over"), (["--over", "pendulum.length=1 m:2 m"], "--over"),
     (["--over", "liquid.film_thickness=5 um:9 mm"], "bridge.volume"),
     (["--over", MU, "--set", "liquid.viscosity=1 Pa s"], "--over")],
)  # fmt: skip
def test_a_plane_that_cannot_be(options: list[str], named: str) -> None:
    """One line that names the option, and exit status 2."""
    told = run("boundary", "granulation", *options)
    assert told.exit_code == 2
    assert told.stderr.startswith(named)
    assert told.stderr.count("\n") == 1


def test_the_picture_names_its_regions() -> None:
    """Each outcome's letters once, inside its region; as many curves as the atlas has."""
    found = whole("pendulum")
    assert found.scene is not None
    figure = draw(found)
    (axes,) = figure.axes
    places = {text.get_text(): text.xy for text in axes.texts}
    assert set(places) == {*LETTERS.values()}
    for letters, (degrees, stokes) in places.items():
        assert LETTERS[OUTCOMES[int(found.region(math.radians(degrees), stokes))]] == letters
    drawn = [line for line in axes.get_lines() if line.get_linestyle() == "-"]
    assert len(drawn) == len(found.curves)
