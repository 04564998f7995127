"""The page in a browser: its numbers are Python's, knobs move the views, addresses do no harm, nothing is requested."""

import json
import math
import random
import shutil
import time
import urllib.parse
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from wetdoublet.solvers import InputError, Scene, collide, collide_many, explore

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = pytest.mark.slow

FLAGS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking", "--disable-sync"]
LACTOSE = Scene.load("lactose-pvp")
GRANULATION = Scene.load("granulation")
SCENES = {
    "granulation": GRANULATION,
    "dry": Scene.load("granulation-dry-bridge").with_entries({"attraction.hamaker": 1e-19}),
    "strings": Scene.load("pendulum"),
    "coating": LACTOSE,
    "beads": Scene.load("glass-beads-water").with_entries({"bridge.law": "willett", "model.arm": "surface"}),
    "unequal": LACTOSE.with_entries(
        {"partner.diameter": "500 um", "partner.density": "1.54 g/cm3", "particles.friction": 0.3}
    ),
    "rubbing": GRANULATION.with_entries({"particles.friction": 0.2, "model.film": "cavitating"}),
    "wall": LACTOSE.with_entries({"partner.wall": True, "partner.coating_thickness": "1 um"}),
}
RESULTS = ("restitution", "tangential_restitution", "contact_time", "rotation", "smallest_gap", "final_spin")
SETTINGS = 500  # random ones, of all scenes together
ADDRESSES = 200
LEDGERS = 15  # separations of each scene
TERMS = {
    "normal_lubrication": "lost squeezing the film",
    "tangential_lubrication": "lost shearing the film",
    "capillary": "stored in the bridge",
    "attraction": "against attraction",
    "dry_contact": "lost in solid contact",
    "strings": "stored in the strings",
}
SHARP = 1e-12  # relative tolerance of integration where numbers are compared to 1e-9


