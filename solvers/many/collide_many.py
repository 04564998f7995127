"""Many collisions in one call: the basis of maps and of everything else that scans."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

from ..engines.settings import RTOL, check_engine, check_rtol
from ..results import REQUESTED
from ..scene.scene import Scene
from .arguments import check_outputs, checked_columns
from .blocks import into_memory
from .impacts import Impacts, laid_out

if TYPE_CHECKING:
    import xarray


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
        engine: "taylor" (default), or "rosenbrock" or "cvodes", which integrate the phases that taylor has found.
        of: what to keep besides outcome and restitution: any number that a `Collision` has, terms of its ledger as
            "energy.capillary" (the ledger is then integrated too, which takes longer), and validity (flags of where the
            model leaves its range, with the results that these need). For contact_time, rotation and until the kernel
            integrates the whole trajectory, otherwise only what e_n depends on: e_n may differ within its tolerance.

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
    names, rtol, engine = check_outputs(of, REQUESTED), check_rtol(rtol), check_engine(engine) or "taylor"
    impact = {"stokes": stokes, "speed": speed, "relative_speed": relative_speed, "angle": angle}
    loaded, arrays, held = checked_columns(scene, impact, vary, hold, most=None, texts=True)
    arguments = {**{f"impact.{name}": values for name, values in impact.items()}, **(vary or {})}
    dims, shape, columns, beside = laid_out(arrays, arguments)
    impacts = Impacts(loaded, columns, dims, shape, rtol, engine, names, held, beside)
    impacts.check()
    return into_memory(impacts)
