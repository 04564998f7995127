"""Results of a batch as columns that are filled block by block, and as a labelled Dataset."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..formatting.labelled import Column, labelled
from ..host.pictures import register
from ..model.validity import flag_attributes, flags
from .batch import Batch
from .broadcast import Layout
from .columns import with_impacts
from .results import FAILED, INTEGRATED, OF_IMPACT, VALIDITY, Block, attributes, outcome_attributes
from .results import blank as blank_column

if TYPE_CHECKING:
    import xarray


def empty(size: int, of: Sequence[str]) -> Block:
    """Result columns before anything is computed: outcome -2."""
    columns: Block = {"outcome": np.full(size, -2, dtype=np.int8)}
    columns["certified"] = np.zeros(size, dtype=bool)
    columns["reason"] = np.empty(size, dtype=object)  # None: has not failed
    for name in dict.fromkeys(("restitution", *of)):
        if name in INTEGRATED or name in OF_IMPACT:
            columns[name] = blank_column(name, size)
    return columns


def blank(size: int, of: Sequence[str]) -> Block:
    """All columns of a chunk, of the kinds that they have when it is computed."""
    results = empty(size, of)
    results["reason"] = as_text(results)
    return results | ({VALIDITY: np.zeros(size, dtype=np.int16)} if VALIDITY in of else {})


def fill(results: Block, where: np.ndarray, block: Block) -> None:
    """Copy a finished block into the result columns."""
    for name, values in block.items():
        results[name][where] = values


def validity(request: Batch, results: Block) -> np.ndarray:
    """Flags of where each collision leaves the model's range; none of one that failed."""
    found = flags(request.scene, with_impacts(request) | results, request.size)
    return np.where(results["outcome"] == FAILED, np.int16(0), found)


def as_text(results: Block) -> np.ndarray:
    """The reasons as a numpy array of text, empty where nothing failed."""
    failed = results["outcome"] == FAILED
    if not failed.any():
        return np.zeros(failed.size, "<U1")
    return np.where(failed, results["reason"], "").astype(str)


def as_dataset(
    request: Batch, results: Block, layout: Layout | None = None, engine: str | None = None
) -> xarray.Dataset:
    """Results as a labelled Dataset, its impacts and varied entries as coordinates.

    Arguments:
        layout: how they are laid out; None: over `collision`.
        engine: which answered, if it is not the request's.
    """
    register()
    along = ("collision",)
    coordinates: dict[str, Column] = {}
    if request.stokes is not None:
        coordinates["stokes"] = along, request.stokes, {"units": "1", "long_name": "Stokes number"}
    if request.speed is not None:
        coordinates["speed"] = along, request.speed, {"units": "m/s", "long_name": "normal approach speed"}
    coordinates["angle"] = along, request.angle, {"units": "rad", "long_name": "impact angle"}
    for name, values in request.vary.items():
        coordinates[name] = along, values, {"units": request.scene.fields[name].unit or "1"}
    for name, values in request.texts.items():
        coordinates[name] = along, values, {"long_name": request.scene.fields[name].what}
    variables: dict[str, Column] = {
        "outcome": (along, results["outcome"], outcome_attributes()),
        "certified": (along, results["certified"], {"long_name": "the stick is proved"}),
        "reason": (along, as_text(results), {"long_name": "why it failed"}),
    }
    for name, values in results.items():
        if name not in variables:
            variables[name] = along, values, flag_attributes() if name == VALIDITY else attributes(name)
    said = {"scene": request.scene.to_toml(), "rtol": request.rtol, "engine": engine or request.engine}
    if request.held:
        said["held"] = request.held
    if request.scene.package is not None:
        said["model"] = request.scene.package.text
    if layout is not None:
        return layout.dataset(variables, coordinates, said)
    return labelled(variables, coordinates, said)
