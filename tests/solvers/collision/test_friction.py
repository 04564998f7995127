"""Friction of the dry contact against closed forms, between engines, and against differences."""

import math
from typing import Any

import pytest
from wetdoublet.solvers import Collision, ComputationError, InputError, Scene, sensitivities
from wetdoublet.solvers.model.model import select_model

from ...helpers.reference import collide

# Hardly any film, and no bridge: what is left is the impact of dry spheres.
DRY = {"liquid.viscosity": "1e-9 Pa s", "particles.roughness": "0.5 um", "particles.dry_restitution": 0.8}
WET = {"liquid.glass_transition_pressure": "1e12 Pa", "liquid.viscosity": "0.01 Pa s", "particles.roughness": "1 um"}
ANGLE = math.radians(30)


def rough(entries: dict[str, object], friction: float, reversed_part: float = 0.0) -> Scene:
    """Granulation with friction."""
    own = {"particles.friction": friction, "particles.contact_tangential_restitution": reversed_part}
    return Scene.load("granulation").with_entries({**WET, **entries, **own})


def dry_wall(friction: float, reversed_part: float = 0.0) -> Scene:
    """A sphere beside a wall, dry but for a trace of film."""
    own = {"particles.friction": friction, "particles.contact_tangential_restitution": reversed_part}
    return Scene.load("granulation-dry-bridge").with_entries({**DRY, "partner.wall": "true", **own})


def along(scene: Scene, speed: float = 1.0) -> tuple[float, float]:
    """Sliding velocity and surface speed of the spin after an impact, over the sliding velocity before."""
    found = collide(scene, speed=speed, angle=ANGLE, engine="rosenbrock")
    sideways = speed * math.tan(ANGLE)
    return found.tangential_restitution or 0.0, (found.final_spin or 0.0) * scene.reduced_radius / sideways


@pytest.mark.parametrize("reversed_part", [0.0, 0.6])
def test_a_sphere_that_sticks_to_a_wall_leaves_rolling(reversed_part: float) -> None:
    """5/7 of its sliding velocity is left, and it rolls; a part of the slip may be reversed (Walton & Braun)."""
    sliding, rolling = along(dry_wall(5.0, reversed_part))
    assert sliding == pytest.approx(1 - 2 / 7 * (1 + reversed_part), rel=1e-6)
    assert rolling == pytest.approx(5 / 7 * (1 + reversed_part), rel=1e-6)


def test_a_sphere_that_slides_takes_coulombs_impulse() -> None:
    """That is mu (1 + e) |u|, whatever the tangential velocity, and 5/2 of that as the speed of its surface."""
    sliding, rolling = along(dry_wall(0.05))
    lost = 0.05 * 1.8 / math.tan(ANGLE)
    assert sliding == pytest.approx(1 - lost, rel=1e-6)
    assert rolling == pytest.approx(2.5 * lost, rel=1e-6)


def test_without_friction_there_is_no_such_term() -> None:
    """Neither a key of the ledger nor another structure; with a coefficient of zero the collision is the same."""
    plain = Scene.load("granulation").with_entries(WET)
    found = collide(plain, stokes=8.0, angle=ANGLE, engine="rosenbrock")
    assert found.energy is not None and "dry_friction" not in found.energy.to_dict()
    assert "friction" not in select_model(plain, True).structure
    zero = collide(rough({}, 0.0), stokes=8.0, angle=ANGLE, engine="rosenbrock")
    assert zero.restitution == pytest.approx(found.restitution, rel=1e-9)
    assert zero.final_spin == pytest.approx(found.final_spin, rel=1e-8)


def test_glass_has_friction_only_if_asked_for() -> None:
    """By default the liquid in its glassy state gives none, and the result says that friction did nothing."""
    glassy = {"liquid.glass_transition_pressure": "0.3 MPa"}
    losses = []
    for what in ("solid", "all"):
        found = collide(rough(glassy | {"model.contact_friction": what}, 0.3), stokes=20.0, angle=ANGLE)
        assert found.reversal == "glass" and found.energy is not None
        losses.append(found.energy.dry_friction)
        says = [each for each in found.validity if "friction does nothing" in each]
        assert len(says) == (what == "solid") and found.to_dict()["validity"] == list(found.validity)
    assert losses[0] == 0.0 < (losses[1] or 0.0)
    touching = collide(rough({}, 0.3), stokes=8.0, angle=ANGLE)
    assert touching.reversal == "rough" and not any("friction" in each for each in touching.validity)


