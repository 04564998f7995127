"""Friction of the dry contact against closed forms, between engines, and against differences."""

import math

import pytest
from wetdoublet.solvers import ComputationError, Scene, sensitivities
from wetdoublet.solvers.model.model import select_model

from ...helpers.reference import collide

WET = {"liquid.glass_transition_pressure": "1e12 Pa", "liquid.viscosity": "0.01 Pa s", "particles.roughness": "1 um"}
ANGLE = math.radians(30)


def rough(entries: dict[str, object], friction: float, reversed_part: float = 0.0) -> Scene:
    """Granulation with friction."""
    own = {"particles.friction": friction, "particles.contact_tangential_restitution": reversed_part}
    return Scene.load("granulation").with_entries({**WET, **entries, **own})


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


BOTH = ("taylor", "rosenbrock")
WRT = ("particles.friction", "particles.contact_tangential_restitution", "liquid.viscosity")


@pytest.mark.slow
def test_no_derivative_at_the_switch_between_sliding_and_sticking() -> None:
    """Where friction just holds the surfaces the switch is named; beside it the spin depends on friction, or not."""

    def slope(friction: float) -> float | None:
        found = sensitivities(rough({}, friction, 0.4), "final_spin", WRT[:1], stokes=8.0, angle=ANGLE)
        return found.gradient["final_spin"][WRT[0]]

    low, high = 0.05, 0.8  # slides, sticks
    assert slope(low) != 0.0 and slope(high) == 0.0

    def bisected(low: float, high: float) -> None:
        while high / low > 1 + 1e-8:
            middle = math.sqrt(low * high)
            low, high = (low, middle) if slope(middle) == 0.0 else (middle, high)

    with pytest.raises(ComputationError, match="switch between sliding and sticking contact"):
        bisected(low, high)


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.05, 0.3])
def test_derivatives_of_both_engines(friction: float) -> None:
    """Of a contact that slides and of one that sticks: of the time too, which the rebound leaves as it is."""
    of, wrt = ("restitution", "contact_time", "final_spin"), [*WRT, "impact.angle"]
    asked = {"stokes": 8.0, "angle": ANGLE, "rtol": 1e-10}
    found, other = (sensitivities(rough({}, friction, 0.4), of, wrt, **asked, engine=e) for e in BOTH)
    for name in of:
        assert list(found.gradient[name].values()) == pytest.approx(list(other.gradient[name].values()), rel=1e-7)
