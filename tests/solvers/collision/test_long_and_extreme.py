"""What physics decides however long it takes, what ends for want of steps, and numbers that are out of range."""

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from wetdoublet.solvers import ComputationError, InputError, Scene, boundary, collide_many, collide_pair, regime_map
from wetdoublet.solvers.engines.casadi.locate import EventLocator
from wetdoublet.solvers.engines.settings import (
    CASADI_STEPS,
    CASADI_STEPS_IN_SPACE,
    KERNEL_STEPS,
    KERNEL_STEPS_IN_SPACE,
    RTOL,
    STEPS,
    STEPS_IN_SPACE,
    Budget,
    casadi_steps,
)
from wetdoublet.solvers.engines.taylor.call import Impacts, run_kernel
from wetdoublet.solvers.export.law.kernels import SPACE, kernels
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model

from ...helpers.entries import CIRCLES
from ...helpers.reference import collide

pytestmark = pytest.mark.slow

WEAK = {
    "particles": {
        "radius": 9.06e-05, "mass": 8.02e-09, "roughness": 1.94e-08, "dry_restitution": 0.987,
        "youngs_modulus": 1.8e11, "poisson_ratio": 0.11,
    },
    "partner": {"wall": True},
    "liquid": {"viscosity": 0.138, "film_thickness": 4.16e-06, "glass_transition_pressure": 1.97e5},
    "attraction": {"hamaker": 9.34e-21},
    "model": {"film": "cavitating"},
}  # fmt: skip
GLASSY = {
    "particles": {"radius": 1.6e-06, "density": 1530.0, "roughness": 1.15e-10, "dry_restitution": 1.0},
    "partner": {"radius": 4.95e-07, "density": 1230.0},
    "liquid": {"viscosity": 4.05e-4, "film_thickness": 1.27e-09, "glass_transition_pressure": 1.78e5},
    "bridge": {"surface_tension": 3.83e-3, "volume": 2e-4, "contact_angle": 1.487, "law": "willett"},
    "attraction": {"hamaker": 7.2e-18},
}
HELD = {
    "particles": {"radius": 7.19e-3, "density": 815.0, "roughness": 1.05e-4, "dry_restitution": 0.586},
    "partner": {"radius": 7.47e-3, "density": 1517.0},
    "liquid": {"viscosity": 0.0241, "film_thickness": 2.93e-4, "glass_transition_pressure": 4.6e5},
    "attraction": {"hamaker": 9.1e-22},
    "model": {"film": "infinite", "tangential": "film"},
}


def test_a_long_approach_to_a_wall_ends_as_head_on() -> None:
    """Beside a wall a stick that head-on is proved after 1e6 x0/v0 is proved there, when sliding has died long ago."""
    scene = Scene.from_dict(WEAK)
    flat, straight = (collide(scene, stokes=3.4e-3, angle=angle, engine="cvodes") for angle in (1.1, 0.0))
    assert (flat.outcome, flat.certified) == (straight.outcome, straight.certified) == ("stick", True)
    assert flat.until == pytest.approx(straight.until, rel=1e-6)
    assert flat.energy is not None and flat.energy.tangential_lubrication > 0


