"""A doublet with a film alone and no angular momentum: what is proved to stick does, and what is not separates."""

import math

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.certificates import proof_for
from wetdoublet.solvers.certificates.spin_down import SpinDownCertificate
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model

from ...helpers.scanned import scanned

pytestmark = pytest.mark.slow

DEGREES = (65, 88)
FILM = Scene.load("granulation-dry-bridge").with_entries({"particles.roughness": "0 um"})


def balanced(stokes: float, angle: float, excess: float = 0.0) -> Scene:
    """The film with an impact whose spins take the angular momentum of the orbit, but for a part of it."""
    scene = FILM.with_impact(stokes=stokes, angle=angle)
    a, film, speed = scene.reduced_radius, scene.liquid.film_thickness, scene.speed_of(stokes)
    orbit = (4 * a + film) ** 2 * speed * math.tan(angle) / (4 * a)
    return scene.with_entries({"impact.spin": -orbit * (1 - excess) / (6.4 * a**2)})


def test_it_sticks_where_the_rotation_dies_out_first() -> None:
    """Proved to stick at small angles, and separated at large ones."""
    found = {}
    for degrees in DEGREES:
        scene = balanced(0.04, math.radians(degrees)).with_entries({"liquid.glass_transition_pressure": 1e30})
        each = [collide(scene, engine=engine, ledger=False) for engine in ("rosenbrock", "taylor")]
        assert all(one.certified == (one.outcome == "stick") for one in each)
        found[degrees] = each[0].outcome != "stick"
        assert each[1].outcome == each[0].outcome
        if found[degrees]:
            assert scanned(scene).restitution == pytest.approx(each[0].restitution, rel=1e-6)
    assert found == dict(zip(DEGREES, (False, True)))


def test_with_any_angular_momentum_it_separates() -> None:
    """What is left of the angular momentum presses the doublet apart: e_n falls with it, and no stick is proved."""
    excesses = 10.0 ** -np.arange(1.0, 6.0)
    found = [collide(balanced(0.04, 0.5, excess), ledger=False) for excess in excesses]
    assert all(one.outcome == "stick-rotate-separate" for one in found)
    powers = np.diff(np.log([one.restitution for one in found])) / np.diff(np.log(excesses))
    assert powers[-1] == pytest.approx(1.2, abs=0.01)  # u ~ F^(3/5) where the film ends, F ~ L^2
    assert collide(balanced(0.04, 0.5), ledger=False).outcome == "stick"


@pytest.mark.parametrize(("engine", "ledger"), [("rosenbrock", False), ("taylor", True)])
@pytest.mark.parametrize("excess", [1e-13, -1e-9])
def test_an_angular_momentum_that_rounding_changes_too_much(engine: str, ledger: bool, excess: float) -> None:
    """What is left of 1e-9 has rounding errors of 1e-7; so has the contact time, as 1/L^2: refused, with the reason."""
    with pytest.raises(ComputationError, match="orbit and spins cancel"):
        collide(balanced(0.04, 0.5, excess), engine=engine, ledger=ledger)


def test_a_bounce_needs_no_angular_momentum() -> None:
    """Fast enough to leave the film before the rotation dies out: decided without any, and with a little alike."""
    rough = {"particles.roughness": "0.2 um", "liquid.glass_transition_pressure": 1e30}
    scenes = [balanced(10.0, 0.5, excess).with_entries(rough) for excess in (0.0, 1e-12, -1e-9)]
    found = [collide(scene, engine="taylor", ledger=False) for scene in scenes]
    assert [one.outcome for one in found] == ["bounce"] * 3
    assert 0.1 < found[0].restitution < 0.97
    assert np.ptp([one.restitution for one in found]) < 1e-8


def test_opposite_spins_of_a_pair() -> None:
    """Along the line of centres, spins that cancel are all slip: proved for unequal spheres, in two modes of slip."""
    scene = FILM.with_entries({"partner.radius": "150 um", "partner.density": 2500.0, "impact.spin": 300.0})
    weights = scene.radius_ratio**2 * scene.mass_ratio  # I_2/I_1
    scene = scene.with_entries({"impact.partner_spin": -300.0 / weights}).with_impact(stokes=0.04, angle=0.0)
    found = collide(scene, engine="rosenbrock", ledger=False)
    assert (found.outcome, found.certified) == ("stick", True)
    n = nondimensionalise(scene, *scene.need_impact())
    model = load(select_model(scene, oblique=True))
    proof = proof_for(model, model.group_values(n.groups), 1e-9)
    assert isinstance(proof, SpinDownCertificate)


@pytest.mark.parametrize("engine", ["rosenbrock", "taylor"])
def test_a_separation_that_rounding_decides_is_none(engine: str) -> None:
    """A film that cavitates holds nothing that opens: L within rounding sets off any e_n of its size, and no outcome.

    With a part F of the orbit's momentum left, e_n is as F: u = sqrt(C) t for a force C ~ F^2 over a length x0.
    """

    def pushed(excess: float) -> Scene:
        return balanced(0.04, 0.5, excess).with_entries({"model.film": "cavitating"})

    found = [collide(pushed(excess), engine=engine, ledger=False).restitution for excess in (1e-9, 1e-10, 1e-11)]
    assert np.array(found[:-1]) / found[1:] == pytest.approx(10.0, rel=1e-4)
    for excess in (0.0, 1e-16):
        with pytest.raises(ComputationError, match="rounding of its angular momentum|have not decided"):
            collide(pushed(excess), engine=engine, ledger=False)
