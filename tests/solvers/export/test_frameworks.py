"""jax and torch: values and derivatives are the toolkit's, by their own checkers too; nothing is wrong in silence."""

from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import ComputationError, InputError, Scene, collide_many, gradients_many

SPEED, ANGLE, MU = np.array([1.0, 2.6, 3.0, 3.4]), 0.2, "liquid.viscosity"  # a stick and bounces of granulation


pytestmark = pytest.mark.filterwarnings("ignore:.*torch.jit.script. is deprecated:DeprecationWarning")  # torch's own


@pytest.fixture
def jax() -> Any:
    """The framework in double precision."""
    found = pytest.importorskip("jax", reason="jax is not installed: pip install -e '.[jax]'")
    found.config.update("jax_enable_x64", True)
    return found


@pytest.fixture
def torch() -> Any:
    """The framework."""
    return pytest.importorskip("torch", reason="torch is not installed: pip install -e '.[torch]'")


def expected(of: str = "restitution") -> tuple[np.ndarray, np.ndarray]:
    """Values and derivatives by viscosity, from the toolkit itself."""
    many = collide_many("granulation", speed=SPEED, angle=ANGLE, of=[of])
    slopes = gradients_many("granulation", speed=SPEED, angle=ANGLE, wrt=MU, of=of, hold="speed")
    return many[of].values, slopes["gradient"].values[0, :, 0]


def test_jax_has_the_toolkits_numbers(jax: Any) -> None:
    """`jit`, `vmap`, `grad` and `jvp` alike; a stick has restitution 0 and derivative 0."""
    from wetdoublet.solvers.export.jax import law

    restitution, (value, slope) = law("granulation"), expected()
    one = lambda v, m: restitution(v, ANGLE, {MU: m})  # noqa: E731 # as jax is written
    assert value[0] == slope[0] == 0
    assert np.array_equal(jax.jit(lambda v: restitution(v, ANGLE))(SPEED), value)
    assert np.allclose(jax.jit(jax.vmap(one, (0, None)))(SPEED, 2.0), value, rtol=1e-9)
    assert np.allclose(jax.vmap(jax.grad(one, 1), (0, None))(SPEED, 2.0), slope, rtol=1e-7)
    assert np.allclose(jax.jvp(lambda m: one(SPEED, m), (2.0,), (1.0,))[1], slope, rtol=1e-7)


def test_many_collisions_are_those_of_the_law(jax: Any, torch: Any) -> None:
    """`collide_many` in the spelling of the toolkit: the same numbers, differentiable by what varies."""
    from wetdoublet.solvers.export import jax as of_jax
    from wetdoublet.solvers.export import torch as of_torch

    value, slope = expected()
    found = jax.grad(lambda m: of_jax.collide_many("granulation", speed=SPEED, angle=ANGLE, vary={MU: m}).sum())(2.0)
    assert found == pytest.approx(slope.sum(), rel=1e-7)
    assert np.allclose(of_torch.collide_many("granulation", speed=torch.tensor(SPEED), angle=ANGLE), value, rtol=1e-9)


def test_torch_has_the_toolkits_numbers(torch: Any) -> None:
    """`backward`, forward mode, `vmap`; in the precision of what it is given."""
    from wetdoublet.solvers.export.torch import law

    restitution, (value, slope) = law("granulation"), expected()
    viscosity = torch.full((4,), 2.0, dtype=torch.float64, requires_grad=True)
    found = restitution(torch.tensor(SPEED), ANGLE, {MU: viscosity})
    found.sum().backward()
    assert np.allclose(found.detach(), value, rtol=1e-9)
    assert np.allclose(viscosity.grad, slope, rtol=1e-7)
    each = torch.func.vmap(torch.func.grad(lambda m, v: restitution(v, ANGLE, {MU: m})))
    assert np.allclose(each(viscosity.detach(), torch.tensor(SPEED)), slope, rtol=1e-7)
    assert restitution(torch.tensor(3.0), ANGLE).dtype == torch.float32


def moved(law: Any, preset: str, stokes: float) -> Any:
    """The restitution as a function of relative changes of speed, angle and viscosity, far from every change."""
    speed, viscosity = Scene.load(preset).speed_of(stokes), float(Scene.load(preset).entries[MU])
    return lambda theta: law(speed * (1 + theta[0]), 0.6 * (1 + theta[1]), {MU: viscosity * (1 + theta[2])})


IMPACTS = (("granulation", 0.3), ("granulation-dry-bridge", 0.5), ("pendulum", 1.5))
CHECKER = {"eps": 1e-5, "atol": 1e-4, "rtol": 1e-4}  # differences of results at 1e-12


