"""Global sensitivity: Sobol indices over ranges of the parameters, by SALib (an optional extra) on `collide_many`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ..engines.settings import check_rtol
from ..errors import ComputationError, InputError, install_extra
from ..host.arguments import check_mapping, check_name, check_whole
from ..host.pictures import register
from ..many.collide_many import collide_many
from ..many.results import FAILED
from ..many.results import QUANTITIES as MANY
from ..many.stream import check_places
from ..scene.held import held_quantity
from ..scene.scene import Scene
from ..scene.schema import SPEEDS
from .parameters import check_wrt
from .uncertainty import check_samples

if TYPE_CHECKING:
    import xarray


def sobol_indices(
    scene: Scene | str | FilePath,
    ranges: Mapping[str, Sequence[float | str]],
    *,
    of: str = "restitution",
    samples: int = 256,
    rtol: float = 1e-8,
    seed: int = 0,
    hold: str | None = None,
    client: Any = None,
    store: str | FilePath | None = None,
) -> xarray.Dataset:
    """First-order and total Sobol indices of a result over a box of parameters, uniformly distributed.

    Arguments:
        scene: a Scene with an impact, a path or a preset's name.
        ranges: dotted name -> (low, high), text with its unit or SI.
        of: restitution, or another result of `collide_many` (an error if some collision sticks).
        samples: number of base samples, a power of two; samples (2 + parameters) collisions are computed.
        hold: what the scene's impact keeps unless it varies itself, as for `Scene.with_entries`.
        client, store: a cluster that computes them and a Zarr store that keeps them, as for `collide_many`; a call that
            was interrupted goes on where it was.

    Returns:
        Dataset over `parameter`: `first`, `total`, and half widths of their 95 % intervals; `collisions` in the
        attributes.

    Raises:
        InputError: an invalid name or range.
        ComputationError: SALib is not installed, a collision failed, or the result is not defined over the whole box.

    Example:
        >>> from wetdoublet.solvers import sobol_indices
        >>> box = {"liquid.viscosity": ("1.9 Pa s", "2.1 Pa s"), "impact.angle": ("65 deg", "70 deg")}
        >>> found = sobol_indices("granulation", box, samples=4)  # needs wetdoublet[global]
        >>> found.first.dims
        ('parameter',)
    """
    import xarray as xr

    register()
    loaded = Scene.load(scene)
    names = check_wrt(loaded, tuple(check_mapping(ranges, "ranges", "(low, high) by dotted name")), "ranges")
    rtol, of, samples, seed = (
        check_rtol(rtol),
        check_name(of, tuple(MANY), "of"),
        check_samples(samples),
        check_whole(seed, "seed", 0, 2**32 - 1),
    )
    check_places(client, store)
    bounds = [_bounds(loaded, name, ranges[name]) for name in names]
    held_quantity(loaded, hold)
    sample, analyze = _salib()
    problem = {"num_vars": len(names), "names": list(names), "bounds": bounds}
    points = sample(problem, samples, calc_second_order=False, seed=seed)
    columns = dict(zip(names, np.asarray(points).T, strict=True))
    _, angle = loaded.need_impact()
    impact: dict[str, Any] = {"angle": columns.pop("impact.angle", angle)}
    moved = [name for name in SPEEDS if name in columns]
    if len(moved) > 1:
        raise InputError("ranges", moved[1], f"only one of {', '.join(SPEEDS)}", f"is given together with {moved[0]}")
    if moved:
        impact[moved[0].partition(".")[2]] = columns.pop(moved[0])
    columns = {name: loaded.as_given(name, column) for name, column in columns.items()}
    keep = ("outcome", "restitution", *(() if of == "restitution" else (of,)))
    collisions = collide_many(loaded, **impact, vary=columns, hold=hold, rtol=rtol, of=keep, client=client, store=store)
    failed = int((collisions.outcome.values == FAILED).sum())
    result = np.asarray(collisions[of].values, dtype=float)
    if failed or not np.isfinite(result).all():
        lost = f"{failed} failed" if failed else f"{of} of {int(np.isnan(result).sum())} sticks is not defined"
        raise ComputationError(
            f"no Sobol indices: of {result.size} collisions {lost}", advice="choose narrower ranges, or restitution"
        )
    if np.ptp(result) == 0:
        raise ComputationError(f"no Sobol indices: {of} is the same over the whole box", advice="choose wider ranges")
    indices = analyze(problem, result, calc_second_order=False, seed=seed + 1)  # SALib takes 0 for none
    return xr.Dataset(
        {
            "first": ("parameter", np.asarray(indices["S1"])),
            "total": ("parameter", np.asarray(indices["ST"])),
            "first_within": ("parameter", np.asarray(indices["S1_conf"])),
            "total_within": ("parameter", np.asarray(indices["ST_conf"])),
        },
        {"parameter": list(names)},
        {"of": of, "collisions": int(result.size), "samples": samples},
    )


def _bounds(scene: Scene, name: str, limits: Sequence[float | str]) -> list[float]:
    accepted = f"(low, high) of {name} with low below high"
    if not isinstance(limits, (list, tuple, np.ndarray)) or len(limits) != 2:
        raise InputError("ranges", limits, accepted, "is not a pair")
    low, high = (scene.si_number(name, value, f"ranges of {name}") for value in limits)
    if not low < high:
        raise InputError("ranges", f"({limits[0]}, {limits[1]})", accepted, "is not ascending")
    return [low, high]


def _salib() -> tuple[Any, Any]:
    """SALib's sampling and analysis."""
    try:
        from SALib.analyze.sobol import analyze
        from SALib.sample.sobol import sample
    except ImportError:
        raise ComputationError("Sobol indices need SALib", advice=install_extra("global")) from None
    return sample, analyze
