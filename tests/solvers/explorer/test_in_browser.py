"""The page in browsers: knobs move every view, addresses do no harm, nothing is requested, anybody can use it."""

import json
import math
import os
import random
import subprocess
import sys
import time
import urllib.parse
from pathlib import Path
from typing import Any

import pytest
from wetdoublet.solvers import Scene, collide, explore

from .page import GRANULATION, Page

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("optimized")]

ADDRESSES = 60


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cache that begins empty."""
    return tmp_path_factory.mktemp("cache")


@pytest.mark.parametrize("preset", ["granulation", "pendulum"])
def test_a_preset_opens_without_a_compiler(preset: str, browser: Any, cache: Path, tmp_path: Path):
    """The command on a machine without one writes the page, and the page has the answer of Python."""
    (tmp_path / "ziglang.py").write_text("raise ImportError")
    blocked = {"PATH": str(tmp_path), "PYTHONPATH": str(tmp_path), "WETDOUBLET_CACHE": str(cache)}
    command = [sys.executable, "-m", "wetdoublet", "explore", preset, "-o", str(tmp_path / "page.html")]
    done = subprocess.run(command, env=os.environ | blocked, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    tab = browser.new_page()
    page, expected = Page(tab, tmp_path / "page.html"), collide(preset)
    found = page.ask("wetdoublet.shown().found")
    assert ("stick", "stick-rotate-separate", "bounce")[found["outcome"]] == expected.outcome
    if expected.outcome != "stick":
        assert found["restitution"] == pytest.approx(expected.restitution, rel=1e-7)
    assert page.complaints == []
    tab.close()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_has_no_finding(scheme: str, opened: Any):
    """Accessibility by axe-core, with all that opens open."""
    axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="needs axe-playwright-python")
    page = opened("unequal", color_scheme=scheme, bypass_csp=True, reduced_motion="reduce")
    page.tab.click("#pin")
    page.tab.click("summary")
    page.ask("wetdoublet.set('liquid.viscosity', 3)")
    page.tab.get_by_role("button", name="Python").click()
    found = axe.Axe().run(page.tab).response["violations"]
    assert not found, [(each["id"], each["nodes"][0]["html"]) for each in found]


def test_every_knob_moves_every_view(opened: Any):
    """Address, answer's state and map are those of the new value."""
    page = opened("coating")
    for knob in page.knobs:
        low, high = knob["low"], knob["high"]
        value = 1.3 * math.sqrt(low * high) if knob["logarithmic"] else 0.37 * (low + high) or 0.21 * high
        page.ask("([name, value]) => wetdoublet.set(name, value)", [knob["name"], value])
        page.settled()
        page.until(f"location.hash.includes({json.dumps(knob['name'])})")
        assert page.ask("wetdoublet.state()")["values"][knob["name"]] == value
        shown = page.ask("wetdoublet.shown().found")
        again = page.ask("wetdoublet.collide(wetdoublet.state())")
        assert shown.pop("outside") == again.pop("outside")
        assert shown == pytest.approx(again, nan_ok=True)
        if knob["name"] not in ("impact.speed", "impact.angle"):
            assert page.ask("wetdoublet.grid().state.values")[knob["name"]] == value
    assert page.complaints == []


def test_an_address_gives_the_same_state_again(opened: Any):
    """To the last bit, with another kind of speed and a pinned state."""
    speed = "impact.kind=relative_speed&impact.speed=1.2345678901234567"
    page = opened("granulation", f"{speed}&pinned=1&pinned.liquid.viscosity=3")
    state = page.ask("wetdoublet.state()")
    assert state["values"]["impact.speed"] == 1.2345678901234567
    assert page.tab.get_by_text("pinned", exact=True).count() == 1
    page.ask("wetdoublet.set('liquid.viscosity', 1/3)")
    page.until("location.hash.includes('viscosity=0.333')")
    again = opened("granulation", page.ask("location.hash.slice(1)"))
    assert again.ask("wetdoublet.state()") == page.ask("wetdoublet.state()")


@pytest.mark.parametrize("address", ["impact.angle=90", "%3Cimg%20src=x%20onerror=alert(1)%3E=1", "__proto__=1"])
def test_a_hostile_address_does_nothing(address: str, opened: Any):
    """The state is the scene's, and a line says what was left out."""
    page = opened("granulation", address)
    assert page.ask("wetdoublet.state()")["values"] == {each["name"]: each["value"] for each in page.knobs}
    assert "left out" in page.ask("document.querySelector('[role=alert]').textContent")
    assert page.complaints == []