@pytest.mark.parametrize(("preset", "stokes"), IMPACTS)
def test_the_checker_of_jax_passes(jax: Any, preset: str, stokes: float) -> None:
    """Both modes."""
    from jax.test_util import check_grads
    from wetdoublet.solvers.export.jax import law

    function = moved(law(preset, rtol=1e-12, undifferentiable="raise"), preset, stokes)
    check_grads(function, (np.zeros(3),), order=1, modes=("fwd", "rev"), **CHECKER)


@pytest.mark.parametrize(("preset", "stokes"), IMPACTS)
def test_the_checker_of_torch_passes(torch: Any, preset: str, stokes: float) -> None:
    """Both modes."""
    from wetdoublet.solvers.export.torch import law

    function = moved(law(preset, rtol=1e-12, undifferentiable="raise"), preset, stokes)
    theta = torch.zeros(3, dtype=torch.float64, requires_grad=True)
    torch.autograd.gradcheck(function, (theta,), check_forward_ad=True, **CHECKER)


def test_what_has_no_derivative_is_nan_zero_or_an_error(jax: Any, torch: Any) -> None:
    """A stick has no contact time: NaN unless another choice was made, never a number."""
    from wetdoublet.solvers.export import jax as of_jax
    from wetdoublet.solvers.export import torch as of_torch

    _, slope = expected("contact_time")
    assert np.isnan(slope[0]) and np.isfinite(slope[1:]).all()
    for choice, first in (("nan", np.nan), ("zero", 0.0)):
        times = of_jax.law("granulation", "contact_time", undifferentiable=choice)
        found = jax.jacfwd(lambda m, times=times: times(SPEED, ANGLE, {MU: m}))(2.0)
        assert np.allclose(found, [first, *slope[1:]], rtol=1e-7, atol=0, equal_nan=True)
    times = of_torch.law("granulation", "contact_time", undifferentiable="raise")
    viscosity = torch.tensor(2.0, dtype=torch.float64, requires_grad=True)
    with pytest.raises(ComputationError, match=r"impact\.speed = 1,.*a stick"):
        times(torch.tensor(SPEED), ANGLE, {MU: viscosity}).sum().backward()


def test_a_loss_without_the_undefined_results_has_its_gradient_in_torch(torch: Any) -> None:
    """A NaN that the loss does not depend on does not reach the gradient."""
    from wetdoublet.solvers.export.torch import law

    viscosity = torch.tensor(2.0, dtype=torch.float64, requires_grad=True)
    law("granulation", "contact_time")(torch.tensor(SPEED), ANGLE, {MU: viscosity}).nansum().backward()
    assert viscosity.grad.item() == pytest.approx(expected("contact_time")[1][1:].sum(), rel=1e-7)


def test_near_a_change_of_outcome_there_is_no_derivative(torch: Any) -> None:
    """So near that its error would exceed what is promised: NaN, as `gradients_many` has it."""
    from wetdoublet.solvers import boundary
    from wetdoublet.solvers.export.torch import law

    scene = Scene.load("granulation")
    stokes = boundary(scene, angle=0.0).changes[0][0].stokes * (1 + 1e-13)
    speed = torch.tensor(stokes / scene.stokes_per_speed, dtype=torch.float64, requires_grad=True)
    law(scene)(speed, 0.0).backward()
    assert torch.isnan(speed.grad)


def test_second_derivatives_are_refused(jax: Any, torch: Any) -> None:
    """By an error, not by zeros."""
    from wetdoublet.solvers.export import jax as of_jax
    from wetdoublet.solvers.export import torch as of_torch

    with pytest.raises(ValueError, match="JVP"):
        jax.hessian(lambda v: of_jax.law("granulation")(v, ANGLE))(3.0)
    speed = torch.tensor(3.0, dtype=torch.float64, requires_grad=True)
    (slope,) = torch.autograd.grad(of_torch.law("granulation")(speed, ANGLE), speed, create_graph=True)
    with pytest.raises(NotImplementedError, match="first derivatives"):
        slope.backward()


def test_outcomes_are_integers_and_bad_input_is_named(jax: Any, torch: Any) -> None:
    """Codes as of `collide_many`; an unknown choice, entry or a speed out of range is an InputError."""
    from wetdoublet.solvers.export import jax as of_jax
    from wetdoublet.solvers.export import torch as of_torch

    for module in (of_jax, of_torch):
        found = module.law("granulation", ["outcome", "restitution"])(SPEED, ANGLE)["outcome"]
        assert np.array_equal(found, [0, 2, 2, 2]) and "int32" in str(found.dtype)
        with pytest.raises(InputError, match="undifferentiable"):
            module.law("granulation", undifferentiable="none")
        with pytest.raises(InputError, match="viscosity"):
            module.law("granulation")(3.0, ANGLE, {"liquid.viskosity": 2.0})
    with pytest.raises(InputError, match=r"impact\.speed"):
        of_torch.law("granulation")(-3.0, ANGLE)
    with pytest.raises(jax.errors.JaxRuntimeError, match=r"impact\.speed"):
        of_jax.law("granulation")(-3.0, ANGLE)
