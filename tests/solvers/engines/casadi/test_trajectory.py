"""The Dataset of a trajectory."""

from importlib.metadata import version

import pytest
import xarray
from wetdoublet.solvers import ComputationError, Scene, collide
from wetdoublet.solvers.engines.casadi import trajectory
from wetdoublet.solvers.engines.casadi.integrators import IntegrationFailed


def test_attributes_of_a_file_suffice_to_repeat_the_collision(tmp_path):
    """A NetCDF file carries scene, outcome, engine, tolerance and version: enough to compute it again."""
    first = collide("granulation", stokes=0.14, angle="40 deg", rtol=1e-8, engine="rosenbrock", trajectory=True)
    first.trajectory.to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as read:
        attrs = read.attrs
    assert attrs["outcome"] == "bounce" and attrs["version"] == version("wetdoublet")
    again = collide(Scene.from_toml(attrs["scene"]), rtol=attrs["rtol"], engine=attrs["engine"])
    assert again.to_dict() == first.to_dict()


def test_a_trajectory_that_fails_is_an_answer(monkeypatch):
    """An integrator that gives up on the way is an error that names phase, time, state and what to try, in SI."""

    def fails(*_):
        raise IntegrationFailed("Evaluation failed")

    monkeypatch.setattr(trajectory, "plain", lambda *_: fails)
    with pytest.raises(
        ComputationError, match=r"rosenbrock gave up .* in phase closing .*gap = 8e-06.*--engine"
    ) as found:
        collide("granulation", engine="rosenbrock", trajectory=True)
    assert found.value.time == 0.0
