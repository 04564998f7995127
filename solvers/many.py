"""Many collisions at once: the building block of maps and everything else that scans.

Each collision is located with CasADi's Rosenbrock integrator compiled to C; blocks of them go to the machine's cores.
A collision that fails is marked with its reason and the rest go on.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import InputError, WetDoubletError, did_you_mean
from .locate import Path, locate
from .model import choose, load
from .numbers import Numbers, numbers
from .scene import Scene
from .schema import FIELDS, unknown_entry
from .settings import RTOL, check_engine, check_rtol

if TYPE_CHECKING:
    import xarray

OUTCOMES = ("stick", "stick-rotate-separate", "bounce")
FAILED = -1
ALWAYS = ("outcome", "restitution", "certified", "reason")
QUANTITIES: dict[str, tuple[str, str]] = {
    "restitution": ("1", "normal restitution e_n"),
    "tangential_restitution": ("1", "tangential restitution r_f omega_f/(r_0 omega_0)"),
    "rotation": ("rad", "angle turned by the line of centres until separation"),
    "contact_time": ("s", "time from first touch to separation"),
    "smallest_gap": ("m", "smallest gap until separation"),
}
_BLOCK = 50  # collisions a worker takes at a time
_ALONE = 100  # fewer collisions are not worth starting workers or a compiler for

Block = dict[str, np.ndarray]
Finished = Callable[[np.ndarray, Block], None]


@dataclass(frozen=True)
class Request:
    """What to collide: a scene, impacts, other entries that vary, and what to keep. Arrays of one length, SI."""

    scene: Scene
    stokes: np.ndarray | None
    speed: np.ndarray | None
    angle: np.ndarray
    vary: dict[str, np.ndarray]
    rtol: float
    engine: str
    of: tuple[str, ...]

    @property
    def size(self) -> int:
        return int(self.angle.size)

    def impact(self, k: int) -> tuple[Scene, float, float]:
        """Scene, speed (m/s) and angle (rad) of collision k."""
        scene = self.scene
        if self.vary:
            scene = scene.with_entries({name: float(values[k]) for name, values in self.vary.items()})
        if self.speed is not None:
            return scene, float(self.speed[k]), float(self.angle[k])
        assert self.stokes is not None
        return scene, scene.speed_of(float(self.stokes[k])), float(self.angle[k])


def collide_many(
    scene: Scene | str | FilePath,
    *,
    stokes: Any = None,
    speed: Any = None,
    angle: Any = None,
    vary: Mapping[str, Any] | None = None,
    rtol: float = RTOL,
    engine: str | None = None,
    of: Sequence[str] = ("outcome", "restitution"),
) -> xarray.Dataset:
    """Many collisions of one scene.

    Arguments:
        scene: a Scene, a path or a preset's name.
        stokes, speed: Stokes numbers, or normal speeds in m/s: 1-D or a single number; default the scene's.
        angle: impact angles in rad, 1-D or a single number; default the scene's.
        vary: other entries by dotted name (SI numbers), 1-D of the same length.
        rtol: relative tolerance, 1e-13..1e-3.
        engine: "rosenbrock" (default: compiled to C where there is a compiler) or "cvodes".
        of: what to keep besides restitution: tangential_restitution, rotation, contact_time, smallest_gap.

    Returns:
        Dataset over `collision`: outcome (int8: 0 stick, 1 stick-rotate-separate, 2 bounce, -1 failed), restitution,
        certified, reason (of a failure, else ""), and what `of` names; NaN where a stick leaves a quantity undefined.

    Raises:
        InputError: a name, length or value that cannot be; a collision that fails is no error, it is marked.

    Example:
        >>> from wetdoublet.solvers import collide_many
        >>> collide_many("granulation", stokes=[0.01, 0.02], angle=1.3).outcome.values
        array([0, 1], dtype=int8)
    """
    request = requested(scene, stokes, speed, angle, vary or {}, rtol, engine, of)
    results = empty(request.size, request.of)
    compute(request, np.arange(request.size), lambda where, block: fill(results, where, block))
    return as_dataset(request, results)


def requested(
    scene: Scene | str | FilePath,
    stokes: Any,
    speed: Any,
    angle: Any,
    vary: Mapping[str, Any],
    rtol: float,
    engine: str | None,
    of: Sequence[str],
) -> Request:
    """A validated Request, everything broadcast to one length."""
    loaded = Scene.load(scene)
    if stokes is not None and speed is not None:
        raise InputError("speed", speed, "only one of stokes, speed", "is given together with stokes")
    of = (of,) if isinstance(of, str) else tuple(of)
    known = (*QUANTITIES, "outcome", "certified", "reason")
    for name in of:
        if name not in known:
            raise InputError("of", name, ", ".join(known), "is not known" + did_you_mean(name, known))
    columns: dict[str, Any] = {}
    if stokes is None and speed is None:
        own = loaded.impact
        stokes, speed = own.stokes, own.speed
        if stokes is None and speed is None:
            raise InputError("stokes", None, "Stokes numbers, or speed, or an [impact] in the scene")
    if stokes is not None:
        columns["impact.stokes"] = stokes
    if speed is not None:
        columns["impact.speed"] = speed
    columns["impact.angle"] = loaded.angle if angle is None else angle
    if columns["impact.angle"] is None:
        raise InputError("angle", None, "angles in rad, or an [impact] in the scene")
    for name, values in vary.items():
        if name not in FIELDS:
            raise unknown_entry(name, values)
        if name.startswith("impact."):
            raise InputError("vary", name, "entries that are not of the impact", "has an argument of its own")
        columns[name] = values
    arrays = {name: _numbers(name, values) for name, values in columns.items()}
    lengths = {name: array.size for name, array in arrays.items() if array.ndim}
    size = max(lengths.values(), default=1)
    for name, length in lengths.items():
        if length not in (1, size):
            raise InputError(name, f"{length} values", f"{size} values, or one", "differs in length from the others")
    full = {name: np.broadcast_to(array.reshape(-1), size).copy() for name, array in arrays.items()}
    return Request(
        scene=loaded,
        stokes=full.pop("impact.stokes", None),
        speed=full.pop("impact.speed", None),
        angle=full.pop("impact.angle"),
        vary=full,
        rtol=check_rtol(rtol),
        engine=check_engine(engine) or "rosenbrock",
        of=of,
    )


def _numbers(name: str, values: Any) -> np.ndarray:
    """An array of SI numbers, each acceptable for its field."""
    if isinstance(values, str):
        values = FIELDS[name].number(values)
    try:
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(name, repr(values), "numbers (SI), in one dimension", "is not a list of numbers") from None
    if array.ndim > 1:
        raise InputError(name, f"{array.ndim} dimensions", "one dimension, or a single number", "is not accepted")
    for value in np.unique(array):
        FIELDS[name].number(float(value), label=name)
    return array


def empty(size: int, of: Sequence[str]) -> Block:
    """Result columns, nothing computed yet: outcome -2."""
    columns: Block = {"outcome": np.full(size, -2, dtype=np.int8)}
    columns["certified"] = np.zeros(size, dtype=bool)
    columns["reason"] = np.full(size, "", dtype=object)
    for name in dict.fromkeys(("restitution", *of)):
        if name in QUANTITIES:
            columns[name] = np.full(size, np.nan)
    return columns


def fill(results: Block, where: np.ndarray, block: Block) -> None:
    """Put a finished block where it belongs."""
    for name, values in block.items():
        results[name][where] = values


def compute(request: Request, which: np.ndarray, finished: Finished) -> None:
    """Collide the collisions `which`, on all cores if they are many; `finished` is told of every block."""
    blocks = [which[k : k + _BLOCK] for k in range(0, which.size, _BLOCK)]
    cores = min(len(blocks), os.cpu_count() or 1)
    many = which.size > _ALONE
    if not many or cores == 1:
        for block in blocks:
            finished(block, run(request, block, many))
        return
    for block, result in _in_parallel(request, blocks, cores):
        finished(block, result)


def _in_parallel(request: Request, blocks: list[np.ndarray], cores: int) -> Iterator[tuple[np.ndarray, Block]]:
    from concurrent.futures import as_completed

    from loky import ProcessPoolExecutor  # starts workers without running the caller's script again

    run(request, blocks[0][:1], True)  # compile once, before the workers ask for it
    pool = ProcessPoolExecutor(max_workers=cores)
    try:
        waiting = {pool.submit(run, request, block, True): block for block in blocks}
        for future in as_completed(waiting):
            yield waiting[future], future.result()
    finally:
        pool.shutdown(wait=True, kill_workers=True)


def run(request: Request, which: np.ndarray, machine_code: bool) -> Block:
    """Collide a block, one after another."""
    block = empty(which.size, request.of)
    for position, k in enumerate(which):
        for name, value in _one(request, int(k), machine_code).items():
            block[name][position] = value
    return block


def _one(request: Request, k: int, machine_code: bool) -> dict[str, Any]:
    try:
        scene, speed, angle = request.impact(k)
        if request.engine == "cvodes":
            return _chained(request, scene, speed, angle)
        n = numbers(scene, speed, angle)
        model = load(choose(scene, n.oblique))
        quadrature = ("rotation",) if "rotation" in request.of and n.oblique and not model.strings else ()
        path = locate(model, n.groups, request.rtol, quadrature, machine_code)
        return _kept(request.of, path, n)
    except WetDoubletError as error:
        return {"outcome": FAILED, "reason": str(error)}


def _kept(of: Sequence[str], path: Path, n: Numbers) -> dict[str, Any]:
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
    if n.oblique and "rotation" in of:
        names = (*path.model.state, *path.extras)
        values["rotation"] = float(path.y[names.index("rotation")])
    return found | {name: value for name, value in values.items() if name in of}


def _chained(request: Request, scene: Scene, speed: float, angle: float) -> dict[str, Any]:
    """One collision by the reference engine."""
    from .simulate import collide

    one = collide(scene, speed=speed, angle=angle, rtol=request.rtol, engine="cvodes", ledger=False).to_dict()
    found = {name: math.nan if one[name] is None else one[name] for name in QUANTITIES if name in request.of}
    return found | {
        "outcome": OUTCOMES.index(one["outcome"]),
        "certified": one["certified"],
        "restitution": one["restitution"],
    }


def as_dataset(request: Request, results: Block) -> xarray.Dataset:
    """Results as a labelled Dataset over `collision`, its impacts and varied entries as coordinates."""
    import xarray as xr

    coordinates: dict[str, Any] = {}
    if request.stokes is not None:
        coordinates["stokes"] = ("collision", request.stokes, {"units": "1", "long_name": "Stokes number"})
    if request.speed is not None:
        coordinates["speed"] = ("collision", request.speed, {"units": "m/s", "long_name": "normal approach speed"})
    coordinates["angle"] = ("collision", request.angle, {"units": "rad", "long_name": "impact angle"})
    for name, values in request.vary.items():
        coordinates[name] = ("collision", values, {"units": FIELDS[name].unit or "1"})
    variables: dict[str, Any] = {
        "outcome": ("collision", results["outcome"], outcome_attributes()),
        "certified": ("collision", results["certified"], {"long_name": "the stick is proved"}),
        "reason": ("collision", results["reason"].astype(str), {"long_name": "why it failed"}),
    }
    for name, (unit, meaning) in QUANTITIES.items():
        if name in results:
            variables[name] = ("collision", results[name], {"units": unit, "long_name": meaning})
    attributes = {"scene": request.scene.to_toml(), "rtol": request.rtol, "engine": request.engine}
    return xr.Dataset(variables, coordinates, attributes)


def outcome_attributes() -> dict[str, Any]:
    """CF flag attributes of an outcome variable."""
    return {
        "long_name": "outcome",
        "flag_values": np.array([FAILED, 0, 1, 2], dtype=np.int8),
        "flag_meanings": "failed " + " ".join(name.replace("-", "_") for name in OUTCOMES),
    }
