"""The table of a collision for a person, what results show in a notebook, and a scene when it is printed."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from wetdoublet import solvers
from wetdoublet.solvers import Scene, boundary, sensitivities
from wetdoublet.solvers.collision.outcome import Event
from wetdoublet.solvers.collision.text import name_of, table

from ...helpers.own_arm import surface
from ...helpers.reference import collide

SPINNING = Scene.load("granulation").with_entries({"impact.spin": 2e5, "impact.partner_spin": -5e4})
SWINGING = "a pendulum with an arm of its own"
IMPACTS = {
    "escapes": ("granulation", {}),
    "bounces": ("granulation", {"stokes": 0.14, "angle": "40 deg"}),
    "sticks at touch": ("granulation", {"stokes": 0.012, "angle": "50 deg"}),
    "sticks later": ("granulation", {"stokes": 0.03, "angle": "40 deg"}),
    "half turn": (SWINGING, {"stokes": 1.0, "angle": "45 deg"}),
    "rotation reverses": (SWINGING, {"stokes": 0.6, "angle": "40 deg"}),
    "pendulum": ("pendulum", {"stokes": 1.0, "angle": "45 deg"}),
    "reversed, sticks": ("pendulum", {"stokes": 1.37, "angle": "20 deg"}),
    "head-on": ("granulation", {"stokes": 0.125, "angle": 0.0}),
    "spins": (SPINNING, {"stokes": 0.5, "angle": 0.0}),
    "gains": ("granulation", {"stokes": 0.3, "angle": "70 deg"}),
    "film alone": ("granulation-dry-bridge", {"stokes": 0.05, "angle": 0.0}),
    "parts at touch": ("granulation-dry-bridge", {"stokes": 0.3, "angle": "70 deg"}),
}


@pytest.fixture(scope="module")
def collisions():
    own = surface("pendulum")  # no proof on strings: runs to its cut-off
    return {name: collide(own if scene is SWINGING else scene, **impact) for name, (scene, impact) in IMPACTS.items()}


def row(text, name):
    """Return what a row of the table says."""
    (line,) = [line for line in text.splitlines() if line.strip().startswith(name)]
    return line.strip().removeprefix(name).strip()


@pytest.mark.parametrize("name", IMPACTS)
def test_fits_a_terminal_and_gives_the_reason(collisions, name):
    """Every table is ASCII, at most 88 columns wide, and what print() shows; the outcome stands with its reason."""
    text = str(collisions[name])
    if name in REASONS:
        assert row(text, "outcome") == REASONS[name][0]
        assert REASONS[name][1] in text
    assert text == table(collisions[name])
    assert text.isascii()
    assert max(map(len, text.splitlines())) <= 88
    assert all(line == line.rstrip() for line in text.splitlines())
    assert not {"nan", "inf", "None"} & set(text.replace(",", " ").split())


REASONS = {
    "escapes": ("stick-rotate-separate", "escaped by centrifugal force, no rebound criterion met"),
    "bounces": ("bounce", "rebounded because the liquid reached its glass transition"),
    "sticks at touch": ("stick", "proved at contact: energy below the barrier"),
    "sticks later": ("stick", "proved: energy below the barrier (certificate)"),
    "half turn": ("stick", "cut off after 767.4 ms: half a turn"),
    "rotation reverses": ("stick", "cut off after 450.7 ms: the strings turn the rotation back"),
    "pendulum": ("stick", "proved: the strings hold it for good"),
    "reversed, sticks": ("stick", "the glass criterion had made it rebound on the way"),
    "film alone": ("stick", "proved at contact: the film stops it"),
}


def test_absent_tables_leave_no_lines(collisions):
    """Strings are named only with a pendulum, Ce, Ca and capillary work only with a bridge, Re only with a density."""
    granulation, pendulum = table(collisions["escapes"]), table(collisions["half turn"])
    assert "strings" not in granulation
    assert "capillary work" in granulation
    assert "Ce 4.612, Ca 815.6" in granulation
    assert "\n  strings" in pendulum
    assert not any(word in pendulum for word in ("capillary", "Ce ", "Ca "))
    assert "Re " not in granulation
    dense = Scene.load("granulation").with_entries({"liquid.density": "1000 kg/m^3"})
    assert ", Re 0.002175" in table(collide(dense))


def test_events_and_ledger_are_those_of_the_result(collisions):
    """Events stand with their times; the ledger's percentages are of the initial energy and add up to 100."""
    text = table(collisions["escapes"])
    assert row(text, "turned") == "17.12 us"
    assert row(text, "rupture") == "1.975 ms"
    assert row(text, "kinetic, initial").endswith("100.000")
    spent = ("kinetic, final", "normal lub", "tangential lub", "dry contact", "capillary work")
    assert sum(float(row(text, name).split()[-1]) for name in spent) == pytest.approx(100, abs=0.003)
    assert row(text, "engine") == f"{collisions['escapes'].engine}, {collisions['escapes'].steps} steps"