def test_sliding_beside_a_wall_in_closed_form() -> None:
    """Slide and spin are two exponentials of one integral over the head-on motion, here known: a film alone."""
    changes: dict[str, Any] = {"partner.wall": True, "particles.roughness": "3 um", "particles.dry_restitution": 0.7}
    given = {k: v for k, v in Scene.load("granulation-dry-bridge").given if "youngs" not in k and "poisson" not in k}
    scene = Scene("", tuple({**given, **changes, "liquid.glass_transition_pressure": 1e15}.items()))
    found = collide(scene, stokes=1.5, angle=0.9, rtol=1e-11)
    n = nondimensionalise(scene, found.speed, 0.9)
    stokes, aspect, low = (n.groups[name] for name in ("stokes", "aspect", "rough_gap"))

    def lost(s: float) -> float:
        return (-math.log(s) - 1.5 + 2 * s - s * s / 2) / stokes

    rebound = 0.7 * (1 - lost(low))
    speeds = (lambda s: 1 - lost(s), lambda s: rebound - (lost(low) - lost(s)))
    assert found.restitution == pytest.approx(speeds[1](1.0), rel=1e-9)
    passed = sum(quad(lambda s, v=v: math.log(2 / (aspect * s)) / v(s), low, 1, epsrel=1e-12)[0] for v in speeds)
    # d(slide, roll)/dt = -k ln(2a/x) ((4, -1), (-5/2, 10)) (slide, roll), the logarithms of Goldman, Cox & Brenner
    matrix = 2 * aspect / (15 * stokes) * np.array([[4.0, -1.0], [-2.5, 10.0]])
    rates, modes = np.linalg.eig(matrix)
    slide, roll = modes @ (np.exp(-rates * passed) * np.linalg.solve(modes, [1.0, 0.0]))
    assert found.tangential_restitution == pytest.approx(slide, rel=1e-8)
    assert found.final_spin == pytest.approx(roll * n.rate, rel=1e-8)


def test_what_is_left_of_sliding_keeps_its_sign_and_digits() -> None:
    """A slide of 1e-10 of the first is as accurate as one of order 1, and positive, as the modes say."""
    wall = Scene.load("granulation").with_entries({"partner.wall": True})
    loose, sharp = (collide(wall, stokes=0.0403, angle=1.2, engine="rosenbrock", rtol=rtol) for rtol in (1e-9, 1e-12))
    for name in ("tangential_restitution", "final_spin"):
        one, exact = getattr(loose, name), getattr(sharp, name)
        assert exact > 0 and one == pytest.approx(exact, rel=1e-6)
    assert sharp.tangential_restitution is not None and sharp.tangential_restitution < 1e-9


def test_an_endless_step_misses_no_rupture() -> None:
    """Beyond the film, under a constant force, the series end and a step is endless: the kernel parts as Rosenbrock."""
    scene = Scene.load("granulation").with_entries({"bridge.law": "constant"})
    stokes = np.geomspace(0.13, 0.4, 6)
    found, expected = (collide_many(scene, stokes=stokes, angle=0.0, engine=each) for each in ("taylor", "rosenbrock"))
    assert (expected.outcome.values[1:] == 2).all()
    assert found.outcome.values.tolist() == expected.outcome.values.tolist()
    np.testing.assert_allclose(found.restitution, expected.restitution, atol=1e-8)


def test_a_weakly_attracted_pair_is_a_proved_stick() -> None:
    """What attracts two unequal spheres outweighs, up to the end of the film, all the energy that they have left."""
    found = collide(Scene.from_dict(HELD), stokes=8.1e-3, angle=1.466e-4, engine="rosenbrock")
    assert (found.outcome, found.certified) == ("stick", True)


def test_chatter_of_a_pair_ends() -> None:
    """Perfectly elastic rebounds on glassy liquid, none higher than the one before: a stick, but no theorem."""
    found = collide(Scene.from_dict(GLASSY), stokes=0.0154, angle=1.56, engine="rosenbrock", ledger=False)
    assert (found.outcome, found.certified) == ("stick", False)
    assert 40 < len(found.events) < 80


AGAIN_AND_AGAIN = {
    "particles": {
        "radius": 4.572e-3, "mass": 1.49e-4, "roughness": 2.218e-9, "dry_restitution": 0.216,
        "youngs_modulus": 6.578e14, "poisson_ratio": 0.3834,
    },
    "liquid": {"viscosity": 0.0633, "film_thickness": 2.603e-6, "glass_transition_pressure": 2.283e7},
    "bridge": {"surface_tension": 0.5783, "volume": 3.386e-4, "contact_angle": 0.9966, "law": "willett-simple"},
}  # fmt: skip


