"""What results show in a notebook, and a scene when it is printed."""

from collections.abc import Callable
from typing import Any

import pytest
from wetdoublet.solvers import Scene, boundary, collide, sensitivities

NAME = "<b>&'\""
SCENE = Scene.load("granulation").with_entries({"name": NAME})

# how it is made, what its table says
RESULTS: dict[str, tuple[Callable[[], Any], list[str]]] = {
    "scene": (lambda: SCENE, ["liquid.viscosity", "2 Pa s", "assumed: glass", "default"]),
    "collision": (
        lambda: collide(SCENE, stokes=0.05, angle="75 deg"),
        ["stick-rotate-separate", "1.581", "rupture at"],
    ),
    "stick": (lambda: collide(SCENE, stokes=0.01, ledger=False), ["stick", "proved"]),
    "boundaries": (lambda: boundary(SCENE, angle=[0.5], stokes=(0.05, 0.2)), ["28.6479", "stick-rotate-separate"]),
    "sensitivities": (lambda: sensitivities(SCENE, stokes=0.01), ["restitution = 0", "wetdoublet boundary"]),
}


@pytest.mark.parametrize("kind", RESULTS)
def test_a_notebook_shows_a_small_escaped_table(kind: str) -> None:
    """A table of what matters; a name that looks like markup is text, and no colour is set that a dark page hides."""
    make, says = RESULTS[kind]
    shown = make()._repr_html_()
    assert all(word in shown for word in says)
    assert "&lt;b&gt;&amp;&#x27;&quot;" in shown and "<b>" not in shown
    assert "<table" in shown and "color:" not in shown
    assert len(shown) < 12_000


def test_a_printed_scene_is_a_table() -> None:
    """Each entry with the unit it was given in, defaults and assumptions marked, and the impact both ways."""
    scene = Scene.load("granulation").with_entries({"liquid.viscosity": 3.0})
    rows = {line.split()[0]: line for line in str(scene).splitlines() if line.strip()}
    assert rows["liquid.viscosity"].split()[1:] == ["3", "Pa", "s"]
    assert rows["particles.reduced_radius"].split()[1:3] == ["50", "um"]
    assert rows["bridge.rupture"].endswith("default")
    assert "assumed: glass" in rows["particles.youngs_modulus"]
    assert f"{scene.speed:.4g} m/s" in str(scene)
    assert max(map(len, str(scene).splitlines())) <= 100
