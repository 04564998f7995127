"""Requests in chunks: Zarr stores that continue, and a real Dask cluster, one of whose workers is killed."""

import os
import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
from wetdoublet.solvers import ComputationError, InputError, collide_many, regime_map
from wetdoublet.solvers.many.stream import chunks

from ...helpers.command import run

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


@pytest.mark.parametrize("shape", [(1,), (100_003,), (300, 7), (5, 4000, 3, 2), (10_000, 10_000)])
@pytest.mark.parametrize("engine", ["taylor", "rosenbrock"])
def test_chunks_cover_a_request_once(shape, engine):
    """Every collision is in one chunk, and no chunk is larger than the kernel takes in one call."""
    cut = chunks(shape, engine)
    extents = [[part.stop - part.start for part in at] for at in cut]
    assert sum(map(np.prod, extents)) == np.prod(shape)
    assert max(map(np.prod, extents)) <= 65536
    if np.prod(shape) < 1e6:
        count = np.zeros(shape, int)
        for at in cut:
            count[at] += 1
        assert (count == 1).all()


def test_a_stored_map_is_the_map(tmp_path, serial):
    """The store that a map is written to has the Dataset that is made in memory; a second one takes its place."""
    same(regime_map("granulation", **GRID, store=tmp_path / "map.zarr"), serial)
    small = {"relative_speed": [0.3, 0.5, 1.0], "angle": [0.0, 1.0], "vary": {"liquid.viscosity": [1.0, 2.0]}}
    assert run(
        "map", "granulation", "--relative-speed", "0.3:1 m/s:3", "--angle", "0:60:2", "-o", tmp_path / "map.zarr"
    ).exit_code == 0  # fmt: skip
    same(regime_map("granulation", **small, store=tmp_path / "map.zarr"), regime_map("granulation", **small))
    assert [path.name for path in tmp_path.iterdir()] == ["map.zarr"]


def test_stored_collisions_are_the_collisions(tmp_path, cluster):
    """Arrays of any shape, labels, times and varying laws are stored as they are returned."""
    angle = xr.DataArray([0.0, 0.9, 1.2, 1.4], dims="row", coords={"lot": ("row", ["a", "b", "c", "d"])})
    day = np.array(["2020-01-01", "2020-02-01"], "M8[ns]")
    stokes = xr.DataArray([0.02, 0.2], dims="day", coords={"day": day})
    requests = (
        {"stokes": stokes, "angle": angle, "of": ["reversal", "validity", "capillary"]},
        {"stokes": 0.02, "angle": [1.3, 1.2], "vary": {"bridge.law": ["mikami", "willett"]}},
        {"stokes": np.full((2, 3), 0.02), "angle": 1.3, "vary": {"liquid.viscosity": [1.0, 1e-30, 2.0]}},
    )
    for request in requests:
        expected = collide_many("granulation", **request)
        same(collide_many("granulation", **request, store=tmp_path / "many.zarr"), expected)
        same(collide_many("granulation", **request, client=cluster), expected)


def test_an_interrupted_store_is_continued(tmp_path, serial):
    """Finished chunks are kept, the store has no name before it is complete, and the next run computes the rest."""
    path, seen = tmp_path / "map.zarr", []

    def until_some_are_done(done, total):
        seen.append(done)
        if len(seen) == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        regime_map("granulation", **GRID, store=path, progress=until_some_are_done)
    assert not path.exists()
    again = []
    found = regime_map("granulation", **GRID, store=path, progress=lambda done, _total: again.append(done))
    assert again[0] == seen[-1] > 0
    assert len(seen) + len(again) == len(chunks((120, 125), "taylor")) + 2
    same(found, serial)
    assert [each.name for each in tmp_path.iterdir()] == ["map.zarr"]


@pytest.mark.parametrize("damage", ["zarr.json", "outcome/zarr.json", "outcome"])
def test_a_damaged_unfinished_store_is_named(tmp_path, damage):
    """What is not as it was written is not continued; the error says which folder it is, and what to do."""

    def interrupt(done, _total):
        if done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        regime_map("granulation", **GRID, store=tmp_path / "map.zarr", progress=interrupt)
    (place,) = tmp_path.glob("*.unfinished")
    if damage == "outcome":
        shutil.rmtree(place / damage)
    else:
        os.truncate(place / damage, 20)
    with pytest.raises(ComputationError, match=r"unfinished is damaged \(.*remove it and compute again"):
        regime_map("granulation", **GRID, store=tmp_path / "map.zarr")


def test_flipped_bits_in_an_unfinished_store(tmp_path, serial):
    """A damaged chunk is computed again; a damaged description is named; no bit gets into the result."""
    stop = iter([False] * 4)

    def interrupt(_done, _total):
        if next(stop, True):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        regime_map("granulation", **GRID, store=tmp_path / "map.zarr", progress=interrupt)
    (place,) = tmp_path.glob("*.unfinished")
    draw = np.random.default_rng(1)
    files = sorted(file for file in place.rglob("*") if file.is_file())
    flipped = []
    for file in draw.choice(files, 12, replace=False):
        content = bytearray(file.read_bytes())
        kept, at = bytes(content), draw.integers(len(content))
        content[at] ^= 1 << draw.integers(8)
        file.write_bytes(content)
        if file.name in ("zarr.json", "token"):
            with pytest.raises(ComputationError, match="is damaged"):
                regime_map("granulation", **GRID, store=tmp_path / "map.zarr", progress=lambda *_: None)
            file.write_bytes(kept)
        else:
            flipped.append(file)
    assert flipped
    same(regime_map("granulation", **GRID, store=tmp_path / "map.zarr"), serial)


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
from wetdoublet.solvers.many.cluster import connected

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


def test_a_worker_of_another_arithmetic_is_refused(serial, cluster):
    """Other compiler flags on one worker: the other computes all. On both, each its own: an error says so."""

    def flags(value):
        import os

        os.environ["WETDOUBLET_CFLAGS"] = value

    cluster.wait_for_workers(2)
    one, other = cluster.run(os.getpid)
    try:
        cluster.run(flags, "-DONE", workers=[one])
        same(regime_map("granulation", **GRID, client=cluster), serial)
        cluster.run(flags, "-DOTHER", workers=[other])
        with pytest.raises(ComputationError, match="workers differ: .* its WETDOUBLET_CFLAGS is -DO.*, not -DO"):
            regime_map("granulation", **GRID, client=cluster)
    finally:
        cluster.run(flags, os.environ["WETDOUBLET_CFLAGS"])


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
                "exists and is no map or batch of wetdoublet: it is not overwritten",
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
        collide_many("granulation", client=3)
    assert {path.name for path in tmp_path.iterdir()} == {"else.json", "else.zarr"}


SCRIPT = """
from wetdoublet.solvers import collide_many
collide_many("granulation", angle=[1.0], engine="rosenbrock", client="local:1")
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
        collide_many("granulation", client=closed)
