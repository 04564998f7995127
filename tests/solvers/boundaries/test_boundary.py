"""Boundaries between outcomes: against the reference, against dense grids of outcomes, and on other structures."""

import json
import math
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import Boundaries, InputError, Scene, boundary, collide, collide_many
from wetdoublet.solvers.boundaries.trace import trace

from ...helpers.command import run
from ...helpers.own_arm import surface

pytestmark = pytest.mark.slow

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


# ---- strips of stick-rotate-separate beside the presets that an earlier coarse scan lost


STRIPS: tuple[tuple[str, dict[str, Any], float, tuple[float, float, float]], ...] = (
    ("granulation", {"particles.roughness": 2e-6}, 27.0, (0.05, 0.0973, 0.1157)),
    ("granulation", {"particles.roughness": 4e-6, "bridge.law": "willett"}, 42.3, (0.02, 0.0523, 0.0705)),
)


@pytest.mark.parametrize(("name", "entries", "degrees", "around"), STRIPS)
def test_a_strip_is_found(
    name: str, entries: dict[str, Any], degrees: float, around: tuple[float, float, float]
) -> None:
    """Between stick and bounce there is a strip of stick-rotate-separate, as single collisions inside it say."""
    scene = Scene.load(name).with_entries(entries)
    found = boundary(scene, angle=math.radians(degrees), stokes=(0.01, 1.0))
    assert pairs(found) == [OUTCOMES[:2], SRS_B]
    assert [one.stokes for one in found.changes[0]] == pytest.approx(
        around[1:], rel=0.03
    )  # as reported, to two or three digits
    holds_on_both_sides(scene, found)


@pytest.mark.parametrize("width", [1e-3, 1e-5, 1e-7])
def test_strips_narrower_than_the_samples(width: float) -> None:
    """Where a strip begins, at the angle where two changes meet, it is seen however narrow it is.

    The angle is found by bisection on the number of changes; there the strip is as narrow as wanted, or narrower.
    """
    scene = Scene.load("granulation").with_entries({"particles.roughness": 2e-6})
    low, high, strip = math.radians(20.0), math.radians(27.0), math.inf
    for _ in range(60):
        middle = 0.5 * (low + high)
        line = boundary(scene, angle=middle, stokes=(0.05, 0.3)).changes[0]
        if len(line) == 2:
            high, strip = middle, line[1].stokes / line[0].stokes - 1
            assert pairs(boundary(scene, angle=middle, stokes=(0.05, 0.3))) == [OUTCOMES[:2], SRS_B]
        else:
            low = middle
        if strip < width:
            break
    assert strip < width


def test_an_escape_from_the_film_alone_is_located() -> None:
    """Head-on, without a bridge, e_n starts from zero: collisions 1e-8 on either side of St* stick, and separate."""
    scene = Scene.load("granulation-dry-bridge").with_entries({"particles.dry_restitution": 0.4})
    (change,) = boundary(scene, angle=0.0).changes[0]
    beside = change.stokes * (1 + np.array([-1e-8, 1e-8]))
    seen = collide_many(scene, stokes=beside, angle=0.0, rtol=1e-12, engine="taylor").outcome.values
    assert [OUTCOMES[k] for k in seen] == ["stick", "bounce"]


def test_creeping_pairs_are_looked_at_by_rosenbrock() -> None:
    """Nearly head-on, unequal spheres creep out of an infinite film: their line is traced all the same."""
    tables = Scene.load("granulation-dry-bridge").to_dict()
    tables["partner"] = {"radius": 3e-4, "density": 2500.0}
    tables["model"] = {"film": "infinite"}
    found = boundary(Scene.from_dict(tables), angle=0.02, stokes=(0.02, 2.0))
    assert not found.failed
    holds_on_both_sides(Scene.from_dict(tables), found)


def test_resolution_is_stated() -> None:
    """The spacing of the Stokes numbers looked at is part of the result and of its text."""
    found = boundary("granulation", angle=1.0, stokes=(0.01, 1.0))
    assert 0 < found.resolution < 0.03
    assert f"{found.resolution:.1%}" in str(found)


