"""`collide(until=...)`: a stick is followed on after it is certain."""

import math

import numpy as np
import pytest
from wetdoublet.solvers import Scene, collide

from ...helpers.scanned import scanned


def test_a_stick_is_followed_from_its_proof_to_the_time_that_is_asked_for() -> None:
    """What was certain at the proof stays; `until` and the trajectory end there, and ledger and momentum hold."""
    impact = {"stokes": 0.05, "angle": "30 deg", "engine": "cvodes"}
    proved, followed = collide("granulation", **impact), collide("granulation", **impact, until="1 ms", trajectory=True)
    for name in ("outcome", "certified", "reversal", "restitution", "contact_time"):
        assert getattr(followed, name) == getattr(proved, name)
    assert followed.certified and proved.decided == proved.until
    assert followed.decided == pytest.approx(proved.until, rel=1e-6)
    assert followed.until == pytest.approx(1e-3, rel=1e-6)
    assert float(followed.trajectory["time"][-1]) == pytest.approx(1e-3, rel=1e-6)
    assert np.all(np.diff(followed.trajectory["time"]) >= 0)
    assert followed.energy.final < proved.energy.final
    assert abs(followed.energy.residual) < 1e-7 * followed.energy.largest
    assert followed.angular_momentum_drift < 1e-9


@pytest.mark.parametrize("engine", ["cvodes", "taylor"])
def test_the_film_stops_the_spheres_where_the_closed_form_says(engine: str) -> None:
    """Head-on in an unbounded film x' = -v0 [1 + ln(x/x0)/St]: proved at contact, the gap comes to x0 exp(-St)."""
    entries = {
        "model.film": "infinite", "liquid.glass_transition_pressure": "1e9 GPa", "particles.youngs_modulus": "1e9 GPa",
    }  # fmt: skip
    scene = Scene.load("granulation-dry-bridge").with_entries(entries)
    stick = collide(scene, stokes=0.7, angle=0, engine=engine, until="2 ms", trajectory=True)
    assert (stick.outcome, stick.decided) == ("stick", 0.0)
    assert stick.trajectory is not None
    gap = float(stick.trajectory["gap"][-1])
    assert gap == pytest.approx(scene.liquid.film_thickness * math.exp(-0.7), rel=1e-6)


@pytest.mark.parametrize(("entries", "criterion"), [({}, "elastic"), ({"particles.roughness": "4 um"}, "rough")])
def test_a_stick_that_is_followed_on_comes_to_rest(entries: dict[str, object], criterion: str) -> None:
    """It is pulled onto the solids, chatters and rests at their gap, after rebounds slower by e_dry = 0.99 each."""
    scene = Scene.load("granulation").with_entries(entries)
    stick = collide(scene, stokes=0.05, angle="40 deg", until="100 ms")
    kinds = [event.kind for event in stick.events]
    assert stick.outcome == "stick"
    assert kinds[-1] == "rests" and kinds.count("rests") == 1
    assert set(kinds[:-1]) - {"turned"} == {criterion, "fell back"}
    # from some 1e-1 v0 to 1e-9: at most ln(1e8)/0.01
    assert len(kinds) < 2 * math.log(1e8) / 0.01


@pytest.mark.parametrize(
    ("stokes", "angle", "kind", "variable", "value"),
    [(0.3, 30, "rotation reverses", "rotation_rate", 0.0), (1.0, 45, "half turn", "rotation", math.pi)],
)
def test_a_stick_that_is_followed_on_is_cut_off(
    stokes: float, angle: float, kind: str, variable: str, value: float
) -> None:
    """On strings where omega passes through zero, or where beta is pi, as the reference finds."""
    impact = {"stokes": stokes, "angle": math.radians(angle)}
    found = collide("pendulum", **impact, rtol=1e-10, until="100 s", trajectory=True, engine="cvodes")
    assert (found.outcome, [event.kind for event in found.events][-1]) == ("stick", kind)
    assert found.until == found.events[-1].time
    assert found.trajectory is not None
    assert float(found.trajectory.time[-1]) == pytest.approx(found.until, rel=1e-14)
    last = float(found.trajectory[variable][-1])
    # relative to omega0 and to pi; the integration's error at 1e-10 with room
    scale = math.pi if kind == "half turn" else float(found.trajectory.rotation_rate[0])
    assert abs(last - value) < 1e-8 * scale
    other = scanned(found.scene)
    assert [kind for kind, _ in other.events] == [event.kind for event in found.events]
    assert other.time == pytest.approx(found.until, rel=1e-7)
