"""The exact boundaries in the window of a regime map, for its picture."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from ..errors import ComputationError, InputError, ModelWarning
from ..many.plot_map import Curve, panels
from ..many.regime_map import impact_axis, scene_of
from ..scene.scene import Scene
from ..scene.user_model import Package
from .atlas_curves import curves_of
from .plane import ANGLE, check_plane

if TYPE_CHECKING:
    import xarray

_PATIENCE = 300  # undecided collisions, after which a picture goes without boundaries
_LINES = 5  # seed lines of constant angle; the lattice of the atlas finds the curves between them


def map_curves(data: xarray.Dataset, package: Package | None = None) -> dict[int, list[Curve]]:
    """The boundaries of each panel of a map: angles (rad) of every curve, and Stokes numbers or speeds (m/s).

    Nothing for a panel of one angle or one Stokes number, of a scene whose model declares events (there is no atlas of
    it), or that cannot be.

    Arguments:
        package: the scene's own model; a map only describes it, so that without its files there are no boundaries.
    """
    base = scene_of(data)
    if package is not None:
        base = Scene(base.name, base.given, base.comments, package)
    if base.package is not None and (base.package.folder is None or base.package.bends):
        return {}  # only described, or without atlas
    angles = data["angle"].values
    impact = impact_axis(data)
    values = data[impact].values
    if min(angles.size, values.size) < 2 or values.min() <= 0:
        return {}
    varied = [str(name) for name in data["outcome"].dims if name not in ("angle", impact)]
    sizes = [data.sizes[name] for name in varied]
    curves: dict[int, list[Curve]] = {}
    for place in panels(data):
        index = np.unravel_index(place, sizes) if varied else ()
        entries = {name: float(data[name].values[k]) for name, k in zip(varied, index, strict=True)}
        curves[place] = []
        try:
            scene = base.with_si(entries)
        except InputError:  # its cells are marked as failed
            continue
        try:
            curves[place] = _curves(scene, angles, values, impact, data.attrs["rtol"])
        except ComputationError as error:
            warnings.warn(f"the picture lacks boundaries: {error}", ModelWarning, stacklevel=2)
    return curves


def _curves(scene: Scene, angles: np.ndarray, values: np.ndarray, impact: str, rtol: float) -> list[Curve]:
    unit = np.array(1.0 if impact == "stokes" else scene.stokes_per_speed)

    def normal(angle: np.ndarray) -> np.ndarray:
        """The Stokes number of an impact of 1 on the map's axis."""
        return unit * np.cos(angle) if impact == "relative_speed" else unit

    span = (float(angles.min()), float(angles.max()))
    window = (float(values.min() * normal(np.array(span[1]))), float(values.max() * normal(np.array(span[0]))))
    plane = check_plane(scene, ANGLE, span, window, rtol)
    plane.patience = _PATIENCE
    atlas = curves_of(plane, _LINES, lambda *_: None)
    return [(np.array(curve.x), np.array(curve.stokes) / normal(np.array(curve.x))) for curve in atlas.curves]
