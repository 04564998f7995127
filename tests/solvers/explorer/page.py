"""A page that is open in a browser, and the scenes of the pages that tests open."""

import json
import time
from pathlib import Path
from typing import Any

from wetdoublet.solvers import Scene, explore

LACTOSE = Scene.load("lactose-pvp")
GRANULATION = Scene.load("granulation")
SCENES = {  # whose modules come with the package
    "granulation": GRANULATION,
    "dry": Scene("dry", tuple(each for each in LACTOSE.given if not each[0].startswith("bridge."))),
    "strings": Scene.load("pendulum"),
    "coating": LACTOSE.with_entries(
        {"name": "a-very-long-name-of-a-scene-that-says-all-about-it-and-its-liquid", "attraction.hamaker": 1e-19}
    ),
    "beads": Scene.load("glass-beads-water").with_entries({"bridge.law": "willett"}),
    "unequal": LACTOSE.with_entries(
        {"partner.diameter": "500 um", "partner.density": "1.54 g/cm3", "particles.friction": 0.3}
    ),
    "wall": LACTOSE.with_entries({"partner.wall": True, "partner.coating_thickness": "1 um"}),
}


class Page:
    """A page of a scene that is open; what it requests and complains of is kept."""

    def __init__(self, tab: Any, path: Path, address: str = "", workers: bool = True) -> None:
        self.tab, self.workers = tab, workers
        self.requests: list[str] = []
        self.complaints: list[str] = []
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
        fine = "wetdoublet.map().idle && wetdoublet.map().count > 1"
        self.until(fine if self.workers else "wetdoublet.map().count > 0")

    def to(self, address: str) -> None:
        """Another address; what was complained of before is forgotten."""
        self.complaints.clear()
        self.ask("text => { location.hash = text }", address)
        self.ask("() => new Promise(done => setTimeout(done, 20))")

    @property
    def knobs(self) -> list[dict[str, Any]]:
        told = json.loads(self.ask("document.getElementById('scene').textContent"))
        found: list[dict[str, Any]] = told["scenes"][0]["knobs"]
        return found


def written(files: dict[str, Path], name: str) -> Path:
    """The page of a scene."""
    if name not in files:
        files[name] = files[""] / f"{name}.html"
        explore(SCENES[name]).write(files[name])
    return files[name]
