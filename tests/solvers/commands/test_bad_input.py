"""The command line: bad input is one line and exit 2, options are judged first, standard output stays clean."""

import json
import os
import re
import subprocess
import sys
import warnings
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest
from wetdoublet.solvers.commands.cli import COMMANDS, cli
from wetdoublet.solvers.commands.texts import entry_range
from wetdoublet.solvers.errors import CheckFailed, ComputationError, InputError, ModelWarning
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.scene.scene import Scene
from wetdoublet.solvers.scene.scenefile import PRESETS
from wetdoublet.solvers.scene.schema import FIELDS

from ...helpers.command import quiet, run


@pytest.fixture
def module(monkeypatch):
    """Put a stand-in in place of a module that a command imports when it runs."""

    def put(name, **content):
        stand_in = ModuleType(name)
        vars(stand_in).update(content)
        parent, _, child = name.rpartition(".")
        monkeypatch.setitem(sys.modules, name, stand_in)
        if parent in sys.modules:
            monkeypatch.setattr(sys.modules[parent], child, stand_in, raising=False)

    return put


@pytest.fixture
def collision(module):
    """Let `collide` be a stand-in that remembers what it was asked."""
    asked = {}

    def collide(scene, **options):
        asked.update(options, scene=scene)
        return asked.get("result") or SimpleNamespace(
            to_dict=lambda: {"outcome": "stick"}, plot=asked.setdefault("plots", []).append
        )

    module("wetdoublet.solvers.collision.collide", collide=collide)
    return asked


