"""Many collisions in one call: the basis of maps and of everything else that scans.

The Taylor kernel computes them in blocks; those that it does not complete, and those of other engines, go in blocks to
worker processes. A collision that fails is marked with its reason and the rest go on.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..engines.casadi.locate import EventSequence, locate
from ..errors import ComputationError, WetDoubletError
from ..formatting.labelled import Column, labelled
from ..host.compiler import compiler
from ..host.cores import usable_cores
from ..host.workers import undisturbed, workers
from ..model.dimensionless import DimensionlessGroups, nondimensionalise
from ..model.model import load, select_model
from ..model.validity import flag_attributes, flags, warn
from ..scene.scene import Scene
from ..settings import FEW, RTOL
from .batch import QUANTITIES, VALIDITY, Batch, validated_batch
from .by_kernel import collide_by_kernel
from .columns import with_impacts

if TYPE_CHECKING:
    import xarray

FAILED = -1
_BLOCK = 50  # collisions in a block for a worker
_ALONE = FEW  # fewer collisions are not worth starting workers for
_SLOW_ALONE = 20  # the same for collisions that the kernel did not complete; they take up to seconds each

Block = dict[str, np.ndarray]
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
) -> xarray.Dataset:
    """Many collisions of one scene.

    Arguments:
        scene: a Scene, a path or a preset's name.
        stokes, speed, relative_speed: Stokes numbers, normal speeds in m/s, or magnitudes of the relative velocity in
            m/s: 1-D or a single number; default the scene's.
        angle: impact angles in rad, 1-D or a single number; default the scene's.
        vary: other entries by dotted name (SI numbers), 1-D of the same length.
        rtol: relative tolerance, 1e-13..1e-3.
        engine: "taylor" (default for more than 100 collisions where there is a C compiler), "rosenbrock" or "cvodes".
        of: quantities to keep besides restitution: tangential_restitution, rotation, contact_time, smallest_gap;
            validity (flags of where the model leaves its range, with the results that these need).

    Returns:
        Dataset over `collision`: outcome (int8: 0 stick, 1 stick-rotate-separate, 2 bounce, -1 failed), restitution,
        certified, reason (of a failure, else ""), and what `of` names; NaN where a stick leaves a quantity undefined.

    Raises:
        InputError: an invalid name, length or value. A collision that fails raises nothing; it is marked.

    Example:
        >>> from wetdoublet.solvers import collide_many
        >>> collide_many("granulation", stokes=[0.01, 0.02], angle=1.3).outcome.values
        array([0, 1], dtype=int8)
    """
    impact = {"stokes": stokes, "speed": speed, "relative_speed": relative_speed, "angle": angle}
    request = validated_batch(scene, impact, {} if vary is None else vary, rtol, engine, of)
    warn(request.scene)
    results = empty(request.size, request.of)
    compute(request, np.arange(request.size), lambda where, block: fill(results, where, block))
    return as_dataset(request, results)


def empty(size: int, of: Sequence[str]) -> Block:
    """Result columns before anything is computed: outcome -2."""
    columns: Block = {"outcome": np.full(size, -2, dtype=np.int8)}
    columns["certified"] = np.zeros(size, dtype=bool)
    columns["reason"] = np.empty(size, dtype=object)  # None: has not failed
    for name in dict.fromkeys(("restitution", *of)):
        if name in QUANTITIES:
            columns[name] = np.full(size, np.nan)
    return columns


def fill(results: Block, where: np.ndarray, block: Block) -> None:
    """Copy a finished block into the result columns."""
    for name, values in block.items():
        results[name][where] = values


def compute(request: Batch, which: np.ndarray, finished: Finished, slow: Slow = lambda _count: None) -> None:
    """Compute the collisions `which`, on all cores if they are many.

    Calls `finished` after every block; results of finished blocks are kept if a later one is interrupted.

    Arguments:
        slow: called with the number of collisions left to slower engines, before those start.
    """
    size, alone = _BLOCK, _ALONE
    if request.engine == "taylor":
        left = collide_by_kernel(request, which, usable_cores() if which.size > _ALONE else 1, finished)
        if 0 < left.size < which.size:
            slow(left.size)
            size, alone = max(1, min(_BLOCK, left.size // (4 * usable_cores()))), _SLOW_ALONE
        which = left
    blocks = [which[k : k + size] for k in range(0, which.size, size)]
    cores = min(len(blocks), usable_cores())
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
        if request.engine == "cvodes":
            return _chained(request, scene, speed, angle)
        n = nondimensionalise(scene, speed, angle)
        model = load(select_model(scene, n.oblique, fold=True))
        turns = model.has("turning_rate") and not model.strings
        quadrature = ("rotation",) if "rotation" in request.of and turns else ()
        try:
            path = locate(model, n.groups, request.rtol, quadrature, machine_code)
        except ComputationError as error:
            raise n.in_si(error) from None
        return _kept(request.of, path, n)
    except WetDoubletError as error:
        return {"outcome": FAILED, "reason": str(error)}
    except Exception as error:  # noqa: BLE001 # a defect of ours spoils one collision, not the others
        return {"outcome": FAILED, "reason": " ".join(f"internal error: {type(error).__name__}: {error}".split())}


def _kept(of: Sequence[str], path: EventSequence, n: DimensionlessGroups) -> dict[str, Any]:
    found: dict[str, Any] = {"outcome": OUTCOMES.index(path.outcome), "certified": path.certified, "restitution": 0.0}
    if not path.separated:
        return found
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
    return found | {name: value for name, value in values.items() if name in of}


def _chained(request: Batch, scene: Scene, speed: float, angle: float) -> dict[str, Any]:
    """One collision by CVODES, as a row of result columns."""
    from ..collision.by_casadi import by_casadi

    n = nondimensionalise(scene, speed, angle)
    one = by_casadi(scene, n, request.rtol, "cvodes", ledger=False, trajectory=False).to_dict()
    found = {name: math.nan if one[name] is None else one[name] for name in QUANTITIES if name in request.of}
    return found | {
        "outcome": OUTCOMES.index(one["outcome"]),
        "certified": one["certified"],
        "restitution": one["restitution"],
    }


def as_dataset(request: Batch, results: Block) -> xarray.Dataset:
    """Results as a labelled Dataset over `collision`, its impacts and varied entries as coordinates."""
    along = ("collision",)
    coordinates: dict[str, Column] = {}
    if request.stokes is not None:
        coordinates["stokes"] = along, request.stokes, {"units": "1", "long_name": "Stokes number"}
    if request.speed is not None:
        coordinates["speed"] = along, request.speed, {"units": "m/s", "long_name": "normal approach speed"}
    coordinates["angle"] = along, request.angle, {"units": "rad", "long_name": "impact angle"}
    for name, values in request.vary.items():
        coordinates[name] = along, values, {"units": request.scene.fields[name].unit or "1"}
    variables: dict[str, Column] = {
        "outcome": (along, results["outcome"], outcome_attributes()),
        "certified": (along, results["certified"], {"long_name": "the stick is proved"}),
        "reason": (along, as_text(results), {"long_name": "why it failed"}),
    }
    for name, (unit, meaning) in QUANTITIES.items():
        if name in results:
            variables[name] = along, results[name], {"units": unit, "long_name": meaning}
    if VALIDITY in request.of:
        variables[VALIDITY] = along, validity(request, results), flag_attributes()
    attributes = {"scene": request.scene.to_toml(), "rtol": request.rtol, "engine": request.engine}
    if request.scene.package is not None:
        attributes["model"] = request.scene.package.text
    return labelled(variables, coordinates, attributes)


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


def outcome_attributes() -> dict[str, Any]:
    """CF flag attributes of an outcome variable."""
    return {
        "long_name": "outcome",
        "flag_values": np.array([FAILED, 0, 1, 2], dtype=np.int8),
        "flag_meanings": "failed " + " ".join(name.replace("-", "_") for name in OUTCOMES),
    }
