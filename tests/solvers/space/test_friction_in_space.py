"""Friction of the dry contact in space, beside a reference that follows it; rest, rolling and sliding."""

import math

import numpy as np
import pytest
from wetdoublet.generated.automaton import OUTCOMES
from wetdoublet.solvers import Scene, collide, collide_pair
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.space.by_kernel import by_kernel
from wetdoublet.solvers.space.ends import TERMS, residual
from wetdoublet.solvers.space.pairs import checked

from ...helpers.random_in_space import arrivals, differences, quantities, request
from ...helpers.scanned import Arrival, Scan
from ...helpers.two_bodies import bodies_of

pytestmark = [pytest.mark.skipif(compiler() is None, reason="no C compiler"), pytest.mark.slow]
WET = {"liquid.glass_transition_pressure": "1e12 Pa", "particles.roughness": "1 um", "liquid.viscosity": "0.01 Pa s"}
RESTS = {"liquid.viscosity": "0.001 Pa s", "particles.dry_restitution": 0.3}
SPIN = 16000.0


def rough(friction, beta_0=0.0, **entries):
    """Granulation with friction, and solids that touch."""
    own = {"particles.friction": friction, "particles.contact_tangential_restitution": beta_0}
    return Scene.load("granulation").with_entries({**WET, **own, **entries})


@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
@pytest.mark.parametrize("friction", [0.02, 0.3])
def test_the_reference_in_the_laboratory_s_axes_says_the_same(engine, friction):
    """Of random pairs, whose contacts slide and stick: impulses on both bodies; friction's loss closes the ledger."""
    scene = rough(friction, 0.5)
    bodies = bodies_of(scene)
    arrived = arrivals(bodies, 10.0, 4, np.random.default_rng(3))
    found = collide_pair(scene, *request(bodies, arrived), rtol=1e-11, engine=engine, ledger=True)
    for k, arrival in enumerate(arrived):
        end = Scan(bodies, arrival, rtol=1e-11).run()
        assert OUTCOMES[int(found.outcome[k])] == end.outcome
        row = {name: found[name].values[k] for name in found.data_vars}
        apart = differences(bodies, arrival, row, quantities(bodies, arrival, end))
        assert max(apart.values(), default=0.0) < 1e-7, apart
    assert (found.outcome == 2).sum() > 2  # these met solid contact
    assert np.all(found["energy.dry_friction"][found.outcome == 2] > 0)
    assert np.all(np.abs(found["energy.residual"]) < 1e-9 * found["energy.initial"])


def by_kernel_alone(scene, arrival, rtol=1e-10):
    """The ends of a pair by the kernel with vectors, without and with ledger."""
    pairs = checked(scene, *(np.array(each) for each in (arrival.normal, arrival.velocities, arrival.spins)))
    for ledger in (False, True):
        ends = by_kernel(pairs, rtol, 1, ledger)
        assert not any(ends.reason)
        yield ends
    assert np.all(np.abs(residual(ends.energy)) < 1e-9 * ends.energy[:, 0])


def test_the_kernel_creeps_where_surfaces_roll():
    """In a plane but for a tilt of 1e-9: with and without ledger as the planar kernel, which has a mode for rolling."""
    scene = rough(0.3, **RESTS, **{"impact.spin": SPIN})
    speed = scene.speed_of(5.0)
    planar = collide(scene, stokes=5.0, angle=0.3, engine="taylor", rtol=1e-10)
    sideways = speed * math.tan(0.3) * (1 + scene.liquid.film_thickness / (4 * scene.reduced_radius))
    tilt = 1e-9 * SPIN
    moving = ((0.0, 0.0, speed), (sideways, 0.0, 0.0))
    for ends in by_kernel_alone(scene, Arrival((0.0, 0.0, 1.0), moving, ((tilt, SPIN, 0.0), (tilt, SPIN, 0.0)))):
        assert OUTCOMES[int(ends.outcome[0])] == planar.outcome
        assert ends.time[0] == pytest.approx(planar.contact_time, rel=1e-7)
        assert ends.spins[0, :, 1] == pytest.approx(planar.final_spin, rel=1e-7)
    assert ends.energy[0, TERMS.index("dry_friction")] == pytest.approx(planar.energy.dry_friction, rel=1e-6)


def test_the_direction_of_sliding_turns_at_rest():
    """A doublet with other spins slides at rest in space until it is released, as the reference finds."""
    scene = rough(0.05, **RESTS)
    bodies, speed = bodies_of(scene), scene.speed_of(20.0)
    spins = ((SPIN, 4000.0, 3000.0), (0.7 * SPIN, 0.6 * SPIN, -2000.0))
    arrival = Arrival((0.0, 0.0, 1.0), ((0.0, 0.0, speed), (0.0, 0.0, 0.0)), spins)
    end = Scan(bodies, arrival, rtol=1e-10).run()
    assert [kind for kind, _ in end.events][-3:-1] == ["released", "film edge"]
    found = collide_pair(scene, arrival.normal, arrival.velocities, spins, engine="rosenbrock", rtol=1e-10, ledger=True)
    row = {name: found[name].values for name in found.data_vars}
    apart = differences(bodies, arrival, row, quantities(bodies, arrival, end))
    assert max(apart.values()) < 1e-6, apart
    assert abs(float(found["energy.residual"])) < 1e-9 * float(found["energy.initial"])
    for ends in by_kernel_alone(scene, arrival):
        assert OUTCOMES[int(ends.outcome[0])] == end.outcome == "bounce"
        assert ends.time[0] == pytest.approx(float(found.time), rel=1e-8)
        np.testing.assert_allclose(ends.normal[0], found.normal, rtol=0, atol=1e-7)
        np.testing.assert_allclose(ends.spins[0], found.spins, rtol=0, atol=1e-8 * SPIN)
    assert ends.energy[0, TERMS.index("dry_friction")] == pytest.approx(float(found["energy.dry_friction"]), rel=1e-8)