BAD = [
    ("collide granulation --stokes nan", "--stokes", '"nan"', "> 0"),
    ("collide granulation --stokes 1 --speed 1m/s", "--speed", '"1m/s"', "only one of --stokes, --speed"),
    ("collide granulation --speed 1", "--speed", "no unit", "with its unit"),
    ("collide granulation --angle 95", "--angle", '"95 deg"', "< 90 deg"),
    ("collide granulation --stokes 1e300", "impact.stokes", "1e+300 is too far off", "stokes number"),
    ("collide granulation --relative-speed 1e200m/s", "impact.relative_speed", '"1e200m/s"', "stokes number"),
    ("critical granulation --angle 20:x:3", "--angle", '"x" is not a number', "an impact angle"),
    ("design granulatoin --over stokes=0.1:1", "scene", "did you mean granulation?", "a preset: granulation, pendulum"),
    ("collide granulation --hold stokes --stokes 0.3", "--hold", "together with --stokes", "--hold without --stokes"),
    ("collide granulation --rtol 1e-14", "--rtol", '"1e-14"', "1e-13 to 1e-3"),
    ("collide granulation --engine cvode", "--engine", "did you mean cvodes?", "cvodes, rosenbrock"),
    ("collide granulation --plot a.gif", "--plot", '"a.gif"', ".png"),
    ("collide granulation --set liquid.viscosty=3", "liquid.viscosty", "did you mean liquid.viscosity?", "liquid.visc"),
    ("collide granulation --set liquid.viscosity", "--set", '"liquid.viscosity"', "NAME=VALUE"),
    ("collide granulation --set impact.speed=1m/s", "impact.speed", "impact.stokes = 0.03", "--speed or --stokes"),
    ("collide granulation --set particles.radius=99um", "particles.radius", "reduced_radius",
     "set particles.reduced_r"),
    ("collide granulation --set particles.reduced_radius=1e-200m", "particles.reduced_radius", "too small",
     "film_thic"),
    ("collide pendulm", "scene", "did you mean pendulum?", "granulation, pendulum"),
    ("collide", "SCENE", "missing", "granulation, pendulum"),
    ("collide granulation --stokes", "--stokes", "its value is missing", "--stokes S"),
    ("collide granulation -o ./x.png --plot x.png", "-o", '"x.png" is given to --plot as well', "two different files"),
    ("collide granulation pendulum", "collide", "pendulum", "SCENE"),
    ("", "COMMAND", "issing", "scenes, collide"),
    ("fit none.csv granulation --free liquid.viscosity", "data", '"none.csv" is no file', "a CSV file"),  # either order
    ("sensitivity granulation --wrt ,", "--wrt", "names nothing", "names, separated by commas"),
    ("bench --set liquid.viscosity=3Pas", "--set", "needs a SCENE", ""),
    ("diff library", "B", "missing", "library"),
    ("diff library granulatio", "B", "did you mean granulation?", "library, granulation"),
    ("export granulation --to latx", "--to", "did you mean latex?", "c, casadi, latex"),
    ("export granulation --to c", "--out", "missing", ""),
    ("generate --out /proc/x", "--out", "/proc cannot be written to", "a folder"),
    ("generate --out pyproject.toml", "--out", '"pyproject.toml" is a file', "a folder"),
    ("generate --check --out x", "--out", '"x"', "--check alone"),
    ("averages granulation --speeds 1m/s --radii 50,200um", "--radii", "has a comma", "a range LO:HI:N, log:LO:HI:N"),
    ("map granulation --stokes 1:2:2 --angle 0:1:2 --set impact.angle=3", "--set", "axis of the map", "impact.spin"),
    ("map granulation --stokes 0.1:0.2:1000000000", "--stokes", "has too many values", "N at most 10000000"),
    ("map granulation --stokes 0.1:0.2:3", "--angle", "missing", ""),
    ("prove granulation --map --stokes 0.1 --angle 0:10:3", "--stokes", '"0.1" is', "two rising edges"),
    ("prove granulation --map --stokes 0.1:0.5:3 --angle 10", "--angle", '"10" is', "two rising edges"),
    ("prove granulation --map --stokes 0.1:0.5:3", "--angle", "missing", "two rising edges"),
    ("map granulation --speed 0.1:0.2:3 --angle 0:80:3", "--speed", '"0.1:0.2:3" has no unit', '"0.1:0.2 m/s:3"'),
    ("map granulation --angle 0:1:2 --vary liquid.viscosity=1:2:3", "--vary liquid.viscosity", '"1:2:3" has no unit',
     '"1:2 Pa s:3"'),
    ("map granulation --set bridge.volume=0.2 --vary bridge.volume=0.1:0.2:2", "--vary", '"bridge.volume"', ""),
    ("map granulation --stokes 1:2:90 --angle 0:80:90 --vary bridge.volume=0.1:0.2:9000", "--vary bridge.volume",
     '"bridge.volume=0.1:0.2:9000" makes 90 x 90 x 9000', ""),
    ("map granulation --stokes 0.1:0.2:3 --angle 0:80:3 -o map.txt", "-o", '"map.txt" has an unsupported suffix', ""),
    ("collide granulation --until 5", "--until", "has no unit", "a time"),
    ("collide granulation --until 3m", "--until", "not a time", ""),
    ("collide granulation --until nans", "--until", "is not finite", ""),
    ("scenes --new powder --hold stokes", "--new", "given together with --hold", "--new NAME alone"),
    ("sensitivity granulation --uncertainty liquid.viscosity=5", "--uncertainty of liquid.viscosity", "no unit", "5 %"),
    ("verify --stress 5 --relative-speed 2m/s", "--relative-speed", "given together with --stress", "alone"),
    ("verify --stress -1", "--stress", "-1", "a whole number from 1 to 10000000"),
    ("verify --out x", "--out", "", "--stress"),
    ("verify granulation --stress 8", "SCENE", "", "--stress"),
    ("design granulation --free liquid.viscosity,liquid.nothing --over stokes=0.1:1,angle=0:60", "--free",
     '"liquid.nothing" is not known', "liquid.viscosity"),
    ("sensitivity granulation --wrt liquid.viscosity,nothing", "--wrt", '"nothing"', "liquid.viscosity"),
    ("verify granulation -o ./x.pdf", "-o", "has an unsupported suffix", "ending in .md"),
]  # fmt: skip


