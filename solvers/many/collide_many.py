"""Many collisions in one call: the basis of maps and of everything else that scans.

The Taylor kernel computes them in blocks; those that it does not complete, and those of other engines, go in blocks to
worker processes. A collision that fails is marked with its reason and the rest go on.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..collision.assemble import partner_spin
from ..engines.casadi.locate import EventSequence, locate
from ..errors import ComputationError, InputError, WetDoubletError
from ..formatting.labelled import Column, labelled
from ..host.compiler import compiler
from ..host.cores import usable_cores
from ..host.pictures import register
from ..host.workers import undisturbed, workers
from ..model.dimensionless import DimensionlessGroups, nondimensionalise
from ..model.model import load, select_model
from ..model.validity import flag_attributes, flags, warn
from ..scene.scene import Scene
from ..settings import FEW, RTOL
from .batch import Batch, batch, check_outputs, check_some_scene, checked_impact, checked_vary, of_one_length
from .broadcast import Layout, laid_out
from .by_kernel import collide_by_kernel
from .chunks import chunks
from .columns import with_impacts
from .of_impact import of_impact
from .results import (
    FAILED,
    INTEGRATED,
    LEDGER,
    NONE,
    OF_IMPACT,
    RATES,
    RESULTS,
    REVERSALS,
    VALIDITY,
    Block,
    attributes,
    outcome_attributes,
)
from .results import blank as blank_column
from .stream import Scan, check_places, digest, into_memory, into_store, software

if TYPE_CHECKING:
    import xarray

_BLOCK = 50  # collisions in a block for a worker
_ALONE = FEW  # fewer collisions are not worth starting workers for
_NUMBERS = 1 << 19  # in the request of a chunk, 4 MB; Dask warns of much more
_SLOW_ALONE = 20  # the same for collisions that the kernel did not complete; they take up to seconds each

Finished = Callable[[np.ndarray, Block], None]
Slow = Callable[[int], None]


def collide_many(
    scene: Scene | str | FilePath,
    *,
    stokes: Any = None,
    speed: Any = None,
    angle: Any = None,
    relative_speed: Any = None,
    vary: Mapping[str, Any] | None = None,
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
        rtol: relative tolerance, 1e-13..1e-3.
        engine: "taylor" (default where its kernel is compiled, and for more than 100 collisions where there is a C
            compiler), "rosenbrock" or "cvodes".
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
    loaded, kept = Scene.load(scene), check_outputs(of, RESULTS)
    file = check_places(client, store)
    impact = {"stokes": stokes, "speed": speed, "relative_speed": relative_speed, "angle": angle}
    vary = {} if vary is None else vary
    loaded, varied = checked_vary(loaded, vary, most=None, texts=True)
    arrays = checked_impact(loaded, impact, None) | varied
    layout = laid_out(arrays, {**{f"impact.{name}": values for name, values in impact.items()}, **vary})
    request = batch(loaded, of_one_length(arrays) if layout is None else layout.columns, rtol, engine, kept)
    if client is not None or file is not None:
        return _in_chunks(request, layout, client, file)
    results = empty(request.size, request.of)
    if request.texts:
        return as_dataset(request, results, layout, _by_text(request, results))
    check_some_scene(request)
    warn(loaded)
    _whole(request, results)
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


def blank(size: int, of: Sequence[str]) -> Block:
    """All columns of a chunk, of the kinds that they have when it is computed."""
    results = empty(size, of)
    results["reason"] = as_text(results)
    return results | ({VALIDITY: np.zeros(size, dtype=np.int16)} if VALIDITY in of else {})


def computed_chunk(request: Batch, cores: int) -> Block:
    """All columns of a chunk of a request, computed in this process.

    Arguments:
        cores: that it may use.
    """
    results = empty(request.size, request.of)
    if request.texts:
        _by_text(request, results, cores)
    else:
        _whole(request, results, cores)
    if VALIDITY in request.of:
        results.setdefault(VALIDITY, np.zeros(request.size, dtype=np.int16))
    results["reason"] = as_text(results)
    return results


def _whole(request: Batch, results: Block, cores: int | None = None) -> None:
    compute(request, np.arange(request.size), lambda where, block: fill(results, where, block), cores=cores)
    if any(name in OF_IMPACT for name in request.of):
        fill(results, np.arange(request.size), of_impact(request))
    if VALIDITY in request.of:
        results[VALIDITY] = validity(request, results)


def _by_text(request: Batch, results: Block, cores: int | None = None) -> str:
    """Fill the results batch by batch, one for each set of choices; returns the engines."""
    engines, first = dict[str, None](), None
    for where, part in request.by_text():
        if isinstance(part, InputError):
            first = first or part
            results["outcome"][where], results["reason"][where] = FAILED, str(part)
            continue
        try:
            if not request.whole:
                check_some_scene(part)
        except InputError as error:
            first = first or error
        else:
            engines[part.engine] = None
            warn(part.scene)
        found = empty(part.size, part.of)
        _whole(part, found, cores)
        if VALIDITY in found:
            results.setdefault(VALIDITY, np.zeros(request.size, dtype=np.int16))
        fill(results, where, found)
    if first is not None and not engines and not request.whole:
        raise first
    return ", ".join(engines) or request.engine


def empty(size: int, of: Sequence[str]) -> Block:
    """Result columns before anything is computed: outcome -2."""
    columns: Block = {"outcome": np.full(size, -2, dtype=np.int8)}
    columns["certified"] = np.zeros(size, dtype=bool)
    columns["reason"] = np.empty(size, dtype=object)  # None: has not failed
    for name in dict.fromkeys(("restitution", *of)):
        if name in INTEGRATED or name in OF_IMPACT:
            columns[name] = blank_column(name, size)
    return columns


def fill(results: Block, where: np.ndarray, block: Block) -> None:
    """Copy a finished block into the result columns."""
    for name, values in block.items():
        results[name][where] = values


def compute(
    request: Batch,
    which: np.ndarray,
    finished: Finished,
    slow: Slow = lambda _count: None,
    cores: int | None = None,
) -> None:
    """Compute the collisions `which`, on all cores if they are many.

    Calls `finished` after every block; results of finished blocks are kept if a later one is interrupted.

    Arguments:
        slow: called with the number of collisions left to slower engines, before those start.
        cores: how many it may use; None for all of this process.
    """
    size, alone = _BLOCK, _ALONE
    most = usable_cores() if cores is None else cores
    if request.engine == "taylor":
        left = collide_by_kernel(request, which, most if which.size > _ALONE else 1, finished)
        if 0 < left.size < which.size:
            slow(left.size)
            size, alone = max(1, min(_BLOCK, left.size // (4 * most))), _SLOW_ALONE
        which = left
    blocks = [which[k : k + size] for k in range(0, which.size, size)]
    cores = min(len(blocks), most)
    many = which.size > _ALONE
    if which.size <= alone or cores == 1:
        for block in blocks:
            finished(block, run(request.part(block), many))
        return
    for block, result in _in_parallel(request, blocks, cores, many):
        finished(block, result)


def _in_parallel(
    request: Batch, blocks: list[np.ndarray], cores: int, machine_code: bool
) -> Iterator[tuple[np.ndarray, Block]]:
    """Blocks and their results in the order in which they finish; each worker receives only its part of the batch."""
    from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, wait

    if request.engine != "cvodes":
        compiler()  # a missing compiler is reported here and not by a worker
    if machine_code:
        run(request.part(blocks[0][:1]), True)  # compile once, before the workers need it
    waiting: dict[Any, np.ndarray] = {}
    left = iter(blocks)
    try:
        with workers(cores) as pool:
            while True:
                with undisturbed():  # only this process handles an interrupt; it then stops its workers
                    for block in left:
                        waiting[pool.submit(run, request.part(block), machine_code)] = block
                        if len(waiting) > 2 * cores:
                            break
                if not waiting:
                    return
                for future in wait(waiting, return_when=FIRST_COMPLETED).done:
                    yield waiting.pop(future), future.result()
    except BrokenExecutor as error:
        raise ComputationError(
            f"a worker process died ({type(error).__name__})", advice="run it again; it may be out of memory"
        ) from None


def run(request: Batch, machine_code: bool) -> Block:
    """Compute the collisions of a batch one after another."""
    block = empty(request.size, request.of)
    for k in range(request.size):
        for name, value in _one(request, k, machine_code).items():
            block[name][k] = value
    return block


def _one(request: Batch, k: int, machine_code: bool) -> dict[str, Any]:
    try:
        scene, speed, angle = request.impact(k)
        if request.engine == "cvodes" or any(name in LEDGER or name == "steps" for name in request.of):
            plugin = "cvodes" if request.engine == "cvodes" else "rosenbrock"
            return _chained(request, scene, speed, angle, plugin)
        n = nondimensionalise(scene, speed, angle)
        model = load(select_model(scene, n.oblique, fold=True))
        turns = model.has("turning_rate") and not model.strings
        quadrature = ("rotation",) if "rotation" in request.of and turns else ()
        try:
            path = locate(model, n.groups, request.rtol, quadrature, machine_code)
        except ComputationError as error:
            raise n.in_si(error) from None
        return _kept(scene, request.of, path, n)
    except WetDoubletError as error:
        return {"outcome": FAILED, "reason": str(error)}
    except Exception as error:  # noqa: BLE001 # a defect of ours spoils one collision, not the others
        return {"outcome": FAILED, "reason": " ".join(f"internal error: {type(error).__name__}: {error}".split())}


def _kept(scene: Scene, of: Sequence[str], path: EventSequence, n: DimensionlessGroups) -> dict[str, Any]:
    found: dict[str, Any] = {"outcome": OUTCOMES.index(path.outcome), "certified": path.certified, "restitution": 0.0}
    if "reversal" in of:
        found["reversal"] = _code(path.reversal)
    if not path.separated:
        return found | ({"until": path.time * n.time} if "until" in of else {})
    outputs = path.model.values("outputs", path.y, path.p)
    found["restitution"] = outputs["restitution"]
    values = {
        "tangential_restitution": outputs.get("tangential_restitution", math.nan),
        "contact_time": path.time * n.time,
        "smallest_gap": path.smallest_gap * n.length,
        "rotation": 0.0,
    }
    names = (*path.model.state, *path.extras)
    if "rotation" in names:
        values["rotation"] = float(path.y[names.index("rotation")])
    if any(name in RATES for name in of):
        rates = {name: outputs[name] * n.rate if n.oblique else 0.0 for name in ("final_spin", "final_rotation_rate")}
        partner = partner_spin(scene, rates["final_spin"], outputs, n)
        values |= rates | {"final_spin_partner": math.nan if partner is None else partner}
    return found | {name: value for name, value in values.items() if name in of}


def _code(reversal: str | None) -> int:
    return NONE if reversal is None else REVERSALS.index(reversal)


def _chained(request: Batch, scene: Scene, speed: float, angle: float, plugin: str) -> dict[str, Any]:
    """One collision as `collide` computes it."""
    from ..collision.by_casadi import by_casadi

    n = nondimensionalise(scene, speed, angle)
    ledger = any(name in LEDGER for name in request.of)
    one = by_casadi(scene, n, request.rtol, plugin, ledger=ledger, trajectory=False)
    found: dict[str, Any] = {"outcome": OUTCOMES.index(one.outcome), "certified": one.certified}
    for name in ("restitution", *(name for name in request.of if name in INTEGRATED)):
        table, _, term = name.rpartition(".")
        value = getattr(getattr(one, table) if table else one, term)
        found[name] = _code(value) if name == "reversal" else math.nan if value is None else value
    return found


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
    if request.scene.package is not None:
        said["model"] = request.scene.package.text
    if layout is not None:
        return layout.dataset(variables, coordinates, said)
    return labelled(variables, coordinates, said)


def as_text(results: Block) -> np.ndarray:
    """The reasons as a numpy array of text, empty where nothing failed."""
    failed = results["outcome"] == FAILED
    if not failed.any():
        return np.zeros(failed.size, "<U1")
    return np.where(failed, results["reason"], "").astype(str)


def validity(request: Batch, results: Block) -> np.ndarray:
    """Flags of where each collision leaves the model's range; none of one that failed."""
    found = flags(request.scene, with_impacts(request) | results, request.size)
    return np.where(results["outcome"] == FAILED, np.int16(0), found)
