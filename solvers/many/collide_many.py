"""Many collisions in one call: the basis of maps and of everything else that scans."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..model.validity import warn
from ..scene.held import held_text
from ..scene.scene import Scene
from ..settings import RTOL
from .batch import (
    Batch,
    batch,
    check_outputs,
    check_some_scene,
    checked_impact,
    checked_vary,
    held_by_default,
    of_one_length,
)
from .broadcast import Layout, laid_out
from .chunks import chunks
from .compute import complete, complete_by_choices, computed_chunk
from .dataset import as_dataset, blank, empty, fill
from .results import RESULTS, Block
from .stream import Scan, check_places, digest, into_memory, into_store, software

if TYPE_CHECKING:
    import xarray

_NUMBERS = 1 << 19  # in the request of a chunk, 4 MB; Dask warns of much more


def collide_many(
    scene: Scene | str | FilePath,
    *,
    stokes: Any = None,
    speed: Any = None,
    angle: Any = None,
    relative_speed: Any = None,
    vary: Mapping[str, Any] | None = None,
    hold: str | None = None,
    rtol: float = RTOL,
    engine: str | None = None,
    of: Sequence[str] = ("outcome", "restitution"),
    client: Any = None,
    store: str | FilePath | None = None,
) -> xarray.Dataset:
    """Many collisions of one scene.

    Arguments:
        scene: a Scene, a path or a preset's name.
        stokes, speed, relative_speed: Stokes numbers, normal speeds in m/s, or magnitudes of the relative velocity in
            m/s; default the scene's.
        angle: impact angles in rad; default the scene's.
        vary: other entries by dotted name: SI numbers, or the names of laws and other choices.
        hold: what the scene's impact keeps where other entries vary, as for `Scene.with_entries`; without effect where
            speeds or Stokes numbers are arguments.
        rtol: relative tolerance, 1e-13..1e-3.
        engine: "taylor" (default; compiled on first use), "rosenbrock" (also where there is no C compiler) or "cvodes".
        of: what to keep besides outcome and restitution: any number that a `Collision` has, terms of its ledger as
            "energy.capillary" (the ledger is then integrated too, which takes longer), and validity (flags of where the
            model leaves its range, with the results that these need). For contact_time, rotation and until the kernel
            integrates the whole trajectory, otherwise only what e_n depends on: e_n may differ within its tolerance.
        client: a `dask.distributed.Client` whose workers compute, or as text a scheduler's address, its file, "local"
            or "local:N" (N processes here, started and ended by this call). The result is the same.
        store: a Zarr store to write the results to, chunk by chunk (`many.zarr`). The same call continues after an
            interrupt. The Dataset that is returned reads from it.

    Numbers, arrays of any shape, quantities with units and DataArrays are broadcast against each other as numpy does,
    DataArrays by the names of their dimensions; plain arrays beside these go with the last dimensions.

    Returns:
        Dataset: outcome (int8: 0 stick, 1 stick-rotate-separate, 2 bounce, -1 failed), restitution, certified, reason
        (of a failure, else ""), and what `of` names; NaN where a stick leaves a quantity undefined. Over `collision` if
        what is given has one dimension or none; over dim_0, dim_1, ... if it has more; over the dimensions of
        DataArrays, with their coordinates, where there are any.

    Raises:
        InputError: an invalid name, shape or value. A collision that fails raises nothing; it is marked.

    Example:
        >>> from wetdoublet.solvers import collide_many
        >>> collide_many("granulation", stokes=[0.01, 0.02], angle=1.3).outcome.values
        array([0, 1], dtype=int8)
        >>> laws = collide_many("granulation", stokes=0.02, angle=1.3, vary={"bridge.law": ["mikami", "willett"]})
        >>> laws.restitution.shape
        (2,)
    """
    loaded, names = Scene.load(scene), check_outputs(of, RESULTS)
    file = check_places(client, store)
    impact = {"stokes": stokes, "speed": speed, "relative_speed": relative_speed, "angle": angle}
    vary = {} if vary is None else vary
    loaded, varied = checked_vary(loaded, vary, most=None, texts=True)
    kept = held_by_default(loaded, impact, varied, hold)
    arrays = checked_impact(loaded, impact, None, kept) | varied
    layout = laid_out(arrays, {**{f"impact.{name}": values for name, values in impact.items()}, **vary})
    request = batch(loaded, of_one_length(arrays) if layout is None else layout.columns, rtol, engine, names)
    request = replace(request, held=held_text(loaded, kept)) if kept else request
    if client is not None or file is not None:
        return _in_chunks(request, layout, client, file)
    results = empty(request.size, request.of)
    if request.texts:
        return as_dataset(request, results, layout, complete_by_choices(request, results))
    check_some_scene(request)
    warn(loaded)
    complete(request, results)
    return as_dataset(request, results, layout)


def _in_chunks(request: Batch, layout: Layout | None, client: Any, file: FilePath | None) -> xarray.Dataset:
    """Compute a request chunk by chunk, on a cluster, into a store, or both."""
    if file is not None and not request.size:
        raise InputError("store", str(file), "at least one collision to write", "would be empty")
    engines = _engines(request)
    engine = ", ".join(dict.fromkeys(engines.values()))
    scan = _scan(replace(request, whole=request.size, engines=engines), layout, engine)
    if file is not None:
        return into_store(scan, file, client)
    results = blank(request.size, request.of)
    results["reason"] = results["reason"].astype(object)
    into_memory(scan, client, np.zeros(request.size, bool), lambda where, block: fill(results, where, block))
    return as_dataset(request, results, layout, engine)


def _engines(request: Batch) -> dict[tuple[str, ...], str]:
    """The engines of a request by its choices; scenes are checked and warned of here, and not on workers."""
    engines: dict[tuple[str, ...], str] = {}
    first = None
    for where, part in request.by_text() if request.texts else ((np.arange(1), request),):
        try:
            if isinstance(part, InputError):
                raise part
            check_some_scene(part)
        except InputError as error:
            first = first or error
        else:
            engines[tuple(str(values[where[0]]) for values in request.texts.values())] = part.engine
            warn(part.scene)
    if first is not None and not engines:
        raise first
    return engines


def _scan(request: Batch, layout: Layout | None, engine: str) -> Scan:
    """The collisions as chunks that are computed by themselves."""
    shape = (request.size,) if layout is None else layout.shape
    given = {"angle": request.angle, "stokes": request.stokes, "speed": request.speed, **request.vary, **request.texts}
    columns = {name: values for name, values in given.items() if values is not None}
    cut = chunks(shape, request.engine, _NUMBERS // (len(columns) + 3 * len(request.texts)))

    def dataset(k: int, block: Block) -> xarray.Dataset:
        import xarray as xr

        flat = as_dataset(request.part(cut.flat(k)), block, None, engine)
        dims = ("collision",) if layout is None else tuple(map(str, layout.dims))
        variables = {
            name: (dims, each.values.reshape(cut.extent(k)[: len(dims)]), each.attrs)
            for name, each in flat.data_vars.items()
        }
        return xr.Dataset(variables, attrs=flat.attrs)

    def coordinates() -> xarray.Dataset:
        nothing = {name: np.broadcast_to(one, request.size) for name, one in blank(1, request.of).items()}
        return as_dataset(request, nothing, layout).coords.to_dataset()

    return Scan(
        cut,
        request.engine,
        task=lambda k: partial(computed_chunk, request.part(cut.flat(k))),
        dataset=dataset,
        blank=lambda k: blank(math.prod(cut.extent(k)), request.of),
        fixed=coordinates,
        identity={
            "scene": request.scene.si,
            "volume": request.scene.ways.volume,
            "columns": {name: digest(values) for name, values in columns.items()},
            "shape": cut.shape,
            "rtol": request.rtol,
            "engine": engine,
            "of": sorted(set(request.of)),
            **software(),
            "model": request.scene.package and request.scene.package.digest,
        },
    )
