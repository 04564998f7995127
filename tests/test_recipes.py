"""Recipes of the architecture page, "Where things go", followed in a copy of the tree: the edits are all it takes."""

import json
import math
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from wetdoublet.solvers import Scene, collide, sensitivities

pytestmark = pytest.mark.slow  # derives structures, and compiles a kernel

ROOT = Path(__file__).resolve().parents[1]

# file, text that is there -> text that takes its place; `{}` is where the old text goes
QUANTITIES, SCALING, AUTOMATON = (
    f"derive/{name}.py" for name in ("vocabulary/quantities", "physics/scaling", "equations/automaton")
)
ENTRY = [  # a quantity of the vocabulary, and an entry of a scene that is it
    (QUANTITIES, "e_dry = ", 'w = _quantity("waviness", "w", LENGTH, "height of the waves", nonnegative=True)\n{}'),
    (
        "solvers/scene/schema.py",
        "    dry_restitution: float = entry(",
        '    waviness: float | None = entry("a waviness", \'"1 um"\', NOT_NEGATIVE, unit="m")\n    """Height."""\n{}',
    ),
]
GROUP = [  # its name and formula
    (
        QUANTITIES,
        "rupture_gap = ",
        'wavy_gap = _group("wavy_gap", "w/x_0", "waviness over x0", unit="x0", nonnegative=True)\n{}',
    ),
    (SCALING, "        q.rough_gap: q.x_b / q.x0,\n", "{}        q.wavy_gap: q.w / q.x0,\n"),
]
CRITERION = [  # a row of the automaton
    (
        AUTOMATON,
        '    Criterion("rough"',
        '    Criterion("wavy", "wavy_gap", "waviness", "the gap is down to w", "w", "w", ("waviness", 0.0)),\n{}',
    )
]
CAUGHT_ROW = """    Event("caught", ("caught",), (_MOVING, _CLOSING), ("caught",), ("gap = target", "cut off"),
          series=("gap",), target="wavy_gap", bound="monotonic"),
{}"""
SET_ROW = """    Event("set", ("set",), (_MOVING, _OPENING), ("set",), ("cut off",),
          series=("stretching",), target="wavy_gap"),
{}"""
EVENTS = [  # two rows: a gap, and what the kernel has no series of; their words, and the definition of that series
    (
        AUTOMATON,
        '    Word("turned"',
        '    Word("caught", "the waves interlock"),\n    Word("set", "the film sets"),\n{}',
    ),
    (AUTOMATON, '    Event("film_edge"', CAUGHT_ROW),
    (AUTOMATON, '    Event("release"', SET_ROW),
    ("derive/equations/events.py", '    "slip": lambda', '    "stretching": lambda _: q.normal_velocity / q.gap,\n{}'),
]
HALVED = """\"\"\"A bridge that pulls half as much, up to half a radius.\"\"\"

from ..user import Rational, cos, law, phi

law("bridge", "halved", source="nobody", force=cos(phi), rupture_distance=Rational(1, 2))
"""
RESULT = [  # its row, and its expression
    ("solvers/results.py", "_COLLISION = (\n", '{}    Definition("lost_speed", "1", "", derivative="casadi"),\n'),
    (
        "solvers/sensitivity/trajectory.py",
        '    if "strings" in energies:\n',
        '    named["lost_speed"] = 1 - named["restitution"]\n{}',
    ),
]
COMMAND = [("solvers/commands/cli.py", '    "scenes": "scenes", ', '{}"hello": "hello", ')]
SMOOTH = """
from wetdoublet.solvers import InputError, Scene
solids = ("particles.youngs_modulus", "particles.poisson_ratio")
given = {name: value for name, value in Scene.load("granulation").given if name not in solids}
given |= {"particles.roughness": 0.0, "attraction.hamaker": 1e-19, "particles.waviness": 1e-6}
Scene("", tuple(given.items()))
try:
    Scene("", tuple((given | {"particles.waviness": 0.0}).items()))
except InputError as error:
    print(error.accepted)
"""
CHECKED = """
from wetdoublet.derive.checks.emitted import events_are_the_definitions
from wetdoublet.derive.emit.document.theory import theory
from wetdoublet.derive.physics.structure import Structure
check = events_are_the_definitions([Structure(oblique=False, bridge=False, strings=False)])
assert check.ok, check
print([(line.note, line.latex) for line in theory() if line.note.startswith("(i")])
"""
HELLO = """\"\"\"`wetdoublet hello`: say hello.\"\"\"

import click

from .signature import command


@command()
def hello(to: str | None) -> None:
    \"\"\"Say hello.

    Options:
        --to NAME: Who is greeted.
    \"\"\"
    click.echo(f"hello {to}")
"""
EMIT = """
from pathlib import Path
from wetdoublet.derive.emit import write
from wetdoublet.solvers.host.files import write_all_in
write_all_in(write.GENERATED, write.emitted(()))  # structures are derived on first use
"""


