"""`collision_averages()`: outcomes and restitution averaged over impact geometry and speeds, for pairs of sizes."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..engines.settings import RTOL, check_rtol
from ..errors import InputError
from ..host.arguments import check_function, check_name
from ..host.outputs import check_file
from ..host.progress import Progress
from ..many.arguments import checked_numbers, first_accepted
from ..model.validity import warn
from ..scene.fields import Field, Range
from ..scene.scene import Scene
from .dataset import dataset
from .matrix import Request, averages
from .sizes import FILMS, FIXED
from .speeds import Speeds

if TYPE_CHECKING:
    import xarray

MOST = 400  # radii
_TOLERANCE = Field(
    "tolerance", "an error", "1e-6", Range("from 1e-9 to 1e-2", 1e-9, 1e-2, low_open=False, high_open=False)
)


def collision_averages(
    scene: Scene | str | Path,
    *,
    speeds: Any = None,
    radii: Any = None,
    films: str = FIXED,
    tolerance: float = 1e-6,
    rtol: float = RTOL,
    progress: Progress | None = None,
    resume: str | Path | None = None,
) -> xarray.Dataset:
    """Sticking probability and mean restitution over all collisions of a gas, for each pair of sizes.

    The direction of the relative velocity is isotropic, so that impact angles have the density sin(2 theta); its
    magnitude has the distribution `speeds`. The normal speed of a collision is V cos(theta). Spins are the scene's.

    Arguments:
        scene: a Scene, a path or a preset's name; its [impact] has no influence but for its spins.
        speeds: relative speeds V of the collisions: one, in m/s or as text; `"maxwell:0.3 m/s"`, those of a gas whose
            velocities have components of this standard deviation, weighted by their flux; a CSV file with the header
            `relative_speed,density`, or two arrays. Default the scene's relative speed.
        radii: radii (m) of the spheres; every pair of them is computed, beside a wall each radius. Default the scene's
            own pair. Densities are those of the scene.
        films: "fixed", the default: the film and the roughness are the scene's for every pair; "proportional": both
            grow with the sum of the radii, a coating with its sphere, a volume in m^3 with the cube of the sum.
        tolerance: absolute error of the quadrature, of the shares and of the means over all collisions. From 1e-9 to
            1e-2. Means over those that separate have it divided by their share.
        rtol: relative tolerance of the collisions, 1e-13..1e-3.
        progress: called with (pairs done, pairs in all) at the start and after every block.
        resume: where an interrupt leaves the finished pairs: in RESUME.KEY.partial, which the same call reads, and
            removes when it has computed the rest.

    Returns:
        Dataset over (radius, partner_radius), over (radius) beside a wall, or without dimensions:
        stick_probability, rotate_probability, bounce_probability (sum 1); restitution_all and
        tangential_restitution_all, means over all collisions in which a stick counts as 0; restitution_separated and
        tangential_restitution_separated, means over the collisions that separate, NaN where none does;
        kinetic_energy_loss, what all kinetic energy loses, rotation included, over that of the relative motion;
        normal_dissipation, the same of the normal motion alone, no cooling rate and negative where rotation feeds it;
        energy_into_rotation, the gain of the energy of rotation over the kinetic energy; of each its error as
        NAME_error; collision_rate, m^3/s, over both number densities (beside a wall m/s); reason of a failure, else "".

    Raises:
        InputError: an invalid name or value, or a scene with strings. A pair that fails raises nothing; it is marked.
        ComputationError: there is no compiled kernel of this scene here.

    Example:
        >>> from wetdoublet.solvers import collision_averages
        >>> found = collision_averages("granulation", speeds="1.5 m/s", tolerance=1e-4)
        >>> round(float(found.stick_probability), 3)
        0.355
    """
    loaded = Scene.load(scene)
    check_function(progress, "progress")
    request = _checked(loaded, speeds, radii, films, tolerance, rtol)
    beside = None if resume is None else check_file(resume, "resume", replaced=True)
    warn(loaded)
    return dataset(loaded, request.axes, averages(request, beside, progress), request.attributes())


def _checked(scene: Scene, speeds: Any, radii: Any, films: str, tolerance: float, rtol: float) -> Request:
    if scene.pendulum is not None:
        raise InputError("scene", scene.name, "a scene without [pendulum]", "has strings, so that nothing is isotropic")
    distribution = Speeds.of(scene.impact.relative_speed if speeds is None else speeds)
    axes: dict[str, np.ndarray] = {}
    if radii is not None:
        axis = checked_numbers("particles.radius", radii).reshape(-1)
        if not 1 <= np.unique(axis).size == axis.size <= MOST:
            raise InputError("radii", axis, f"1 to {MOST} different radii", f"has {axis.size}")
        axes = {"radius": axis} if scene.wall else {"radius": axis, "partner_radius": axis.copy()}
    request = Request(
        scene, distribution, axes, check_name(films, FILMS, "films"), _TOLERANCE.number(tolerance), check_rtol(rtol)
    )
    first_accepted(partial(request.scene_of, sizes) for sizes in request.sizes)
    return request
