"""Derivatives of any collision beside extrapolated differences."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from wetdoublet.solvers import ComputationError, Scene, collide_many, sensitivities
from wetdoublet.solvers.sensitivity import by_casadi, by_kernel
from wetdoublet.solvers.sensitivity.problem import Problem, Query

from .scenes import scenes
from .settings import examples, few
from .structures import STRUCTURES

STEP = 2e-4  # relative, of an entry
RESULTS = ("restitution", "contact_time")
# beyond which no step goes
ENDS = {"particles.dry_restitution": 1.0, "particles.poisson_ratio": 0.5, "bridge.contact_angle": math.pi / 2}

pytestmark = pytest.mark.filterwarnings("ignore::wetdoublet.solvers.ModelWarning")


@examples(12)
@given(scenes(few(STRUCTURES, 11)), st.integers(0, 2**32 - 1), st.sampled_from(["forward", "adjoint"]))
def test_a_derivative_is_the_extrapolated_difference(scene: Scene, seed: int, method: str) -> None:
    """Of restitution and contact time by three entries at random, the impact's among them."""
    entries = [
        name
        for name, value in scene.si
        if isinstance(value, float) and value not in (0.0, ENDS.get(name)) and "impact" not in name
    ]
    draw = np.random.default_rng(seed)
    names = [str(name) for name in draw.choice(entries, 2, replace=False)] + ["impact.speed"]
    speed, angle = scene.need_impact()
    steps = np.array([-2, -1, 1, 2, 0.0]) * STEP
    try:
        found = sensitivities(scene, of=list(RESULTS), wrt=names, method=method, rtol=1e-11)
    except ComputationError as error:
        assert any(word in str(error) for word in ("derivative", "differentiate", "decided")), error
        assume(False)
    assume(found.value["restitution"] != 0.0)
    for name in names:
        own = speed if name == "impact.speed" else float(scene.entries[name])
        moved = own * (1 + steps)
        many = collide_many(
            scene,
            speed=moved if name == "impact.speed" else np.full(5, speed),
            angle=np.full(5, angle),
            vary={} if name == "impact.speed" else {name: moved},
            rtol=1e-13,
            of=("outcome", *RESULTS),
        )
        if len(set(many["outcome"].values.tolist())) > 1:
            continue  # a change of outcome is nearer than the steps
        for result in RESULTS:
            value = many[result].values
            wide, near = (value[3] - value[0]) / 4, (value[2] - value[1]) / 2
            slope, error = (4 * near - wide) / (3 * STEP), abs(near - wide) / STEP
            allowed = 0.1 * error + 1e-6 * (abs(value[4]) + abs(slope))
            assert math.isclose(found.gradient[result][name] * own, slope, rel_tol=0, abs_tol=allowed), (result, name)


@pytest.mark.slow
def test_an_adjoint_of_a_thinning_liquid_is_the_forward_derivative() -> None:
    """Of e_n, by both integrators, against the kernel, whose steps are controlled for its tangents: a part of 1e-5.

    The force of a power law has no bounded slope where the spheres turn: Rosenbrock's steps, which follow the states,
    were wrong by 3e-5 here.
    """
    liquid = {"liquid.law": "power-law", "liquid.flow_index": 0.6, "liquid.reference_rate": 1e4}
    scene = Scene.load("granulation").with_entries(liquid).with_impact(stokes=0.0332, angle=1.1365)
    names = ("liquid.flow_index", "liquid.viscosity", "liquid.film_thickness", "impact.speed", "impact.angle")
    problem = Problem.of(scene, *scene.need_impact(), names, "speed")
    found = by_kernel.slopes(problem, Query(RESULTS[:1], "forward", 1e-11, None))
    assert problem.path.separated and found is not None
    forward = found[1] * problem.reference(names)
    for engine in ("rosenbrock", "cvodes"):
        _, gradient = by_casadi.slopes(problem, Query(RESULTS[:1], "adjoint", 1e-9, None), engine)
        error = np.abs(gradient * problem.reference(names) - forward)
        assert (error < 1e-5 * np.abs(forward).max(axis=1, keepdims=True)).all()
