"""Averages as files of codes with population balances: an OpenFOAM dictionary, a Python module for PySDM."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError

if TYPE_CHECKING:
    import xarray

_FOAM = """\
FoamFile
{{
    version     2.0;
    format      ascii;
    class       dictionary;
    object      wetCoalescence;
}}

// {title}; {speeds}. {source}.
// rate: collisions per time and number densities, m^3/s; coalescence: the part of them that stick, times rate.
radii       ({radii}); // m
rate        ({rate});
efficiency  ({efficiency});
coalescence ({coalescence});
"""
_PYSDM = '''\
"""Collisions of wet particles for PySDM: {title}; {speeds}. {source}.

    Coalescence(collision_kernel=CollisionRate(), coalescence_efficiency=CoalescenceEfficiency())
"""

import numpy as np

RADII = np.array([{radii}])  # m
EFFICIENCY = np.array([{efficiency}])  # part of the collisions that stick
RATE = np.array([{rate}])  # m^3/s, collisions per time and number densities


def interpolated(table, *radii):
    """A table at pairs of radii (m), linear in their logarithms; ValueError outside of it."""
    near = RADII[[0, -1]] * [1 - 1e-9, 1 + 1e-9]
    outside = [each[(each < near[0]) | (each > near[1])] for each in radii]
    if any(each.size for each in outside):
        raise ValueError(f"radii from {{RADII[0]}} to {{RADII[-1]}} m are known, not {{np.concatenate(outside)[0]}} m")
    (i, u), (j, v) = (_place(np.log(each)) for each in radii)
    low, high = (table[i + k, j] * (1 - v) + table[i + k, j + 1] * v for k in (0, 1))
    return low * (1 - u) + high * u


def _place(at):
    log = np.log(RADII)
    k = np.clip(np.searchsorted(log, at) - 1, 0, RADII.size - 2)
    return k, (at - log[k]) / (log[k + 1] - log[k])


class _OfRadii:
    def __init__(self, table):
        self.table, self.particulator, self.larger, self.smaller = table, None, None, None

    def register(self, builder):
        self.particulator = builder.particulator
        builder.request_attribute("radius")
        storage, pairs = self.particulator.PairwiseStorage, self.particulator.n_sd // 2
        self.larger, self.smaller = (storage.empty(pairs, dtype=float) for _ in range(2))

    def __call__(self, output, is_first_in_pair):
        radius = self.particulator.attributes["radius"]
        self.larger.max(radius, is_first_in_pair)
        self.smaller.min(radius, is_first_in_pair)
        large, small = self.larger.to_ndarray(), self.smaller.to_ndarray()
        paired, values = small > 0, np.zeros(large.size)
        values[paired] = interpolated(self.table, large[paired], small[paired])
        output.fill(self.particulator.PairwiseStorage.from_ndarray(values))


class CoalescenceEfficiency(_OfRadii):
    def __init__(self):
        super().__init__(EFFICIENCY)


class CollisionRate(_OfRadii):
    def __init__(self):
        super().__init__(RATE)
'''


def to_openfoam(data: xarray.Dataset) -> str:
    """The collision rate and the coalescence efficiency of pairs of radii as a dictionary of OpenFOAM.

    A single pair has in addition an entry `coalescenceModels` that OpenFOAM takes as it is.

    Raises:
        InputError: beside a wall, or a pair that failed.
    """
    radii, rate, efficiency = _tables(data, "averages as a dictionary")
    rows = {"rate": rate, "efficiency": efficiency, "coalescence": rate * efficiency}
    written = {name: " ".join(f"({_numbers(row)})" for row in table) for name, table in rows.items()}
    text = _FOAM.format(**_about(data), radii=_numbers(radii), **written)
    if radii.size > 1:
        return text
    one = float(rows["coalescence"][0, 0])
    return f"{text}\ncoalescenceModels\n(\n    constantCoalescence\n    {{\n        rate {one!r};\n    }}\n);\n"


def to_pysdm(data: xarray.Dataset) -> str:
    """A Python module with a coalescence efficiency and a collision kernel of PySDM, between the radii of the table.

    Raises:
        InputError: beside a wall, fewer than two radii, a pair that failed, or spheres of different materials.
    """
    radii, rate, efficiency = _tables(data, "averages for PySDM")
    error = 2 * data["stick_probability_error"].values.max(initial=1e-12)
    if radii.size < 2 or np.any(np.diff(radii) <= 0):
        raise InputError("radii", radii, "two or more that ascend", "has none between them")
    if np.abs(efficiency - efficiency.T).max() > error:
        raise InputError("radii", radii, "spheres of one material", "has pairs that depend on which is the first")
    rows = {"rate": rate, "efficiency": efficiency}
    written = {name: ", ".join(f"[{_numbers(row, ', ')}]" for row in table) for name, table in rows.items()}
    return _PYSDM.format(**_about(data), radii=_numbers(radii, ", "), **written)


def _tables(data: xarray.Dataset, what: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Radii, collision rate and efficiency of all pairs."""
    if "partner_radius" not in data.dims:
        raise InputError("radii", None, "radii of pairs of spheres", f"is needed for {what}")
    efficiency = data["stick_probability"].values
    if np.isnan(efficiency).any():
        failed = next(str(reason) for reason in data["reason"].values.ravel() if reason)
        raise InputError(
            "radii", data["radius"].values, "radii whose pairs all have averages", f"has one with none: {failed}"
        )
    return data["radius"].values, data["collision_rate"].values, efficiency


def _about(data: xarray.Dataset) -> dict[str, str]:
    """Title, speeds and source, on one line each and without what would end a comment or a docstring."""
    return {
        name: " ".join(str(data.attrs[name]).replace('"', "'").replace("\\", "/").split())
        for name in ("title", "speeds", "source")
    }


def _numbers(values: np.ndarray, between: str = " ") -> str:
    return between.join(repr(float(value)) for value in values)
