"""Every result draws itself and, where it is tabular, is a Dataset."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import xarray as xr
from wetdoublet.solvers import (
    InputError,
    band,
    boundary,
    boundary_sensitivities,
    collide_many,
    gradients_many,
    plot,
    regime_map,
    sensitivities,
)
from wetdoublet.solvers.verify import Finding, Report

IMPACT: dict[str, Any] = {"stokes": 0.05, "angle": "75 deg"}
WRT = ("liquid.viscosity", "impact.speed")
SOME = {"stokes": [0.02, 0.05, 0.2], "angle": 1.2}
BAND: dict[str, Any] = {"uncertainty": {"liquid.viscosity": "5 %"}, "over": "impact.stokes", "values": [0.05, 0.2]}

DRAWN: dict[str, Callable[[], Any]] = {
    "boundaries": lambda: boundary("granulation", angle=[0.5], stokes=(0.05, 0.2)),
    "boundary sensitivities": lambda: boundary_sensitivities("granulation", angle=0.5, stokes=(0.05, 0.2), wrt=WRT[0]),
    "sensitivities": lambda: sensitivities("granulation", wrt=WRT, **IMPACT),
    "many": lambda: collide_many("granulation", **SOME).wetdoublet,
    "map": lambda: regime_map("granulation", stokes=[0.02, 0.05, 0.2], angle=[0.5, 1.0]).wetdoublet,
    "gradients": lambda: gradients_many("granulation", wrt=WRT, **SOME).wetdoublet,
    "band": lambda: band("granulation", **BAND, samples=4).wetdoublet,
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", DRAWN)
def test_results_draw_themselves(kind: str, tmp_path: Path) -> None:
    """`.plot(path)` writes the picture and returns the figure; a file of another kind is refused."""
    result = DRAWN[kind]()
    figure = result.plot(tmp_path / "p.png")
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")
    assert any(axes.has_data() for axes in figure.axes)
    with pytest.raises(InputError, match=r"^path: .*unsupported suffix"):
        result.plot(tmp_path / "p.txt")


def test_a_map_read_from_a_file_is_drawn(tmp_path: Path) -> None:
    """`plot` takes Datasets that were written and read; one that is not of this package is refused."""
    collide_many("granulation", **SOME).to_netcdf(tmp_path / "many.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "many.nc") as back:
        assert plot(back).axes[0].has_data()
    for strange in (xr.Dataset({"x": 1.0}), 3):
        with pytest.raises(InputError, match="^data: "):
            plot(strange)


@pytest.mark.slow
def test_tables() -> None:
    """A Dataset says what the result says."""
    found = sensitivities("granulation", ["restitution", "rotation"], WRT, **IMPACT)
    gradient = found.to_dataset().gradient.sel(quantity="rotation", parameter="impact.speed")
    assert float(gradient) == found.gradient["rotation"]["impact.speed"]

    moved = boundary_sensitivities("granulation", angle=[0.5, 1.0], wrt=WRT[0])
    changes = [one for line in moved.changes for one in line]
    slopes = [one.gradient["stokes"][WRT[0]] for one in changes]
    assert moved.to_dataset().stokes_gradient.sel(parameter=WRT[0]).values.tolist() == slopes
    kinds = moved.boundaries.to_dataset().kind.values.ravel()
    assert [kind for kind in kinds if kind] == [one.change.kind for one in changes]


FINDINGS = (Finding("g", "a", "it holds", "1e-9", "1e-8", True), Finding("g", "b", "told", "2", "", None))


def test_a_verification_is_a_table() -> None:
    """One row a finding; a note is neither true nor false."""
    report = Report(FINDINGS)
    assert report.to_dataset().ok.values.tolist() == [1, -1]
    assert json.loads(json.dumps(report.to_dict()))["findings"][0]["bound"] == "1e-8"