@pytest.mark.parametrize(("line", "field", "says", "accepted"), BAD, ids=[bad[0] for bad in BAD])
def test_bad_input(line, field, says, accepted):
    """Bad input exits 2 with one line that names field, value and what is accepted, and prints nothing else."""
    result = run(*line.split())
    assert (result.exit_code, result.stdout, len(result.stderr.splitlines())) == (2, "", 1)
    assert result.stderr.startswith(field + ": ")
    before, _, after = result.stderr.partition("; accepted: ")
    assert says in before and accepted in after


@pytest.mark.parametrize("text", ["log:1:2:2", " 1 : 2 :2", "2:2:1", "1"])
def test_the_range_that_is_suggested_is_accepted(text):
    """Numbers without their unit, of every quantity that has one: the example in the message is the range as meant."""
    for name, entry in FIELDS.items():
        if entry.unit and entry.unit != "rad":
            with pytest.raises(InputError, match="has no unit") as error:
                entry_range(entry, text)
            example = re.search('as "(.+?)"', str(error.value))[1]
            low, *_, high = 2 * entry_range(entry, example)
            assert high / low == pytest.approx(1 if text in ("2:2:1", "1") else 2), name


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_is_refused_twice_and_misspelt(name):
    """Of all options of all commands; flags may be repeated."""
    for option in cli.get_command(None, name).params:
        if option.param_type_name == "option" and not (option.multiple or option.is_flag):
            done = run(name, option.opts[0], "one", option.opts[0], "other")
            assert (done.exit_code, "is given twice" in done.stderr) == (2, True)
        if option.param_type_name == "option" and len(option.opts[0]) > 4 and option.opts[0] != "--help":
            done = run(name, f"{option.opts[0]}z")
            assert (done.exit_code, f"did you mean {option.opts[0]}?" in done.stderr) == (2, True)


def test_options_come_before_what_is_missing(tmp_path):
    """A bad option is reported before a scene without an impact, a broken scene and a missing one."""
    file = tmp_path / "scene.toml"
    file.write_text(Scene.load("granulation").to_toml().partition("[impact]")[0])
    assert run("collide", str(file)).stderr.startswith("impact.stokes: missing; accepted: stokes = 0.03")
    for scene in (str(file), "nowhere.toml"):
        assert run("collide", scene, "--rtol", "1").stderr.startswith("--rtol: ")
    file.write_text("[liquid\n")
    assert run("collide", str(file)).stderr.startswith(f"{file}, line 1: ")
    assert run("collide", str(file), "--angle", "95 deg").stderr.startswith("--angle: ")
    assert run("--version").stdout.startswith("wetdoublet ")


def test_failures(collision, monkeypatch):
    """A computation that fails exits 1, an interrupt 130, a defect 1, NaN never reaches JSON: one line each."""

    def fail(error):
        def to_dict():
            raise error

        collision["result"] = SimpleNamespace(to_dict=to_dict)
        return run("collide", "granulation", "--json")

    stopped = ComputationError("step too small", "contact", 1e-3, {"x": 1e-6}, "try --engine rosenbrock")
    for error, status, says in (
        (stopped, 1, "step too small in phase contact at t = 0.001 s; state x = 1e-06; try --engine rosenbrock"),
        (CheckFailed("broken\nlaw"), 1, "broken law"),
        (KeyboardInterrupt(), 130, "interrupted"),
        (ZeroDivisionError("oops\nthere"), 1, "internal error: ZeroDivisionError: oops there"),
        (OSError(28, "No space left on device", "a.txt"), 1, "a.txt: No space left on device"),
    ):
        result = fail(error)
        assert (result.exit_code, result.stdout, len(result.stderr.splitlines())) == (status, "", 1)
        assert result.stderr.startswith(says)
    collision["result"] = SimpleNamespace(to_dict=lambda: {"restitution": float("nan")})
    result = run("collide", "granulation", "--json")
    assert (result.exit_code, result.stdout) == (1, "")
    result = run("collide", "granulation", "--json", "--debug")
    assert "Traceback" in result.stderr and result.stdout == ""