def test_a_pair_that_rebounds_again_and_again_is_given_up() -> None:
    """In space too a collision takes no more steps than its budget, and says how many, where and when they ended."""
    velocities, spins = [[0.1297, -0.01152, 0.08369], [0, 0, 0]], [[-74.6, -75.2, -13.4], [-11.8, 13.2, 376.5]]
    found = collide_pair(Scene.from_dict(AGAIN_AND_AGAIN), [0, 0, 1], velocities, spins, engine="rosenbrock")
    reason = str(found.reason.values)
    assert (int(found.outcome), math.isnan(float(found.restitution))) == (-1, True)
    assert reason.startswith(f"{CASADI_STEPS_IN_SPACE} steps in ")
    assert all(part in reason for part in (" in phase ", " at t = ", "gap = ", "again and again: try "))


def test_the_exported_law_has_the_same_budget() -> None:
    """Each kernel of the law is given the steps of the settings, fewer in space, where a step takes longer."""
    for own in kernels(Scene.load("granulation"), 1e-9):
        steps = STEPS_IN_SPACE if own.prefix == SPACE else STEPS
        assert f"MOST_STEPS_TAKEN = {steps} " in own.generated_files["in_si.h"]


def test_both_engines_share_the_budget() -> None:
    """What the kernel may take, and CasADi after it, is together what CasADi alone may take."""
    for space, alone, kernel, whole in (
        (False, CASADI_STEPS, KERNEL_STEPS, STEPS),
        (True, CASADI_STEPS_IN_SPACE, KERNEL_STEPS_IN_SPACE, STEPS_IN_SPACE),
    ):
        assert casadi_steps(RTOL, space) == alone
        assert casadi_steps(RTOL, space, spent=KERNEL_STEPS) / alone + kernel / whole == 1


def test_steps_are_counted() -> None:
    """A collision that has spent its steps ends with phase, time, state, and how many phases they went into."""
    scene = Scene.load("granulation")
    n = nondimensionalise(scene, scene.speed_of(0.02), math.radians(75))
    model = load(select_model(scene, oblique=True, fold=True))
    whole = Budget(CASADI_STEPS)
    EventLocator(model, n.groups, 1e-9, budget=whole).run()
    assert 25 < whole.spent < CASADI_STEPS / 20
    with pytest.raises(ComputationError, match="steps in . phases have not decided the outcome") as raised:
        EventLocator(model, n.groups, 1e-9, budget=Budget(whole.spent - 1)).run()
    assert raised.value.phase and raised.value.time and raised.value.state
    found = EventLocator(model, n.groups, 1e-9, budget=Budget(3 * whole.spent)).run()
    assert found.outcome == "stick-rotate-separate"


@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_one_extreme_point_leaves_the_others(engine: str) -> None:
    """A map from 1e-300 to 1e300 has its points in between; what is out of range is marked."""
    data = regime_map("granulation", stokes=[1e-300, 0.2, 1e300, 1.7e308], angle=1.0, engine=engine, of=())
    assert data.outcome.values.tolist() == [[-1, 2, -1, -1]]
    assert all("impact.speed" in reason for reason in data.reason.values[data.outcome.values == -1])


@pytest.mark.parametrize(
    ("impact", "changes"),
    [
        ({"stokes": 1e308}, {}),
        ({"stokes": 1e-320}, {}),
        ({"speed": 1e200}, {}),
        ({"stokes": 0.1}, {"liquid.viscosity": 1e250}),
        ({"stokes": 0.1}, {"particles.reduced_mass": 1e-300}),
        ({"stokes": 0.1}, {"bridge.surface_tension": 1e-200}),
    ],
)
def test_extreme_numbers_are_bad_input(impact: dict[str, float], changes: dict[str, float]) -> None:
    """Where groups or scales leave their range, that is said of an entry, and collisions are marked."""
    scene = Scene.load("granulation").with_entries(changes)
    with pytest.raises(InputError, match="is too far off.*; accepted: "):
        collide(scene, angle=1.0, **impact)
    found = collide_many(scene, angle=[1.0, 0.5], of=("contact_time",), **impact)
    assert found.outcome.values.tolist() == [-1, -1]


