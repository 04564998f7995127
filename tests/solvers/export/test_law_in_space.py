"""Collisions in space by the exported law: as `collide_pair`, in every frame, with no silent NaN."""

import math
import subprocess
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide_pair
from wetdoublet.solvers.collision.space.pairs import Bodies
from wetdoublet.solvers.export.law.texts import source

from ...helpers.exported_law import FOUND, Law, law_alone
from ...helpers.flags import QUICK
from .conftest import OWN, SPHERES, STRICT, WALL

pytestmark = pytest.mark.skipif("gcc" not in FOUND, reason="needs gcc and g++")


def arrivals(scene: Scene, count: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normals, velocities and spins of pairs that approach; a third in a plane, some along the line of centres."""
    draw, a = np.random.default_rng(seed), float(scene.material["reduced_radius"])
    normal = draw.normal(size=(count, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    speed = 10 ** draw.uniform(-1.7, 1.5, count)[:, None] / scene.stokes_per_speed
    velocities = draw.normal(size=(count, 2, 3)) * speed[:, None]
    opening = np.sum(normal * (velocities[:, 1] - velocities[:, 0]), axis=1, keepdims=True)
    velocities[:, 1] -= (opening + speed) * normal
    spins = 0.3 * draw.normal(size=(count, 2, 3)) * (speed / a)[:, None]
    axis = np.cross(normal, velocities[:, 1] - velocities[:, 0])
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    spins[::3] = np.sum(spins * axis[:, None], axis=2, keepdims=True)[::3] * axis[::3, None]
    velocities[::10, 1] = velocities[::10, 0] - (speed * normal)[::10]
    spins[::10] = 0.0
    spins[10::20] = 30.0 * normal[10::20, None] * (speed / a)[10::20, None]  # twist alone
    return normal, velocities, spins


def close(found: np.ndarray, expected: np.ndarray, scale: np.ndarray, rtol: float = 1e-6) -> None:
    """Vectors by their length, beside a scale."""
    apart, size = (np.linalg.norm(np.nan_to_num(each), axis=-1) for each in (found - expected, scale))
    assert np.array_equal(np.isnan(found), np.isnan(expected))
    assert np.all(apart <= rtol * size), (apart / size).max()


def agree(law: Law, scene: Scene, count: int) -> None:
    """All that the law says beside `collide_pair`; a stick is the same to rounding."""
    normal, velocities, spins = arrivals(scene, count)
    mine = 1 if scene.wall else 2
    spins = spins[:, :mine]
    found = law.collide_pairs(law.pairs(3.0 * normal, velocities, spins))
    expected = collide_pair(scene, normal, velocities, spins, engine="taylor")
    assert np.array_equal(found["outcome"], expected.outcome.values)
    assert set(found["outcome"]) >= {0, 2}
    assert np.array_equal(found["certified"] != 0, expected.certified.values)
    away = found["outcome"] > 0
    for name in ("restitution", "time", "gap", "slip_restitution"):
        np.testing.assert_allclose(found[name][away], expected[name].values[away], rtol=1e-7)
    assert not found["time"][~away].any()
    for name in ("position", "normal", "velocities", "spins", "centre_velocity", "angular_velocity"):
        scale = {"velocities": velocities, "spins": np.abs(spins).max(axis=1, keepdims=True) + 1.0}
        scale |= {"centre_velocity": velocities[:, 0], "angular_velocity": np.abs(spins).max(axis=1) + 1.0}
        given = expected[name].values
        for rows, rtol in ((away, 1e-6), (~away, 1e-12)):
            close(found[name][rows], given[rows], scale.get(name, given)[rows], rtol)


def test_two_spheres_are_those_of_collide_pair(law: Law):
    """In planes, out of them and along the line of centres."""
    agree(law, SPHERES, 40)


RUBS = {"particles.friction": 0.2, "particles.contact_tangential_restitution": 0.5, "model.contact_friction": "all"}
RESTS = {"particles.friction": 0.1, "particles.dry_restitution": 0.2, "liquid.viscosity": "1 mPa s"}
OTHERS = {
    "in solid contact": OWN.with_entries({**RESTS, "liquid.glass_transition_pressure": "1e12 Pa"}),
    "rubbing": OWN.with_entries(RUBS),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", OTHERS)
def test_others_are_those_of_collide_pair(name: str, tmp_path: Path):
    """Solid contact until rotation opens it; friction at every rebound."""
    scene = OTHERS[name]
    agree(Law(scene, law_alone(scene, tmp_path), *STRICT), scene, 60)


@pytest.mark.slow
def test_a_wall_that_moves_is_that_of_collide_pair(walled: tuple[Path, Law]):
    """Sliding, rolling and twist beside it."""
    agree(walled[1], WALL, 60)


def test_what_cannot_collide_has_a_status(law: Law):
    """No direction, no number, receding, beyond range: NaN and a reason; sound pairs beside them are computed."""
    nan, inf, still = math.nan, math.inf, [0.0, 0.0, 0.0]
    ahead, none = [[0.0, 0.0, 0.5], still], [still, still]
    wanted = {
        "NO_DIRECTION": [(still, ahead, none), ([0, nan, 1], ahead, none), ([inf, 0, 0], ahead, none)],
        "NOT_A_NUMBER": [([0, 0, 1], [[0, 0, nan], still], none), ([0, 0, 1], ahead, [still, [0, inf, 0]])],
        "NOT_APPROACHING": [([0, 0, -1], ahead, none), ([0, 0, 1], none, none), ([1, 0, 0], ahead, none)],
        "OUT_OF_RANGE": [
            ([0, 0, 1], [[0, 0, 1e200], still], none), ([0, 0, 1], [[0, 0, 1e-300], still], none),
            ([0, 0, 1], ahead, [[1e200, 0, 0], still]),
        ],
        "UNDECIDED_TOO_OBLIQUE": [
            ([0, 0, 1], [[1e9, 0, 1], still], none), ([0, 0, 1], ahead, [[1e14, 1e12, 5], still]),
        ],
        "OK": [
            ([0, 0, 5e-324], ahead, none), ([1e308] * 3, [[0.5] * 3, still], none),
            ([0, 0, 1], [[0, 0, 80.0], still], [[0, 0, 1e6], [0, 0, -1e6]]),  # twist alone
            ([0, 0, 1], ahead, [[1e-200, 1e-300, 0], still]),
        ],
    }  # fmt: skip
    names = [name for name, rows in wanted.items() for _ in rows]
    normal, velocities, spins = (np.array([row[k] for rows in wanted.values() for row in rows]) for k in range(3))
    found = law.collide_pairs(law.pairs(normal, velocities, spins))
    assert found["status"].tolist() == [law.number(name) for name in names]
    sound = found["status"] == 0
    for name in ("restitution", "time", "position", "normal", "velocities", "spins", "centre_velocity"):
        numbers = np.isfinite(found[name].reshape(sound.size, -1))
        assert numbers[sound].all(), name
        assert not numbers[~sound].any(), name
    assert np.all(found["outcome"][~sound] == law.number("UNDECIDED"))
    assert "approach" in law.message(law.number("NOT_APPROACHING"))
    material = law.material()
    material["viscosity"] = nan
    refused = law.collide_pairs(law.pairs(normal, velocities, spins), material=material)
    assert np.all(refused["status"] == law.number("BAD_VISCOSITY"))


def test_particles_are_moved_in_place(law: Law):
    """Momentum and angular momentum about the origin, and the centre of mass; without an answer nothing moves."""
    bodies = Bodies.of(SPHERES)
    mass, inertia = np.array(bodies.mass)[:, None], np.array(bodies.inertia)[:, None]
    normal, velocities, spins = arrivals(SPHERES, 12, seed=6)
    for k in range(12):
        both = np.zeros(2, law.dtype("particle"))
        both["position"] = [[1e-3, -2e-3, 5e-4], np.array([1e-3, -2e-3, 5e-4]) + law.contact_distance() * normal[k]]
        both["velocity"], both["spin"] = velocities[k], spins[k]
        before = both.copy()
        after = law.collide_particles(both)[0]
        pair = law.collide_pairs(law.pairs(normal[k], velocities[k : k + 1], spins[k : k + 1]))[0]
        assert after["outcome"] == pair["outcome"]
        assert np.array_equal(both["velocity"], after["velocities"])
        assert both["position"][1] - both["position"][0] == pytest.approx(after["position"], abs=1e-15)
        centres = [np.sum(mass * each["position"], axis=0) / mass.sum() for each in (before, both)]
        drift = np.sum(mass * before["velocity"], axis=0) / mass.sum()
        assert centres[1] == pytest.approx(centres[0] + after["time"] * drift, rel=1e-9, abs=1e-12)
        turning = [
            np.sum(mass * np.cross(each["position"], each["velocity"]) + inertia * each["spin"], axis=0)
            for each in (before, both)
        ]
        assert turning[1] == pytest.approx(turning[0], abs=1e-9 * np.abs(turning[0]).max())
    before["velocity"] *= -1
    both = before.copy()
    assert law.collide_particles(both)[0]["status"] == law.number("NOT_APPROACHING")
    assert both.tobytes() == before.tobytes()


def test_a_pair_found_late_is_brought_back_to_contact(law: Law):
    """The same end as of the pair at contact, at the same moment; momentum and angular momentum as found."""
    bodies = Bodies.of(SPHERES)
    mass, inertia = np.array(bodies.mass)[:, None], np.array(bodies.inertia)[:, None]
    normal, velocities, spins = arrivals(SPHERES, 12, seed=7)
    distance = law.contact_distance()
    for k in range(12):
        both = np.zeros(2, law.dtype("particle"))
        both["position"][1], both["velocity"], both["spin"] = distance * normal[k], velocities[k], spins[k]
        late = both.copy()
        way = np.linalg.norm(velocities[k, 1] - velocities[k, 0])
        delay = (-1) ** k * 1e-3 * distance / way  # also early
        late["position"] += delay * late["velocity"]
        turning = np.sum(mass * np.cross(late["position"], late["velocity"]) + inertia * late["spin"], axis=0)
        in_time, found = law.collide_particles(both)[0], law.collide_particles(late, tolerance=2e-3)[0]
        assert found["outcome"] == in_time["outcome"]
        assert found["time"] == pytest.approx(in_time["time"] - delay, rel=1e-6, abs=1e-12)
        for name, scale in (("position", distance), ("velocity", way), ("spin", way / distance)):
            assert late[name] == pytest.approx(both[name], abs=1e-6 * scale)
        after = np.sum(mass * np.cross(late["position"], late["velocity"]) + inertia * late["spin"], axis=0)
        assert after == pytest.approx(turning, abs=1e-9 * np.abs(turning).max())


def test_a_pair_that_is_not_in_contact_stays(law: Law):
    """Too far, too near, or on paths that pass each other: refused, with the tolerance that is asked for."""
    distance = law.contact_distance()
    cases = (
        (1e-9, 0.1, [0, 0, -1.0], "NOT_IN_CONTACT"), (0.5, 0.1, [0, 0, -1.0], "NOT_IN_CONTACT"),
        (100.0, 0.1, [0, 0, -1.0], "NOT_IN_CONTACT"), (1.01, 0.02, [0, 1.0, -0.1], "NOT_IN_CONTACT"),
        (1.01, np.nan, [0, 0, -1.0], "BAD_TOLERANCE"), (1.0, -1e-9, [0, 0, -1.0], "BAD_TOLERANCE"),
    )  # fmt: skip
    for share, tolerance, velocity, status in cases:
        both = np.zeros(2, law.dtype("particle"))
        both["position"][1, 2], both["velocity"][1] = share * distance, velocity
        before = both.copy()
        found = law.collide_particles(both, tolerance=tolerance)[0]
        assert found["status"] == law.number(status)
        assert both.tobytes() == before.tobytes()


@pytest.mark.parametrize(
    ("scene", "why"),
    [
        (Scene.load("pendulum"), "pendulum hold the spheres in one plane"),
        (WALL.with_entries({"particles.friction": 0.3}), "particles.friction couples the directions along a wall"),
    ],
)
def test_the_header_says_why_there_is_none(scene: Scene, why: str):
    """Scenes whose collisions are in a plane only."""
    said = " ".join(source(scene).header.replace(" * ", " ").split())
    assert why in said
    assert "#define LAW_IN_SPACE 0" in said
    assert "law_collide_pair(const" not in said


@pytest.mark.slow
def test_an_end_with_more_energy_than_its_beginning_is_refused(folder: Path, law: Law, tmp_path: Path):
    """A separation as fast as the approach is an answer; one at twice that speed, which no contact allows, is none."""
    name = law.name
    probe = tmp_path / "probe.c"
    probe.write_text(
        f'#include "{folder / name}.c"\n'
        "int main(void)\n{\n"
        "    bodies b = {0};\n    arrival a = {0};\n"
        f"    {name}_pair_after made;\n"
        "    b.film = 0.01;\n    b.contact = b.reduced_mass = a.speed = a.velocity[0].x = 1.0;\n"
        "    b.mass[0] = b.mass[1] = 2.0;\n    b.inertia[0] = b.inertia[1] = 0.8;\n    a.normal.x = 1.0;\n"
        "    ending e = as_arrived(&b, &a);\n"
        f"    e.outcome = {name.upper()}_BOUNCE;\n"
        "    for (int times = 1; times <= 2; times++) {\n        e.opening = times;\n"
        "        both_after(&b, &a, &e, &made);\n"
        '        printf("%d %d %g ", made.status, made.outcome, made.velocities[1][0]);\n    }\n    return 0;\n}\n'
    )
    command = f"gcc -std=c99 {QUICK} -include stdio.h {probe} -o {tmp_path}/probe -lm".split()
    subprocess.run(command, check=True)
    said = subprocess.run([tmp_path / "probe"], capture_output=True, text=True, check=True).stdout.split()
    refused = law.number("UNDECIDED_NOT_FINITE")
    assert said == ["0", str(law.number("BOUNCE")), "1", str(refused), str(law.number("UNDECIDED")), "nan"]
    assert "energy" in law.message(refused)
