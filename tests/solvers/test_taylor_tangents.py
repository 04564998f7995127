"""Derivatives by the kernel beyond the paper's structures: partners, attractions, films, ruptures, a user's laws."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from wetdoublet.solvers import Scene, sensitivities
from wetdoublet.solvers.compiled import compiler
from wetdoublet.solvers.taylor import headers, library

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")
RTOL = 1e-8  # of a low order, whose kernel is compiled fast
OF = ("restitution", "tangential_restitution", "contact_time", "smallest_gap", "rotation", "final_spin")
PAIR = {
    "partner.radius": "300 um", "partner.density": "1500 kg/m^3", "attraction.hamaker": 1e-16,
    "model.film": "constant-volume", "bridge.law": "willett", "bridge.rupture": "own",
}  # fmt: skip
MODEL = """
from wetdoublet.derive.user import *
stress = quantity("yield_stress", "s", unit="Pa", default="2 Pa", bounds=">= 0", meaning="yield stress")
thinning = quantity("thinning", "n", default=0.3, bounds=">= 0", meaning="how the film thins with the shear")
law("bridge", "yielding", meaning="constant force and a stress that the gap relieves", source="by a test",
    force=2 * pi * R * sigma * cos(phi) + stress * R**2 * exp(-x / R))
law("film", "thinning", meaning="thins as it is sheared", source="by a test",
    resistance=1 / gap / (1 + thinning * opening**2))
"""
WALL = {"partner.wall": True, "attraction.hamaker": 1e-15, "particles.roughness": "2 um"}
ROUGH = {"liquid.glass_transition_pressure": "10 GPa"}  # so that it goes through the film


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Kernels compiled without optimisation, for two lanes: in a third of the time."""
    monkeypatch.setattr(library, "FLAGS", ("-O0", *(f for f in library.FLAGS if f not in ("-O2", "-funroll-loops"))))
    monkeypatch.setattr(library, "lanes", lambda: 2)


def _agrees(scene: Scene, stokes: float, degrees: float) -> None:
    """All gradients as CasADi's forward derivatives have them, but for errors of the tolerance."""
    asked = {"stokes": stokes, "angle": np.radians(degrees)}
    found = sensitivities(scene, OF, **asked, rtol=RTOL, engine="taylor")
    expected = sensitivities(scene, OF, **asked, rtol=1e-10, engine="rosenbrock")
    assert (found.engine, found.outcome) == ("taylor", expected.outcome)
    for name in OF:
        # in theta, p = p_ref (1 + theta): of one unit; errors of the conditioning, some tens at most
        size = {p: at or 1.0 for p, at in expected.reference.items()}
        own, right = ([g.gradient[name][p] * size[p] for p in size] for g in (found, expected))
        np.testing.assert_allclose(own, right, atol=100 * RTOL * np.abs(right).max(), err_msg=name)
        assert not any(right[k] == 0 for k in np.flatnonzero(own))  # what is small is not nothing


def test_partner_attraction_spreading_film_own_rupture() -> None:
    """Unequal spheres, an attraction, a film of constant volume, the law's own rupture distance, all in one scene."""
    scene = Scene.load("granulation").with_entries(PAIR)
    _agrees(scene, 0.6, 30.0)
    _agrees(scene, 0.06, 75.0)


def test_a_users_model_at_a_wall(tmp_path: Path) -> None:
    """Laws with quantities of their own, one that knows the opening velocity, at a wall: by these quantities too."""
    model = tmp_path / "mine.py"
    model.write_text(MODEL)
    scene = Scene.load("granulation", model=model).with_entries(WALL | ROUGH)
    _agrees(scene, 5.0, 45.0)
    found = sensitivities(scene, "restitution", stokes=5.0, angle="45 deg", rtol=RTOL, engine="taylor")
    assert found.gradient["restitution"]["custom.thinning"] != 0
    assert found.gradient["restitution"]["custom.yield_stress"] < 0  # it pulls


def test_what_has_no_tangent_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """A law whose slopes are not emitted: one line says why, once, and CasADi answers."""
    texts = headers._texts
    none = ["#error no slopes of it\n"]
    monkeypatch.setattr(headers, "_texts", lambda choice, tangent: none if tangent else texts(choice, tangent))
    headers.tangents.cache_clear()
    headers._say.cache_clear()
    try:
        for stokes in (0.3, 0.4):
            found = sensitivities(Scene.load("granulation"), stokes=stokes, angle=0.5, engine="taylor")
            assert found.engine == "rosenbrock"
    finally:
        headers.tangents.cache_clear()
    said = "no derivatives by the Taylor kernel (no slopes of it): other engines answer\n"
    assert capsys.readouterr().err == said