def assert_the_kernel_agrees(expected: Collision, scene: Scene, **impact: Any) -> None:
    """The kernel goes through resting contact with friction itself, to the same events, losses and end."""
    assert expected.energy is not None
    for ledger in (False, True):
        found = collide(scene, engine="taylor", ledger=ledger, **impact)
        assert (found.outcome, found.certified, found.engine) == (expected.outcome, expected.certified, "taylor")
        assert [event.kind for event in found.events] == [event.kind for event in expected.events]
        times = [[event.time for event in each.events] for each in (found, expected)]
        assert times[0] == pytest.approx(times[1], rel=1e-6)
        assert found.restitution == pytest.approx(expected.restitution, rel=1e-7)
    assert found.energy is not None and abs(found.energy.residual) < 1e-8 * found.energy.largest
    for term in ("dry_friction", "tangential_lubrication", "dry_contact"):
        assert getattr(found.energy, term) == pytest.approx(
            getattr(expected.energy, term), abs=1e-7 * expected.energy.largest
        )


@pytest.mark.slow
def test_a_resting_doublet_on_strings_rolls_and_slides() -> None:
    """Both modes are met, by two integrators at the same times, and the ledger closes over them."""
    entries = {
        "liquid.glass_transition_pressure": "1e12 Pa", "particles.dry_restitution": 0.0, "particles.roughness": "20 um",
        "liquid.viscosity": "0.1 Pa s", "particles.friction": 0.3,
    }  # fmt: skip
    scene = Scene.load("pendulum").with_entries(entries)
    both = [collide(scene, stokes=20.0, angle="1 deg", engine=engine) for engine in ("rosenbrock", "cvodes")]
    for found in both:
        assert [event.kind for event in found.events] == ["rough", "rests", "rolls", "slides", "rotation reverses"]
        assert found.energy is not None and (found.energy.dry_friction or 0.0) > 0
        assert abs(found.energy.residual) < 1e-8 * found.energy.largest
    times = [[event.time for event in found.events] for found in both]
    assert times[0] == pytest.approx(times[1], rel=1e-8)
    assert_the_kernel_agrees(both[0], scene, stokes=20.0, angle="1 deg")


@pytest.mark.slow
def test_a_spinning_doublet_that_slides_at_rest_is_released() -> None:
    """Friction turns spin into rotation until the centrifugal force opens the gap; energy and L are kept account of."""
    entries = {
        **WET, "liquid.viscosity": "0.001 Pa s", "particles.dry_restitution": 0.0, "particles.friction": 0.3,
        "impact.spin": 16000.0,
    }  # fmt: skip
    scene = Scene.load("granulation").with_entries(entries)
    found = collide(scene, stokes=20.0, angle=0.0, engine="rosenbrock")
    assert [event.kind for event in found.events][:3] == ["rough", "rests", "released"]
    assert found.energy is not None and abs(found.energy.residual) < 1e-9 * found.energy.initial
    assert found.angular_momentum_drift == pytest.approx(0.0, abs=1e-12)
    assert_the_kernel_agrees(found, scene, stokes=20.0, angle=0.0)


@pytest.mark.parametrize("engine", ["rosenbrock", "taylor"])
@pytest.mark.slow
def test_where_chatter_is_cut_off_changes_no_more_than_the_tolerance(engine: str) -> None:
    """A doublet that rebounds ever less and then slides at rest is cut off at a speed that goes as its square root."""
    entries = {
        **WET, "liquid.viscosity": "0.001 Pa s", "particles.dry_restitution": 0.3, "particles.friction": 0.3,
        "impact.spin": 16000.0,
    }  # fmt: skip
    scene = Scene.load("granulation").with_entries(entries)
    coarse, fine = (
        collide(scene, stokes=20.0, angle=0.0, engine=engine, rtol=rtol, ledger=False) for rtol in (1e-7, 1e-12)
    )
    assert len(coarse.events) < len(fine.events) and "rests" in [event.kind for event in coarse.events]
    assert coarse.contact_time == pytest.approx(fine.contact_time, rel=1e-7)
    assert coarse.final_spin == pytest.approx(fine.final_spin, rel=1e-7)


