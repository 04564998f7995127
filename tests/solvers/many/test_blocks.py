"""Maps in blocks: what a killed client or worker leaves is finished, and only what is missing is computed."""

import os
import signal
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
from wetdoublet.solvers import ComputationError, Scene, regime_map
from wetdoublet.solvers.many.blocks import blocks

from ...helpers.command import run

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("optimized")]
pytest.importorskip("zarr")
distributed = pytest.importorskip("distributed")
dask = pytest.importorskip("dask")

GRID = {"stokes": np.geomspace(0.005, 0.5, 125), "angle": np.linspace(0, 1.5, 120)}


@pytest.fixture(scope="module")
def cluster():
    """A client of a scheduler and two worker processes on loopback, which are started again when they are killed."""
    settings = {"host": "127.0.0.1", "dashboard_address": "127.0.0.1:0", "memory_limit": 0, "silence_logs": 60}
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, **settings) as started,
        distributed.Client(started) as client,
    ):
        yield client


@pytest.fixture(scope="module")
def serial():
    """The map, computed by this process in memory."""
    return regime_map("granulation", **GRID)


def same(one, other):
    """Identical names, labels, attributes and bits."""
    xr.testing.assert_identical(one.load(), other.load())
    for name, variable in one.variables.items():
        assert variable.dtype.kind in "UOT" or variable.values.tobytes() == other[name].values.tobytes(), name


def test_a_stored_map_is_the_map(tmp_path, serial):
    """The store that a map is written to has the Dataset that is made in memory; a second one takes its place."""
    same(regime_map("granulation", **GRID, store=tmp_path / "map.zarr"), serial)
    small = {"relative_speed": [0.3, 0.5, 1.0], "angle": [0.0, 1.0], "vary": {"liquid.viscosity": [1.0, 2.0]}}
    assert run(
        "map", "granulation", "--relative-speed", "0.3:1 m/s:3", "--angle", "0:60:2", "-o", tmp_path / "map.zarr"
    ).exit_code == 0  # fmt: skip
    same(regime_map("granulation", **small, store=tmp_path / "map.zarr"), regime_map("granulation", **small))
    assert [path.name for path in tmp_path.iterdir()] == ["map.zarr"]


def interrupted_after(blocks):
    """A progress that interrupts when so many blocks are finished."""
    left = iter(range(blocks + 1))

    def progress(_done, _total):
        if next(left) == blocks:
            raise KeyboardInterrupt

    return progress


def test_a_damaged_unfinished_store(tmp_path, serial):
    """A block whose outcomes are damaged is computed again; without its description all is; no bit gets through."""
    draw, counts = np.random.default_rng(1), []
    for damaged in ("outcome/c/0/0", "zarr.json"):
        with pytest.raises(KeyboardInterrupt):
            regime_map("granulation", **GRID, store=tmp_path / "map.zarr", progress=interrupted_after(4))
        (file, *_) = next(tmp_path.glob("*.unfinished")).glob(damaged)
        content = bytearray(file.read_bytes())
        content[draw.integers(len(content)) if damaged != "zarr.json" else 0] ^= 1 << draw.integers(8)
        file.write_bytes(content)
        counts.append([])
        found = regime_map(
            "granulation", **GRID, store=tmp_path / "map.zarr", progress=lambda done, _: counts[-1].append(done)
        )
        same(found, serial)
    sizes = [np.prod([part.stop - part.start for part in at]) for at in blocks((120, 125), "taylor")]
    assert [each[0] for each in counts] == [sum(sizes[1:4]), 0]


KILLED = """
import os, signal, sys
import numpy as np
from wetdoublet.solvers import regime_map
from wetdoublet.solvers.many import blocks

plain, left = blocks._write, iter(range(4))

def killing(*block):
    plain(*block)
    if next(left) == 3:
        os.kill(os.getpid(), signal.SIGKILL)

blocks._write = killing
axes = {"stokes": np.geomspace(0.005, 0.5, 125), "angle": np.linspace(0, 1.5, 120)}
regime_map("granulation", **axes, store="map.zarr")
"""