def test_the_table_gives_speeds_as_the_scene_does() -> None:
    """Beside St stands the normal speed, or the relative one where the scene gives that, of the changes."""
    plain = Scene.load("granulation")
    for scene, share in ((plain, 1.0), (plain.with_impact(relative_speed="1 m/s"), math.cos(1.0))):
        found = boundary(scene, angle=1.0, stokes=(0.02, 1.0))
        row = str(found).splitlines()[1].split()
        assert float(row[3]) == pytest.approx(scene.speed_of(float(row[1])) / share, rel=1e-5)


def test_rosenbrock_traces_the_same_boundaries() -> None:
    """Without a kernel the same logic runs on fewer samples: the changes agree, and the resolution says so."""
    scene, angle = Scene.load("granulation"), np.array([math.radians(55.0)])
    kernel = trace(scene, angle, (0.01, 1.0), 1e-9)
    other = trace(scene, angle, (0.01, 1.0), 1e-9, kernel=False)
    assert not any(other.failures)
    for one, its in zip(kernel.changes[0], other.changes[0], strict=True):
        assert (one.before, one.after) == (its.before, its.after)
        assert one.stokes == pytest.approx(its.stokes, rel=1e-8)
    assert other.resolution > 5 * kernel.resolution


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
    [("willett", 3.95), ("willett-simple", 4.70), ("soulie", 4.12), ("rabinovich", 5.78), ("lambert", 4.65)],
)  # fmt: skip
def test_other_bridges(law: str, expected: float) -> None:
    """Ce* at 45 deg, surface arm, other bridge laws, by the prototype."""
    scene = surface("granulation").with_entries({"bridge.law": law})
    found = boundary(scene, angle=math.pi / 4)
    assert found.changes[0][0].centrifugal == pytest.approx(expected, abs=0.0055)  # half a unit of the last digit
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


def test_a_span_cuts_the_line() -> None:
    """Only changes within `stokes` are reported; a span between two changes has none."""
    angle = math.radians(55)
    whole = boundary("granulation", angle=angle).changes[0]
    assert len(whole) == 2
    first, second = (one.stokes for one in whole)
    assert boundary("granulation", angle=angle, stokes=(first * 1.01, second * 0.99)).changes == ((),)
    (only,) = boundary("granulation", angle=angle, stokes=(first * 1.01, second * 1.01)).changes[0]
    assert only.stokes == pytest.approx(second, rel=3e-9)


def test_the_default_range_covers_what_a_scene_meets() -> None:
    """Large beads in water leave their bridge beyond St 100 only, a soft pair in syrup rebounds below 1e-4."""
    beads = Scene.load("glass-beads-water").with_entries(
        {"particles.diameter": "2 mm", "particles.dry_restitution": 0.6}
    )
    soft = Scene.from_dict({
        "particles": {"radius": 2.5e-4, "density": 4700.0, "roughness": 2e-8, "dry_restitution": 0.8,
                      "youngs_modulus": 8e8, "poisson_ratio": 0.3},
        "liquid": {"viscosity": 880.0, "film_thickness": 8.7e-6},
    })  # fmt: skip
    for scene, beyond in ((beads, lambda stokes: stokes > 100), (soft, lambda stokes: stokes < 1e-4)):
        found = boundary(scene, angle=0.0)
        wide = boundary(scene, angle=0.0, stokes=(1e-8, 1e8)).changes[0]
        assert [one.stokes for one in found.changes[0]] == pytest.approx([one.stokes for one in wide], rel=3e-9)
        assert any(beyond(one.stokes) for one in wide)
    assert boundary("granulation", angle=0.9).window == (1e-4, 100.0)


def test_no_change_is_said_with_its_range() -> None:
    """The sentence has the Stokes numbers that were searched and their normal speeds, in a table and over an entry."""
    done = run("boundary", "granulation", "--angle", "60:60:1", "--stokes", "1:2")
    speed = Scene.load("granulation").speed_of(1.0)
    assert f"no change for St 1 to 2 (normal speed {speed:.4g} to {2 * speed:.4g} m/s)" in done.stdout
