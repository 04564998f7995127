"""Interrupted maps: what is finished is kept on disk, and only what is missing is computed again."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from wetdoublet.solvers import InputError, Scene, regime_map
from wetdoublet.solvers.many.journal import Journal, beside
from wetdoublet.solvers.many.results import empty

from ...helpers.command import finished, run


def test_journal(tmp_path):
    """Finished blocks are found again by the same request, whole lines only, and never by another request."""
    path = tmp_path / "a.partial"
    block = empty(3, ("restitution",))
    block["outcome"][:] = [0, 2, -1]
    block["restitution"][:] = [0.0, 0.1 + 0.2, np.nan]
    block["reason"][2] = "no\nluck"
    ours, theirs = Journal(path, {"rtol": 1e-9}), Journal(path, {"rtol": 1e-8})
    ours.add(np.array([4, 5, 9]), block)
    theirs.add(np.array([1]), empty(1, ()))
    with path.open("ab") as file:  # torn by a crash
        file.write(path.read_bytes().splitlines()[1][:-9])
    ours.add(np.array([7]), empty(1, ("restitution",)))
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
    theirs.add(np.array([1, 2]), empty(2, ()))
    with partial.open("ab") as other:
        other.write(b"\xff anything\n")
    before = partial.read_bytes().split()
    done = run("map", "granulation", "--stokes", "0.02:0.1:2", "--angle", "60:60:1", "-o", file)
    assert done.exit_code == 0
    assert "stays: it holds 2 finished collisions of another request and 1 lines" in done.stderr
    assert partial.read_bytes().split() == before
    assert file.exists()


@pytest.mark.slow
def test_an_interrupted_run_is_continued(tmp_path):
    """What is finished is kept when a run is interrupted; the next computes what is missing and no more."""
    path = tmp_path / "a.partial"
    grid = {"stokes": np.geomspace(0.005, 0.5, 8), "angle": np.linspace(0, 1.5, 10), "engine": "rosenbrock"}
    seen = []

    def until_something_is_done(done, total):
        seen.append((done, total))
        if done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        regime_map("granulation", **grid, journal=path, progress=until_something_is_done)
    kept = sum(where.size for where in finished(path))
    assert seen == [(0, 80), (kept, 80)]
    assert 0 < kept < 80

    seen.clear()
    whole = regime_map("granulation", **grid, journal=path, progress=lambda *counts: seen.append(counts))
    assert (seen[0], seen[-1]) == ((kept, 80), (80, 80))
    everything = np.concatenate(finished(path))
    assert np.sort(everything).tolist() == list(range(80))  # nothing twice
    xr.testing.assert_identical(whole, regime_map("granulation", **grid))


def test_a_journal_is_one_run_s_at_a_time(tmp_path):
    """A run that is given a journal that another one has is refused, and says which argument; afterwards it is free."""
    path = tmp_path / "a.partial"

    def meanwhile(done, _total):
        if not done:
            with pytest.raises(InputError, match="^journal: .* is being written by another run"):
                regime_map("granulation", stokes=0.1, angle=1.0, journal=path)

    regime_map("granulation", stokes=[0.1, 0.2], angle=1.0, journal=path, progress=meanwhile)
    regime_map("granulation", stokes=0.1, angle=1.0, journal=path)


def test_a_folder_in_place_of_a_journal_is_refused_by_the_option(tmp_path, monkeypatch):
    """The message names the option that the journal's file follows from, and the folder."""
    monkeypatch.chdir(tmp_path)  # a long path is shortened in messages
    journal = beside(Path("map.nc"))
    journal.path.mkdir()
    with pytest.raises(InputError, match=r"^-o: .*map\.nc\.partial"), journal.locked("-o"):
        pass


@pytest.mark.parametrize("name", ["no/such/a.partial", "", "a\0b", "."])
def test_a_journal_that_cannot_be_is_bad_input(tmp_path, name, monkeypatch):
    """It is refused before anything is computed, by the argument's name."""
    monkeypatch.chdir(tmp_path)
    seen = []
    with pytest.raises(InputError, match="^journal: "):
        regime_map("granulation", stokes=0.1, angle=1.0, journal=name, progress=lambda *counts: seen.append(counts))
    assert not seen
    assert not list(tmp_path.iterdir())
