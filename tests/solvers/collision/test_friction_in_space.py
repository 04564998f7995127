"""Friction of the dry contact in space, beside a reference that follows it; rest, rolling and sliding."""

import math

import numpy as np
import pytest
from wetdoublet.generated.automaton import OUTCOMES
from wetdoublet.solvers import Scene, collide, collide_pair
from wetdoublet.solvers.collision.space.by_kernel import by_kernel
from wetdoublet.solvers.collision.space.ends import TERMS, residual
from wetdoublet.solvers.collision.space.pairs import checked
from wetdoublet.solvers.host.compiler import compiler

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


CLOCK = '''"""A kick, and a cut-off, at a time."""
from wetdoublet.derive.user import *

kicked = quantity("kicked", unit="s", default="1e9 s", meaning="time of the kick")
last = quantity("last", unit="s", default="1e9 s", meaning="time at which it ends")
event("kick", guard=kicked - t, jump={u: u + 10*v0}, releases=100*m*v0**2)
event("late", guard=last - t, ends="stick")
'''
COMES_TO_REST = RESTS | {"particles.dry_restitution": 0.0}


def clocked(folder, **entries):
    """A rough scene that comes to rest, with a model of these times."""
    (folder / "clock.py").write_text(CLOCK)
    own = {"particles.friction": 0.3, **WET, **COMES_TO_REST, **entries}
    return Scene.load("granulation", model=folder / "clock.py").with_entries(own)


def test_rolling_surfaces_wait_for_a_kick_as_in_the_plane(tmp_path):
    """In a plane but for a tilt of 1e-9: a doublet that has crept at rest is set free as one that has rolled."""
    scene = clocked(tmp_path, **{"custom.kicked": 0.01, "impact.spin": SPIN / 40})
    planar, speed = collide(scene, stokes=5.0, angle=0.3, rtol=1e-10), scene.speed_of(5.0)
    assert [event.kind for event in planar.events][-4:-1] == ["rolls", "kick", "film edge"]
    sideways = speed * math.tan(0.3) * (1 + scene.liquid.film_thickness / (4 * scene.reduced_radius))
    spin = (1e-9 * SPIN, SPIN / 40, 0.0)
    arrival = Arrival((0.0, 0.0, 1.0), ((0.0, 0.0, speed), (sideways, 0.0, 0.0)), (spin, spin))
    for ends in by_kernel_alone(scene, arrival):
        assert ends.time[0] == pytest.approx(planar.contact_time, rel=1e-9)
        assert ends.opening[0] == pytest.approx(planar.restitution * speed, rel=1e-8)
        assert ends.spins[0, :, 1] == pytest.approx(planar.final_spin, rel=1e-7)


@pytest.mark.parametrize("last", [0.01, 1.0])
def test_a_doublet_with_twist_is_followed_at_rest_to_a_time(last, tmp_path):
    """It tumbles: the angular momentum keeps its three components, and within a second all slip is gone."""
    scene = clocked(tmp_path, **{"custom.last": last})
    bodies, speed = bodies_of(scene), scene.speed_of(5.0)
    spins = ((400.0, 400.0, 300.0), (280.0, 240.0, -200.0))
    arrival = Arrival((0.0, 0.0, 1.0), ((0.0, 0.0, speed), (0.0, 0.0, 0.0)), spins)
    for ends in by_kernel_alone(scene, arrival):
        assert (OUTCOMES[int(ends.outcome[0])], ends.time[0]) == ("stick", pytest.approx(last, rel=1e-9))
        normal, turning, own = ends.normal[0], ends.turning[0], ends.spins[0]
        apart = sum(bodies.radii) + ends.gap[0]
        momentum = bodies.m * apart**2 * turning + np.array(bodies.inertias) @ own
        first = np.array(bodies.inertias) @ np.array(spins)
        np.testing.assert_allclose(momentum, first, rtol=0, atol=1e-8 * np.linalg.norm(first))
        assert np.linalg.norm(normal) == pytest.approx(1.0, abs=1e-8)
        slips = (turning - own) @ (np.eye(3) - np.outer(normal, normal))  # across the line of centres
        rolls = np.linalg.norm(slips, axis=1) / np.linalg.norm(own[0])
        assert (rolls.max() < 1e-6) == (last >= 1.0)
        assert np.linalg.norm(slips.sum(axis=0)) < 1e-7 * np.linalg.norm(own[0])  # the surfaces do not slide
