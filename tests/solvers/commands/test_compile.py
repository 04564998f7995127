"""`wetdoublet compile`: kernels before they are needed."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from wetdoublet.solvers.host.compiler import compiler


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
