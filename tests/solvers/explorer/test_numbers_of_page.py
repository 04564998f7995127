"""The page's numbers are Python's, in browsers: collisions, maps, curves, ledgers, and what it gives for Python."""

import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, collide, collide_many, explore

from .page import LACTOSE, SCENES

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("optimized")]

RESULTS = ("restitution", "tangential_restitution", "contact_time", "rotation", "smallest_gap", "final_spin")
SETTINGS = 80  # random ones, of all scenes together
LEDGERS = 4  # separations of each scene
TERMS = {
    "normal_lubrication": "lost squeezing the film",
    "tangential_lubrication": "lost shearing the film",
    "capillary": "stored in the bridge",
    "attraction": "against attraction",
    "dry_contact": "lost in solid contact",
    "strings": "stored in the strings",
}
SHARP = 1e-12  # relative tolerance of integration where numbers are compared to 1e-9


@pytest.mark.parametrize("name", SCENES)
def test_numbers_are_those_of_python(name: str, opened: Any):
    """Random settings, through the TOML that the page gives: outcomes all, numbers to 1e-9; refusals are the same."""
    page, draw, decided = opened(name), random.Random(name), 0
    for _ in range(-(-SETTINGS // len(SCENES))):
        state = page.ask("wetdoublet.state()")
        for knob in page.knobs:
            part = draw.uniform(0.3, 0.7)
            if knob["value"] is None or draw.random() < 0.3:
                continue
            low, high = knob["low"], knob["high"]
            value = low * (high / low) ** part if knob["logarithmic"] else low + (high - low) * (1.6 * part - 0.3)
            state["values"][knob["name"]] = value
        found, toml = page.ask(f"s => [wetdoublet.collide(s, {SHARP}), wetdoublet.toml(s)]", state)
        try:
            scene = Scene.from_toml(toml)
        except InputError:
            assert found["status"] >= 100
            continue
        assert found["status"] == 0, found["message"]
        expected = collide(scene, rtol=SHARP, ledger=False).to_dict()
        assert ("stick", "stick-rotate-separate", "bounce")[found["outcome"]] == expected["outcome"]
        assert found["speed"] == pytest.approx(expected["speed"], rel=1e-14)
        for result in RESULTS if expected["outcome"] != "stick" else ():
            assert found[result] == pytest.approx(expected[result], rel=1e-9, abs=1e-9 * (result == "rotation")), result
        decided += 1
    assert decided > 5


@pytest.mark.parametrize("name", ["strings", "wall", "rubbing"])
def test_the_map_is_that_of_python(name: str, opened: Any):
    """Every seventh cell of the fine map, and where it is outside the model's range."""
    page = opened(name)
    cells = page.ask(
        "(g => [g.across, g.upward, g.outcome, g.restitution, g.outside].map(a => [...a]))(wetdoublet.grid())"
    )
    across, upward, outcome, restitution, outside = (np.array(each, float) for each in cells)
    angle, speed = (each.ravel()[::7] for each in np.meshgrid(np.radians(across), upward))
    given = {page.ask("wetdoublet.state().speed"): speed}
    expected = collide_many(SCENES[name], angle=angle, **given, rtol=1e-6, of=("outcome", "restitution", "validity"))
    assert np.array_equal(outcome[::7], expected["outcome"].values)
    np.testing.assert_allclose(restitution[::7], expected["restitution"].values, atol=2e-5, rtol=2e-5)
    assert np.array_equal(outside[::7] != 0, expected["validity"].values != 0)


@pytest.mark.parametrize("name", ["granulation", "strings"])
def test_curves_end_as_the_collision_does(name: str, opened: Any):
    """Energies and events are those of Python's trajectory."""
    page, one = opened(name), collide(SCENES[name])
    known = one.to_dict()
    if known["outcome"] == "stick":
        page = opened(name, "impact.speed=20")
        known = collide(SCENES[name], relative_speed=20.0).to_dict()
    first, last = page.ask("wetdoublet.energies()")
    assert sum(first) == pytest.approx(1, rel=1e-12)
    assert sum(last) == pytest.approx(known["energy"]["final"] / known["energy"]["initial"], rel=1e-7)
    times = [each["time"] for each in page.ask("wetdoublet.shown().path.events")]
    expected = [each["time"] for each in known["events"] if each["kind"] not in ("tangential edge",)]
    assert times == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("name", ["dry", "strings", "beads"])
def test_the_ledger_is_that_of_python(name: str, opened: Any):
    """It balances at all times; at the end of random separations its terms are Python's."""
    page, draw, separations = opened(name), random.Random(name), 0
    for _ in range(400):
        if separations == LEDGERS:
            break
        for knob in page.knobs:
            part, low, high = draw.uniform(0.3, 0.7), knob["low"], knob["high"]
            if knob["value"] is not None and draw.random() < 0.7:
                value = low * (high / low) ** part if knob["logarithmic"] else low + (high - low) * (1.6 * part - 0.3)
                page.ask("([name, value]) => wetdoublet.set(name, value)", [knob["name"], value])
        if page.ask("wetdoublet.shown().path === null"):
            continue
        shares = page.ask("[0, 0.01, 0.1, 0.3, 0.5, 0.8, 1].map(part => wetdoublet.ledger(part))")
        # Python refuses a result whose ledger is open by 1e4 rtol, which is the limit of rounding in stiff films
        assert [sum(part for *_, part in each) for each in shares] == pytest.approx([1] * 7, abs=1e-5)
        expected = collide(Scene.from_toml(page.ask("wetdoublet.toml(wetdoublet.state())"))).to_dict()
        if expected["outcome"] == "stick":
            continue
        separations += 1
        energy, last = expected["energy"], {words: part for _, words, part in shares[-1]}
        largest = max(map(abs, energy.values()))
        for term, words in TERMS.items():
            assert last.get(words, 0.0) * energy["initial"] == pytest.approx(energy.get(term, 0.0), abs=1e-9 * largest)
        kinetic = sum(part for colour, _, part in shares[-1] if colour in ("e0", "e1", "e2"))
        assert kinetic * energy["initial"] == pytest.approx(energy["final"], abs=1e-9 * largest)
        text = page.ask("document.querySelector('[role=status]').textContent")
        assert ("leaves faster" in text) == (expected["restitution"] > 1)
    assert separations == LEDGERS


def test_with_friction_losses_are_not_told_apart(opened: Any):
    """They are one part, which closes the sum, and the kinetic parts are those at separation."""
    page = opened("unequal")
    page.ask("wetdoublet.set('impact.speed', 20)")
    expected = collide(Scene.from_toml(page.ask("wetdoublet.toml(wetdoublet.state())"))).to_dict()["energy"]
    *kinetic, (_, words, lost) = page.ask("wetdoublet.ledger(1)")
    assert words == "lost, or stored in the bridge"
    assert sum(part for *_, part in kinetic) * expected["initial"] == pytest.approx(expected["final"], rel=1e-8)
    assert lost == pytest.approx(1 - expected["final"] / expected["initial"], abs=1e-8)


def test_python_gives_the_same_numbers(opened: Any, capsys: pytest.CaptureFixture[str]):
    """The line that the page shows, run."""
    page = opened("coating", "impact.speed=3&liquid.viscosity=20&particles.youngs_modulus=never")
    line = page.ask("wetdoublet.python(wetdoublet.state())")
    found = page.ask("wetdoublet.shown().found")
    names: dict[str, Any] = {}
    exec(line.replace("print(", "one = ("), names)
    assert found["restitution"] == pytest.approx(names["one"].restitution, rel=1e-8)


def test_a_preset_with_the_same_law_may_be_chosen(opened: Any, tmp_path: Path, files: dict[str, Path]):
    """And another bridge law, which keeps the state; the address has the scene."""
    willett = LACTOSE.with_entries({"bridge.law": "willett"})
    files["laws"] = tmp_path / "laws.html"
    explore(LACTOSE, willett).write(files["laws"])
    page = opened("laws")
    assert page.ask("[...document.querySelectorAll('#preset option')].length") == 4
    factor = next(each["factor"] for each in page.knobs if each["name"] == "liquid.viscosity")
    page.ask(f"wetdoublet.set('liquid.viscosity', 0.5/{factor})")
    for place, scene in ((1, willett.with_entries({"liquid.viscosity": 0.5})), (2, Scene.load("glass-beads-water"))):
        page.tab.select_option("#preset", str(place))
        page.until(
            f"location.hash.startsWith('#scene={place}') && document.getElementById('preset').value == '{place}'"
        )
        page.settled()
        expected = collide(scene).to_dict()
        found = page.ask("wetdoublet.shown().found")
        assert ("stick", "stick-rotate-separate", "bounce")[found["outcome"]] == expected["outcome"]
        assert found["restitution"] == pytest.approx(expected["restitution"], rel=1e-7)
    again = opened("laws", page.ask("location.hash.slice(1)"))
    assert again.ask("wetdoublet.state()") == page.ask("wetdoublet.state()")
    assert page.complaints == again.complaints == []
