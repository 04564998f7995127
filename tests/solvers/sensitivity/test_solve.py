"""Entries at which a result has a value: all of them, with derivatives; what is jumped over; what has none."""

import json
import math
import pickle

import numpy as np
import pytest
from wetdoublet.solvers import ModelWarning, Scene, boundary, collide, collide_many, solve

from ...helpers.command import run

FREE = {"free": "liquid.viscosity", "within": (0.2, 20.0)}
GRANULATION = Scene.load("granulation").with_impact(stokes=0.13, angle="20 deg")


def test_a_root_is_confirmed_and_its_derivatives_are_those_of_the_root():
    """e_n = 0.5 over the viscosity: by CVODES as well, and moved as the gradient says with another film and target."""
    found = solve(GRANULATION, **FREE, restitution=0.5)
    (value,) = found
    assert isinstance(found, list) and found.found[0].outcome == "bounce" and found.jumps == ()
    confirmed = collide(GRANULATION.with_entries({"liquid.viscosity": value}), engine="cvodes")
    assert confirmed.restitution == pytest.approx(0.5, abs=1e-7)
    gradient, step = found.found[0].gradient, 1e-4
    films = [GRANULATION.with_entries({"liquid.film_thickness": 8e-6 * (1 + sign * step)}) for sign in (1, -1)]
    thick, thin = (solve(scene, **FREE, restitution=0.5)[0] for scene in films)
    assert gradient["liquid.film_thickness"] == pytest.approx((thick - thin) / (2 * step * 8e-6), rel=1e-5)
    targets = [solve(GRANULATION, **FREE, restitution=0.5 * (1 + sign * step))[0] for sign in (1, -1)]
    assert gradient["restitution"] == pytest.approx((targets[0] - targets[1]) / step, rel=1e-5)
    assert "liquid.viscosity" not in gradient


@pytest.mark.slow
def test_all_roots_are_found_on_both_sides_of_an_extremum():
    """At 60 deg e_n over the viscosity rises and falls by 1e-3: two roots below the maximum, none above it."""
    scene = Scene.load("granulation").with_impact(stokes=0.03, angle="60 deg")
    two = solve(scene, free="liquid.viscosity", within=(0.05, 5.5), restitution=0.502)
    assert len(two) == 2
    dense = np.geomspace(0.05, 5.5, 4001)
    values = collide_many(scene, vary={"liquid.viscosity": dense}, rtol=1e-11).restitution.values
    crossed = np.flatnonzero(np.diff(values > 0.502))
    assert [np.searchsorted(dense, value) - 1 for value in two] == crossed.tolist()
    top = float(values.max())
    close = solve(scene, free="liquid.viscosity", within=(0.05, 5.5), restitution=top * (1 - 1e-8))
    assert len(close) == 2 and close[1] / close[0] < 1.01  # nearer to each other than samples of the range
    none = solve(scene, free="liquid.viscosity", within=(0.05, 5.5), restitution=top * (1 + 1e-6))
    assert none == [] and "none: no liquid.viscosity from 0.05 to 5.5 Pa s has it" in str(none)
    assert none.attained[1] == pytest.approx(top, rel=1e-6)


def test_a_volume_is_sought_as_the_scene_gives_it():
    """In m^3 where it is given so: of spheres of 100 um that is V/R^3 times 1e-12 m^3."""
    ratio = Scene.load("granulation").with_impact(stokes=0.05)
    volume = ratio.with_entries({"bridge.volume": "1e-4 mm^3"})
    (expected,) = solve(ratio, free="bridge.volume", within=(0.05, 0.3), restitution=0.65)
    found = solve(volume, free="bridge.volume", within=("5e-5 mm^3", "3e-4 mm^3"), restitution=0.65)
    assert found == pytest.approx([expected * 1e-12], rel=1e-9)


def test_a_jump_over_the_value_is_no_root():
    """Where the glass criterion is grazed e_n jumps from 0.5017 to 1.004: 0.8 is jumped over, there and only there."""
    scene = Scene.load("granulation").with_impact(stokes=0.03, angle="60 deg")
    found = solve(scene, **FREE, restitution=0.8)
    assert found == [] and len(found.jumps) == 1
    (jump,) = found.jumps
    assert (jump.before, jump.after) == ("stick-rotate-separate", "bounce by glass")
    assert jump.below < 0.51 and jump.above > 1.0
    # the same change of outcome, along the Stokes number
    at = boundary(scene.with_entries({"liquid.viscosity": jump.value}), angle=scene.angle).changes[0]
    assert min(abs(change.stokes / scene.stokes_of(scene.speed) - 1) for change in at) > 0.1  # of another viscosity
    there = scene.with_entries({"liquid.viscosity": jump.value})
    assert min(abs(change.stokes / there.stokes - 1) for change in at) < 1e-7