def test_scenes():
    """`scenes` lists the presets; `scenes NAME` prints one that loads as itself, changed if asked."""
    lines = run("scenes").stdout.splitlines()
    assert [line.split()[0] for line in lines] == [*PRESETS]
    assert all(len(line.split()) > 5 and len(line) < 100 for line in lines)
    assert Scene.from_toml(run("scenes", "pendulum").stdout) == Scene.load("pendulum")
    changed = run("scenes", "granulation", "--set", "liquid.viscosity=3 Pa s", "--angle", "10 deg").stdout
    assert Scene.from_toml(changed).liquid.viscosity == 3.0
    changed = run("scenes", "granulation", "--angle", "20deg", "--speed", "1 m/s").stdout
    assert changed.endswith('[impact]\nspeed = "1 m/s"\nangle = "20deg"\n')


def test_a_bare_generate_beside_no_source_asks_where_to(monkeypatch, tmp_path):
    """An installed package has no tree to rewrite: `--out` or `--check` are named, and nothing is written."""
    from wetdoublet.solvers.commands import scenes

    monkeypatch.setattr(scenes, "OWN", tmp_path / "generated")
    result = run("generate")
    assert result.exit_code == 2
    assert str(tmp_path / "generated") in result.stderr and "--out DIR, or --check" in result.stderr
    assert not (tmp_path / "generated").exists()


def test_a_reader_that_leaves():
    """A broken pipe is quiet."""
    code = "import os; os.close(0); from wetdoublet.solvers.commands.cli import main; main(['scenes', 'granulation'])"
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run([sys.executable, "-c", code], check=False, stdout=write, stderr=subprocess.PIPE, text=True)
    os.close(write)
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.parametrize(
    ("line", "status", "errors"),
    [
        ("scenes >&-", 1, "standard output: is closed; accepted: a file that can be written\n"),
        ("scenes >&- 2>&-", 1, ""),
        ("collide granulation --json -o FILE >&-", 0, ""),
        ("collide granulation --stokes x >&- 2>&-", 2, ""),
    ],
)
def test_closed_streams(line: str, status: int, errors: str, tmp_path: Path):
    """What can't be written to a closed standard output fails; what goes to a file does not, nor to standard error."""
    file = tmp_path / "one.json"
    command = f"{sys.executable} -m wetdoublet.solvers {line.replace('FILE', str(file))}"
    done = subprocess.run(["sh", "-c", command], check=False, stderr=subprocess.PIPE, text=True)
    assert (done.returncode, done.stderr) == (status, errors)
    assert not file.exists() or json.loads(file.read_text())["outcome"]


@pytest.mark.slow
def test_a_new_scene(tmp_path, monkeypatch):
    """`scenes --new NAME` writes a commented scene that runs as it is, and overwrites nothing."""
    monkeypatch.chdir(tmp_path)
    assert run("scenes", "--new", "mine").stdout == "mine.toml\n"
    assert run("collide", "mine.toml").exit_code == 0
    text = (tmp_path / "mine.toml").read_text()
    assert 'name = "mine"' in text and all("#" in line for line in text.splitlines() if line.startswith("# "))
    offered = r"(?m)^# (?=youngs|poisson|friction|contact_|glass_|coating_fraction|spin|partner_spin)"
    uncommented = re.sub(offered, "", text)
    assert Scene.from_toml(uncommented).bridge is not None  # what is offered is right as well
    again = run("scenes", "--new", "mine")
    assert again.exit_code == 2 and again.stderr.startswith('--new: "mine" would overwrite mine.toml; accepted: ')
    assert run("scenes", "lactose-pvp", "--new", "other").exit_code == 2
    assert (tmp_path / "mine.toml").read_text() == text and not (tmp_path / "other.toml").exists()


