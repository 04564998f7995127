"""Averages as files of other codes: what is written is what was computed, in forms that those codes read."""

import re
from typing import Any

import numpy as np
import pytest
import xarray as xr
from wetdoublet.solvers import InputError, Scene, collision_averages
from wetdoublet.solvers.averages.hosts import to_openfoam, to_pysdm

RADII = [60e-6, 110e-6, 200e-6]


@pytest.fixture(scope="module")
def averages() -> xr.Dataset:
    """Of pairs of three sizes."""
    return collision_averages("granulation", speeds="maxwell:0.5 m/s", radii=RADII, tolerance=1e-3)


def test_openfoam_reads_the_tables(averages: xr.Dataset) -> None:
    """Lists of lists of numbers, in the order of the radii; of one pair the rate as constantCoalescence takes it."""
    text = to_openfoam(averages)
    stick, rate = averages.stick_probability.values, averages.collision_rate.values
    for name, expected in (("radii", np.array(RADII)), ("rate", rate), ("coalescence", rate * stick)):
        [found] = re.findall(rf"^{name} +\(+(.*?)\)+;", text, re.MULTILINE)
        rows = [row.split() for row in found.split(") (")]
        assert np.array_equal(np.array(rows, float).reshape(expected.shape), expected)
    one = to_openfoam(averages.isel(radius=[1], partner_radius=[1]))
    [constant] = re.findall(r"constantCoalescence\s*\{\s*rate (\S+);", one)
    assert float(constant) == rate[1, 1] * stick[1, 1]


class Storage:
    """As PySDM's pairwise storage: an array, filled from neighbours that are a pair."""

    def __init__(self, values: np.ndarray) -> None:
        self.values = values

    @classmethod
    def empty(cls, shape: int, dtype: type) -> "Storage":
        return cls(np.full(shape, np.nan, dtype))

    @classmethod
    def from_ndarray(cls, values: np.ndarray) -> "Storage":
        return cls(values)

    def to_ndarray(self) -> np.ndarray:
        return self.values

    def max(self, other: np.ndarray, is_first: np.ndarray) -> None:
        self.values = np.where(is_first[::2], np.maximum(other[::2], other[1::2]), 0.0)

    def min(self, other: np.ndarray, is_first: np.ndarray) -> None:
        self.values = np.where(is_first[::2], np.minimum(other[::2], other[1::2]), 0.0)

    def fill(self, other: "Storage") -> None:
        self.values = other.values


class Builder:
    """As PySDM's: two pairs, and two super-droplets that are none."""

    PairwiseStorage = Storage
    n_sd = 6

    def __init__(self, radius: np.ndarray) -> None:
        self.particulator, self.attributes = self, {"radius": radius}

    def request_attribute(self, name: str) -> None:
        assert name == "radius"


def test_pysdm_has_the_table(averages: xr.Dataset) -> None:
    """At its radii and, linear in their logarithms, between; whichever is the first; outside it says so."""
    module: dict[str, Any] = {}
    exec(to_pysdm(averages), module)
    radius = np.array([200e-6, 60e-6, 60e-6, np.sqrt(60e-6 * 110e-6), 1.0, 1.0])
    first = np.array([True, False, True, False, False, False])
    for name, of in (("stick_probability", "CoalescenceEfficiency"), ("collision_rate", "CollisionRate")):
        table, made, output = averages[name].values, module[of](), Storage.empty(3, float)
        made.register(Builder(radius))
        made(output, first)
        assert output.values == pytest.approx([table[2, 0], (table[0, 0] + table[1, 0]) / 2, 0.0], rel=1e-12)
        made.register(Builder(3 * radius))
        with pytest.raises(ValueError, match="radii from 6e-05 to 0.0002 m are known"):
            made(output, first)


def test_what_has_no_table_is_refused(averages: xr.Dataset) -> None:
    """A wall, a single radius, a pair that failed, and spheres of different materials."""
    wall = Scene.load("granulation").with_entries({"partner.wall": True})
    with pytest.raises(InputError, match="radii"):
        to_openfoam(collision_averages(wall, speeds=1.0, radii=[1e-4], tolerance=1e-2))
    with pytest.raises(InputError, match="two or more"):
        to_pysdm(averages.isel(radius=[0], partner_radius=[0]))
    failed = averages.copy(deep=True)
    failed.stick_probability[0, 1], failed.reason[0, 1] = np.nan, "too small"
    with pytest.raises(InputError, match="has one with none"):
        to_openfoam(failed)
    other = averages.copy(deep=True)
    other.stick_probability[0, 1] += 0.1
    with pytest.raises(InputError, match="depend on which is the first"):
        to_pysdm(other)
