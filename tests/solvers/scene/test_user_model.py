"""A user's model beside a scene: a small file through every command, and names that mean something to an engine."""

import json
import math
import pickle
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from wetdoublet.derive.checks.user import model_checks
from wetdoublet.derive.user.names import EMITTED, taken
from wetdoublet.derive.user.template import TEMPLATE
from wetdoublet.derive.vocabulary.quantities import VOCABULARY
from wetdoublet.solvers import (
    InputError,
    Scene,
    boundary,
    collide,
    collide_many,
    critical,
    equations,
    fit,
    regime_map,
    sensitivities,
    solve,
)
from wetdoublet.solvers.host.compiler import compiler
from wetdoublet.solvers.many.regime_map import scene_of
from wetdoublet.solvers.sensitivity.materials import materials_of
from wetdoublet.solvers.verify.conserved import conserved
from wetdoublet.solvers.verify.identities import of_the_model
from wetdoublet.solvers.verify.sample import Extent, collisions

from ...helpers.command import run

pytestmark = pytest.mark.slow


def with_model(mine: Path, **entries: str) -> Scene:
    """Granulation with the model."""
    scene = Scene.load("granulation", model=mine)
    return scene.with_entries({name.replace("__", "."): value for name, value in entries.items()})


def test_the_law_runs_through_the_commands(mine: Path, tmp_path: Path):
    """collide, map, boundary, sensitivity and scenes take the model from the command line."""
    one = run("collide", "granulation", "--model", str(mine), "--set", "custom.yield_stress=2 kPa", "--json")
    assert json.loads(one.output)["outcome"] == "stick"  # the library's trajectory escapes here
    file = tmp_path / "m.nc"
    grid = ("--stokes", "0.03:0.06:2", "--angle", "60:60:1", "--vary", "custom.yield_stress=0 Pa:2 kPa:2")
    done = run("map", "granulation", "--model", str(mine), *grid, "-o", str(file), "--plot", str(tmp_path / "m.png"))
    assert done.exception is None, done.exception
    assert file.is_file()
    line = run("boundary", "granulation", "--model", str(mine), "--angle", "45:45:1", "--stokes", "0.03:0.08", "--json")
    # an independent prototype's
    assert json.loads(line.output)["changes"][0][0]["centrifugal"] == pytest.approx(4.121, abs=2e-3)
    own = ("--model", str(mine), "--set", "custom.yield_stress=20 Pa", "--stokes", "0.06")
    slope = run("sensitivity", "granulation", *own, "--wrt", "custom.yield_stress", "--json")
    assert json.loads(slope.output)["gradient"]["restitution"]["custom.yield_stress"] < 0
    shown = run("scenes", "granulation", "--model", str(mine))
    assert 'yield_stress = "0 Pa"' in shown.output
    assert 'law = "yielding"' in shown.output


def test_verify_has_the_models_own_checks(mine: Path):
    """`verify` proves the model's law and holds its collisions to every bound (the sample is cut short)."""
    scene = with_model(mine, custom__yield_stress="50 Pa")
    assert scene.package is not None
    assert {(finding.group, finding.ok) for finding in of_the_model(scene.package)} == {("Model: mine", True)}
    collided = collisions(scene, (0.0, 1.0), Extent(factors=(1.0,)))
    found = {finding.name: finding for finding in conserved(collided)}
    assert found["energy ledger"].ok
    assert all(finding.ok is not False for finding in found.values())


def test_many_and_workers_have_the_model(mine: Path):
    """A batch sees the declared quantity vary: a yield stress adds to the bridge, until the doublet sticks."""
    scene = with_model(mine, custom__yield_stress="3 Pa")
    stress = np.array([0.0, 50.0, 100.0, 2000.0])
    many = collide_many(scene, stokes=0.03, angle=np.pi / 3, vary={"custom.yield_stress": stress})
    assert set(many.reason.values) == {""}
    assert many.attrs["model"] == (mine / "manifest.json").read_text()
    assert many["custom.yield_stress"].attrs["units"] == "Pa"
    found = many.restitution.values.tolist()
    assert found == sorted(found, reverse=True) and found[0] > found[1] > found[-1] == 0
    assert pickle.loads(pickle.dumps(scene)) == scene
    assert scene != Scene.load("granulation").with_entries({"bridge.law": "constant"})
    assert Scene.from_toml(scene.to_toml(), package=scene.package) == scene