class Tree:
    """A copy of the tree with recipes applied, its own cache, and its laws and tables emitted."""

    def __init__(self, work: Path, edits: list[tuple[str, str, str]]) -> None:
        self.package = work / "wetdoublet"
        for folder in ("derive", "solvers"):
            shutil.copytree(ROOT / folder, self.package / folder, ignore=shutil.ignore_patterns("__pycache__"))
        (self.package / "generated").mkdir()
        # a package without __init__ would give way to the installed one, which has it
        shutil.copy(ROOT / "solvers" / "package" / "__init__.py", self.package)
        for path, old, new in edits:
            file = self.package / path
            before, found, after = file.read_text().rpartition(old)
            assert found, f"{path} has no {old}"
            file.write_text(before + new.replace("{}", old) + after)
        (self.package / "solvers/commands/hello.py").write_text(HELLO)
        (self.package / "derive/laws/halved.py").write_text(HALVED)
        self.environment = os.environ | {"PYTHONPATH": str(work), "XDG_CACHE_HOME": str(work / "cache")}
        self.python("-c", EMIT)

    def python(self, *arguments: str) -> str:
        """Standard output of a Python process that imports this tree."""
        done = subprocess.run(
            [sys.executable, *arguments], env=self.environment, capture_output=True, text=True, timeout=300, check=False
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    def run(self, *command: str) -> str:
        """Standard output of a command."""
        return self.python("-m", "wetdoublet.solvers", *command)

    def told(self, *command: str) -> dict[str, Any]:
        """What a command says with --json."""
        told: dict[str, Any] = json.loads(self.run(*command, "--json"))
        return told


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Tree:
    return Tree(tmp_path_factory.mktemp("recipes"), [*ENTRY, *GROUP, *CRITERION, *RESULT, *COMMAND])


@pytest.fixture(scope="module")
def eventful(tmp_path_factory: pytest.TempPathFactory) -> Tree:
    return Tree(tmp_path_factory.mktemp("events"), [*ENTRY, *GROUP, *EVENTS])


HARD = {"liquid.glass_transition_pressure": "1e6 GPa", "particles.roughness": "0.1 um"}
FAST = {"stokes": 5.0, "angle": 0.0}
ROUGH, WAVY = HARD | {"particles.roughness": "2 um"}, HARD | {"particles.waviness": "2 um"}


CAUGHT = {"particles.roughness": "0.1 um", "particles.waviness": "4 um"}  # x0 is 8 um
SET = {"particles.roughness": "2 um", "particles.waviness": "1.6 um"}


def duration(start: float, end: float, speed: Callable[[float], float]) -> float:
    """Time (s) from one gap to another, over x0, at a speed over v0 that depends on the gap."""
    scene = Scene.load("granulation")
    return abs(quad(lambda x: 1 / speed(x), start, end)[0]) * 8e-6 * scene.stokes_per_speed / STOKES


def options(entries: dict[str, str], stokes: float, engine: str) -> list[str]:
    """Of a command, head-on."""
    given = [word for name, value in entries.items() for word in ("--set", f"{name}={value}")]
    return [*given, "--stokes", str(stokes), "--angle", "0 deg", "--engine", engine]


def test_a_new_rebound_criterion(tree: Tree, tmp_path: Path) -> None:
    """Waves reverse as roughness of their height does, under their own word; Rosenbrock confirms the kernel."""
    rough = collide(Scene.load("granulation").with_entries(ROUGH), **FAST, engine="rosenbrock")
    wavy = tree.told("collide", "granulation", *options(WAVY, 5.0, "rosenbrock"), "--plot", str(tmp_path / "wavy.svg"))
    assert (tmp_path / "wavy.svg").stat().st_size > 0
    assert (rough.reversal, wavy["reversal"], wavy["engine"]) == ("rough", "wavy", "rosenbrock")
    assert wavy["restitution"] == pytest.approx(rough.restitution, rel=1e-13)


# head-on in an infinite film the speed falls by ln(x)/St; the bridge is negligible
ANALYTIC = {"liquid.glass_transition_pressure": "1e6 GPa", "bridge.surface_tension": "1e-12 N/m",
            "model.film": "infinite", "particles.dry_restitution": "0.6"}  # fmt: skip
STOKES = 5.0


def test_a_new_event_at_a_gap(eventful: Tree) -> None:
    """It ends the collision when the gap is down to its group; Rosenbrock confirms the kernel."""
    told = eventful.told("collide", "granulation", *options(ANALYTIC | CAUGHT, STOKES, "rosenbrock"))
    assert [event["kind"] for event in told["events"]] == ["caught"]
    assert (told["outcome"], told["engine"]) == ("stick", "rosenbrock")
    assert told["events"][0]["time"] == pytest.approx(duration(1.0, 0.5, lambda x: 1 + math.log(x) / STOKES), rel=1e-8)


def test_a_new_event_of_another_series(eventful: Tree) -> None:
    """It happens where u/x is down to its group while opening: the kernel's recurrences of u/x are emitted."""
    told = eventful.told("collide", "granulation", *options(ANALYTIC | SET, STOKES, "rosenbrock"))
    assert ([event["kind"] for event in told["events"]], told["engine"]) == (["rough", "set"], "rosenbrock")

    def opening(x: float) -> float:
        return 0.6 * (1 + math.log(0.25) / STOKES) - math.log(x / 0.25) / STOKES

    end = brentq(lambda x: opening(x) / x - 0.2, 0.25, 1.0)
    elapsed = told["events"][1]["time"] - told["events"][0]["time"]
    assert elapsed == pytest.approx(duration(0.25, end, opening), rel=1e-8)


def test_a_new_rebound_criterion_is_printed_and_checked(tree: Tree) -> None:
    """The theory has its line, and its event function is its group's definition."""
    assert "('(iii) waviness', 'x \\\\leq w')" in tree.python("-c", CHECKED)


def test_the_new_criterion_keeps_the_gap_open(tree: Tree) -> None:
    """A scene without other contact, whose attraction would be unbounded, is refused if the waves are flat."""
    assert (
        tree.python("-c", SMOOTH)
        == "a positive particles.roughness or particles.waviness or particles.youngs_modulus\n"
    )


def test_a_new_entry_and_a_new_result_have_derivatives(tree: Tree) -> None:
    """By the waviness they are those by the roughness, where that is what reverses; 1 - e_n has the opposite slope."""
    scene = Scene.load("granulation").with_entries(ROUGH)
    rough = sensitivities(scene, **FAST, wrt="particles.roughness", engine="rosenbrock")
    wavy = tree.told("sensitivity", "granulation", *options(WAVY, 5.0, "rosenbrock"), "--of", "restitution,lost_speed")
    expected = pytest.approx(rough.gradient["restitution"]["particles.roughness"], rel=1e-10)
    assert wavy["gradient"]["restitution"]["particles.waviness"] == expected
    assert -wavy["gradient"]["lost_speed"]["particles.waviness"] == expected
    assert wavy["gradient"]["restitution"]["particles.roughness"] == 0.0
    assert wavy["value"]["lost_speed"] == 1 - wavy["value"]["restitution"]


def test_a_new_bridge_law(tree: Tree) -> None:
    """A file: half the constant force, up to the common rupture distance of V = 1/8, is that of half the tension."""
    entries = {"bridge.law": "constant", "bridge.surface_tension": "0.0125 N/m", "bridge.volume": 0.125}
    constant = collide(Scene.load("granulation").with_entries(entries), stokes=0.5, angle=0.0, engine="cvodes")
    halved = {"bridge.law": "halved", "bridge.rupture": "own"}
    told = tree.told("collide", "granulation", *options(halved, 0.5, "cvodes"))
    assert told["outcome"] == constant.outcome
    assert told["restitution"] == pytest.approx(constant.restitution, rel=1e-12)
    assert told["contact_time"] == pytest.approx(constant.contact_time, rel=1e-12)


def test_a_new_command(tree: Tree) -> None:
    """It is run by its name, with the option of its signature."""
    assert tree.run("hello", "--to", "you") == "hello you\n"
