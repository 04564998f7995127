"""Derivatives by the Taylor kernel: those of differences and of the CasADi engines, and laws that any must keep."""

import numpy as np
import pytest
from wetdoublet.generated.automaton import LAST_ANSWER, OUTCOMES, Status
from wetdoublet.solvers import Scene, collide, gradients_many, sensitivities
from wetdoublet.solvers.engines.taylor.call import KernelImpacts
from wetdoublet.solvers.engines.taylor.tangent import run_tangent
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.scene.groups import si_values
from wetdoublet.solvers.sensitivity.gradients_many import STICK

pytestmark = [pytest.mark.skipif(compiler() is None, reason="no C compiler"), pytest.mark.slow]
OF = ("restitution", "rotation", "contact_time", "smallest_gap")
SEPARATRIX = 0.049117734419372415  # St of granulation at 45 deg, by bisection at rtol 1e-13


@pytest.mark.parametrize(("preset", "stokes", "angle"), [("granulation", (0.01, 0.4), (0.9, 1.45))])
def test_backward_is_forward(preset: str, stokes: tuple[float, float], angle: tuple[float, float]) -> None:
    """Taken back along the trajectory, derivatives of e_n by all quantities are those carried along it.

    Both at 1e-12, where either is exact to some 1e-10 of the largest elasticity. Slow collisions of granules stay in
    the film until it has forgotten the approach, where the way back ends. In another order, and so in other lanes,
    the numbers are the same.
    """
    scene, count = Scene.load(preset), 24
    draw = np.random.default_rng(8)
    impacts = KernelImpacts(
        scene, scene.speed_of(np.exp(draw.uniform(*np.log(stokes), count))), draw.uniform(*angle, count), {}
    )
    forward, backward, turned = (
        run_tangent(those, True, 1e-12, False, order=11, backward=back)
        for those, back in ((impacts, False), (impacts, True), (impacts.subset(np.arange(count)[::-1]), True))
    )
    assert forward is not None
    assert backward is not None
    assert turned is not None
    np.testing.assert_array_equal(turned.slopes[::-1], backward.slopes)
    short = backward.answers["status"] <= LAST_ANSWER
    np.testing.assert_array_equal(forward.answers["outcome"][short], backward.answers["outcome"][short])
    separated = (forward.answers["outcome"] > 0) & short
    assert separated.sum() >= 12
    values = si_values(scene, None, None)
    units = np.tile([values.get(quantity) or 0.0 for quantity in forward.quantities], (count, 1))
    units[:, forward.quantities.index("speed")] = impacts.speed
    units[:, forward.quantities.index("angle")] = impacts.angle
    along, back = (each.slopes[separated, :, 0] * units[separated] for each in (forward, backward))
    assert (np.abs(along - back).max(axis=1) < 1e-9 * np.abs(along).max(axis=1)).all()


@pytest.mark.parametrize("backward", [False, True])
def test_resting_with_friction_is_decided(backward: bool) -> None:
    """A kernel with derivatives follows a doublet through resting contact: the same stick with the same events."""
    beads = Scene.load("glass-beads-water")
    entries = {"liquid.viscosity": 1e-3 * dict(beads.si)["liquid.viscosity"], "particles.friction": 0.3}
    scene = beads.with_entries({**entries, "particles.dry_restitution": 0.05})
    found = collide(scene, speed=0.3, angle=1.2, engine="taylor")
    assert found.events[-1].kind == "rests" and found.until > found.events[-1].time  # proved later than it rests
    run = run_tangent(KernelImpacts(scene, np.array([0.3]), np.array([1.2]), {}), True, 1e-9, False, backward=backward)
    answer = run.answers[0]
    assert answer["status"] == Status.DECIDED
    assert (answer["outcome"], answer["events"]) == (OUTCOMES.index(found.outcome), len(found.events))


