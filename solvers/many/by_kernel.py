"""A batch of collisions by the Taylor kernel: columns of SI quantities in, columns of results out."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from ...generated import scaling
from ...generated.automaton import LAST_ANSWER
from ..engines.taylor.call import Impacts, run_kernel
from ..scene.contact import AT_ANY_SPEED, gap_at_any_speed, never_touching
from ..scene.entry_rules import FARTHEST
from ..scene.groups import formulas, si_values
from ..scene.quantities import NO_GLASS
from ..scene.scene import Scene
from ..settings import FEW
from .batch import Batch
from .columns import varied_columns

Block = dict[str, np.ndarray]
_STRETCH = 65536  # collisions in one call of the kernel, so that progress is reported and memory stays bounded
_MOST = 1e30  # largest magnitude of an SI quantity; its inverse is the smallest
_NEVER = ("glass_transition_pressure", "youngs_modulus")  # set very large to disable a rebound criterion
_NEAR = 1e-9  # relative distance to a limit of valid input below which the scene itself is validated


def collide_by_kernel(
    request: Batch, which: np.ndarray, threads: int, finished: Callable[[np.ndarray, Block], None]
) -> np.ndarray:
    """Compute the collisions `which` of a batch; returns the indices of those that need another engine.

    Arguments:
        finished: called with the indices and results of every finished block.
    """
    left = [which[:0]]
    for first in range(0, which.size, _STRETCH):
        part = which[first : first + _STRETCH]
        whole = part.size == request.size and bool((part == np.arange(part.size)).all())
        impacts, sound = impacts_of(request if whole else request.part(part))
        found = run_kernel(impacts, request.rtol, "rotation" in request.of, threads, few=request.size <= FEW)
        if found is None:
            return which
        kept = found["status"] <= LAST_ANSWER
        if part.size == kept.size and kept.all():  # the usual case; avoids copies
            finished(part, _block(request, found, impacts))
            continue
        done = sound.copy()
        done[sound] = kept
        finished(part[done], _block(request, found[kept], impacts.part(kept)))
        left.append(part[~done])
    return np.concatenate(left)


def impacts_of(request: Batch) -> tuple[Impacts, np.ndarray]:
    """The impacts of a batch in SI, and a mask of their collisions; the others need the scene's own validation."""
    scene = request.scene
    values: dict[str, np.ndarray] = {}
    with np.errstate(all="ignore"):  # overflow and NaN are excluded by the mask
        if request.vary:
            values = varied_columns(request)
            sound = _sound(scene, values)
            unit = scaling.stokes(values["reduced_radius"], values["reduced_mass"], values["viscosity"], 1.0)
        else:
            sound, unit = np.ones(request.size, bool), scene.stokes_per_speed
        speed = request.speed if request.speed is not None else np.asarray(request.stokes) / unit
        for name, column in (values or si_values(scene, None, None)).items():
            sound &= _usual(column, name)
        sound &= _usual(speed)
    impacts = Impacts(scene, speed, request.angle, values)
    return impacts if sound.all() else impacts.part(np.flatnonzero(sound)), sound


def _usual(values: np.ndarray | float, name: str = "") -> np.ndarray:
    """Mask of values with which no dimensionless group overflows; others are left to `nondimensionalise`."""
    size = np.abs(values)
    most = 1e200 if name in _NEVER else _MOST
    usual: np.ndarray = (size == 0) | ((size >= 1 / _MOST) & (size <= most))
    return usual


def _sound(scene: Scene, values: Mapping[str, np.ndarray]) -> np.ndarray:
    """Mask of collisions that satisfy `scene.entry_rules` with a margin; the scene itself validates the others."""
    film = values["film_thickness"]
    sound = np.ones(film.shape, bool)
    for word in AT_ANY_SPEED:
        sound &= gap_at_any_speed(word, values) < 1 - _NEAR
    rupture = film
    if scene.bridge is not None:
        formula, arguments = formulas(scene)["rupture_gap"]
        gap = np.asarray(formula(*(values[name] for name in arguments)))
        sound &= (gap > 1 + _NEAR) & np.isfinite(gap)
        rupture = gap * film
    if scene.pendulum is not None:
        sound &= values["string_length"] > (4 * values["reduced_radius"] + rupture / 2) * (1 + _NEAR)
    # attraction diverges at zero gap, and without glass criterion nothing stops the approach
    stopped = (scene.attraction is None) & (values["glass_transition_pressure"] < NO_GLASS)
    sound &= ~np.asarray(never_touching(values)) | stopped
    for ratio in ("radius_ratio", "mass_ratio"):
        if scene.partner is not None and ratio in values:
            sound &= (values[ratio] * FARTHEST > 1 + _NEAR) & (values[ratio] < FARTHEST * (1 - _NEAR))
    return sound


def _block(request: Batch, found: np.ndarray, impacts: Impacts) -> Block:
    """Kernel records as the requested columns of a result."""
    separated = found["outcome"] > 0

    def thickness() -> np.ndarray | float:
        return impacts.others.get("film_thickness", request.scene.liquid.film_thickness)

    def where(defined: np.ndarray, values: np.ndarray) -> np.ndarray:
        return np.where(defined, values, np.nan)

    columns: dict[str, Callable[[], np.ndarray]] = {
        "tangential_restitution": lambda: where(separated & (impacts.angle > 0), found["shown"][:, 1]),
        "contact_time": lambda: where(separated, found["time"] * thickness() / impacts.speed),
        "smallest_gap": lambda: where(separated, found["smallest_gap"] * thickness()),
        "rotation": lambda: where(separated, found["turned"]),
    }
    block: Block = {
        "outcome": found["outcome"].astype(np.int8),
        "certified": found["certified"] != 0,
        "restitution": np.where(separated, found["shown"][:, 0], 0.0),
    }
    return block | {name: column() for name, column in columns.items() if name in request.of}
