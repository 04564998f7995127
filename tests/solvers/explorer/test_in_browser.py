"""The page in browsers: knobs move every view, addresses do no harm, nothing is requested, anybody can use it."""

import json
import math
import os
import random
import re
import subprocess
import sys
import urllib.parse
from pathlib import Path
from typing import Any

import pytest
from wetdoublet.solvers import Scene, collide, explore

from .page import GRANULATION, Page

pytestmark = pytest.mark.slow

ADDRESSES = 40
OUTCOMES = ("Stick", "Stick, rotate, separate", "Bounce")


@pytest.fixture(scope="module")
def granulation(opened: Any) -> Page:
    """A page on which tests go to addresses of their own."""
    page: Page = opened("granulation", workers=False)
    return page


def test_a_preset_opens_without_a_compiler(opened: Any, files: dict[str, Path], tmp_path: Path):
    """The command on a machine without one writes the page, and the page has the answer of Python, event by event."""
    (tmp_path / "ziglang.py").write_text("raise ImportError")
    blocked = {"PATH": str(tmp_path), "PYTHONPATH": str(tmp_path)}
    files["pendulum"] = tmp_path / "page.html"
    command = [sys.executable, "-m", "wetdoublet", "explore", "pendulum", "-o", str(files["pendulum"])]
    done = subprocess.run(command, env=os.environ | blocked, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    page, expected = opened("pendulum", workers=False), collide("pendulum")
    found = page.ask("wetdoublet.shown().found")
    assert expected.outcome == "stick-rotate-separate" and found["outcome"] == 1
    assert found["restitution"] == pytest.approx(expected.restitution, rel=1e-7)
    times = [each.time for each in expected.events if each.kind != "tangential edge"]
    assert [each["time"] for each in page.ask("wetdoublet.shown().path.events")] == pytest.approx(times, rel=1e-6)
    assert page.complaints == []


def test_axe_has_no_finding_and_no_width_needs_scrolling_sideways(opened: Any):
    """Accessibility by axe-core, with all that opens open, in a light and a dark scheme; a phone and a wide screen."""
    axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="needs axe-playwright-python")
    page = opened("unequal", workers=False, bypass_csp=True)
    page.tab.click("#pin")
    page.tab.click("summary")
    page.ask("wetdoublet.set('liquid.viscosity', 3)")
    page.tab.get_by_role("button", name="Python").click()
    for scheme in ("light", "dark"):
        page.tab.emulate_media(color_scheme=scheme)
        found = axe.Axe().run(page.tab).response["violations"]
        assert not found, [(each["id"], each["nodes"][0]["html"]) for each in found]
    for width in (320, 2560):
        page.tab.set_viewport_size({"width": width, "height": 800})
        page.until("document.documentElement.scrollWidth <= innerWidth")


def test_every_knob_moves_every_view(opened: Any):
    """Address, answer's state and map are those of the new value, and nothing leaves the page.

    Only the file itself and the workers' text were requested, and the policy in the page forbids the rest.
    """
    page = opened("coating")
    for knob in page.knobs:
        low, high = knob["low"], knob["high"]
        value = 1.3 * math.sqrt(low * high) if knob["logarithmic"] else 0.37 * (low + high) or 0.21 * high
        page.ask("([name, value]) => wetdoublet.set(name, value)", [knob["name"], value])
        page.until(f"location.hash.includes({json.dumps(knob['name'])})")
        assert page.ask("wetdoublet.state()")["values"][knob["name"]] == value
        shown = page.ask("wetdoublet.shown().found")
        again = page.ask("wetdoublet.collide(wetdoublet.state())")
        assert shown.pop("outside") == again.pop("outside")
        assert shown == pytest.approx(again, nan_ok=True)
        if knob["name"] not in ("impact.speed", "impact.angle"):
            page.until(f"wetdoublet.grid().state.values[{json.dumps(knob['name'])}] === {value!r}")
    assert page.complaints == []
    page.tab.get_by_role("button", name="Python").click()
    page.ask("fetch('https://example.org/').catch(() => 0)")
    assert all(each.startswith(("file:", "blob:")) for each in page.requests)
    assert any("Content Security Policy" in each for each in page.complaints)