@pytest.fixture(scope="module")
def compiler() -> None:
    """Something that compiles a law to WebAssembly."""
    try:
        assert explore(GRANULATION).html
    except InputError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def firefox(compiler: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Firefox without a window."""
    pytest.importorskip("websockets", reason="needs websockets (pip install websockets)")
    executable = next(filter(None, map(shutil.which, ("firefox", "firefox-esr"))), None)
    if executable is None:
        pytest.skip("needs Firefox")
    from .firefox import started

    with started(executable, tmp_path_factory.mktemp("firefox")) as tab:
        yield tab


@pytest.fixture(scope="module")
def browser(compiler: None) -> Iterator[Any]:
    """Chromium without a window."""
    playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright (pip install playwright)")
    if BROWSER is None:
        pytest.skip("needs Chromium")
    with playwright.sync_playwright() as driver:
        yield driver.chromium.launch(executable_path=BROWSER, args=FLAGS)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Pages that are written already."""
    return {}


class Page:
    """A page of a scene that is open; what it requests and complains of is kept."""

    def __init__(self, tab: Any, path: Path, address: str = "") -> None:
        self.tab = tab
        self.requests: list[str] = []
        self.complaints: list[str] = []
        if not hasattr(tab, "on"):
            self.requests, self.complaints = tab.requests, tab.complaints
        else:  # Playwright's
            tab.on("request", lambda request: self.requests.append(request.url))
            tab.on("pageerror", lambda error: self.complaints.append(str(error)))
            tab.on("console", lambda message: self.complaints.append(message.text))
            tab.on("dialog", lambda dialog: self.complaints.append(dialog.message))
        tab.goto(f"{path.as_uri()}#{address}" if address else path.as_uri())
        self.until("!!window.wetdoublet")
        self.settled()

    def ask(self, expression: str, argument: Any = None) -> Any:
        return self.tab.evaluate(expression, argument)

    def until(self, condition: str) -> None:
        for _ in range(600):
            if self.ask(condition):
                return
            time.sleep(0.05)
        raise AssertionError(condition)

    def settled(self) -> None:
        self.until("wetdoublet.map().idle && wetdoublet.map().count > 1")

    @property
    def knobs(self) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = json.loads(self.ask("document.getElementById('scene').textContent"))["scenes"][0][
            "knobs"
        ]
        return found


@pytest.fixture
def opened(browser: Any, files: dict[str, Path], tmp_path: Path) -> Iterator[Any]:
    """Opens the page of a scene by name."""
    contexts = []

    def open_page(name: str, address: str = "", **settings: Any) -> Page:
        contexts.append(browser.new_context(**settings))
        return Page(contexts[-1].new_page(), written(files, name, tmp_path), address)

    yield open_page
    for each in contexts:
        each.close()


@pytest.fixture(params=["chromium", "firefox"])
def anywhere(request: pytest.FixtureRequest, files: dict[str, Path], tmp_path: Path) -> Any:
    """Opens the page of a scene by name, in one browser and in the other; one page at a time."""
    if request.param == "chromium":
        return request.getfixturevalue("opened")
    tab = request.getfixturevalue("firefox")
    return lambda name, address="": Page(tab, written(files, name, tmp_path), address)


def written(files: dict[str, Path], name: str, folder: Path) -> Path:
    """The page of a scene."""
    if name not in files:
        files[name] = folder / f"{name}.html"
        explore(SCENES[name]).write(files[name])
    return files[name]


@pytest.mark.parametrize("name", SCENES)
def test_numbers_are_those_of_python(name: str, anywhere: Any):
    """Random settings, through the TOML that the page gives: outcomes all, numbers to 1e-9; refusals are the same."""
    page, draw, decided = anywhere(name), random.Random(name), 0
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
    assert decided > 30


@pytest.mark.parametrize("name", ["granulation", "coating", "strings", "wall", "unequal", "rubbing"])
def test_the_map_is_that_of_python(name: str, anywhere: Any):
    """Every seventh cell of the fine map, and where it is outside the model's range."""
    page = anywhere(name)
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


@pytest.mark.parametrize("name", ["granulation", "coating", "strings", "unequal"])
def test_curves_end_as_the_collision_does(name: str, anywhere: Any):
    """Energies and events are those of Python's trajectory."""
    page, one = anywhere(name), collide(SCENES[name])
    known = one.to_dict()
    if known["outcome"] == "stick":
        page = anywhere(name, "impact.speed=20")
        known = collide(SCENES[name], relative_speed=20.0).to_dict()
    first, last = page.ask("wetdoublet.energies()")
    assert sum(first) == pytest.approx(1, rel=1e-12)
    assert sum(last) == pytest.approx(known["energy"]["final"] / known["energy"]["initial"], rel=1e-7)
    times = [each["time"] for each in page.ask("wetdoublet.shown().path.events")]
    expected = [each["time"] for each in known["events"] if each["kind"] not in ("tangential edge",)]
    assert times == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("name", [name for name, scene in SCENES.items() if scene.particles.friction is None])
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


def test_every_knob_moves_every_view(anywhere: Any):
    """Address, answer's state and map are those of the new value."""
    page = anywhere("coating")
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


@pytest.mark.parametrize(
    "address",
    [
        "liquid.viscosity=NaN", "liquid.viscosity=1e308", "impact.speed=-1", "impact.angle=90", "impact.angle=1e400",
        "liquid.viscosity=%3Cscript%3Ealert(1)%3C/script%3E", "%3Cimg%20src=x%20onerror=alert(1)%3E=1", "__proto__=1",
        "constructor.prototype=3", "across=__proto__", "impact.kind=warp", "liquid.viscosity=javascript:alert(1)",
    ],
)  # fmt: skip
def test_a_hostile_address_does_nothing(address: str, anywhere: Any):
    """The state is the scene's, and a line says what was left out."""
    page = anywhere("granulation", address)
    plain = {each["name"]: each["value"] for each in page.knobs}
    assert page.ask("wetdoublet.state()")["values"] == plain
    assert "left out" in page.ask("document.querySelector('[role=alert]').textContent")
    assert page.complaints == []


def test_random_addresses_do_no_harm(opened: Any):
    """Numbers that no scene has, keys of other pages and scraps of script: an answer or a line, and no complaint."""
    page, draw = opened("coating"), random.Random("addresses")
    names = [each["name"] for each in page.knobs]
    others = [
        "scene",
        "pinned",
        "across",
        "upward",
        "impact.kind",
        "__proto__",
        "toString",
        "<svg onload=alert(1)>",
        "",
    ]
    values = [
        "NaN",
        "-Infinity",
        "1e308",
        "-1e308",
        "5e-324",
        "0",
        "-0",
        "never",
        "1e400",
        "0x10",
        "１２",
        "\0",
        "%",
        "%ff",
        "stokes",
    ]
    values += ["javascript:alert(1)", "<script>alert(1)</script>", "';alert(1);'", "2", "99", *names[:3], "1" * 3000]
    for _ in range(ADDRESSES):
        pairs = []
        for _ in range(draw.randint(1, 4)):
            key, value = draw.choice(names + others), draw.choice([*values, repr(10 ** draw.uniform(-320, 308))])
            pairs.append(f"{draw.choice(['', '', 'pinned.'])}{key}={value}")
        text = draw.choice(["&", "&", "#", "&&"]).join(pairs)
        page.ask(
            "text => { location.hash = text }", text if draw.random() < 0.5 else urllib.parse.quote(text, safe="=&")
        )
        page.ask("() => new Promise(done => setTimeout(done, 20))")
        page.until("!!document.querySelector('[role=status]').textContent.trim()")
        found = page.ask("wetdoublet.shown().found")
        assert found["status"] != 0 or found["outcome"] in (0, 1, 2), text
        if found["status"] == 0 and found["outcome"] != 0:
            assert math.isfinite(found["restitution"]), text
        assert page.ask("document.querySelectorAll('[role=status] *, [role=alert] *').length") == 2, (
            text
        )  # title, words
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


def test_python_gives_the_same_numbers(opened: Any, capsys: pytest.CaptureFixture[str]):
    """The line that the page shows, run."""
    page = opened("coating", "impact.speed=3&liquid.viscosity=20&particles.youngs_modulus=never")
    line = page.ask("wetdoublet.python(wetdoublet.state())")
    found = page.ask("wetdoublet.shown().found")
    names: dict[str, Any] = {}
    exec(line.replace("print(", "one = ("), names)
    assert found["restitution"] == pytest.approx(names["one"].restitution, rel=1e-8)


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


@pytest.mark.parametrize("width", [320, 420, 1280, 2560])
def test_no_width_needs_scrolling_sideways(width: int, opened: Any):
    page = opened("unequal", viewport={"width": width, "height": 800})
    assert page.ask("document.documentElement.scrollWidth <= innerWidth")


@pytest.mark.parametrize("outcome", [0, 1, 2])
def test_the_legend_shows_an_outcome(outcome: int, opened: Any):
    """Each of its buttons chooses an impact that has the outcome, and the answer says so."""
    page, names = opened("granulation"), ("Stick", "Stick, rotate, separate", "Bounce")
    page.tab.locator(".legend button").nth(outcome).click()
    assert page.ask("wetdoublet.shown().found")["outcome"] == outcome
    assert page.tab.inner_text("[role=status]").startswith(f"{names[outcome]}.")


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