def test_a_map_is_drawn_without_the_models_folder(mine: Path, tmp_path: Path):
    """What a map keeps of the model describes its scene, and holds no code."""
    data = regime_map(with_model(mine, custom__yield_stress="7 Pa"), stokes=[0.01], angle=[0.1], of=["restitution"])
    scene = scene_of(data)
    assert scene.entries["custom.yield_stress"] == 7.0
    assert scene.package is not None
    with pytest.raises(InputError, match="only described here"):
        scene.package.text_of("scaling.py")


@pytest.mark.parametrize("asked", ["from factors import FACTOR", "import math, factors\nFACTOR = factors.FACTOR"])
def test_a_model_file_that_imports_others_follows_them(asked: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """A module of its own that changes, though the file does not, changes the force."""
    path = tmp_path / "mine.py"
    path.write_text(f"from wetdoublet.derive.user import *\n{asked}\nlaw('bridge', 'mine', force=FACTOR*pi*a*sigma)\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    texts = []
    for factor in (2, 3):
        (tmp_path / "factors.py").write_text(f"FACTOR = {factor}\n")
        monkeypatch.delitem(sys.modules, "factors", raising=False)
        package = Scene.load("granulation", model=path).package
        texts.append(package.text_of(package.law_file("bridge", "mine")))
    assert texts[0] != texts[1]


def test_what_has_no_default_must_be_given(tmp_path: Path):
    """A quantity without a default is named where nothing gives it; of two laws one is chosen by name."""
    file = tmp_path / "two.py"
    file.write_text(
        'from wetdoublet.derive.user import *\nk = quantity("strength")\n'
        'law("bridge", "one", force=k*2*cos(phi))\nlaw("bridge", "two", force=2*cos(phi) + 0*k)\n'
    )
    scene = Scene.load("granulation", model=file)
    with pytest.raises(InputError, match=r"custom.strength: missing; accepted: a number \(strength\) > 0, such as 1"):
        collide_many(scene, stokes=[0.03])
    one, two = (scene.with_entries({"custom.strength": 1, "bridge.law": law}) for law in ("one", "two"))
    library = Scene.load("granulation").with_entries({"bridge.law": "constant"})
    found = [collide(each, stokes=0.1, engine="rosenbrock", ledger=False).restitution for each in (one, two, library)]
    assert found == pytest.approx([found[2]] * 3, rel=1e-12)


def test_what_is_looked_for_needs_no_value(tmp_path: Path):
    """`solve` and `fit` find a quantity that nothing gives: the library's surface tension, a layer from its gap."""
    file = tmp_path / "layered.py"
    file.write_text(
        'from wetdoublet.derive.user import *\ntension = quantity("tension", unit="N/m")\n'
        'layer = quantity("layer", unit="m", bounds=">= 0")\nlaw("bridge", "mine", force=2*pi*R*tension*cos(phi))\n'
        'criterion("soft", gap=layer)\n'
    )
    scene = Scene.load("granulation", model=file)
    library = Scene.load("granulation").with_entries({"bridge.law": "constant"})
    sigma = library.bridge.surface_tension
    impacts = {"speed": np.linspace(0.5, 3, 8), "angle": np.full(8, 0.9)}
    seen = collide_many(library, **impacts)
    expected = collide(library, stokes=0.1, angle="60 deg").restitution
    bare = scene.with_entries({"custom.layer": "0 m"})
    within = ("0.01 N/m", "0.1 N/m")
    found = solve(bare, restitution=expected, free="custom.tension", within=within, stokes=0.1, angle="60 deg")
    assert found == pytest.approx([sigma], rel=1e-7)
    rows = {**impacts, "restitution": seen.restitution.values, "restitution_sd": np.full(8, 0.01)}
    estimate = fit(bare, rows, "custom.tension").estimates["custom.tension"]
    assert estimate.low < sigma < estimate.high < 2 * estimate.low
    for free, says in (("custom.tension,custom.layer", "is one text"), (5, "custom.tension: missing")):
        with pytest.raises(InputError, match=says):
            fit(bare, rows, free)
    firm = scene.with_entries({"custom.tension": sigma, "liquid.glass_transition_pressure": "2 GPa"})
    found = solve(firm, smallest_gap="3 um", free="custom.layer", within=("1 um", "5 um"), stokes=1.0, angle=0.9)
    assert found == pytest.approx([3e-6], rel=1e-6)
    with pytest.raises(InputError, match=r"custom.layer: missing"):
        solve(scene, restitution=0.5, free="custom.tension", within=(0.01, 0.1), stokes=0.1, angle=0.9)


def test_custom_needs_its_model(mine: Path, tmp_path: Path):
    """A scene file with [custom] is an error without the model, and says what to give."""
    file = tmp_path / "scene.toml"
    file.write_text(with_model(mine).to_toml().replace('law = "yielding"', 'law = "mikami"'))
    with pytest.raises(InputError, match=r"custom.yield_stress: .* no model is given; accepted: .*--model DIR"):
        Scene.load(file)
    assert Scene.load(file, model=mine).bridge.law == "yielding"


def test_a_scene_file_is_judged_with_the_laws_of_its_model(tmp_path: Path):
    """The library's law that the model's takes the place of need not have the rupture distance that is asked for."""
    model, file = tmp_path / "short.py", tmp_path / "scene.toml"
    model.write_text(
        "from wetdoublet.derive.user import *\n"
        "law('bridge', 'short', force=2*cos(phi)*(1 - h/sqrt(h**2 + 2*V/pi)), rupture_distance=V**Rational(1, 2))\n"
    )
    text = Scene.load("granulation").to_toml().replace('law = "mikami"', 'law = "lambert"\nrupture = "own"')
    file.write_text(text)
    scene = Scene.load(file, model=model)
    assert scene.bridge.law == "short"
    assert scene.rupture_gap == pytest.approx(math.sqrt(0.1) * 1e-4, rel=1e-12)
    [material] = materials_of({name: [value] for name, value in Scene.from_toml(text.replace("own", "common")).given}
                              | {"bridge.rupture": ["own"]}, model=model)  # fmt: skip
    assert material.scene == scene.with_entries({"name": ""})
    file.write_text(text.replace("lambert", "lambart"))
    with pytest.raises(InputError, match=r'bridge.law: "lambart" is not known'):
        Scene.load(file, model=model)


def test_the_template_runs(tmp_path: Path):
    """`generate --template` prints a model that passes a check of each kind, is emitted and collides as it is."""
    file = tmp_path / "template.py"
    file.write_text(run("generate", "--template").output)
    assert run("generate", str(file), "--out", str(tmp_path / "out")).exit_code == 0
    done = run("collide", "granulation", "--model", str(tmp_path / "out"), "--json")
    assert json.loads(done.output)["outcome"] == "stick-rotate-separate"
    checks = model_checks(Path("mine.py"), TEMPLATE)[1]
    assert {check.name.partition(":")[0] for check in checks} == {"dimensions", "groups", "limits", "limit", "emission"}
    assert all(check.ok for check in checks)


def test_a_default_of_another_dimension_is_no_example(tmp_path: Path):
    """A pressure as the default of a viscosity is refused, and what is accepted is the viscosity's unit."""
    file, declared = tmp_path / "mine.py", 'k = quantity("k", unit="Pa s", default="1 Pa", meaning="a lag")\n'
    law = 'law("film", "mine", resistance=6*pi*k*a**2*u/x)\n'
    file.write_text(f"from wetdoublet.derive.user import *\n{declared}{law}")
    refused = run("generate", file, "--out", tmp_path / "mine")
    said = '"1 Pa" is a pressure, not a viscosity; accepted: the lag > 0 with its unit, which is Pa s'
    assert (refused.exit_code, refused.stderr.rstrip().endswith(said)) == (2, True)


WORDS = sorted(word for word in taken() if word.islower() and word not in VOCABULARY and "_" not in word)[::8]
SHORT = ["c", "of", "s", "v", "vec", "y"]  # arguments of the functions in C
ALL = '''"""Parts and quantities that bear every word that means something."""
from wetdoublet.derive.user import *

parts = [let(word, h * (k + 1)) for k, word in enumerate({words})]
own = [quantity(word, unit="m", default="1 um") for word in {names}]
law("bridge", "all", force=2*cos(phi)*exp(-sum(parts)/1e6 - sum(own)/R/1e3))
'''


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs a C compiler")
def test_every_word_compiles(tmp_path: Path):
    """Kernel and exported law of a model that bears all words; the kernel agrees with CVODES, which has no C."""
    path = tmp_path / "words.py"
    names = [word for word in SHORT if taken()[word] == EMITTED]
    path.write_text(ALL.format(words=sorted({*WORDS, *SHORT, "gap_over_radius"} - {*names}), names=names))
    scene = Scene.load("granulation", model=path).with_impact(stokes=0.06, angle=math.radians(60))
    found = collide(scene, engine="taylor", ledger=False)
    assert found.engine == "taylor"
    assert found.restitution == pytest.approx(collide(scene, engine="cvodes", ledger=False).restitution, rel=1e-7)
    done = run("export", "granulation", "--model", str(path), "--to", "c", "--out", str(tmp_path / "law"))
    assert done.exception is None, done.exception
    for language in ("c", "c++"):
        command = ["gcc", "-fsyntax-only", "-x", language, str(tmp_path / "law" / "granulation.c")]
        assert subprocess.run(command, capture_output=True, text=True, check=False).stderr == ""


PULLED = """from wetdoublet.derive.user import *
pull = quantity("pull", unit="N", meaning="pull")
law("bridge", "pulling", force=pull * exp(-x / R))
"""
MEASURED = {"speed [m/s]": [0.1, 0.3], "angle [deg]": [60, 60], "restitution": [0.1, 0.3]}
CALLS = {
    "collide": collide,
    "collide_many": lambda scene: collide_many(scene, stokes=0.1, angle=1.0),
    "regime_map": lambda scene: regime_map(scene, stokes=[0.1], angle=[1.0]),
    "sensitivities": lambda scene: sensitivities(scene, of=["restitution"]),
    "boundary": lambda scene: boundary(scene, angle=[1.0]),
    "critical": critical,
    "solve": lambda scene: solve(scene, free="impact.stokes", within=(0.01, 0.1), restitution=0.1),
    "fit": lambda scene: fit(scene, MEASURED, free=["liquid.viscosity"]),
    "equations": equations,
}


@pytest.mark.parametrize("call", CALLS)
def test_a_missing_quantity_of_a_model_is_demanded_by_a_call(call: str, tmp_path: Path):
    """Not by the loading, from a preset or a Scene."""
    (tmp_path / "pull.py").write_text(PULLED)
    for source in ("granulation", Scene.load("granulation")):
        scene = Scene.load(source, model=tmp_path / "pull.py")
        with pytest.raises(InputError, match="custom.pull: missing"):
            CALLS[call](scene)


@pytest.mark.skipif(compiler() is None, reason="no C compiler")
def test_a_missing_quantity_of_a_model_may_vary(tmp_path: Path):
    """The same collisions as of scenes that have it, from Python and from the command line."""
    (tmp_path / "pull.py").write_text(PULLED)
    scene = Scene.load("granulation", model=tmp_path / "pull.py")
    found = collide_many(scene, stokes=0.1, angle=1.0, vary={"custom.pull": ["1 uN", "2 uN"]})
    for pull, restitution in zip(("1 uN", "2 uN"), found.restitution.values, strict=True):
        one = collide(scene.with_entries({"custom.pull": pull}), stokes=0.1, angle=1.0, ledger=False)
        assert one.restitution == pytest.approx(restitution, rel=1e-9)
    ranges = ["--stokes", "0.1:0.2:2", "--angle", "1 rad", "--vary", "custom.pull=1:2 uN:2"]
    drawn = run("map", "granulation", "--model", tmp_path / "pull.py", *ranges, "--json")
    variables = json.loads(drawn.stdout)["data_vars"]
    np.testing.assert_allclose(np.ravel(variables["restitution"]["data"])[:2], found.restitution, rtol=1e-9)


def test_a_law_of_a_slot_without_a_table_names_the_slot(tmp_path: Path):
    """A model with a law of attraction on a scene without one is refused, with the table that is missing."""
    model = tmp_path / "near.py"
    model.write_text("from wetdoublet.derive.user import *\nlaw('attraction', 'near', force=A_H * R / (12 * x**2))\n")
    with pytest.raises(InputError, match=r"has a law in the slot attraction; accepted: a scene with a \[attraction\]"):
        Scene.load("granulation", model=model)
