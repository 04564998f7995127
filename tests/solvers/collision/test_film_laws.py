"""Film laws against closed forms of the head-on collision, and against Newton's law for the oblique one."""

import math

import pytest
from wetdoublet.solvers import Scene

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
def test_head_on_in_closed_form(film):
    """The outcome changes where the closed form says, and below it the stick is proved.

    A reversed doublet leaves with e_dry (1 - L/St) - L/St, or, cavitating, with e_dry (1 - L/St): there is no suction.
    """
    level, suction = lost(film, X_B / X0), film != "cavitating"
    threshold = level * (1 + suction / E_DRY)
    below, *above = (collide(alone(film), stokes=threshold * f, angle=0.0) for f in (1 - 1e-5, 1 + 1e-5, 1.2, 4.0))
    assert (below.outcome, below.certified) == ("stick", True)
    assert {(each.outcome, each.reversal) for each in above} == {("bounce", "rough")}
    for one in above[1:]:
        taken = level / one.scene.stokes_of(one.speed)
        assert one.restitution == pytest.approx(E_DRY * (1 - taken) - suction * taken, rel=1e-7)
