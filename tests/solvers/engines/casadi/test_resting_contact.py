"""Weak rebounds that come to rest, and the cut-offs of strings."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from wetdoublet.solvers import Scene, collide
from wetdoublet.solvers.certificates import NoCertificate
from wetdoublet.solvers.engines.casadi import locate
from wetdoublet.solvers.model.dimensionless import nondimensionalise
from wetdoublet.solvers.model.model import load, select_model

from ....helpers.independent import Spheres, integrated


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


def test_resting_turns_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """In resting contact, gap held at the roughness, the rotation goes on: an integration with x held, up to omega = 0.

    Wholly inelastic spheres on strings: the first contact is at rest at once. (The stick is proved long before.)
    """
    monkeypatch.setattr(locate, "proof_for", lambda *_: NoCertificate())
    scene = Scene.load("pendulum").with_entries({"particles.roughness": "350 um", "particles.dry_restitution": 0.0})
    found = collide(scene, stokes=0.05, angle="30 deg", rtol=1e-11, trajectory=True, engine="cvodes")
    assert (found.outcome, [event.kind for event in found.events]) == ("stick", ["rough", "rests", "rotation reverses"])
    assert found.trajectory is not None
    assert found.until is not None
    resting = found.trajectory.isel(time=found.trajectory.phase.values == "resting contact")
    assert float(abs(resting.gap / 350e-6 - 1).max()) < 1e-12
    assert not resting.normal_velocity.any()
    body = Spheres(scene, found.speed)
    names = ("gap", "normal_velocity", "rotation_rate", "spin", "rotation")
    start = np.array([float(resting[name][0]) for name in names])

    def rates(_: float, y: np.ndarray) -> list[float]:
        return [0.0, 0.0, *body.rates(np.array([350e-6, 0.0, *y[2:]]), film=True, shear=True)[2:]]

    span = (found.events[0].time, found.until)
    end = solve_ivp(rates, span, start, method="Radau", rtol=1e-10, atol=1e-16).y[:, -1]
    assert abs(end[2]) < 1e-7 * start[2]
    assert float(resting.spin[-1]) == pytest.approx(end[3], abs=1e-7 * start[2])
    assert float(resting.rotation[-1]) == pytest.approx(end[4], rel=1e-7)


@pytest.mark.parametrize(
    ("stokes", "angle", "kind", "variable", "value"),
    [(0.3, 30, "rotation reverses", "rotation_rate", 0.0), (1.0, 45, "half turn", "rotation", math.pi)],
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
    other = integrated(found.scene, stokes, math.radians(angle))
    assert other.events == [event.kind for event in found.events]
    assert other.time == pytest.approx(found.until, rel=1e-7)


def test_rest_without_shear_is_for_good() -> None:
    """Soft spheres that rest beyond their film feel no tangential force: nothing changes any more, a stick is proved.

    x_r = 33 x0 here; the inward force holds while the rate of rotation stays what it is.
    """
    scene = Scene.from_dict(
        {
            "particles": {
                "reduced_radius": 8.47208e-05,
                "density": 10818.7,
                "roughness": 2.99316e-11,
                "dry_restitution": 0.191098,
                "youngs_modulus": 2488630.0,
                "poisson_ratio": 0.0534149,
            },
            "liquid": {
                "viscosity": 0.000731582,
                "film_thickness": 3.48475e-09,
                "glass_transition_pressure": 112043000000.0,
            },
            "bridge": {"surface_tension": 0.213029, "volume": 1.80604e-05, "contact_angle": 1.54154, "law": "soulie"},
            "model": {"tangential": "film"},
        }
    )
    n = nondimensionalise(scene, scene.speed_of(187.815), 1.40734)
    locator: Any = locate.EventLocator(load(select_model(scene, oblique=True)), n.groups, 1e-9)
    locator.proof = locator.proof.beside  # the orbit's momentum proves it sooner
    found = locator.run()
    assert found.kinds[-2:] == ["elastic", "rests"]
    assert (found.outcome, found.certified) == ("stick", True)
    state = dict(zip(locator.model.state, locator.y, strict=False))
    assert state["gap"] > 1
    assert locator.model.values("inward_force", locator.y, locator.p)["inward_force"] > 0
    rates = locator.model.values("resting_rates", locator.y, locator.p, film=0, shear=0)
    assert not any(rates.values())