@pytest.mark.slow
def test_a_home_that_cannot_be_written(tmp_path):
    """Matplotlib then works from a temporary folder, and standard error stays clean."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("XDG_", "MPL"))}
    line = ["-m", "wetdoublet.solvers", "collide", "granulation", "--plot", str(tmp_path / "a.png")]
    line += ["--engine", "cvodes"]  # which keeps nothing in the user's cache
    done = subprocess.run(
        [sys.executable, *line], check=False, capture_output=True, text=True, env=kept | {"HOME": "/proc/none"}
    )
    assert (done.returncode, quiet(done.stderr)) == (0, "") and (tmp_path / "a.png").is_file()


def test_generate(module, tmp_path):
    """`generate` lists what it wrote, `--check` what differs, with exit 1."""
    differences = ["--- generated/a.py", "extra: generated/b.py"]
    module("wetdoublet.derive.emit.write", emitted=lambda: {"a.py": "A = 1\n"}, check=lambda: differences)
    out = tmp_path / "new" / "folder"
    result = run("generate", "--out", str(out))
    assert (result.exit_code, result.stdout.split()) == (0, [str(out / "a.py")]) and out.is_dir()
    result = run("generate", "--check")
    assert (result.exit_code, result.stdout.splitlines()) == (1, differences) and len(result.stderr.splitlines()) == 1
    assert "`wetdoublet generate` mends" in result.stderr and "extra is to be removed" in result.stderr
    differences.clear()
    result = run("generate", "--check")
    assert (result.exit_code, result.output) == (0, "")


def test_a_warning_is_said_once(module):
    """However many collisions a warning is of, it is one line; another one is another line; the JSON stays pure."""

    def collide(scene, **options):
        for text in ("a law is stretched", "a law is stretched", "another one"):
            warnings.warn(text, ModelWarning, stacklevel=2)
        return SimpleNamespace(to_dict=dict)

    module("wetdoublet.solvers.collision.collide", collide=collide)
    for _ in range(2):  # each command anew
        done = run("collide", "granulation", "--json")
        assert json.loads(done.stdout) == {}
        assert done.stderr == "warning: a law is stretched\nwarning: another one\n"


def test_only_near_names_are_suggested():
    """A name that is like none gets no suggestion, and an empty scene is no folder."""
    for option in ("--foo", "--pdf", "--x"):
        assert "did you mean" not in run("collide", "granulation", option).stderr
    result = run("collide", "")
    assert result.stderr.startswith('scene: "" is an empty name; accepted: a scene file')


@pytest.mark.parametrize(
    ("line", "columns"),
    [("critical {}", "particles.diameter [um]"), ("averages granulation --speeds {}", "relative_speed,density")],
)
def test_a_table_without_columns(line, columns, tmp_path):
    """The columns that are named are those of this table."""
    (tmp_path / "empty.csv").touch()
    done = run(*line.format(tmp_path / "empty.csv").split())
    assert done.exit_code == 2
    assert "has no line with names of columns" in done.stderr and columns in done.stderr


@pytest.mark.skipif(compiler() is None, reason="no C compiler")
def test_a_cache_that_cannot_be_written(tmp_path: Path) -> None:
    """Kernels that would be lost at the end of the process are not compiled: the last line names the folder."""
    file = tmp_path / "file"
    file.write_text("")
    command = (sys.executable, "-m", "wetdoublet.solvers", "compile", "granulation-dry-bridge")
    env = os.environ | {"WETDOUBLET_CACHE": str(file / "cache")}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=env)
    assert (done.returncode, done.stdout) == (1, "")
    said = done.stderr.splitlines()[-1]
    assert said.startswith(f"kernels cannot be kept in the cache {file / 'cache'}: ")
    assert "WETDOUBLET_CACHE" in said.partition(";")[2]
