"""What one tree answers, for `two_trees.py`: public functions and commands only, a JSON line an answer.

Scenes are drawn as for the tree's own stress test. What raises answers with the name of the class and the message.
"""

import dataclasses
import hashlib
import json
import re
import subprocess
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import wetdoublet.solvers as wd
import xarray
from wetdoublet.solvers.verify.stress.sample import NUMBERS, Model, models, scene_of

TASK: dict[str, Any] = json.loads(sys.argv[1]) if __name__ == "__main__" else {}
QUICK = bool(TASK.get("quick"))
PRESETS = ("granulation", "pendulum", "granulation-dry-bridge")
ENGINES = ("taylor", "rosenbrock", "cvodes")
FIELDS = ("restitution", "tangential_restitution", "rotation", "contact_time", "smallest_gap")
MODELS = 5 if QUICK else 12  # combinations of laws and structures: each compiles kernels of its own
BATCH = 10  # impacts of a scene, the first head-on
MASKS = ((r"\d{4}-\d\d-\d\d", "DATE"), (r"\b\d+(\.\d+)? s of processor time", "TIME"))
TEXTS = {".c", ".csv", ".h", ".html", ".json", ".md", ".py", ".svg", ".tex", ".toml", ".txt", ""}


def plain(value: Any) -> Any:
    """What JSON does not know of anything public; a scene within a result is left out."""
    if isinstance(value, wd.Scene):
        return {"toml": value.to_toml(), "si": value.si}
    if dataclasses.is_dataclass(value):
        return {f.name: getattr(value, f.name) for f in dataclasses.fields(value) if f.name != "scene"}
    if isinstance(value, Mapping):
        return value.to_dict() if hasattr(value, "data_vars") else dict(value)
    return value.tolist() if hasattr(value, "tolist") else str(value)


def answer(call: Callable[..., Any], *given: Any, **options: Any) -> Any:
    """What a call returns and warns of, or raises."""
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        try:
            found = call(*given, **options)
        except Exception as error:  # noqa: BLE001 - whatever it is, the other tree must raise it as well
            return {"raises": type(error).__name__, "message": str(error)}
    return {"warns": [str(one.message) for one in heard], "returns": found} if heard else found


class Out:
    """The file of answers."""

    def __init__(self, file: str) -> None:
        self.stream = Path(file).open("w")  # noqa: SIM115 - closed with the process

    def __call__(self, what: str, name: str, value: Any, *, count: int = 1, about: str = "", **more: Any) -> None:
        record = {"what": what, "name": f"{what}: {name}", "count": count, "about": about, "value": value}
        self.stream.write(json.dumps(record | more, default=plain) + "\n")
        self.stream.flush()


def scenes(out: Out, number: int, model: Model, count: int) -> Iterator[tuple[str, wd.Scene, Any, Any]]:
    """Name, scene, Stokes numbers and angles of so many scenes of a model; what is refused is an answer as well."""
    random, made = np.random.default_rng([TASK["seed"], number]), 0
    for k in range(40 * count):
        name = f"model {number}, scene {k}"
        stokes, angle = np.exp(random.uniform(np.log(3e-3), np.log(8.0), BATCH)), random.uniform(0.0, 1.5, BATCH)
        try:
            scene = scene_of(name, model, random.random(NUMBERS), moderate=True)
        except wd.InputError as error:
            out("scene refused", name, str(error), about=str(model))
            continue
        out("scene", name, scene, about=str(model))
        yield name, scene, stokes, angle * (np.arange(BATCH) > 0)
        made += 1
        if made == count:
            return


