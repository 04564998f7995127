"""Derivatives by the Taylor kernel: those of differences and of the CasADi engines, and laws that any must keep."""

import json
from functools import cache

import numpy as np
import pytest
import xarray as xr
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st
from wetdoublet.generated.automaton import LAST_ANSWER
from wetdoublet.solvers import ComputationError, InputError, Scene, gradients_many, sensitivities
from wetdoublet.solvers.commands.cli import cli
from wetdoublet.solvers.engines.choice import gradient_engine
from wetdoublet.solvers.engines.taylor.call import Impacts
from wetdoublet.solvers.engines.taylor.tangent import run_tangent
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.scene.groups import si_values
from wetdoublet.solvers.sensitivity import gradients_many as many
from wetdoublet.solvers.sensitivity.by_kernel import KNOWN
from wetdoublet.solvers.sensitivity.gradients_many import STICK

pytestmark = [pytest.mark.skipif(compiler() is None, reason="no C compiler"), pytest.mark.slow]
OF = ("restitution", "rotation", "contact_time", "smallest_gap")
SEPARATRIX = 0.049117734419372415  # St of granulation at 45 deg, by bisection at rtol 1e-13


@cache
def of_granulation() -> tuple[xr.Dataset, np.ndarray, np.ndarray]:
    """Random impacts of the preset, all results and parameters."""
    draw = np.random.default_rng(5)
    stokes, angle = np.exp(draw.uniform(np.log(0.01), np.log(0.4), 24)), draw.uniform(0.1, 1.4, 24)
    return gradients_many("granulation", stokes=stokes, angle=angle, of=OF, engine="taylor"), stokes, angle