@pytest.mark.parametrize("span", [(1e-300, 1.0), (1e-3, 1e300)])
def test_extreme_spans_are_bad_input(span: tuple[float, float]) -> None:
    """A boundary is looked for among Stokes numbers that can be told apart: the range is said."""
    with pytest.raises(InputError, match=r"^impact.stokes: .* is too far off; accepted: from 1e-30 to 1e\+30$"):
        boundary("granulation", angle=0.5, stokes=span)


def test_a_spin_beyond_all_bounds_is_named() -> None:
    """A spin that no double resolves beside the speed is refused by its own name."""
    with pytest.raises(InputError, match=r"^impact.spin: 1e\+150 is too far off; accepted: "):
        collide(Scene.load("granulation").with_entries({"impact.spin": 1e150}))


def test_circling_is_decided_by_its_limit() -> None:
    """A doublet that dips ever less into its film has the outcome of its limit: millions of steps on either side agree.

    The limit depends on the angular momentum and the bridge alone, so angles have one Ce*.
    """
    scene = Scene.from_dict(CIRCLES)
    angles = np.array([0.4465, 0.5])
    found = boundary(scene, angle=angles, stokes=(0.005, 0.05))
    assert not found.failed
    first, second = (line[0] for line in found.changes)
    assert (first.before, first.after) == ("stick", "stick-rotate-separate")
    assert first.centrifugal == pytest.approx(second.centrifugal, rel=1e-8)
    aside = first.stokes * np.array([1 - 3e-5, 1 + 3e-5])
    speed = aside / scene.stokes_per_speed
    told = run_kernel(Impacts(scene, speed, np.full(2, 0.4465), {}), 1e-9, budget=3_000_000)
    if told is not None:  # there is a kernel
        assert told["status"].tolist() == [0, 0]
        assert told["outcome"].tolist() == [0, 1]


def test_a_sliding_that_has_died_away_does_not_stop_rosenbrock():
    """Far from the wall the energy's rates are of the order exp(-370): their squares, which underflow, once failed."""
    scene = Scene.from_dict(
        {
            "particles": {"reduced_radius": 8.95e-6, "density": 1611.0, "roughness": 3.69e-10, "dry_restitution": 0.081,
                          "youngs_modulus": 4.4757e6, "poisson_ratio": 0.216},
            "liquid": {"viscosity": 1063.0, "film_thickness": 1.598e-7, "glass_transition_pressure": 1.01e7},
            "bridge": {"surface_tension": 0.607, "volume": 1.86e-5, "contact_angle": 1.541, "law": "constant"},
            "model": {"glass": "film-corrected"},
            "partner": {"wall": True},
            "impact": {"stokes": 0.0098, "angle": 1.56875},
        }
    )  # fmt: skip
    ours, kernel = (collide(scene, engine=engine, rtol=1e-9) for engine in ("rosenbrock", "taylor"))
    assert ours.outcome == kernel.outcome == "bounce"
    assert ours.restitution == pytest.approx(kernel.restitution, rel=1e-8)
    assert ours.energy is not None
    assert abs(ours.energy.residual) < 1e-9 * ours.energy.initial