@pytest.mark.parametrize(("restitution", "given"), [(1.0, False), (1.001, True)])
def test_what_rotation_has_given_is_said_beyond_one(collisions, restitution, given):
    shown = row(table(replace(collisions["bounces"], restitution=restitution)), "restitution e_n")
    assert shown.startswith(f"{restitution:g}") and ("rotation has given it energy" in shown) == given


def test_spins_before_and_after(collisions):
    """Both spheres' spins at initial contact and at separation; none before where the scene gives none."""
    lines = table(collisions["spins"]).splitlines()
    names = [line[:12].strip() for line in lines]
    first, last = names.index("initial spin"), names.index("final spin")
    assert "200000 rad/s" in lines[first] and "-50000 rad/s" in lines[first + 1]
    assert lines[first + 1].endswith("its partner") and lines[last + 1].endswith("its partner")
    assert "initial spin" not in table(collisions["head-on"])


def test_a_name_is_one_short_line():
    """Control characters and line breaks of a scene's name do not reach the terminal, nor does a novel."""
    scene = Scene.load("granulation").with_entries({"name": "a\n\x1b[2J " + "b" * 99})
    assert name_of(scene, 20) == "a [2J bbbbbbbbbbb..."
    assert max(map(len, table(collide(scene)).splitlines())) <= 88
    assert name_of(scene.with_entries({"name": ""})) == "unnamed scene"


def test_many_events_are_shortened(collisions):
    """A chatter's hundreds of events do not fill the screen: first and last stand, the others are counted."""
    few, many = (tuple(Event("rough", 1e-6 * k) for k in range(count)) for count in (40, 100_000))
    few, many, rests = (
        replace(collisions["escapes"], events=each) for each in (few, many, (*many[:300], Event("rests", 4e-4)))
    )
    assert repr(few).count("kind='rough'") == repr(many).count("kind='rough'") == 40
    for part in ("... 99960 more ...", repr(many.events[0]), repr(many.events[-1])):
        assert part in repr(many)
    assert len(many.to_dict()["events"]) == 100_000
    assert len(table(rests).splitlines()) < 50
    assert (row(table(rests), "..."), row(table(rests), "rests")) == ("289 more", "400 us")


NAME = "<b>&'\""
SCENE = Scene.load("granulation").with_entries({"name": NAME})

RESULTS: dict[str, tuple[Callable[[], Any], list[str]]] = {  # how it is made, what its table says
    "scene": (lambda: SCENE, ["liquid.viscosity", "2 Pa s", "assumed: glass", "default"]),
    "collision": (
        lambda: solvers.collide(SCENE, stokes=0.05, angle="75 deg"),
        ["stick-rotate-separate", "1.581", "rotation has given"],
    ),
    "stick": (lambda: solvers.collide(SCENE, stokes=0.01, ledger=False), ["stick", "proved"]),
    "boundaries": (lambda: boundary(SCENE, angle=[0.5], stokes=(0.05, 0.2)), ["28.6479", "stick-rotate-separate"]),
    "sensitivities": (lambda: sensitivities(SCENE, stokes=0.01), ["restitution", "wetdoublet boundary"]),
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


def test_a_scene_without_a_name_has_no_empty_heading() -> None:
    assert "unnamed scene" in Scene("", SCENE.given)._repr_html_().partition("</tr>")[0]


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