def test_sticks_and_boundaries() -> None:
    """A stick has e_n = 0 with the gradient 0 and nothing else; at a boundary there is none, and it is named."""
    stokes = SEPARATRIX * np.array([0.5, 1 - 1e-7, 1 + 1e-7, 1.3])
    found = gradients_many("granulation", stokes=stokes, angle="45 deg", of=OF, wrt="liquid.viscosity", engine="taylor")
    assert found.outcome.values.tolist() == [0, -1, -1, 1]
    assert found.reason.values[0] == STICK
    assert found.reason.values[3] == ""
    for reason in found.reason.values[1:3]:
        assert reason.startswith("no derivative: the collision lies at the separatrix")
    gradient = found.gradient.values[:, :, 0]
    assert gradient[0, 0] == 0.0
    assert np.isnan(gradient[1:, 0]).all()
    assert np.isnan(gradient[:, 1:3]).all()
    assert np.isfinite(gradient[:, 3]).all()


def test_the_engine_that_is_chosen() -> None:
    """Where none is requested: the kernel; what it lacks is Rosenbrock's: backwards, the ledger."""
    scene, asked = Scene.load("granulation"), {"stokes": 0.02, "angle": 1.3, "wrt": "liquid.viscosity"}
    found = sensitivities(scene, OF, **asked)
    assert found.engine == "taylor"
    assert gradients_many(scene, **asked, of=OF).engine.values.tolist() == ["taylor"]
    assert sensitivities(scene, OF, **asked, method="adjoint").engine == "rosenbrock"
    assert sensitivities(scene, (*OF, "energy.capillary"), **asked).engine == "rosenbrock"
    plain = gradients_many(scene, **asked, of=OF, engine="rosenbrock")
    assert plain.engine.values.tolist() == ["rosenbrock"]
    for of in OF:
        own = plain.gradient.sel(quantity=of).values.item()
        assert found.gradient[of]["liquid.viscosity"] == pytest.approx(own, rel=1e-6)


def test_a_partner_that_is_equal_varies_alone() -> None:
    """The spin of one sphere depends on the other's size and mass: against differences of unequal pairs."""
    scene = Scene.load("granulation")
    size, mass = (2 * float(scene.material[name]) for name in ("reduced_radius", "reduced_mass"))
    entries = {"partner.radius": size, "partner.mass": mass}
    impact = {"speed": 0.14 / scene.stokes_per_speed, "angle": "40 deg"}
    found = sensitivities(scene.with_entries(entries), ["final_spin"], [*entries], engine="taylor", **impact)
    assert found.engine == "taylor"
    for name, value in entries.items():

        def at(part: float, name: str = name, value: float = value) -> float:
            own = scene.with_entries(entries | {name: value * (1 + part)})
            return float(collide(own, rtol=1e-12, ledger=False, **impact).final_spin)

        expected = (at(1e-4) - at(-1e-4)) / 2e-4  # the error is 1e-8 of the third derivative
        assert float(found.gradient["final_spin"][name] or 0) * value == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize("engine", ["rosenbrock", "cvodes"])
def test_an_adjoint_sweep_where_a_result_has_no_slope(engine: str) -> None:
    """Head-on beside a wall the tangential restitution is none; derivatives of other results are the tangents'."""
    wall = {"partner.wall": True, "model.film": "constant-volume", "impact.spin": -178.0}
    scene = Scene.load("granulation").with_entries(wall).with_impact(stokes=18.0, angle=0.0)
    wrt = ["particles.dry_restitution", "liquid.viscosity", "impact.spin"]
    of = ["restitution", "energy.normal_lubrication", "final_spin"]
    forward, adjoint = (sensitivities(scene, of, wrt, method=way, engine=engine) for way in ("forward", "adjoint"))
    many = gradients_many(scene, of=of[:2], wrt=wrt)
    assert many.reason.item() == ""
    for name in of:
        slopes = list(forward.gradient[name].values())
        assert list(adjoint.gradient[name].values()) == pytest.approx(
            slopes, rel=1e-5, abs=1e-7 * max(map(abs, slopes))
        )
        if name in of[:2]:
            row = many.gradient.sel(quantity=name).values[0]
            assert row == pytest.approx(slopes, rel=1e-5, abs=1e-7 * max(map(abs, slopes)))