@pytest.mark.slow
def test_a_doublet_that_rolls_at_rest_while_its_spins_equalise_sticks() -> None:
    """No force of release or of rolling changes there: signs of rounding in their slopes are no events."""
    entries = {
        "particles": {
            "radius": 8.3e-4, "mass": 1.65e-6, "roughness": 8e-8, "dry_restitution": 0.9, "youngs_modulus": 5e8,
            "poisson_ratio": 0.49, "friction": 1e6,
        },
        "liquid": {"viscosity": 0.12, "film_thickness": 4.3e-5, "glass_transition_pressure": 3e6},
        "impact": {"stokes": 1.45, "angle": 0.88, "spin": 1960.0, "partner_spin": -2245.0},
        "attraction": {"hamaker": 6.4e-11},
        "model": {"tangential": "film"},
    }  # fmt: skip
    found = collide(Scene.from_dict(entries), engine="rosenbrock")
    assert found.outcome == "stick" and found.certified
    assert [event.kind for event in found.events][-2:] == ["rests", "rolls"]
    for ledger in (False, True):
        by_kernel = collide(Scene.from_dict(entries), engine="taylor", ledger=ledger)
        assert (by_kernel.outcome, by_kernel.certified, by_kernel.engine) == ("stick", True, "taylor")
    assert found.energy is not None and abs(found.energy.residual) < 1e-8 * found.energy.initial


@pytest.mark.slow
def test_chatter_with_friction_on_strings_is_a_stick_as_without() -> None:
    """Rebounds without end on glassy liquid, each lower than the last: friction of solids has no part in them."""
    entries = {
        "particles": {
            "reduced_radius": "0.98 mm", "density": "1350 kg/m^3", "roughness": "0.085 nm", "dry_restitution": 0.5,
        },
        "liquid": {"viscosity": "0.168 mPa s", "film_thickness": "0.66 um", "glass_transition_pressure": "3260 Pa"},
        "bridge": {"law": "constant", "surface_tension": "0.186 N/m", "volume": 1.08e-4, "contact_angle": 0.465},
        "pendulum": {"length": "11 mm", "gravity": "62 m/s^2"},
        "model": {"film": "constant-volume"},
    }  # fmt: skip
    smooth = Scene.from_dict(entries)
    assert collide(smooth, stokes=0.116, angle=1.12, engine="taylor").outcome == "stick"
    found = collide(smooth.with_entries({"particles.friction": 0.0137}), stokes=0.116, angle=1.12, engine="taylor")
    assert (found.outcome, found.certified, found.engine, found.reversal) == ("stick", False, "taylor", "glass")
    assert found.energy is not None and found.energy.dry_friction == 0.0


@pytest.mark.slow
def test_slip_that_friction_reverses_wholly_may_be_zero() -> None:
    """With opposite spins of equal spheres nothing turns, and the engines agree."""
    entries = {"impact.spin": 1e3, "impact.partner_spin": -1e3}
    both = [collide(rough(entries, 1e6, 1.0), stokes=8.0, angle=0.0, engine=name) for name in ("rosenbrock", "taylor")]
    assert both[0].outcome == both[1].outcome == "bounce"
    assert both[0].restitution == pytest.approx(both[1].restitution, rel=1e-8)


WRT = ("particles.friction", "particles.contact_tangential_restitution", "liquid.viscosity")