def test_random_addresses_do_no_harm(opened: Any):
    """Numbers that no scene has, keys of other pages and scraps of script: an answer or a line, and no complaint."""
    page, draw = opened("coating", workers=False), random.Random("addresses")
    names = [each["name"] for each in page.knobs]
    others = ["scene", "pinned", "across", "upward", "impact.kind", "__proto__", "toString", "<svg onload=alert(1)>"]
    values = ["NaN", "-Infinity", "1e308", "-1e308", "5e-324", "0", "-0", "never", "1e400", "0x10", "１２", "\0"]
    values += ["%", "%ff", "stokes"]
    values += ["javascript:alert(1)", "<script>alert(1)</script>", "';alert(1);'", "2", "99", *names[:3], "1" * 3000]
    for _ in range(ADDRESSES):
        pairs = []
        for _ in range(draw.randint(1, 4)):
            key, value = draw.choice([*names, *others, ""]), draw.choice([*values, repr(10 ** draw.uniform(-320, 308))])
            pairs.append(f"{draw.choice(['', '', 'pinned.'])}{key}={value}")
        text = draw.choice(["&", "&", "#", "&&"]).join(pairs)
        written = text if draw.random() < 0.5 else urllib.parse.quote(text, safe="=&")
        page.ask("text => { location.hash = text }", written)
        page.ask("() => new Promise(done => setTimeout(done, 20))")
        page.until("!!document.querySelector('[role=status]').textContent.trim()")
        found = page.ask("wetdoublet.shown().found")
        assert found["status"] != 0 or found["outcome"] in (0, 1, 2), text
        if found["status"] == 0 and found["outcome"] != 0:
            assert math.isfinite(found["restitution"]), text
        elements = page.ask("document.querySelectorAll('[role=status] *, [role=alert] *').length")
        assert elements == 2, text  # title, words
    page.settled()
    assert page.complaints == []


def test_a_widget_or_a_notebook_tells_what_it_shows(opened: Any, tmp_path: Path):
    """In a frame, which needs neither a file nor an address of its own; a widget's TOML is the scene of the page."""
    pytest.importorskip("anywidget", reason="needs anywidget")
    page, shown = opened("granulation", workers=False), explore(GRANULATION)
    (tmp_path / "notebook.html").write_text(shown._repr_html_())
    page.tab.goto((tmp_path / "notebook.html").as_uri())
    page.until("document.readyState == 'complete'")
    frame = page.tab.frames[1]
    frame.wait_for_function("!!window.wetdoublet && wetdoublet.map().count > 0")
    frame.evaluate("wetdoublet.set('liquid.viscosity', 3)")
    assert frame.evaluate("wetdoublet.state().values['liquid.viscosity']") == 3
    assert page.complaints == []
    widget = shown.widget
    assert widget.html == shown.html
    model = (
        "{values: {html: %s}, get(k) { return this.values[k] }, set(k, v) { this.values[k] = v }, save_changes() {}}"
    )
    html = json.dumps(widget.html).replace("<", "\\u003c")
    script = f"{widget._esm}".replace("export default", "window.module =") + f"window.model = {model % html};"
    script += "module.render({model, el: document.body});"
    (tmp_path / "host.html").write_text(f"<!doctype html><meta charset=utf-8><body><script>{script}</script>")
    page.tab.goto((tmp_path / "host.html").as_uri())
    page.until("!!frames[0]?.wetdoublet")
    page.ask("frames[0].wetdoublet.set('liquid.viscosity', 3.5)")
    page.until("(model.values.address ?? '').includes('viscosity=3.5')")
    assert Scene.from_toml(page.ask("model.values.toml")).entries["liquid.viscosity"] == 3.5


# ---- of one page


