"""Files of a table: NetCDF by xarray, and the header in C."""

from __future__ import annotations

import io
import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..host import files
from ..host.outputs import check_file
from ..many.regime_map import netcdf, scene_of
from .data import Attack, Data, Law, Range
from .series import Trees

if TYPE_CHECKING:
    import xarray

SUFFIXES = (".nc", ".h")
_FORMAT = "wetdoublet table 2"
_SEAL = b"\nwetdoublet crc32 "  # after what HDF5 reads: the checksum of all before it
_OWN = {
    "slices": ("slice_end",), "first_panel": ("slice_end",), "cuts": ("panel", "end"), "maps": ("panel",),
    "first_edge": ("panel_end",), "edges": ("edge",), "outcome": ("cell",), "criterion": ("cell",),
    "cell_map": ("cell",), "root": ("cell",), "of_stick": ("result",),
}  # fmt: skip
_TREES = {
    "axis": ("node",), "cut": ("node",), "child": ("node",), "box": ("patch", "of_box"), "size": ("patch", "variable"),
    "start": ("patch",), "coefficients": ("coefficient",),
}  # fmt: skip
_MEANING = {
    "slices": "ends of the slices of the third variable (its logarithm if logarithmic)",
    "first_panel": "first angle panel of each slice",
    "cuts": "nodes of the lower and upper angle of each panel",
    "maps": "map of the angle in each panel: low + 3 high; 0 linear, 1 square root, 2 logarithm",
    "first_edge": "first boundary of each panel among edges; cell k of panel p is number first_edge + p + k",
    "edges": "nodes of the boundaries, ln St as a function of t and x",
    "outcome": "outcome of each cell: 0 stick, 1 stick-rotate-separate, 2 bounce",
    "criterion": "first rebound criterion of a bounce: 0 glass, 1 elastic, 2 rough, -1 none",
    "cell_map": "map of the height of each cell",
    "root": "node of the results of each cell, -1 for a stick",
    "of_stick": "results of a stick",
    "axis": "coordinate that a node divides: 0 x, 1 z, -1 none",
    "cut": "where a node divides",
    "child": "first child of a node, or its patch",
    "box": "x, z, 1/dx, 1/dz of each patch",
    "size": "number of Chebyshev coefficients in t, x and z of each patch",
    "start": "first coefficient of each patch",
    "coefficients": "Chebyshev coefficients, by result, t, x and z",
}


def dataset(table: Law) -> xarray.Dataset:
    """The Dataset of a table."""
    import xarray as xr

    variables: dict[str, Any] = {
        name: (dims, getattr(table.data, name), {"long_name": _MEANING[name]}) for name, dims in _OWN.items()
    }
    for prefix, trees in (("shape", table.data.shapes), ("result", table.data.results)):
        for name, dims in _TREES.items():
            dims_in_file = tuple(one if one in ("of_box", "variable") else f"{prefix}_{one}" for one in dims)
            variables[f"{prefix}_{name}"] = dims_in_file, getattr(trees, name), {"long_name": _MEANING[name]}
    return xr.Dataset(variables, attrs=_attributes(table))


def _attributes(table: Law) -> dict[str, Any]:
    from importlib.metadata import version

    third, angle, stokes = table.found.at
    attributes = {
        "Conventions": "CF-1.11",
        "title": f"Law of a collision law: {table.scene.name or 'unnamed scene'}",
        "source": f"wetdoublet {version('wetdoublet')}",
        "format": _FORMAT,
        "scene": table.scene.to_toml(),
        "results": " ".join(table.of),
        "stokes": np.array(table.range.stokes),
        "angle": np.array(table.range.angle),
        "third": table.range.third or "",
        "third_range": np.array(table.range.ends),
        "rtol": table.rtol,
        "error": table.error,
        "error_meaning": "largest error of a result, over its magnitude where that is above 1",
        "attack": "random and boundary-hugging queries; each answer is a collision's at most 1e-6 (relative) beside it",
        "attack_queries": table.found.queries,
        "attack_direct": table.found.direct,
        "largest_error_found": table.found.largest,
        "largest_error_at": np.array([third, angle, stokes]),
    }
    return attributes | ({} if table.scene.package is None else {"model": table.scene.package.text})


def save(table: Law, path: str | Path) -> None:
    """Write a table; the format by the suffix."""
    file = check_file(path, "path", SUFFIXES)
    if file.suffix.lower() == ".h":
        from .c_file import header

        files.write(file, header(table))
        return
    files.write(file, sealed(bytes(netcdf(dataset(table)))))


def sealed(content: bytes) -> bytes:
    """Content with its checksum behind it."""
    return content + _SEAL + f"{zlib.crc32(content):08x}".encode()


def _content(path: str | Path) -> bytes:
    """What HDF5 may read of a file; InputError unless it is as it was written."""
    accepted = "a NetCDF file that `wetdoublet table` has written"
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        problem = "does not exist" if isinstance(error, FileNotFoundError) else f"cannot be read ({error.strerror})"
        raise InputError("path", str(path), accepted, problem) from None
    whole = content[: -len(_SEAL) - 8]
    if content == sealed(whole):
        return whole
    if _SEAL.strip() in content[-len(_SEAL) - 8 :] or _FORMAT.encode() in content:
        raise InputError("path", str(path), accepted, "is damaged or cut short: make the table anew")
    if _FORMAT[:-1].encode() in content:
        raise InputError("path", str(path), accepted, "is of an older version: make the table anew")
    raise InputError("path", str(path), accepted, "is no table")


def load(path: str | Path) -> Law:
    """Read a table from NetCDF."""
    import xarray as xr

    with xr.open_dataset(io.BytesIO(_content(path)), engine="h5netcdf") as opened:
        content = opened.load()
    attributes = content.attrs
    of = tuple(str(attributes["results"]).split())

    def ends(name: str) -> tuple[float, float]:
        low, high = (float(one) for one in attributes[name])
        return low, high

    ranges = Range(str(attributes["third"]) or None, ends("third_range"), ends("angle"), ends("stokes"))
    third, angle, stokes = (float(one) for one in attributes["largest_error_at"])
    attack = Attack(int(attributes["attack_queries"]), float(attributes["largest_error_found"]), (third, angle, stokes),
                    int(attributes["attack_direct"]))  # fmt: skip
    trees = [
        Trees(**{name: content[f"{prefix}_{name}"].values for name in _TREES}, count=count)
        for prefix, count in (("shape", 1), ("result", len(of)))
    ]
    data = Data(*ranges.corners, ranges.logarithmic, *(content[name].values for name in _OWN), *trees)
    return Law(scene_of(content), of, ranges, float(attributes["error"]), attack, float(attributes["rtol"]), data)