def test_no_derivative_at_the_switch_between_sliding_and_sticking() -> None:
    """It is named, with its distance in the coefficient of friction; beside it there is one."""
    scene = rough({}, 0.1, 0.4)
    near = sensitivities(scene, ("restitution",), WRT[:1], stokes=8.0, angle=ANGLE, engine="rosenbrock").near
    assert near is not None and near.boundary == "switch between sliding and sticking contact"
    at = [0.1 * math.exp(sign * near.distance) for sign in (1, -1)]
    refused = 0
    for friction in at:
        try:
            scene = rough({}, friction, 0.4)
            sensitivities(scene, ("restitution",), WRT[:1], stokes=8.0, angle=ANGLE, engine="rosenbrock")
        except ComputationError as error:
            refused += "switch between sliding and sticking contact" in str(error)
    assert refused == 1


@pytest.mark.parametrize(
    ("entries", "said"),
    [
        ({"particles.contact_tangential_restitution": 0.3}, "without particles.friction"),
        ({"model.contact_friction": "all"}, "without particles.friction"),
        ({"particles.friction": -0.1}, "out of range"),
        ({"particles.friction": 0.1, "particles.contact_tangential_restitution": 1.5}, "out of range"),
    ],
)
def test_entries_that_make_no_sense_are_refused(entries: dict[str, object], said: str) -> None:
    """By name, with what is accepted."""
    with pytest.raises(InputError, match=said):
        Scene.load("granulation").with_entries(entries)


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["rosenbrock", "taylor"])
def test_a_doublet_at_rest_that_only_friction_turns_sticks_at_once(engine: str) -> None:
    """Glass at the edge of the film, where tangential lubrication is zero: friction falls with the normal force."""
    scene = Scene.from_dict(
        {
            "particles": {
                "reduced_radius": 2.89196e-5, "density": 3608.54, "roughness": 2.7334e-11, "dry_restitution": 0.0,
                "youngs_modulus": 1.7724e13, "poisson_ratio": 0.329514, "friction": 1.37477,
                "contact_tangential_restitution": 0.728743,
            },
            "liquid": {
                "viscosity": 0.00120608, "film_thickness": 2.98859e-9, "glass_transition_pressure": 418349.0,
            },
            "bridge": {
                "surface_tension": 0.0910611, "volume": 2.99678e-5, "contact_angle": 0.161982, "law": "lambert",
            },
            "model": {"film": "cavitating", "tangential": "film", "contact_friction": "all"},
            "impact": {"stokes": 54.472, "angle": 0.188747, "spin": -7532.17, "partner_spin": -54875.0},
        }
    )  # fmt: skip
    found = collide(scene, engine=engine, ledger=False)
    assert (found.outcome, found.certified, found.engine) == ("stick", True, engine)
    assert [event.kind for event in found.events] == ["glass", "rests"]


@pytest.mark.slow
def test_a_slide_that_begins_with_no_slip_is_followed() -> None:
    """Rounding of a slip that is zero ends no slide: one event, few steps, and the end is Rosenbrock's."""
    scene = Scene.from_dict(
        {
            "particles": {
                "reduced_radius": 1.8010143999255044e-06, "density": 3489.181961648908,
                "roughness": 1.3274910258114892e-10, "dry_restitution": 0.20082446488017835,
                "friction": 1.0228846459777265, "contact_tangential_restitution": 0.0,
            },
            "liquid": {
                "viscosity": 0.0004992778839170332, "film_thickness": 4.190263925978391e-09,
                "glass_transition_pressure": 257462265199.22565,
            },
            "attraction": {"hamaker": 2.295212656134125e-19},
            "partner": {"radius": 8.827806376355772e-07, "density": 506.37121069166585},
            "model": {"contact_friction": "all"},
            "impact": {
                "speed": 6.402927383667082, "angle": 1.4454146792286053, "spin": 15580188.783278335,
                "partner_spin": 13345651.909063289,
            },
        }
    )  # fmt: skip
    found, expected = (collide(scene, engine=each, ledger=False) for each in ("taylor", "rosenbrock"))
    assert found.engine == "taylor"
    assert found.steps < 1000  # without an end of the slide: as many as there are
    assert [each.kind for each in found.events] == [each.kind for each in expected.events]
    assert found.restitution == pytest.approx(expected.restitution, rel=1e-7)
    assert found.contact_time == pytest.approx(expected.contact_time, rel=1e-7)