@pytest.mark.slow
def test_a_root_beside_a_change_of_outcome_is_found():
    """The pendulum's e_n begins at 0 as a square root: 1e-4 lies within 1e-5 of where sticking ends."""
    found = solve("pendulum", free="impact.stokes", within=(0.5, 3.0), angle="45 deg", restitution=1e-4)
    (value,) = found
    change = boundary("pendulum", angle=math.radians(45)).changes[0][0]
    assert change.before == "stick"
    assert 0 < value / change.stokes - 1 < 1e-5
    # and the contact time of the granulation diverges where sticking ends
    scene = Scene.load("granulation").with_impact(angle="60 deg")
    end = boundary(scene, angle=scene.angle).changes[0][0]
    for milliseconds, beside in ((60, 1e-4), (120, 1e-7)):
        found = solve(scene, free="impact.stokes", within=(0.001, 0.1), contact_time=f"{milliseconds} ms")
        assert end.before == "stick" and 0 < found[0] / end.stokes - 1 < beside
        assert bool(found.found[0].gradient) == (milliseconds == 60)  # nearer than 1e-6 there are no derivatives
    assert "separatrix" in str(found)
    none = solve(scene, free="impact.stokes", within=(0.001, 0.1), contact_time="1 s")
    assert none == [] and "beside a change of outcome nothing is resolved" in str(none)


def test_a_result_that_does_not_change_is_said():
    """Glass at initial contact: the smallest gap is x0 whatever the viscosity; the value is no list of roots."""
    scene = GRANULATION.with_impact(stokes=0.5)
    found = solve(scene, free="liquid.viscosity", within=(2, 5), smallest_gap="8 um")
    assert found == []
    ((low, high),) = found.throughout
    assert (low, high) == pytest.approx((2, 5))
    assert "all along from 2 to 5 Pa s" in str(found) and "none" not in str(found)


def test_the_command():
    """A table, JSON with the list, and one line that names the option that is wrong."""
    arguments = ["solve", "granulation", "--stokes", 0.13, "--angle", 20, "--for", "restitution=0.5"]
    value = solve(GRANULATION, free="liquid.viscosity", within=(0.5, 5.0), restitution=0.5)[0]
    shown = run(*arguments, "--free", "liquid.viscosity=0.5:5 Pa s")
    assert shown.exit_code == 0 and f"{value:.10g} Pa s  bounce" in shown.stdout
    record = json.loads(run(*arguments, "--free", "liquid.viscosity=0.5:5 Pa s", "--json").stdout)
    assert record["solutions"] == [value] and record["within"] == [0.5, 5.0]
    assert record["gradients"][0]["restitution"] == pytest.approx(0.610114, rel=1e-5)
    for option, message in (
        ("liquid.viscosty=0.5:5 Pa s", "--free"), ("liquid.viscosity=0.5:5", "--free"), ("bridge.law=1:2", "--free"),
        ("impact.stokes=0.1:0.2", "--stokes"),
    ):  # fmt: skip
        wrong = run(*arguments, "--free", option)
        assert wrong.exit_code == 2 and wrong.stderr.startswith(message)
    for target, message in (("restituton=1", "--for"), ("restitution=0", "restitution"), ("restitution", "--for"),
                            ("free=1", "--for"), ("stokes=0.1", "--for")):  # fmt: skip
        wrong = run(*arguments[:-1], target, "--free", "liquid.viscosity=0.5:5 Pa s")
        assert wrong.exit_code == 2 and wrong.stderr.startswith(message), wrong.stderr
    again = pickle.loads(pickle.dumps(solve(GRANULATION, **FREE, restitution=0.5)))
    assert again == pytest.approx([value], rel=1e-12) and again.found[0].outcome == "bounce"


def test_samples_without_a_collision_are_counted_with_a_reason():
    """A roughness above the film is no scene: how many samples, where, and why; the root below is found."""
    found = solve(
        GRANULATION, free="particles.roughness", within=(1e-8, 2e-5), restitution=0.5, stokes=0.03, angle="45 deg"
    )
    (remark,) = found.remarks
    assert len(found) == 1 and remark.startswith("124 samples from 8.026e-06 to 2e-05 m are passed over; the first: ")
    assert "is not below the film thickness" in remark
    gap = collide(GRANULATION.with_entries({"particles.roughness": 7.999e-6}), stokes=0.2).restitution
    last = solve(GRANULATION, free="particles.roughness", within=(1e-8, 2e-5), restitution=gap, stokes=0.2)
    assert last[-1] == pytest.approx(7.999e-6, rel=1e-6)  # between the last sample and the film


def test_a_warning_of_the_model_is_given_once():
    """Hundreds of calls, the roots and their derivatives: one warning, as of one collision."""
    scene = GRANULATION.with_entries({"bridge.law": "willett", "bridge.volume": 0.3})
    with pytest.warns(ModelWarning, match=r"volume = 0\.3 is above 0\.1") as told:
        assert solve(scene, free="impact.stokes", within=(0.005, 0.1), restitution=1.55, angle="75 deg")
    assert len(told) == 1


@pytest.mark.parametrize(
    ("of", "stokes", "text"),
    [("energy.attraction", 0.13, "no collision of this scene has"), ("rotation", 0.01, "all stick")],
)
def test_a_result_that_no_collision_has_is_said(of, stokes, text):
    """A scene without attraction has no work of it, though it bounces; sticks have no rotation."""
    none = solve(GRANULATION, **{of: 1.0}, free="liquid.viscosity", within=(2.0, 3.0), stokes=stokes)
    assert not none and none.attained is None and text in str(none)


def test_a_term_of_the_ledger_may_have_a_value():
    """The work of the bridge over its volume; other results are those of the harness."""
    scene = Scene.load("granulation").with_impact(stokes=0.02, angle="75 deg")
    found = solve(scene, free="bridge.volume", within=(0.03, 0.3), **{"energy.capillary": 2e-10})
    assert found
    for value in found:
        one = collide(scene.with_entries({"bridge.volume": value}), engine="rosenbrock")
        assert one.energy.capillary == pytest.approx(2e-10, rel=1e-6)
