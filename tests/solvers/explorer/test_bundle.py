"""The page's parts that need neither a browser nor a compiler for WebAssembly."""

import base64
import gzip
import hashlib
import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from wetdoublet.solvers import InputError, Scene
from wetdoublet.solvers.explorer import module as modules
from wetdoublet.solvers.explorer.build import texts
from wetdoublet.solvers.explorer.knobs import knobs
from wetdoublet.solvers.explorer.module import BUILT as FOLDER
from wetdoublet.solvers.explorer.module import module
from wetdoublet.solvers.explorer.page_of_scene import explore
from wetdoublet.solvers.export.law.texts import LawSource, source
from wetdoublet.solvers.host.user_cache import folder

from ...helpers.flags import QUICK

ROOM = Path(__file__).parents[3] / "solvers" / "explorer"
BUILT = ("page.css", "page.js", "worker.js")


def test_the_bundle_is_that_of_its_sources():
    """The digest that the build writes is of the sources and of what they are built to."""
    digest = hashlib.sha256()
    sources = sorted(each for each in (ROOM / "page").iterdir() if each.suffix in (".ts", ".css", ".json", ".mjs"))
    for path in (*sources, *(ROOM / "built" / name for name in BUILT)):
        digest.update(f"{path.name}\0".encode() + path.read_bytes() + b"\0")
    assert (ROOM / "built" / "DIGEST").read_text().strip() == digest.hexdigest()


@pytest.mark.slow
@pytest.mark.skipif(not (ROOM / "page" / "node_modules").is_dir(), reason="needs `npm ci` in solvers/explorer/page")
def test_the_bundle_is_built_again_byte_for_byte(tmp_path: Path):
    """By esbuild of the version that package-lock.json has."""
    node = shutil.which("node")
    assert node is not None
    subprocess.run([node, "build.mjs", str(tmp_path)], cwd=ROOM / "page", check=True)
    for name in (*BUILT, "DIGEST"):
        assert (tmp_path / name).read_bytes() == (ROOM / "built" / name).read_bytes(), name


def embedded(page: str) -> dict[str, bytes]:
    """The modules of a page by their digests."""
    data = json.loads(page.partition('id="scene">')[2].partition("</script>")[0])
    return {digest: gzip.decompress(base64.b64decode(text)) for digest, text in data["modules"].items()}


@pytest.mark.slow
def test_a_law_that_does_not_come_with_the_package_is_compiled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Into a cache without modules, and without optimization; the page has it under the digest of its bytes."""
    scene = Scene.load("granulation-dry-bridge").with_entries({"partner.wall": True})
    source(scene)
    for kind in ("derived", "emitted"):
        for path in folder().glob(f"{kind}-*"):
            shutil.copy(path, tmp_path)
    monkeypatch.setenv("WETDOUBLET_CACHE", str(tmp_path))
    monkeypatch.setattr(modules, "FLAGS", (*QUICK.split(), *modules.FLAGS[1:]))
    try:
        page = explore(scene).html
    except InputError as error:
        pytest.skip(str(error))
    ((digest, content),) = embedded(page).items()
    assert hashlib.sha256(content).hexdigest() == digest
    (kept,) = tmp_path.glob("explorer-*.wasm")
    assert kept.read_bytes() == content


def without_compiler(monkeypatch: pytest.MonkeyPatch, empty: Path) -> None:
    """No program on the path, and no ziglang; the cache that tests share has no module."""
    monkeypatch.setenv("PATH", str(empty))
    monkeypatch.setitem(sys.modules, "ziglang", None)


def test_a_page_opens_without_a_compiler(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    """Its modules come with the package, as the files are named."""
    without_compiler(monkeypatch, tmp_path)
    page = explore("granulation").html
    assert {*embedded(page).values()} <= {gzip.decompress(path.read_bytes()) for path in FOLDER.glob("*.wasm.gz")}


@pytest.mark.slow
def test_the_modules_in_the_package_are_those_of_its_laws():
    """`python -m wetdoublet.solvers.explorer.build` writes what is missing and removes what is left over."""
    names = [path.name.split(".") for path in FOLDER.glob("*.wasm.gz")]
    assert {name for name, *_ in names} == {*texts()}
    for path in FOLDER.glob("*.wasm.gz"):
        assert path.name.split(".")[1] == hashlib.sha256(path.read_bytes()).hexdigest()[:32]


def test_a_damaged_module_is_not_used(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    """It is named, and the law compiled as one that does not come with the package."""
    without_compiler(monkeypatch, tmp_path)
    for path in FOLDER.glob("*.wasm.gz"):
        content = bytearray(path.read_bytes())
        content[len(content) // 2] ^= 1
        (tmp_path / path.name).write_bytes(content)
    for path in (ROOM / "built" / name for name in BUILT):
        shutil.copy(path, tmp_path)
    monkeypatch.setattr(modules, "BUILT", tmp_path)
    with pytest.raises(InputError, match=r"wetdoublet\[explorer\]"):
        assert explore("granulation-dry-bridge").html
    assert "is damaged" in capsys.readouterr().err


def test_without_a_compiler_the_extra_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    """One line that says what to install."""
    without_compiler(monkeypatch, tmp_path)
    with pytest.raises(InputError, match=r"wetdoublet\[explorer\]"):
        module(LawSource("", "int nothing;\n", (), ()))


def test_a_scene_without_an_impact_is_refused():
    """Before anything is compiled."""
    given = tuple(each for each in Scene.load("granulation").given if not each[0].startswith("impact."))
    with pytest.raises(InputError, match=r"impact\.stokes"):
        explore(Scene("", given))


@pytest.mark.slow
def test_a_liquid_by_its_name_has_a_knob_in_pascal_seconds():
    """Its text has a space and no unit."""
    pytest.importorskip("CoolProp")
    scene = Scene.load("granulation").with_entries({"liquid.viscosity": "glycerol 85 %, 25 degC"})
    law = source(scene)
    knob = next(each for each in knobs(scene, law.entries, law.impact) if each["name"] == "liquid.viscosity")
    assert knob["value"] * knob["factor"] == pytest.approx(scene.entries["liquid.viscosity"], rel=1e-15)


@pytest.mark.parametrize("name", ["lactose-pvp", "pendulum"])
def test_knobs_have_the_scenes_numbers_and_units(name: str):
    """What a knob sets is the scene's own number, within its slider; every number of the law but one has a knob."""
    scene = Scene.load(name)
    law = source(scene)
    entries = {each.name: each.value for each in law.entries}
    made = knobs(scene, law.entries, law.impact)
    for each in made:
        assert each["value"] is None or each["low"] <= each["value"] <= each["high"], each["name"]
        for member in each["members"]:
            si = each["never"] if each["value"] is None else each["value"] * each["factor"]
            assert si == pytest.approx(entries[member], rel=1e-15), member
    assert {*entries} - {member for each in made for member in each["members"]} <= {"liquid_density"}
    texts = {each["name"]: f"{each['value']:g} {each['unit']}" for each in made if each["value"] is not None}
    given = dict(scene.given)
    assert texts["liquid.viscosity"] == given["liquid.viscosity"]
    angle = next(each for each in made if each["name"] == "impact.angle")
    assert math.radians(angle["value"]) == pytest.approx(scene.angle, rel=1e-15)
