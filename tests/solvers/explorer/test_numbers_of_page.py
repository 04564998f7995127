"""The page's numbers are Python's, in a browser: collisions, ledgers, maps, and what it gives for Python."""

import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, collide, collide_many, explore

from .page import LACTOSE, SCENES, Page

pytestmark = pytest.mark.slow

OUTCOMES = ("stick", "stick-rotate-separate", "bounce")
RESULTS = ("restitution", "tangential_restitution", "contact_time", "rotation", "smallest_gap", "final_spin")
SETTINGS, LEDGERS = 12, 2  # random ones of each scene, and the separations among them whose ledger is looked at
TERMS = {
    "normal_lubrication": "lost squeezing the film",
    "tangential_lubrication": "lost shearing the film",
    "capillary": "stored in the bridge",
    "attraction": "against attraction",
    "dry_contact": "lost in solid contact",
    "strings": "stored in the strings",
}
SHARP = 1e-12  # relative tolerance of integration where numbers are compared to 1e-9


@pytest.mark.parametrize("name", [each for each in SCENES if each != "granulation"])  # as "beads", but for its numbers
def test_numbers_are_those_of_python(name: str, opened: Any):
    """Random settings, through the TOML that the page gives: outcomes all, numbers to 1e-9; refusals are the same."""
    page, draw, decided, separations = opened(name, workers=False), random.Random(name), 0, 0
    state = page.ask("wetdoublet.state()")
    first = dict(state["values"])
    for _ in range(5 * SETTINGS):
        changed = {}
        for knob in page.knobs:
            part, low, high = draw.uniform(0.3, 0.7), knob["low"], knob["high"]
            if knob["value"] is not None and draw.random() < 0.7:
                value = low * (high / low) ** part if knob["logarithmic"] else low + (high - low) * (1.6 * part - 0.3)
                changed[knob["name"]] = value
        state["values"] = first | changed
        found, toml = page.ask(f"s => [wetdoublet.collide(s, {SHARP}), wetdoublet.toml(s)]", state)
        try:
            scene = Scene.from_toml(toml)
        except InputError:
            assert found["status"] >= 100
            continue
        assert found["status"] == 0, found["message"]
        expected = collide(scene, rtol=SHARP, ledger=False).to_dict()
        assert OUTCOMES[found["outcome"]] == expected["outcome"]
        assert found["speed"] == pytest.approx(expected["speed"], rel=1e-14)
        decided += 1
        if expected["outcome"] != "stick":
            for result in RESULTS:
                close = pytest.approx(expected[result], rel=1e-9, abs=1e-9 * (result == "rotation"))
                assert found[result] == close, result
            if separations < LEDGERS:
                separations += 1
                balanced(page, first | changed)
        if decided >= SETTINGS and separations == LEDGERS:
            break
    assert decided >= SETTINGS and separations == LEDGERS


def balanced(page: Page, values: dict[str, float | None]) -> None:
    """The ledger of a state, once it is shown: it balances at all times, and at the end its terms are Python's.

    With friction losses are not told apart: they are one part, which closes the sum.
    """
    for name, value in values.items():
        if value is not None:
            page.ask("([name, value]) => wetdoublet.set(name, value)", [name, value])
    shares = page.ask("[0, 0.01, 0.1, 0.3, 0.5, 0.8, 1].map(part => wetdoublet.ledger(part))")
    # Python refuses a result whose ledger is open by 1e4 rtol, which is the limit of rounding in stiff films
    assert [sum(part for *_, part in each) for each in shares] == pytest.approx([1] * 7, abs=1e-5)
    expected = collide(Scene.from_toml(page.ask("wetdoublet.toml(wetdoublet.state())"))).to_dict()
    energy, last = expected["energy"], {words: part for _, words, part in shares[-1]}
    largest = max(map(abs, energy.values()))
    kinetic = sum(part for colour, _, part in shares[-1] if colour in ("e0", "e1", "e2"))
    assert kinetic * energy["initial"] == pytest.approx(energy["final"], abs=1e-9 * largest)
    if "dry_friction" in energy:
        lost = last["lost, or stored in the bridge"]
        assert lost == pytest.approx(1 - energy["final"] / energy["initial"], abs=1e-8)
    else:
        for term, words in TERMS.items():
            assert last.get(words, 0.0) * energy["initial"] == pytest.approx(energy.get(term, 0.0), abs=1e-9 * largest)
    text = page.ask("document.querySelector('[role=status]').textContent")
    assert ("leaves faster" in text) == (expected["restitution"] > 1)


@pytest.mark.parametrize("name", ["strings", "wall"])
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


def test_python_gives_the_same_numbers(opened: Any, capsys: pytest.CaptureFixture[str]):
    """The line that the page shows, run."""
    page = opened("coating", "impact.speed=3&liquid.viscosity=20&particles.youngs_modulus=never", workers=False)
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
    page = opened("laws", workers=False)
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
        assert OUTCOMES[found["outcome"]] == expected["outcome"]
        assert found["restitution"] == pytest.approx(expected["restitution"], rel=1e-7)
    assert page.complaints == []
    address, state = page.ask("[location.hash.slice(1), wetdoublet.state()]")
    again = opened("laws", address, workers=False)
    assert again.ask("wetdoublet.state()") == state
    assert again.complaints == []