def test_an_address_gives_the_same_state_again(granulation: Page):
    """To the last bit, with another kind of speed and a pinned state."""
    granulation.to("impact.kind=relative_speed&impact.speed=1.2345678901234567&pinned=1&pinned.liquid.viscosity=3")
    state = granulation.ask("wetdoublet.state()")
    assert state["values"]["impact.speed"] == 1.2345678901234567
    assert granulation.tab.get_by_text("pinned", exact=True).count() == 1
    granulation.ask("wetdoublet.set('liquid.viscosity', 1/3)")
    granulation.until("location.hash.includes('viscosity=0.333')")
    address, state = granulation.ask("[location.hash.slice(1), wetdoublet.state()]")
    granulation.to("")
    assert granulation.ask("wetdoublet.state()") != state
    granulation.to(address)
    assert granulation.ask("wetdoublet.state()") == state


@pytest.mark.parametrize("address", ["impact.angle=90", "%3Cimg%20src=x%20onerror=alert(1)%3E=1", "__proto__=1"])
def test_a_hostile_address_does_nothing(address: str, granulation: Page):
    """The state is the scene's, and a line says what was left out."""
    granulation.to(address)
    values = granulation.ask("wetdoublet.state()")["values"]
    assert values == {each["name"]: each["value"] for each in granulation.knobs}
    assert "left out" in granulation.ask("document.querySelector('[role=alert]').textContent")
    assert granulation.complaints == []


def test_bad_numbers_are_answered_in_words(granulation: Page):
    """A number that the law refuses, and texts in a number's field."""
    granulation.to("particles.roughness=9")
    assert "roughness is not below film_thickness" in granulation.tab.inner_text("[role=status]")
    before = granulation.ask("wetdoublet.state()")
    for text in ("NaN", "1e999", "<b>", "", "2 Pa s"):
        granulation.tab.fill("input[name='liquid.viscosity']", text)
        granulation.tab.press("input[name='liquid.viscosity']", "Enter")
        assert granulation.ask("wetdoublet.state()") == before
        assert granulation.tab.get_attribute("input[name='liquid.viscosity']", "aria-invalid") == "true"
    assert granulation.complaints == []


def test_the_keyboard_alone(granulation: Page):
    """Arrows move the chosen impact in the map, and sliders; Tab reaches what can be pressed."""
    granulation.to("liquid.viscosity=2")
    tab = granulation.tab
    assert tab.get_by_role("button", name="Play").count() == 1  # nothing moves by itself
    before = granulation.ask("wetdoublet.state()")["values"]
    tab.focus(".map")
    tab.keyboard.press("ArrowUp")
    tab.keyboard.press("Shift+ArrowLeft")
    values = granulation.ask("wetdoublet.state()")["values"]
    assert values["impact.speed"] > before["impact.speed"]
    assert values["impact.angle"] == pytest.approx(before["impact.angle"] - 0.05 * 85, rel=1e-4)
    tab.focus("input[type=range][data-knob='liquid.viscosity']")
    tab.keyboard.press("PageDown")
    assert granulation.ask("wetdoublet.state()")["values"]["liquid.viscosity"] < before["liquid.viscosity"]
    assert math.isfinite(granulation.ask("wetdoublet.shown().found")["restitution"])


def test_the_legend_shows_an_outcome(granulation: Page):
    """Each of its buttons chooses an impact that has the outcome, and the answer says so."""
    granulation.to("")
    granulation.settled()
    for outcome, name in enumerate(OUTCOMES):
        granulation.tab.locator(".legend button").nth(outcome).click()
        found = granulation.ask("wetdoublet.shown().found")
        assert found["outcome"] == outcome
        said = granulation.tab.inner_text("[role=status]")
        degrees = float(re.findall(r"([\d.]+)° from head-on", said)[0])
        assert said.startswith(f"{name}. Impact at ") and math.radians(degrees) == pytest.approx(
            found["angle"], rel=5e-3
        )
