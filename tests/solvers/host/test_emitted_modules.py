"""Emitted modules: verified before they run, refused if tampered with or stale, derived once and kept."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from wetdoublet.solvers import InputError, Scene, collide
from wetdoublet.solvers.errors import CheckFailed
from wetdoublet.solvers.host import emitted

from ...helpers.command import run
from ...helpers.yielding import LAW


def copied(mine: Path, tmp_path: Path) -> Path:
    """A copy of the model file and its package that a test may spoil."""
    import shutil

    shutil.copy(mine.with_suffix(".py"), tmp_path / "mine.py")
    return Path(shutil.copytree(mine, tmp_path / "mine"))


@pytest.mark.parametrize("name", ["laws/bridge_yielding.py", "scaling.py"])
def test_tampered_code_is_not_run(mine: Path, tmp_path: Path, name: str):
    """A file that is not what was emitted is refused before any of it runs, with what to run instead."""
    folder = copied(mine, tmp_path)
    (folder / name).write_text(f"raise SystemExit('run')\n{(folder / name).read_text()}")
    with pytest.raises(
        InputError, match=f"{name}: is not what was emitted; .*run `wetdoublet generate .*mine.py --out"
    ):
        Scene.load("granulation", model=folder)


def test_stale_models_are_refused(mine: Path, tmp_path: Path):
    """A model whose file has changed since, or that another library's equations made, says what to run."""
    folder = copied(mine, tmp_path)
    (tmp_path / "mine.py").write_text(LAW + "\n# changed\n")
    with pytest.raises(InputError, match="is stale: .*mine.py has changed since"):
        Scene.load("granulation", model=folder)
    (tmp_path / "mine.py").unlink()  # the package lives without it
    assert Scene.load("granulation", model=folder).bridge.law == "yielding"
    manifest = json.loads((folder / "manifest.json").read_text())
    (folder / "manifest.json").write_text(json.dumps(manifest | {"library": "0" * 64}))
    with pytest.raises(InputError, match="other equations of the library"):
        Scene.load("granulation", model=folder)


@pytest.mark.slow
def test_generate_check_and_clean_up(mine: Path, tmp_path: Path):
    """--check names what differs; emitting again mends it, removes what is no longer emitted, and leaves the rest."""
    folder = copied(mine, tmp_path)
    arguments = ("generate", str(tmp_path / "mine.py"), "--out", str(folder))
    assert run(*arguments, "--check").exit_code == 0
    (folder / "oblique_bridge.py").write_text("")
    (folder / "notes.txt").write_text("mine")
    done = run(*arguments, "--check")
    assert done.exit_code == 1
    assert "differs: oblique_bridge.py" in done.output
    (tmp_path / "mine.py").write_text('from wetdoublet.derive.user import *\nlaw("bridge", "one", force=1 + 0*h)\n')
    assert run(*arguments).exit_code == 0
    assert {path.name for path in folder.rglob("*.*")} == {"bridge_one.py", "manifest.json", "model.py", "notes.txt"}


def test_generate_says_what_a_law_with_kinks_changes(tmp_path: Path):
    """Against the library: the law's guard and side are equations of it, read back as they are emitted."""
    body = 'law("bridge", "bent", force=pi*R*sigma*(2 + Min(x/x0, 1)))'
    (tmp_path / "mine.py").write_text(f"from wetdoublet.derive.user import *\n{body}\n")
    done = run("generate", str(tmp_path / "mine.py"), "--out", str(tmp_path / "bent"))
    assert done.exit_code == 0, done.output
    assert "\nbridge: kink_2\n  added    aspect - 2*gap_over_radius\n" in done.output


def test_generate_says_what_has_changed(mine: Path, tmp_path: Path):
    """The terms that differ from the model as it was, and what is written; where nothing has changed, that."""
    folder = copied(mine, tmp_path)
    arguments = ("generate", str(tmp_path / "mine.py"), "--out", str(folder))
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*.*")}
    assert run(*arguments).output.startswith("nothing has changed: the 10 files in ")
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*.*")} == before
    later = LAW.replace("-0.34 * K", "-0.35 * K")
    surface = 'law("arm", "surface", lever=2*a, accept=("angular momentum",))\n'
    surface += 'event("lost", guard=2 - u/v0, ends="stick")\n'
    (tmp_path / "mine.py").write_text(later + surface)
    done = run(*arguments).output
    assert f"Against {folder}/, 4 equations differ:\n" in done
    assert "bridge yielding: rise\n  changed  contact_angle**2*(-0.34*logarithm - 0.96)\n      to" in done
    assert "arm: lever\n  changed  distance/2\n      to   2\n" in done
    assert "events, lost\n  added    2 - normal_velocity\n" in done
    assert "group      as before\nevent      added    lost: watched always; cut off: a stick\n" in done
    assert "conserved  removed  angular momentum L" in done and f"written  {folder / 'laws/arm_surface.py'}\n" in done
    later = later.replace('default="0 Pa"', 'default="12 Pa"')
    (tmp_path / "mine.py").write_text("import numpy\n" + later)  # may read anything
    done = run(*arguments).output
    assert "\nlaw        removed  arm surface\nquantity   removed  yield_stress [Pa] >= 0, default 0 Pa\n" in done
    assert "\nquantity   added    yield_stress [Pa] >= 0, default 12 Pa\nterm       as before\ngroup      as" in done
    assert not run(*arguments).output.startswith("nothing")


_COLLIDE = """
import sys
from wetdoublet.solvers import Scene, collide
one = collide(Scene.load("granulation", model=sys.argv[1]), engine="rosenbrock", ledger=False)
print(repr(one.restitution), "sympy" in sys.modules)
"""


@pytest.mark.slow
def test_a_model_file_is_derived_once(mine: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """A model file in place of a folder is derived on first use; another process then computes without sympy."""
    monkeypatch.setenv("WETDOUBLET_CACHE", str(tmp_path))
    file = mine.with_suffix(".py")
    first = collide(Scene.load("granulation", model=file), engine="rosenbrock", ledger=False)
    command = [sys.executable, "-c", _COLLIDE, str(file)]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=900)
    assert done.stdout.split() == [repr(first.restitution), "False"]


def test_what_is_not_committed_is_derived_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """A structure that is not among the committed ones is derived to the same bytes, and the second time read."""
    monkeypatch.setenv("WETDOUBLET_CACHE", str(tmp_path))
    monkeypatch.setattr(emitted, "committed", lambda path: False)
    expected = (Path(emitted.__file__).parents[2] / "generated" / "head_on.py").read_text()
    assert emitted.text("head_on") == expected
    monkeypatch.setattr("wetdoublet.derive.emit.first_use.structure_text", lambda name: pytest.fail("derived twice"))
    assert emitted.text("head_on") == expected
    assert emitted.executed("head_on", expected.encode()).STATES == ("gap", "normal_velocity")


def test_a_missing_table_of_laws_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """No scene is read without it: the file is named, and the remedy."""
    text = Scene.load("granulation").to_toml()
    emitted._verified.cache_clear()
    monkeypatch.setattr(emitted, "_FOLDER", tmp_path)
    with pytest.raises(CheckFailed, match=r"laws\.json is not what was emitted .* run `wetdoublet generate`"):
        Scene.from_toml(text)
    emitted._verified.cache_clear()
