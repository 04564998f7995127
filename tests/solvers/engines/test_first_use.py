"""The first use of a scene: its kernel is compiled and waited for, so that what is compiled never decides an answer."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from wetdoublet.solvers import collide
from wetdoublet.solvers.host.compiler import compiler

pytestmark = [pytest.mark.skipif(compiler() is None or os.name != "posix", reason="no C compiler"), pytest.mark.slow]
HEAD_ON = ("collide", "granulation", "--stokes", "0.3", "--angle", "0", "--rtol", "1e-8", "--json")


def first(folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """A process that collides granulation head-on, with a cache in a folder."""
    env = os.environ | {"WETDOUBLET_CACHE": str(folder / "cache")} | environment
    return subprocess.run(
        (sys.executable, "-m", "wetdoublet.solvers", *HEAD_ON), capture_output=True, text=True, check=False, env=env
    )


def script(folder: Path, text: str) -> str:
    """A compiler that is a shell script."""
    path = folder / "some-cc"
    path.write_text(text)
    path.chmod(0o700)
    return str(path)


def test_the_cache_does_not_decide(tmp_path: Path) -> None:
    """With an empty cache, a filled one and one that cannot be written the kernel answers, with the same digits."""
    (tmp_path / "file").write_text("")
    runs = [first(tmp_path), first(tmp_path), first(tmp_path / "file")]
    assert [done.returncode for done in runs] == [0, 0, 0]
    assert [done.stderr.count("\n") for done in runs] == [0, 0, 1]
    assert "kept in" in runs[2].stderr
    assert runs[0].stdout == runs[1].stdout == runs[2].stdout
    found = json.loads(runs[0].stdout)
    assert found["engine"] == "taylor"
    reference = collide("granulation", stokes=0.3, angle=0, rtol=1e-8, engine="cvodes")
    assert found["restitution"] == pytest.approx(reference.restitution, rel=1e-7)
