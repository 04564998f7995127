"""Weak rebounds that come to rest, and the cut-offs of strings."""

import math
from dataclasses import replace

import pytest
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.certificates import NoCertificate
from wetdoublet.solvers.engines.casadi import locate
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model

from ....helpers.scanned import scanned


@pytest.mark.parametrize(("entries", "criterion"), [({}, "elastic"), ({"particles.roughness": "4 um"}, "rough")])
def test_chatter_rests(entries: dict[str, object], criterion: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A stick that is not proved and continued is pulled onto the solids, chatters, and comes to rest at their gap."""
    monkeypatch.setattr(locate, "STRETCHES", 4)
    scene = Scene.load("granulation").with_entries(entries)
    n = nondimensionalise(scene, scene.speed_of(0.05), math.radians(40))
    locator = locate.EventLocator(load(select_model(scene, oblique=True)), n.groups, 1e-9)
    locator.proof, locator.watch = NoCertificate(), replace(locator.watch, certificate=None)
    locator.run()  # until nothing changes any more
    found = locator.path.kinds
    assert found[-1] == "rests"
    assert not locator.path.certified
    assert set(found[:-1]) - {"turned"} == {criterion, "fell back"}
    assert found.count("rests") == 1
    # a series of rebounds, each slower by at least e_dry = 0.99, from some 1e-1 v0 to 1e-9: at most ln(1e8)/0.01
    assert len(found) < 2 * math.log(1e8) / 0.01
    assert locator.y[0] == pytest.approx(locator.contact_gap, rel=1e-12)
    assert not locator.path.separated


@pytest.mark.parametrize(
    ("stokes", "angle", "kind", "variable", "value"),
    [
        (0.3, 30, "rotation reverses", "rotation_rate", 0.0),
        pytest.param(1.0, 45, "half turn", "rotation", math.pi, marks=pytest.mark.slow),
    ],
)
def test_cut_offs(
    stokes: float, angle: float, kind: str, variable: str, value: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Strings end a stick that nothing proved where omega passes through zero, or where beta is pi."""
    monkeypatch.setattr(locate, "proof_for", lambda *_: NoCertificate())
    found = collide("pendulum", stokes=stokes, angle=math.radians(angle), rtol=1e-10, trajectory=True, engine="cvodes")
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