def test_random_addresses_do_no_harm(opened: Any):
    """Numbers that no scene has, keys of other pages and scraps of script: an answer or a line, and no complaint."""
    page, draw = opened("coating"), random.Random("addresses")
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


def test_bad_numbers_are_answered_in_words(opened: Any):
    """A number that the law refuses, and texts in a number's field."""
    page = opened("granulation", "particles.roughness=9")
    assert "roughness is not below film_thickness" in page.tab.inner_text("[role=status]")
    before = page.ask("wetdoublet.state()")
    for text in ("NaN", "1e999", "<b>", "", "2 Pa s"):
        page.tab.fill("input[name='liquid.viscosity']", text)
        page.tab.press("input[name='liquid.viscosity']", "Enter")
        assert page.ask("wetdoublet.state()") == before
        assert page.tab.get_attribute("input[name='liquid.viscosity']", "aria-invalid") == "true"
    assert page.complaints == []


def test_nothing_leaves_the_page(opened: Any):
    """Only the file itself and the workers' text are requested, and the policy in the page forbids the rest."""
    page = opened("granulation")
    page.tab.get_by_role("button", name="Python").click()
    page.ask("fetch('https://example.org/').catch(() => 0)")
    assert all(each.startswith(("file:", "blob:")) for each in page.requests)
    assert any("Content Security Policy" in each for each in page.complaints)


def test_the_keyboard_alone(opened: Any):
    """Arrows move the chosen impact in the map, and sliders; Tab reaches what can be pressed."""
    page = opened("granulation", reduced_motion="reduce")
    assert page.tab.get_by_role("button", name="Play").count() == 1  # nothing moves by itself
    before = page.ask("wetdoublet.state()")["values"]
    page.tab.focus(".map")
    page.tab.keyboard.press("ArrowUp")
    page.tab.keyboard.press("Shift+ArrowLeft")
    values = page.ask("wetdoublet.state()")["values"]
    assert values["impact.speed"] > before["impact.speed"]
    assert values["impact.angle"] == pytest.approx(before["impact.angle"] - 0.05 * 85, rel=1e-4)
    page.tab.focus("input[type=range][data-knob='liquid.viscosity']")
    page.tab.keyboard.press("PageDown")
    assert page.ask("wetdoublet.state()")["values"]["liquid.viscosity"] < before["liquid.viscosity"]
    assert math.isfinite(page.ask("wetdoublet.shown().found")["restitution"])


@pytest.mark.parametrize("width", [320, 2560])
def test_no_width_needs_scrolling_sideways(width: int, opened: Any):
    page = opened("unequal", viewport={"width": width, "height": 800})
    assert page.ask("document.documentElement.scrollWidth <= innerWidth")


def test_the_legend_shows_an_outcome(opened: Any):
    """Each of its buttons chooses an impact that has the outcome, and the answer says so."""
    page = opened("granulation")
    for outcome, name in enumerate(("Stick", "Stick, rotate, separate", "Bounce")):
        page.tab.locator(".legend button").nth(outcome).click()
        found = page.ask("wetdoublet.shown().found")
        assert found["outcome"] == outcome
        said = page.tab.inner_text("[role=status]")
        assert said.startswith(f"{name}. Impact at ") and f"{math.degrees(found['angle']):.3g}° from head-on" in said


def test_a_notebook_shows_the_page(opened: Any, tmp_path: Path):
    """In a frame, which needs neither a file nor an address of its own."""
    page = opened("granulation")
    (tmp_path / "notebook.html").write_text(explore(GRANULATION)._repr_html_())
    page.tab.goto((tmp_path / "notebook.html").as_uri())
    frame = page.tab.frames[1]
    for _ in range(200):
        if frame.evaluate("!!window.wetdoublet && wetdoublet.map().refined"):
            break
        time.sleep(0.05)
    frame.evaluate("wetdoublet.set('liquid.viscosity', 3)")
    assert frame.evaluate("wetdoublet.state().values['liquid.viscosity']") == 3
    assert page.complaints == []


def test_the_widget_tells_python_what_it_shows(opened: Any, tmp_path: Path):
    """The module of the anywidget, run with a model as a notebook has one: its TOML is the scene of the page."""
    pytest.importorskip("anywidget", reason="needs anywidget")
    page, widget = opened("granulation"), explore(GRANULATION).widget
    assert widget.html == explore(GRANULATION).html
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