def test_sliding_a_million_times_faster_than_the_approach_keeps_the_gaps_digits():
    """What sliding dissipates, 7e5 times the energy of the approach, takes no digit of the gap with it: e_n to 1e-8."""
    scene = Scene.from_dict(
        {
            "particles": {"reduced_radius": 1.78978e-4, "density": 17253.0, "roughness": 1.96899e-6,
                          "dry_restitution": 0.174873, "youngs_modulus": 1.25661e8, "poisson_ratio": 0.436472,
                          "friction": 0.3397, "contact_tangential_restitution": 0.0},
            "liquid": {"viscosity": 7.43673e-5, "film_thickness": 1.40519e-5, "glass_transition_pressure": 3549.08},
            "model": {"arm": "midgap", "film": "finite", "tangential": "immersed", "glass": "film-corrected",
                      "contact_friction": "solid"},
            "partner": {"radius": 2.87444e-4, "density": 25823.2},
            "attraction": {"hamaker": 1.216e-26},
            "impact": {"stokes": 5.51096e-6, "angle": 1.57061},
        }
    )  # fmt: skip
    ours, kernel = (collide(scene, engine=engine, rtol=1e-9) for engine in ("rosenbrock", "taylor"))
    assert ours.outcome == kernel.outcome == "stick-rotate-separate"
    assert ours.restitution == pytest.approx(kernel.restitution, rel=1e-8)
    assert ours.energy is not None and ours.energy.initial > 1e6 * kernel.energy.normal_lubrication


EXHAUSTED = {
    "particles": {"reduced_radius": 1.08263e-5, "density": 2236.23, "roughness": 7.50108e-15, "friction": 0.0961143,
                  "dry_restitution": 0.527421, "youngs_modulus": 8.42353e9, "poisson_ratio": 0.25034,
                  "contact_tangential_restitution": 0.454073},
    "liquid": {"viscosity": 541.824, "film_thickness": 3.05244e-9, "glass_transition_pressure": 1.92921e11},
    "bridge": {"surface_tension": 1.46833e-3, "volume": 3.80431e-3, "contact_angle": 0.486209, "law": "lambert"},
    "model": {"tangential": "film", "contact_friction": "all"},
    "partner": {"radius": 9.91556e-5, "density": 3473.93},
    "impact": {"stokes": 3.87337e-6, "angle": 0.0418748, "spin": 1109.49, "partner_spin": -27249.3},
}  # fmt: skip
ON_THE_EDGE = {
    "particles": {"reduced_radius": 1.38822e-4, "density": 519.069, "roughness": 8.20202e-9, "dry_restitution": 0.0,
                  "youngs_modulus": 1.21852e10, "poisson_ratio": 0.336057, "friction": 0.034162,
                  "contact_tangential_restitution": 1.0},
    "liquid": {"viscosity": 40.8259, "film_thickness": 8.8255e-6, "glass_transition_pressure": 11509.7},
    "bridge": {"surface_tension": 1.19837e-4, "volume": 4.68131e-5, "contact_angle": 0.883566},
    "model": {"tangential": "film"},
    "impact": {"stokes": 524.211, "angle": 0.0, "spin": 2.06406e9},
}  # fmt: skip


@pytest.mark.parametrize("rtol", [1e-6, 1e-9, 1e-11, 1e-12])
@pytest.mark.parametrize("entries", [EXHAUSTED, ON_THE_EDGE])
def test_a_contact_that_only_its_own_friction_turns_is_never_released(entries: dict[str, Any], rtol: float) -> None:
    """Friction is proportional to the reaction, which it can lower to nothing but not reverse: a stick for each engine.

    It is proved, and one that rests on the edge of the shear, where it vanishes, too.
    """
    scene = Scene.from_dict(entries)
    found = [collide(scene, engine=engine, rtol=rtol) for engine in ("taylor", "rosenbrock", "cvodes")]
    assert [(each.outcome, each.events[-1].kind) for each in found] == [("stick", "rests")] * 3
    assert all(each.certified for each in found)
    by_kernel = collide_many(scene, engine="taylor", rtol=rtol)
    assert (by_kernel.outcome.item(), by_kernel.certified.item()) == (0, True)