@pytest.mark.parametrize(
    ("preset", "stokes", "angle"), [("pendulum", (1.3, 3.0), (0.1, 1.3)), ("granulation", (0.01, 0.4), (0.9, 1.45))]
)
def test_backward_is_forward(preset: str, stokes: tuple[float, float], angle: tuple[float, float]) -> None:
    """Taken back along the trajectory, derivatives of e_n by all quantities are those carried along it.

    Both at 1e-12, where either is exact to some 1e-10 of the largest elasticity. Slow collisions of granules stay in
    the film until it has forgotten the approach, where the way back ends. In another order, and so in other lanes,
    the numbers are the same.
    """
    scene, count = Scene.load(preset), 24
    draw = np.random.default_rng(8)
    impacts = Impacts(
        scene, scene.speed_of(np.exp(draw.uniform(*np.log(stokes), count))), draw.uniform(*angle, count), {}
    )
    forward, backward, turned = (
        run_tangent(those, True, 1e-12, False, order=11, backward=back)
        for those, back in ((impacts, False), (impacts, True), (impacts.part(np.arange(count)[::-1]), True))
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


def test_many_are_taken_back() -> None:
    """Of more than a hundred, e_n's derivatives are taken back: those carried along where other results are asked for.

    Each is within 1e-6 of its largest elasticity; the same collisions are sticks, and the same are refused.
    """
    draw = np.random.default_rng(6)
    stokes, angle = np.exp(draw.uniform(np.log(0.06), np.log(0.4), 120)), draw.uniform(0.5, 1.3, 120)
    both = gradients_many("granulation", stokes=stokes, angle=angle, of=OF)
    back = gradients_many("granulation", stokes=stokes, angle=angle)
    np.testing.assert_array_equal(both.outcome, back.outcome)
    np.testing.assert_array_equal(both.reason != "", back.reason != "")
    along, own = (np.nan_to_num(each.elasticity.values[0]) for each in (both, back))
    separated = both.outcome.values > 0
    assert separated.sum() > 40
    apart = np.abs(along - own).max(axis=1)[separated]
    assert (apart < 1e-6 * np.abs(along).max(axis=1)[separated]).all()


@settings(max_examples=25, deadline=None)
@given(st.floats(0.02, 0.4), st.floats(0.1, 1.4), st.sampled_from(["speed", "stokes"]))
def test_units_make_no_difference(stokes: float, angle: float, hold: str) -> None:
    """Euler: a change of the unit of mass, length or time moves a result by its own dimension and nothing else."""
    found = gradients_many("granulation", stokes=stokes, angle=angle, of=OF, hold=hold, engine="taylor")
    if found.outcome.values[0] < 1:
        return
    dimensions = {  # mass, length, time
        "particles.reduced_radius": (0, 1, 0), "particles.reduced_mass": (1, 0, 0), "particles.roughness": (0, 1, 0),
        "particles.youngs_modulus": (1, -1, -2), "liquid.viscosity": (1, -1, -1), "liquid.film_thickness": (0, 1, 0),
        "liquid.glass_transition_pressure": (1, -1, -2), "bridge.surface_tension": (1, 0, -2),
        "impact.speed": (0, 1, -1) if hold == "speed" else (0, 0, 0),
    }  # fmt: skip
    own = {"contact_time": (0, 0, 1), "smallest_gap": (0, 1, 0)}
    for name in OF:
        row = found.elasticity.sel(quantity=name, parameter=list(dimensions)).values[0]
        row = np.nan_to_num(row)  # what has no influence on a result that is zero
        if hold == "stokes" and name == "contact_time":
            continue  # the speed follows from the number, and has the units of all others
        expected = np.array(own.get(name, (0, 0, 0)))
        np.testing.assert_allclose(row @ np.array(list(dimensions.values())), expected, atol=1e-6 * np.abs(row).max())


def test_a_subset_is_columns_of_the_whole() -> None:
    """Whichever parameters are asked for, each has the derivative that it has among all."""
    whole, stokes, angle = of_granulation()
    some = ["impact.angle", "liquid.viscosity", "particles.dry_restitution"]
    part = gradients_many("granulation", stokes=stokes, angle=angle, of=OF, wrt=some, engine="taylor")
    assert part.parameter.values.tolist() == some
    for k in range(stokes.size):
        for name in OF:
            row = whole.elasticity.sel(quantity=name).values[k]
            own = part.elasticity.sel(quantity=name).values[k]
            expected = whole.elasticity.sel(quantity=name, parameter=some).values[k]
            if not np.isnan(row).all():
                np.testing.assert_allclose(own, expected, atol=1e-6 * np.nanmax(np.abs(row)))


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


@pytest.mark.parametrize("distance", [6e-4, 5e-5])
def test_first_touch_needs_no_measuring(distance: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Just past the speed at which initial contact is glassy, many say what one says: derivative, or why none.

    The pressure at initial contact is proportional to the speed, so the distance is the speed's own; the limit is 1e-4.
    """
    rtol, angle, names = 1e-8, 0.3554, "liquid.viscosity"
    scene = Scene.load("granulation")
    probe = 0.2356 / scene.stokes_per_speed
    seen = run_tangent(Impacts(scene, np.array([probe]), np.array([angle]), {}), True, rtol, False)
    assert seen is not None
    assert seen.near[0, 1] == 7
    speed = probe * np.exp(distance - seen.near[0, 0])
    one, said = None, ""
    try:
        one = sensitivities(scene, ["restitution"], [names], speed=speed, angle=angle, rtol=rtol)
    except ComputationError as error:
        said = str(error)
    monkeypatch.setattr(many, "sensitivities", None)  # that nothing is done alone
    found = gradients_many(scene, speed=speed, angle=angle, wrt=names, rtol=rtol, engine="taylor")
    assert found.reason.values[0] == said
    if distance > 1e-4:
        assert one is not None
        expected = one.gradient["restitution"]["liquid.viscosity"]
        np.testing.assert_allclose(found.gradient.values.item(), expected, rtol=1e-6)
    else:
        assert f"glass criterion met at initial contact at a relative distance of {distance:.2g}" in said
        assert np.isnan(found.gradient.values).all()


def test_hints_of_a_boundary_are_decided_by_the_kernel() -> None:
    """Slow past the barrier, or a step that ends just before the glass criterion: the kernel's, as Rosenbrock's.

    Of a tolerance of 1e-8 an error may be amplified by up to the limit, to 1e-4; these are known to 1e-6.
    """
    degrees = np.array([26.858586171430467, 35.884055551575386, 57.88905621865916])
    stokes, names = np.array([1.4339000517448264, 1.4685210299674938, 0.520813436903123]), ["liquid.viscosity"]
    for rtol in (1e-8, 10**-8.5):
        found = gradients_many("pendulum", stokes=stokes, angle=np.radians(degrees), rtol=rtol, wrt=names)
        assert found.engine.values.tolist() == ["taylor"] * 3
    for k, slope in enumerate(found.gradient.values[0, :, 0]):
        one = sensitivities(
            "pendulum", wrt=names, stokes=stokes[k], angle=np.radians(degrees[k]), engine="rosenbrock", rtol=1e-11
        )
        assert slope == pytest.approx(one.gradient["restitution"]["liquid.viscosity"], rel=1e-6)


def test_what_the_kernel_does_not_know() -> None:
    """A term of the ledger, or a law that the kernel has not, is computed one by one: the same numbers as alone."""
    found = gradients_many(
        "granulation", stokes=0.03, angle="65 deg", of=["energy.capillary"], wrt="bridge.volume", engine="taylor"
    )
    alone = sensitivities("granulation", "energy.capillary", "bridge.volume", stokes=0.03, angle="65 deg")
    assert found.gradient.values.item() == alone.gradient["energy.capillary"]["bridge.volume"]
    assert found.engine.values.tolist() == ["rosenbrock"]


def test_the_engine_that_is_chosen() -> None:
    """Where none is requested: the kernel; what it lacks is Rosenbrock's: backwards, the ledger."""
    scene, asked = Scene.load("granulation"), {"stokes": 0.02, "angle": 1.3, "wrt": "liquid.viscosity"}
    found = sensitivities(scene, OF, **asked)
    assert found.engine == "taylor"
    assert gradients_many(scene, **asked, of=OF).engine.values.tolist() == ["taylor"]
    assert sensitivities(scene, OF, **asked, method="adjoint").engine == "rosenbrock"
    assert gradient_engine(scene, (*OF, "energy.capillary"), KNOWN, (True,)) == "rosenbrock"
    plain = gradients_many(scene, **asked, of=OF, engine="rosenbrock")
    assert plain.engine.values.tolist() == ["rosenbrock"]
    for of in OF:
        own = plain.gradient.sel(quantity=of).values.item()
        assert found.gradient[of]["liquid.viscosity"] == pytest.approx(own, rel=1e-6)


def test_bad_input() -> None:
    """Names and lengths that cannot be are one line that says what is accepted."""
    with pytest.raises(InputError, match="restitution"):
        gradients_many("granulation", of="restitutio")
    with pytest.raises(InputError, match="differs in length"):
        gradients_many("granulation", stokes=[0.1, 0.2], angle=[0.1, 0.2, 0.3])


def test_from_the_command_line() -> None:
    """`sensitivity --engine taylor` says that the kernel answered, with Rosenbrock's numbers."""
    given_ = ["sensitivity", "granulation", "--of", "restitution,rotation", "--wrt", "liquid.viscosity", "--json"]
    told = [CliRunner().invoke(cli, [*given_, *more]) for more in ([], ["--engine", "taylor"])]
    expected, found = (json.loads(each.stdout) for each in told)
    assert found["engine"] == "taylor"
    assert found["gradient"]["rotation"]["liquid.viscosity"] == pytest.approx(
        expected["gradient"]["rotation"]["liquid.viscosity"], rel=1e-5
    )