def collisions(out: Out) -> None:
    """One by one and many, by each engine."""
    out("names", "public", list(wd.__all__))
    for number, model in enumerate(models(MODELS, TASK["seed"])):
        for name, scene, stokes, angle in scenes(out, number, model, -(-TASK["collisions"] // MODELS // BATCH)):
            about, impacts = scene.to_toml(), [*zip(stokes.tolist(), angle.tolist())][: 3 if QUICK else BATCH]
            for engine in ENGINES:
                for impact in impacts:
                    given = dict(zip(("stokes", "angle"), impact))
                    found = answer(wd.collide, scene, engine=engine, **given)
                    out(f"collide {engine}", f"{name}, {given}", found, about=about)
                found = answer(wd.collide_many, scene, stokes=stokes, angle=angle, engine=engine, of=FIELDS)
                out(f"collide_many {engine}", name, found, count=BATCH, about=about)
    for preset, engine in product(PRESETS, ENGINES):
        out("trajectory", f"{preset}, {engine}", answer(wd.collide, preset, engine=engine, trajectory=True))
        loose = answer(wd.collide, preset, engine=engine, ledger=False, rtol=1e-6)
        out(f"collide {engine}", f"{preset}, no ledger", loose)
        many = 90 if QUICK else 120  # more than a hundred: integrators are compiled
        vary = {"liquid.viscosity": np.geomspace(0.5, 2.0, many) * dict(wd.Scene.load(preset).si)["liquid.viscosity"]}
        found = answer(wd.collide_many, preset, vary=vary, engine=engine, of=FIELDS)
        out(f"collide_many {engine}, vary", preset, found, count=many)


def space(out: Out) -> None:
    """Pairs in space with any velocities and spins, and solids that chatter until they rest in friction."""
    for number, model in enumerate(models(MODELS, TASK["seed"])):
        if model["strings"] or (model["friction"] and model["partner"] == "wall"):
            continue
        planar = model | {"spins": ""}
        for name, scene, stokes, _ in scenes(out, number, planar, 1 if QUICK else 3):
            random, speed = np.random.default_rng(number), scene.speed_of(1.0) * stokes[:, None, None]
            particles = 1 if model["partner"] == "wall" else 2
            velocities, spins = random.normal(size=(2, BATCH, particles, 3))
            normal = velocities[:, 0] - (velocities[:, 1] if particles == 2 else 0) + random.normal(size=(BATCH, 3)) / 2
            given = (normal, speed * velocities, speed / scene.reduced_radius * spins)
            for ledger in (False, True):
                answers = answer(wd.collide_pair, scene, *given, ledger=ledger)
                out("collide_pair", f"{name}, ledger {ledger}", answers, count=BATCH, about=scene.to_toml())
    beads = wd.Scene.load("glass-beads-water")
    for restitution in np.geomspace(0.003, 0.3, 20 if QUICK else 60):  # each passes other speeds before it rests
        entries = {"particles.dry_restitution": float(restitution), "particles.friction": 0.3}
        scene = beads.with_entries({**entries, "liquid.viscosity": 1e-3 * float(dict(beads.si)["liquid.viscosity"])})
        for speed in (0.25, 0.3):  # so oblique that no proof ends it at its first rebound
            answers = answer(wd.collide, scene, speed=speed, angle=1.2, engine="taylor", rtol=1e-13)
            out("rests", f"dry restitution {restitution:.3g}, {speed} m/s", answers, about=scene.to_toml())


def gradients(out: Out) -> None:
    """Derivatives in parameters, by all methods."""
    of = ("restitution", "contact_time", "rotation")
    for number, model in enumerate(models(3 if QUICK else 6, TASK["seed"])):
        for name, scene, stokes, angle in scenes(out, number, model, 1 if QUICK else 2):
            about = scene.to_toml()
            for hold in ("speed", "stokes"):
                found = answer(wd.gradients_many, scene, stokes=stokes, angle=angle, of=of, hold=hold, engine="taylor")
                out("gradients_many", f"{name}, {hold} held", found, count=BATCH, about=about)
            for k in range(1, 3 if QUICK else 5):
                for method, engine in (("forward", "rosenbrock"), ("adjoint", "rosenbrock"), ("forward", "cvodes")):
                    impact = {"stokes": float(stokes[k]), "angle": float(angle[k])}
                    found = answer(wd.sensitivities, scene, of, method=method, engine=engine, **impact)
                    out("sensitivities", f"{name}, {impact}, {method}, {engine}", found, about=about)
    sigma = {"liquid.viscosity": "5 %", "impact.angle": "1 deg"}
    for preset in PRESETS[:1] if QUICK else PRESETS:
        stokes = np.array([0.8, 1.0, 1.2]) * (wd.Scene.load(preset).stokes or 1.0)
        out("band", preset, answer(wd.band, preset, sigma, "impact.stokes", stokes, samples=16))


def boundaries(out: Out) -> None:
    """Lines, planes and grids."""
    for preset in PRESETS:
        found = wd.boundary(preset, angle=np.radians([0.0, 35.0, 55.0, 70.0]))
        out("boundary", preset, [found, found.to_dict(), str(found), found.to_dataset()], count=4)
        moved = answer(wd.boundary_sensitivities, preset, angle=np.radians([55.0]), wrt=("liquid.viscosity",))
        out("boundary_sensitivities", preset, moved)
        grid = {"stokes": np.geomspace(0.01, 5.0, 12), "angle": np.linspace(0.0, 1.4, 7)}
        out("regime_map", preset, answer(wd.regime_map, preset, **grid), count=84)
    for number, model in enumerate(models(3 if QUICK else 8, TASK["seed"])):
        for name, scene, _, angle in scenes(out, number, model, 1):
            out("boundary", name, answer(wd.boundary, scene, angle=angle[:3]), count=3, about=scene.to_toml())
    out("atlas", "granulation", answer(wd.atlas, "granulation", span=np.radians([20.0, 65.0])))
    if not QUICK:
        rough = {"over": "particles.roughness", "span": ("0.1 um", "4 um")}
        out("atlas", "granulation, roughness", answer(wd.atlas, "granulation", **rough))
        out("atlas", "pendulum", answer(wd.atlas, "pendulum", span=np.radians([20.0, 65.0])))


QUICK_COMMANDS = """
--version
scenes
scenes granulation -o mine.toml
collide granulation
collide granulation --stokes 0.02 --angle 75 --plot flight.png
collide pendulum --stokes 1.5 --angle 45deg --json
collide mine.toml --speed 0.54m/s --angle 60deg --engine rosenbrock -o flight.txt
collide granulation --engine taylor --json --set bridge.law=willett
collide granulation --set liquid.viscosty=3
map granulation --stokes log:0.005:0.5:12 --angle 0:85:8 -o map.nc --plot map.png
boundary granulation --angle 40:60:3 --plot lines.png
boundary pendulum --angle 40:60:3 --json
boundary granulation --angle 55:55:1 --wrt all
sensitivity granulation
sensitivity granulation --of restitution,contact_time --plot tornado.png --uncertainty liquid.viscosity=5%
sensitivity pendulum --wrt liquid.viscosity,impact.angle --method adjoint --json
export granulation --to casadi --out exported
export pendulum --to latex --out exported
export granulation --to matlab
diff granulation granulation --set bridge.law=willett
reproduce factors --out paper
"""
COMMANDS = """
map pendulum --stokes 0.5:3:6 --angle 20:60:5 --vary liquid.viscosity=20Pa_s:40Pa_s:2 -o more.nc
boundary granulation --angle 30:60 --plot atlas.png
sensitivity granulation --wrt liquid.viscosity,impact.angle
diff library mine.py
generate mine.py --out mine
collide granulation --model mine
reproduce table1 --out paper
reproduce fig3 --out paper
generate --check
verify pendulum
"""


def commands(out: Out) -> None:
    """Every command: exit status, what it prints, and the files that it leaves."""
    every = _command(out, "--help").partition("Commands:\n")[2]
    for name in re.findall(r"^  (\w[\w-]*)", every, flags=re.M):
        _command(out, f"{name} --help")
    Path("mine.py").write_text(_command(out, "generate --template"))
    for line in (QUICK_COMMANDS + ("" if QUICK else COMMANDS)).split("\n"):
        if line:
            _command(out, line)


def _command(out: Out, line: str) -> str:
    before = set(Path().rglob("*"))
    words = [word.replace("_s", " s") if "Pa_s" in word else word for word in line.split()]
    done = subprocess.run([sys.executable, "-m", "wetdoublet.solvers", *words], capture_output=True, text=True)
    left = [path for path in set(Path().rglob("*")) - before if path.is_file() and "__pycache__" not in path.parts]
    found = {"exit": done.returncode, "stdout": _masked(done.stdout), "stderr": _masked(done.stderr)}
    out("command", line, found | {"files": {str(path): _content(path) for path in sorted(left)}})
    return done.stdout


def _content(path: Path) -> Any:
    if path.suffix == ".nc":
        return xarray.load_dataset(path, engine="h5netcdf", decode_cf=False)
    return _masked(path.read_text()) if path.suffix in TEXTS else hashlib.sha256(path.read_bytes()).hexdigest()


def _masked(text: str) -> str:
    for pattern, word in (*((re.escape(folder), "FOLDER") for folder in TASK["masked"]), *MASKS):
        text = re.sub(pattern, word, text)
    return text


if __name__ == "__main__":
    home = Path(wd.__file__).resolve().parent
    if home != Path(TASK["source"]).resolve() / "solvers":
        sys.exit(f"wetdoublet.solvers is imported from {home}, not from the tree {TASK['source']}")
    {each.__name__: each for each in (collisions, space, gradients, boundaries, commands)}[TASK["kind"]](
        Out(TASK["file"])
    )
