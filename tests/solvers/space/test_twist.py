"""Head-on with twist alone: no torque ever acts, so it is the planar head-on law, whatever the twist."""

import numpy as np
import pytest
from wetdoublet.generated.automaton import OUTCOMES
from wetdoublet.solvers import Scene, collide, collide_pair
from wetdoublet.solvers.space.pairs import Bodies

UNEQUAL = {"partner.radius": "200 um", "partner.mass": "8e-5 g"}
NORMAL = np.array([1.0, 2.0, -0.3]) / np.linalg.norm([1.0, 2.0, -0.3])
TWISTS = 2e4, 1e6  # rad/s: the first is 5 times as fast as the approach at the surface


@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
@pytest.mark.parametrize("entries", [{}, UNEQUAL | {"particles.friction": 0.3}])
def test_twist_alone_is_the_head_on_law(entries: dict[str, object], engine: str) -> None:
    """Outcome, proof, e_n and time of the planar collision; both twists stay, and are in the ledger."""
    scene = Scene.load("granulation").with_entries(entries)
    inertia = np.array(Bodies.of(scene).inertia)
    for speed in (0.5437, 3.0):  # a stick, a bounce
        planar = collide(scene, speed=speed, angle=0.0, engine=engine)
        for twist in TWISTS:
            spins = np.array([twist, -0.3 * twist])[:, None] * NORMAL
            found = collide_pair(scene, 3.0 * NORMAL, [speed * NORMAL, 0.0 * NORMAL], spins, engine=engine, ledger=True)
            assert OUTCOMES[int(found.outcome)] == planar.outcome, str(found.reason.values)
            assert bool(found.certified) == planar.certified
            assert float(found.restitution) == pytest.approx(planar.restitution, rel=1e-10)
            np.testing.assert_allclose(found.spins, spins, rtol=0, atol=1e-14 * twist)
            np.testing.assert_allclose(found.normal, NORMAL, rtol=0, atol=1e-15)
            twisting = 0.5 * inertia @ np.array([twist, 0.3 * twist]) ** 2
            assert planar.energy is not None
            for term in ("initial", "final"):
                expected = getattr(planar.energy, term) + twisting
                assert float(found[f"energy.{term}"]) == pytest.approx(expected, rel=1e-9)


def test_the_smallest_motion_across_is_no_twist_alone() -> None:
    """A slip a thousand times above rounding turns the line of centres, and twist with it."""
    scene = Scene.load("granulation")
    across = np.cross(NORMAL, [0.0, 0.0, 1.0])
    spins = 1e5 * NORMAL + 1e-8 * across / np.linalg.norm(across)
    found = collide_pair(scene, NORMAL, [3.0 * NORMAL, 0.0 * NORMAL], [spins, spins], rtol=1e-11)
    assert np.max(np.abs(found.normal.values - NORMAL)) < 1e-12
    assert found.outcome == 2
