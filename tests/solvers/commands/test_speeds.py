"""Whatever a command prints or draws says which speed it is: the normal one, the relative one, or a Stokes number."""

import csv
import html
import json
import re
from pathlib import Path

import matplotlib as mpl
import pytest
from wetdoublet.solvers import Scene
from wetdoublet.solvers.commands.cli import COMMANDS

from ...helpers.command import run

GRID = ("--relative-speed", "1:2 m/s:2", "--angle", "55:60:2")
WINDOW = ("--free", "liquid.viscosity", "--over", "relative_speed=0.5 m/s:8 m/s,angle=60:60", "-n", "2")
QUICK = ("--restitution-sd", "none")
LINES = ("--angle", "55:55:1", "--stokes", "0.02:0.2")
UNCERTAIN = ("--uncertainty", "impact.angle=1 deg", "--over", "relative_speed=1:2 m/s:2")
SHOWN: dict[str, tuple[str, ...]] = {
    "scenes": (),
    "collide": (),
    "collide --json": ("--json",),
    "sensitivity": ("--wrt", "impact.speed,impact.relative_speed,liquid.viscosity"),
    "sensitivity --json": ("--wrt", "liquid.viscosity", "--json"),
    "sensitivity band": UNCERTAIN,
    "map": GRID,
    "boundary": (*LINES, "--wrt", "liquid.viscosity"),
    "boundary --json": (*LINES, "--json"),
    "critical": ("--angle", "55"),
    "critical --json": ("--angle", "55", "--json"),
    "solve": ("--free", "impact.relative_speed=1:4 m/s", "--for", "contact_time=0.1 ms"),
    "solve --json": ("--free", "liquid.viscosity=0.5:9 Pa s", "--for", "contact_time=0.1 ms", "--json"),
    "averages": ("--tolerance", "1e-2"),
    "check": (),
    "fit": ("--free", "liquid.viscosity"),
}
DRAWN = {"collide", "sensitivity", "sensitivity band", "boundary", "critical", "fit"}
SILENT = {  # why the others show no speed
    "prove": "names in SI and Stokes numbers", "reproduce": "the paper's figures are over Stokes numbers and angles",
    "verify": "residuals of laws", "bench": "CPU times and errors", "export": "functions, whose headers name arguments",
    "generate": "files of equations", "diff": "files of equations", "compile": "digests", "cite": "references",
    "explore": "a page, whose labels say which",
    "tracks": "the columns of `fit`; printed, they say normal speed",
    "flow-curve": "shear rates and viscosities of a liquid",
}  # fmt: skip
NAMED = re.compile(r"(normal|relative|rel\.|approach|impact\.)[\s_]?$|_$")
MACHINE = re.compile(r"""^["']?speed(_sd)?["']?( \[m/s\])?["']?\s*([:,]|$)""")


def unnamed(text: str) -> list[str]:
    """Places where a text says `speed` without which one; keys of JSON and columns of CSV are entries' names."""
    found = []
    for at in re.finditer(r"(?i)\bspeeds?\b|_speeds?\b", text):
        start = at.start() - (text[at.start() - 1] in "\"'")
        entry = (
            MACHINE.match(text[start : at.end() + 9].split("\n", maxsplit=1)[0]) and text[start - 1 : start] in "\n ,{"
        )
        if not (entry or at.group().startswith("_") or NAMED.search(text[: at.start()])):
            found.append(text[max(0, at.start() - 30) : at.end() + 20])
    return found


def check_picture(picture: Path) -> None:
    """No text in an SVG says `speed`, or has m/s, without which speed it is."""
    text = html.unescape(re.sub(r"<[^>]+>", "\n", picture.read_text(encoding="utf-8").partition("<g")[2]))
    text = re.sub(r"\s*\n\s*", " ", text)
    assert unnamed(text) == []
    assert "m/s" not in text or re.search(r"(normal|relative)( approach)? (speed|velocity)", text)


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Granulation with a relative speed, as a file."""
    file = tmp_path_factory.mktemp("scene") / "scene.toml"
    file.write_text(Scene.load("granulation").with_impact(relative_speed="2 m/s").to_toml())
    rows = [f"{speed} m/s,60 deg,bounce" for speed in (5, 6, 7)] + ["0.5 m/s,60 deg,stick"] * 3
    text = "\n".join(["relative_speed [m/s],angle [deg],outcome", *rows])
    (file.parent / "data.csv").write_text(text.replace(" m/s,", ",").replace(" deg,", ","))
    return file


def test_every_command_is_looked_at() -> None:
    """A command shows its speeds here, or it is said why it has none."""
    assert {name.partition(" ")[0] for name in SHOWN} | {"design", *SILENT} == set(COMMANDS)


@pytest.mark.parametrize("name", SHOWN)
@pytest.mark.slow
def test_output_says_which_speed(name: str, scene: Path, tmp_path: Path) -> None:
    """No table, JSON, CSV or picture of a command says `speed` alone, and none shows m/s without a name of it."""
    command = name.partition(" ")[0]
    words = [command, scene, *([scene.parent / "data.csv"] if command in ("fit", "check") else []), *SHOWN[name]]
    picture = tmp_path / "picture.svg"
    words += ["--plot", picture] if name in DRAWN else []
    file = tmp_path / "table.csv"
    words += ["-o", file] if command == "map" else []
    with mpl.rc_context({"svg.fonttype": "none"}):
        done = run(*words)
    assert done.exit_code == 0, done.stderr
    if name == "map":  # it is printed where it is neither drawn nor written
        done = run(command, scene, *GRID)
    assert unnamed(done.stdout) == []
    assert unnamed(file.read_text() if file.suffix == ".csv" and file.exists() else "") == []
    if "m/s" in done.stdout:
        assert re.search(r"(normal|relative|rel\.)[\s_]speed|normal component", done.stdout)
    assert picture.exists() == (name in DRAWN)
    if picture.exists():
        check_picture(picture)


@pytest.mark.slow
def test_a_design_shows_the_speed_of_its_window(scene: Path) -> None:
    """Table, picture, JSON and CSV have the same relative speeds, at 60 deg twice the normal ones, and name them."""
    file, picture = scene.parent / "design.csv", scene.parent / "design.svg"
    with mpl.rc_context({"svg.fonttype": "none"}):
        table = run("design", scene, *WINDOW, *QUICK, "-o", file, "--plot", picture).stdout
    object_ = run("design", scene, *WINDOW, *QUICK, "--json").stdout
    assert unnamed(table) == unnamed(object_) == unnamed(file.read_text()) == []
    check_picture(picture)
    impacts = json.loads(object_)["impacts"]
    shown = [float(value) for value in re.findall(r"([\d.]+) m/s", table)]
    assert shown == pytest.approx([each["relative_speed"] for each in impacts], rel=1e-3)
    assert [each["relative_speed"] for each in impacts] == pytest.approx([2 * each["speed"] for each in impacts])
    [first, *_] = csv.DictReader(file.read_text().splitlines())
    assert float(first["relative_speed [m/s]"]) == pytest.approx(shown[0], rel=1e-3)