def test_an_exhausted_contact_stays_when_followed_on() -> None:
    """Long after the proof, with a reaction of rounding errors only, the contact still holds: nothing releases it."""
    until = 100 * collide(Scene.from_dict(EXHAUSTED), engine="rosenbrock").until
    found = collide(Scene.from_dict(EXHAUSTED), engine="rosenbrock", until=max(until, 10.0))
    assert (found.outcome, found.events[-1].kind) == ("stick", "rests")


def test_strings_that_pull_a_million_times_faster_than_the_approach_keep_the_ledger():
    """Work of strings of 1e12 of the energy of the approach: Rosenbrock's ledger closes, and is CVODES'."""
    scene = Scene.from_dict(
        {
            "particles": {"reduced_radius": 1.34394e-3, "density": 2617.44, "roughness": 5.51467e-6,
                          "dry_restitution": 0.376264, "youngs_modulus": 2.71279e6, "poisson_ratio": 0.47309},
            "liquid": {"viscosity": 9.27384e-5, "film_thickness": 9.06288e-4, "glass_transition_pressure": 9.92989e9},
            "pendulum": {"length": 0.672202, "gravity": 0.39167, "law": "small-angle"},
            "impact": {"stokes": 1.91989e-5, "angle": 0.0},
        }
    )  # fmt: skip
    ours, other = (collide(scene, engine=engine, rtol=1e-9) for engine in ("rosenbrock", "cvodes"))
    assert ours.outcome == other.outcome == "stick"
    assert ours.energy is not None and other.energy is not None
    lost, expected = ours.energy.normal_lubrication, other.energy.normal_lubrication
    assert lost == pytest.approx(expected, rel=1e-7) and lost > 1e10 * ours.energy.initial
    assert abs(ours.energy.residual) < 1e-9 * lost


def test_a_spin_that_stays_zero_does_not_stop_a_creep() -> None:
    """Implicit steps measure no error where a state is zero and does not change: 70,000 of them led nowhere."""
    scene = Scene.from_dict(
        {
            "particles": {
                "reduced_radius": 5.4567314190352894e-05, "reduced_mass": 1.0615083483106647e-08,
                "roughness": 6.202658156670815e-07, "dry_restitution": 0.30736409654641805,
                "youngs_modulus": 7419163955.700603, "poisson_ratio": 0.40134356186426184,
            },
            "partner": {"radius": 1.3455705211500345e-05, "mass": 6.575729332956459e-08},
            "liquid": {
                "viscosity": 6.182860522181882, "film_thickness": 4.108247651403465e-05,
                "glass_transition_pressure": 64101457.42919423,
            },
            "model": {"glass": "film-corrected", "film": "infinite"},
        }
    )  # fmt: skip
    creeping = np.geomspace(0.0025, 0.0032, 41)[37]
    found = collide_many(scene, stokes=creeping * np.array([1.0, 1.0 + 1e-9]), angle=0.37038374872590746, of=("steps",))
    assert found.steps.max() < 1000


def test_a_film_alone_at_a_tiny_angle_has_its_ledger() -> None:
    """A creep of 1e13 of its times: rounding of the momenta's exchange does not hold up the implicit steps."""
    scene = Scene.from_dict(
        {
            "particles": {
                "reduced_radius": 8.943655292652102e-05, "reduced_mass": 9.567300970252206e-08,
                "roughness": 5.609211718580454e-09, "dry_restitution": 0.5814757704088492,
                "youngs_modulus": 168544678897.12454, "poisson_ratio": 0.18911001352777418,
            },
            "liquid": {"viscosity": 1.7240318492921058, "film_thickness": 1.4092898991587152e-06},
            "impact": {"stokes": 0.13219499687607913, "angle": 9.459265e-06},
        }
    )  # fmt: skip
    found, plain = (collide(scene, engine=None, ledger=ledger) for ledger in (True, False))
    assert found.engine == plain.engine == "taylor"
    assert found.steps < KERNEL_STEPS / 4
    assert found.restitution == pytest.approx(plain.restitution, rel=1e-7)
    assert not found.energy.is_open(RTOL)
