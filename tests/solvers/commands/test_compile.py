"""`wetdoublet compile`: kernels before they are needed."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from wetdoublet.solvers.host.compiler import compiler

from ...helpers.command import quiet
from ...helpers.flags import QUICK

LATER = """
from wetdoublet.solvers import collide, collide_many, compile_kernels, regime_map
scene, impacts = "granulation-dry-bridge", {"speed": [0.4, 0.5], "angle": [0.0, 1.0]}
print(*{each.already for each in compile_kernels(scene)})
print(collide(scene).engine, collide(scene, trajectory=True).engine, collide(scene, ledger=False, angle=0).engine)
print(collide_many(scene, **impacts).engine, regime_map(scene, **impacts).engine)
"""


@pytest.mark.skipif(compiler() is None, reason="no C compiler")
@pytest.mark.slow
def test_what_is_compiled_answers(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """All kernels of a scene are compiled; a later process takes them for one collision, a batch and a map."""
    monkeypatch.setenv("WETDOUBLET_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("WETDOUBLET_CFLAGS", QUICK)
    command = (sys.executable, "-m", "wetdoublet.solvers", "compile", "granulation-dry-bridge", "--json")
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, quiet(done.stderr)) == (0, "")
    said = json.loads(done.stdout)
    assert {use for each in said["kernels"] for use in each["serves"]} >= {"collide", "collide_many", "map", "boundary"}
    assert all(each["seconds"] > 0 and each["bytes"] > 1000 and not each["already"] for each in said["kernels"])
    assert len([*(tmp_path / "cache").glob("taylor-*.so")]) == len(said["kernels"])
    later = subprocess.run((sys.executable, "-c", LATER), capture_output=True, text=True, check=False)
    assert (later.returncode, quiet(later.stderr)) == (0, "")
    assert later.stdout.splitlines() == ["True", "taylor taylor taylor", "taylor taylor"]


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
