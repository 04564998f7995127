"""The figure of a collision, and the doublet's frames in it."""

import math

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.collision.plot.figure import draw
from wetdoublet.solvers.collision.plot.frames import frames, orientation

from .test_text import IMPACTS as SHOWN

pytestmark = pytest.mark.slow
NAMES = ("escapes", "sticks at touch", "sticks later", "head-on", "parts at touch")
IMPACTS = {name: SHOWN[name] for name in NAMES} | {"pendulum bounces": ("pendulum", {"stokes": 1.5, "angle": "45 deg"})}


@pytest.fixture(scope="module")
def collisions():
    return {name: collide(scene, **impact, trajectory=True) for name, (scene, impact) in IMPACTS.items()}


@pytest.mark.parametrize("name", IMPACTS)
def test_nothing_is_clipped(collisions, name):
    """Everything drawn lies inside the figure."""
    figure = draw(collisions[name])
    figure.draw_without_rendering()
    box, (width, height) = figure.get_tightbbox(), figure.get_size_inches()
    assert min(box.x0, box.y0, width - box.x1, height - box.y1) >= 0


@pytest.mark.parametrize("name", IMPACTS)
def test_frames_are_of_the_trajectory(collisions, name):
    """Frames start at contact; their centres are 4a + x apart about a resting centre of mass, turned by beta."""
    collision = collisions[name]
    data, a = collision.trajectory, collision.scene.particles.reduced_radius
    pictures = frames(collision)
    assert pictures[0].time == 0
    assert [frame.free for frame in pictures[:-1]] == [False] * (len(pictures) - 1)
    assert pictures[-1].free == (collision.outcome != "stick")
    for frame in pictures:
        (x1, y1), (x2, y2) = frame.centres
        assert math.hypot(x2 - x1, y2 - y1) == pytest.approx(4 * a + frame.gap, rel=1e-12)
        assert (x1 + x2, y1 + y2) == (0, 0)
        if not frame.free and frame.time > 0:
            assert frame.gap == pytest.approx(float(np.interp(frame.time, data["time"], data["gap"])), rel=1e-12)
            assert frame.angle == pytest.approx(float(np.interp(frame.time, data["time"], data["rotation"])), rel=1e-12)


@pytest.mark.parametrize("name", sorted({*IMPACTS} - {"sticks later", "sticks at touch"}))
def test_after_rupture_the_pair_moves_straight(collisions, name):
    """The last frame of a separated pair is on the straight line that leaves the frame of rupture."""
    collision = collisions[name]
    *_, before, after = frames(collision)
    (x0, y0), (x1, y1) = before.centres[1], after.centres[1]
    wait = after.time - before.time
    assert wait > 0
    assert 2 * (x1 - x0) == pytest.approx(after.relative[0] * wait, rel=1e-9, abs=1e-9 * before.radius)
    assert 2 * (y1 - y0) == pytest.approx(after.relative[1] * wait, rel=1e-9, abs=1e-9 * before.radius)
    opening = after.relative[0] * math.cos(before.angle) + after.relative[1] * math.sin(before.angle)
    assert opening == pytest.approx(collision.restitution * collision.speed, rel=1e-6)
    assert after.gap - before.gap == pytest.approx(0.8 * before.radius)


def test_spheres_that_spin_along_the_line_of_centres_turn():
    """At angle zero a spin gives the panels of rotation and of sliding beside a wall, and pictures that slide."""
    spinning = Scene.load("granulation").with_entries({"partner.wall": True, "impact.spin": 2e5})
    found = collide(spinning, stokes=0.5, angle=0.0, trajectory=True)
    assert [axes.get_ylabel().split()[0] for axes in draw(found).axes[:4]] == ["gap", "normal", "rotation", "sliding"]
    slid = np.trapezoid(found.trajectory["sliding_velocity"], found.trajectory["time"])
    *_, last, _ = frames(found)
    assert last.slid == pytest.approx(slid, rel=1e-4) and slid > 0


def test_orientation_is_the_integral_of_spin():
    """A sphere's orientation is int xi dt: exact where it turns with the doublet, to second order where it slips."""
    time = np.linspace(0, 2, 401)
    beta, omega = time**3, 3 * time**2
    assert orientation(time, beta, omega, omega) == pytest.approx(beta, abs=0)
    slipping = omega - np.exp(-time)
    exact = beta - (1 - np.exp(-time))
    assert orientation(time, beta, omega, slipping) == pytest.approx(exact, abs=1e-5)


def test_the_proof_stands_at_its_time():
    """A stick that is followed on has its proof marked where it was certain, not behind the events that come after."""
    impact = {"relative_speed": "0.7 m/s", "angle": "45 deg"}
    collision = collide("lactose-pvp", **impact, until="0.5 ms", trajectory=True)
    assert collision.certified
    assert collision.decided < collision.events[-1].time
    texts = [text for axes in draw(collision).axes for text in axes.texts]
    (mark,) = {text.xy[0] for text in texts if "proved to stick" in text.get_text()}
    assert mark == pytest.approx(collision.decided * 1e6, abs=0.02 * 500)  # us; labels this near are joined
