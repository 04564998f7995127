"""Film laws against closed forms of the head-on collision, and against Newton's law for the oblique one."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from wetdoublet.solvers import Scene, collide_many
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.model.phases import Region

from ...helpers.reference import collide

X0, X_B, E_DRY = 8e-6, 2e-7, 0.9


def alone(film, **changes):
    """Granulation with a film only, rebounding by roughness only."""
    preset = Scene.load("granulation-dry-bridge")
    given = {name: value for name, value in preset.given if "young" not in name and "poiss" not in name}
    given = {name: value for name, value in given.items() if not name.startswith("bridge")}
    entries = {
        "liquid.glass_transition_pressure": "1e6 GPa",
        "liquid.film_thickness": X0,
        "particles.roughness": X_B,
        "particles.dry_restitution": E_DRY,
        "model.film": film,
    }
    return Scene("", tuple({**given, **entries, **changes}.items()))


def lost(film, s):
    """What the film takes of St u/v0 between x0 and s x0, by hand: the integral of the resistance."""
    if film == "infinite":
        return math.log(1 / s)
    return math.log(1 / s) - 1.5 + 2 * s - s**2 / 2


@pytest.mark.parametrize("film", ["finite", "infinite", "cavitating"])
@pytest.mark.parametrize("part", [1.2, 4.0])
def test_head_on_in_closed_form(film, part):
    """A reversed doublet leaves with e_dry (1 - L/St) - L/St, or, cavitating, with e_dry (1 - L/St): no suction."""
    level = lost(film, X_B / X0)
    threshold = level * (1 + (0 if film == "cavitating" else 1 / E_DRY))
    stokes = part * threshold
    one = collide(alone(film), stokes=stokes, angle=0.0)
    at_contact = 1 - level / stokes
    expected = E_DRY * at_contact - (0 if film == "cavitating" else level / stokes)
    assert one.outcome == "bounce" and one.reversal == "rough"
    assert one.restitution == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize("film", ["finite", "infinite", "cavitating"])
def test_the_head_on_certificate_knows_its_film(film):
    """Head-on with a film alone the outcome changes where the closed form says, and below it the stick is proved."""
    level = lost(film, X_B / X0)
    threshold = level * (1 + (0 if film == "cavitating" else 1 / E_DRY))
    below, above = (collide(alone(film), stokes=threshold * f, angle=0.0) for f in (1 - 1e-5, 1 + 1e-5))
    assert (below.outcome, below.certified) == ("stick", True)
    assert above.outcome == "bounce"


def bridged(film, **changes):
    """A wet oblique scene with the constant bridge, no criteria."""
    bridge = {
        "bridge.surface_tension": "0.025 N/m",
        "bridge.volume": 0.05,
        "bridge.contact_angle": "0 deg",
        "bridge.law": "constant",
    }
    return alone(film, **{**bridge, "particles.roughness": 0.0, **changes})


def test_no_film_edge_where_the_film_has_none():
    """A film of constant volume reaches up to rupture: x = x0 is no event; with the others it is."""
    for film in ("infinite", "constant-volume"):
        kinds = [event.kind for event in collide(bridged(film), stokes=0.12, angle="75 deg").events]
        assert ("film edge" in kinds) == (film == "infinite")


def test_constant_volume_head_on():
    """Head-on with the constant bridge, a film of constant volume: the velocity back at rupture is scipy's."""
    scene = bridged("constant-volume", **{"particles.roughness": X_B})
    one = collide(scene, stokes=8.0, angle=0.0, rtol=1e-11)
    a, m, mu, reach = 5e-5, 5.2e-9, scene.liquid.viscosity, 2 * 5e-5 * 0.05 ** (1 / 3)

    def rates(x, y):  # u against x: m u du/dx = -F
        rim = math.sqrt(x * x + 0.05 * (2 * a) ** 3 / (math.pi * a))
        return [-(6 * math.pi * mu * a**2 * y[0] / x * (1 - x / rim) ** 2 + 4 * math.pi * a * 0.025) / (m * y[0])]

    def integrated(span, u):
        return float(solve_ivp(rates, span, [u], rtol=1e-11, atol=1e-14, method="LSODA").y[0, -1])

    at_contact = integrated((X0, X_B), -one.speed)
    expected = integrated((X_B, reach), -E_DRY * at_contact) / one.speed
    assert one.outcome == "bounce"
    assert one.restitution == pytest.approx(expected, rel=1e-7)


def test_a_cavitated_film_does_not_act():
    """The force flag of a region is off only where the film is there, opens, and cavitates."""
    assert Region(1, 1, False, True).flags == {"film": 0, "shear": 1}
    assert Region(1, 1, False).flags == {"film": 1, "shear": 1}
    assert [load(select_model(alone(film), False)).cavitates for film in ("finite", "cavitating")] == [False, True]


def test_a_pendulum_whose_film_cavitates_has_a_kernel():
    """Without a bound of its film's impulse its certificates are left out, and the kernel answers like the engines."""
    scene = Scene.load("pendulum").with_entries({"model.film": "cavitating"})
    stokes, angle = [0.3, 1.0, 3.0], np.radians([10.0, 45.0, 60.0])
    one, other = (collide_many(scene, stokes=stokes, angle=angle, engine=engine) for engine in ("taylor", "rosenbrock"))
    assert one.outcome.values.tolist() == other.outcome.values.tolist()
    np.testing.assert_allclose(one.restitution, other.restitution, rtol=1e-7)
