"""Interrupted maps: what is finished is kept on disk, and only what is missing is computed again."""

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import xarray as xr
from wetdoublet.solvers import Scene, many, regime_map
from wetdoublet.solvers.journal import Journal

from .command import run

# slow enough to be interrupted
LARGE = ["map", "granulation", "--stokes", "log:0.005:0.5:60", "--angle", "1:85:60", "--engine", "rosenbrock"]


def test_journal(tmp_path):
    """Finished blocks are found again by the same request, whole lines only, and never by another request."""
    path = tmp_path / "a.partial"
    block = many.empty(3, ("restitution",))
    block["outcome"][:] = [0, 2, -1]
    block["restitution"][:] = [0.0, 0.1 + 0.2, np.nan]
    block["reason"][2] = "no\nluck"
    ours, theirs = Journal(path, {"rtol": 1e-9}), Journal(path, {"rtol": 1e-8})
    ours.add(np.array([4, 5, 9]), block)
    theirs.add(np.array([1]), many.empty(1, ()))
    with path.open("ab") as file:  # torn by a crash
        file.write(path.read_bytes().splitlines()[1][:-9])
    ours.add(np.array([7]), many.empty(1, ("restitution",)))
    assert (ours.count(), ours.others(), theirs.others()) == (4, (1, 0), (4, 1))
    (where, back), (later, _) = ours.read()
    assert (where.tolist(), later.tolist()) == ([4, 5, 9], [7])
    for name, values in block.items():
        np.testing.assert_array_equal(back[name], values)
        assert back[name].dtype == values.dtype
    assert len(theirs.read()) == 1
    ours.remove()
    assert not ours.read()
    assert len(theirs.read()) == 1  # what another request has finished stays usable
    theirs.remove()
    assert not path.exists()


def test_another_request_never_uses_a_journal(tmp_path):
    """Scene, axes, tolerance, engine and quantities are all part of what a journal is kept under."""
    path = tmp_path / "a.partial"
    grid = {"stokes": [0.02, 0.1], "angle": 1.0}

    def done(scene="granulation", **changes):
        seen = []
        regime_map(scene, **{**grid, **changes}, journal=path, progress=lambda *counts: seen.append(counts))
        return seen[0][0]

    assert done() == 0
    assert done() == 2
    other = Scene.load("granulation").with_entries({"liquid.viscosity": 3.0})
    assert done(other) == 0
    for changes in ({"stokes": [0.02, 0.2]}, {"angle": 1.1}, {"rtol": 1e-8}, {"engine": "cvodes"}, {"of": ()}):
        assert done(**changes) == 0, changes
    assert done() == 2


def test_a_journal_of_another_request_stays(tmp_path):
    """A map written beside a journal with other collisions, or with anything else, leaves it and says so."""
    file, partial = tmp_path / "map.nc", tmp_path / "map.nc.partial"
    theirs = Journal(partial, {"rtol": 1e-8})
    theirs.add(np.array([1, 2]), many.empty(2, ()))
    with partial.open("ab") as other:
        other.write(b"\xff anything\n")
    before = partial.read_bytes().split()
    done = run("map", "granulation", "--stokes", "0.02:0.1:2", "--angle", "60:60:1", "-o", file)
    assert done.exit_code == 0
    assert "stays: it holds 2 finished collisions of another request and 1 lines" in done.stderr
    assert partial.read_bytes().split() == before
    assert file.exists()


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_an_interrupted_run_is_continued(tmp_path):
    """Ctrl-C exits 130 with a line that says how to go on; the second run computes what is missing and no more."""
    file, partial = tmp_path / "map.nc", tmp_path / "map.nc.partial"
    start = [sys.executable, "-m", "wetdoublet.solvers", *LARGE, "-o", str(file)]
    first = subprocess.Popen(
        start,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    deadline = time.monotonic() + 30
    while not partial.exists() and time.monotonic() < deadline:
        time.sleep(0.01)
    os.killpg(first.pid, signal.SIGINT)  # as a terminal does: to the workers too
    out, err = first.communicate(timeout=30)
    assert (first.returncode, out) == (130, "")
    kept = sum(len(json.loads(line.split(b" ", 2)[2])["where"]) for line in partial.read_bytes().split(b"\n") if line)
    assert 0 < kept < 3600
    assert err == f"interrupted: {kept} of 3600 collisions are kept in {partial}; the same command computes the rest\n"
    assert not file.exists()

    counting = (
        "import sys\n"
        "from importlib import import_module\n"
        "module = import_module('wetdoublet.solvers.regimes')\n"
        "real = module.compute\n"
        "def compute(request, which, finished):\n"
        "    def counted(where, block):\n"
        "        print(where.size)\n"
        "        finished(where, block)\n"
        "    real(request, which, counted)\n"
        "module.compute = compute\n"
        "from wetdoublet.solvers.cli import main\n"
        "main(sys.argv[1:])\n"
    )
    second = subprocess.run(
        [sys.executable, "-c", counting, *start[3:]], capture_output=True, text=True, check=False, timeout=60
    )
    assert second.returncode == 0, second.stderr
    assert sum(map(int, second.stdout.split())) == 3600 - kept
    assert not partial.exists()
    with xr.open_dataset(file) as back:
        assert int((back.outcome == -2).sum()) == 0
        expected = regime_map("granulation", stokes=back.stokes.values[::20], angle=back.angle.values[::20])
        np.testing.assert_array_equal(back.restitution.values[::20, ::20], expected.restitution.values)
