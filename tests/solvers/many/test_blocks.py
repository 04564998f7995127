"""Maps in blocks: what a killed client or worker leaves is finished, and only what is missing is computed."""

import os
import signal
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
from wetdoublet.solvers import ComputationError, InputError, Scene, regime_map
from wetdoublet.solvers.many.blocks import blocks

from ...helpers.command import run

pytestmark = pytest.mark.slow
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


INTERRUPTED = """
import asyncio, os, signal, threading
import zarr
from wetdoublet.solvers.commands.cli import main

plain = zarr.storage.LocalStore.set

async def slow(self, key, value, *more, **options):
    if "/c/" in key:
        threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT)).start()
        zarr.storage.LocalStore.set = plain
        await asyncio.sleep(0.2)
    await plain(self, key, value, *more, **options)

zarr.storage.LocalStore.set = slow
main(["map", "granulation", "--stokes", "0.01:0.3:3", "--angle", "0:80:2", "-o", "map.zarr"])
"""


@pytest.mark.skipif(os.name != "posix", reason="signals are sent as on POSIX")
def test_an_interrupt_while_zarr_writes(tmp_path):
    """One line and status 130; Zarr's tasks write no traceback."""
    command = (sys.executable, "-c", INTERRUPTED)
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (130, "interrupted\n")


LOCAL = """
import signal, socket
from contextlib import suppress
from wetdoublet.solvers.many.blocks import connected

usual = socket.socket()
with suppress(OSError):  # whoever has it
    usual.bind(("127.0.0.1", 8787))
    usual.listen()
with connected("local:1") as client:
    client.wait_for_workers(1)
    (blocked,) = client.run(lambda: signal.pthread_sigmask(signal.SIG_BLOCK, ())).values()
print(signal.SIGINT in blocked)
"""


def test_local_workers_are_undisturbed():
    """As many as asked for; interrupts are blocked while they start; whoever has Dask's usual port is no matter."""
    done = subprocess.run([sys.executable, "-W", "error::UserWarning", "-c", LOCAL], capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("True\n", "")


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


def test_an_unreachable_scheduler_is_bad_input(tmp_path):
    """One line names the option and what is accepted; nothing is left behind."""
    (tmp_path / "else.zarr").mkdir()
    (tmp_path / "else.json").write_text("{}")
    with dask.config.set({"distributed.comm.timeouts.connect": "0.2s"}):
        for option, value, problem, accepted in (
            ("--scheduler", "tcp://127.0.0.1:9", "is not reachable (", "tcp://HOST:PORT of a running Dask scheduler"),
            ("--scheduler", "nowhere", "is no address of a scheduler", "local, or local:WORKERS"),
            ("--scheduler", str(tmp_path / "no.json"), "is a file that does not exist", "local, or local:WORKERS"),
            ("--scheduler", str(tmp_path / "else.json"), "is not the file of a scheduler", "local, or local:WORKERS"),
            (
                "-o",
                str(tmp_path / "else.zarr"),
                "exists and is no map of wetdoublet: it is not overwritten",
                "a name ending in .zarr",
            ),
        ):
            output = () if option == "-o" else ("-o", tmp_path / "map.zarr")
            done = run("map", "granulation", "--stokes", "0.02:0.1:2", "--angle", "60", option, value, *output)
            line, nothing = done.stderr.split("\n")
            assert (done.exit_code, nothing) == (2, "")
            assert line.startswith(f"{option}: ")
            assert problem in line
            assert accepted in line.partition("accepted: ")[2]
    with pytest.raises(InputError, match="^client: "):
        regime_map("granulation", client=3)
    assert {path.name for path in tmp_path.iterdir()} == {"else.json", "else.zarr"}


SCRIPT = """
from wetdoublet.solvers import regime_map
regime_map("granulation", angle=[1.0], engine="rosenbrock", client="local:1")
"""


def test_local_workers_of_an_unguarded_script(tmp_path):
    """The error says what the script needs; Dask's processes would run the script again."""
    (tmp_path / "script.py").write_text(SCRIPT)
    done = subprocess.run((sys.executable, tmp_path / "script.py"), capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert 'start them below `if __name__ == "__main__":`' in done.stderr.splitlines()[-1]


def test_a_closed_client_is_bad_input(cluster):
    """A client that was closed is named."""
    with distributed.Client(cluster.scheduler.address) as closed:
        pass
    with pytest.raises(InputError, match="^client: .* is closed; accepted: a client that is open"):
        regime_map("granulation", client=closed)