@pytest.mark.skipif(os.name != "posix", reason="signals are sent as on POSIX")
def test_a_killed_client_loses_nothing_that_was_written(tmp_path, serial):
    """Killed outright behind its fourth block: the second call computes the others and no more, to the same bits."""
    done = subprocess.run([sys.executable, "-c", KILLED], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == -signal.SIGKILL, done.stderr
    (place,) = tmp_path.iterdir()
    assert place.name.startswith("map.zarr.")
    seen, sizes = [], [np.prod([part.stop - part.start for part in at]) for at in blocks((120, 125), "taylor")]
    found = regime_map("granulation", **GRID, store=tmp_path / "map.zarr", progress=lambda done, _: seen.append(done))
    assert seen == [sum(sizes[: 4 + k]) for k in range(len(sizes) - 3)]
    same(found, serial)


# ---- in memory


def test_an_interrupted_map_in_memory_is_continued(tmp_path):
    """What an interrupt finds finished is read by the same call, which computes the rest and removes it."""
    grid = {"stokes": np.geomspace(0.005, 0.5, 8), "angle": np.linspace(0, 1.5, 8), "engine": "rosenbrock"}
    seen = []

    def until_something_is_done(done, total):
        seen.append((done, total))
        if done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match=r"interrupted: \d+ of 64 collisions are kept in .*partial; the same"):
        regime_map("granulation", **grid, resume=tmp_path / "map.nc", progress=until_something_is_done)
    kept = seen[-1][0]
    assert 0 < kept < 64
    (file,) = tmp_path.iterdir()
    seen.clear()
    whole = regime_map("granulation", **grid, resume=tmp_path / "map.nc", progress=lambda *counts: seen.append(counts))
    assert (seen[0], seen[-1]) == ((kept, 64), (64, 64))
    xr.testing.assert_identical(whole, regime_map("granulation", **grid))
    assert not file.exists()


def test_another_request_never_uses_what_is_kept(tmp_path):
    """Scene, axes, tolerance, engine and quantities are part of what it is kept under; a damaged file is nothing."""
    grid = {"stokes": np.geomspace(0.02, 0.1, 60), "angle": 1.0}

    def begins(scene="granulation", **changes):
        seen = []

        def stop(done, _total):
            seen.append(done)
            if len(seen) > 1 or done:
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            regime_map(scene, **{**grid, **changes}, resume=tmp_path / "map.nc", progress=stop)
        return seen[0]

    assert (begins(), begins()) == (0, 60)
    other = Scene.load("granulation").with_entries({"liquid.viscosity": 3.0})
    assert begins(other) == 0
    for changes in ({"stokes": [0.02, 0.2]}, {"angle": 1.1}, {"rtol": 1e-8}, {"engine": "cvodes"}, {"of": ()}):
        assert begins(**changes) == 0, changes
    assert begins() == 60
    for file in tmp_path.iterdir():
        os.truncate(file, 200)
    assert begins() == 0


# ---- interrupts and clusters


@pytest.mark.slow
def test_a_lost_worker_is_survived(tmp_path, serial, cluster):
    """One of two workers is killed in mid-run: the same bits, in a store and in memory."""
    victims = list(cluster.run(os.getpid).values())

    def kill(done, _total):
        if done and victims:
            os.kill(victims.pop(), signal.SIGKILL)
            victims.clear()

    same(regime_map("granulation", **GRID, client=cluster, store=tmp_path / "map.zarr", progress=kill), serial)
    assert not victims
    same(regime_map("granulation", **GRID, client=cluster), serial)


def test_workers_of_two_arithmetics_are_refused(serial, cluster):
    """Other compiler flags on one worker would be other last digits: an error names both. All alike compute."""

    def flags(value):
        import os

        os.environ["WETDOUBLET_CFLAGS"] = value

    cluster.wait_for_workers(2)
    one, other = cluster.run(os.getpid)
    usual = os.environ.get("WETDOUBLET_CFLAGS", "")
    try:
        cluster.run(flags, f"{usual} -DALIKE", workers=[one])
        with pytest.raises(ComputationError, match="workers differ: .* its WETDOUBLET_CFLAGS is "):
            regime_map("granulation", **GRID, client=cluster)
        cluster.run(flags, f"{usual} -DALIKE", workers=[other])
        same(regime_map("granulation", **GRID, client=cluster), serial)
    finally:
        cluster.run(flags, usual)
