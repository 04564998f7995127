"""A sphere and a wall: the line of centres does not turn, so the planar kernel gives the motion in space exactly.

The normal motion does not depend on the tangential one. Friction is linear in sliding and rolling and the same in every
direction along the wall, so both components of these vectors go through one linear map. Two planar collisions with the
same normal motion give it: one that slides, and one that slides and spins. Spin along the normal stays as it is.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...generated.automaton import LAST_ANSWER, OUTCOMES, Status
from ..engines.casadi.locate import locate
from ..engines.taylor.call import Impacts, run_kernel
from ..errors import ComputationError, WetDoubletError
from ..model.dimensionless import nondimensionalise
from ..model.model import load, select_model
from .ends import FAILED, Ends
from .pairs import Pairs, dot, length

_SLIDES = np.pi / 4  # slides as fast as it approaches


@dataclass
class Planar:
    """Planar collisions with a wall; lengths over x0, times over x0/v0, speeds over that of the approach."""

    outcome: np.ndarray
    certified: np.ndarray
    reason: np.ndarray
    left: np.ndarray
    time: np.ndarray
    gap: np.ndarray
    opening: np.ndarray
    slide: np.ndarray
    roll: np.ndarray


def planar_by_kernel(impacts: Impacts, rtol: float, threads: int, few: bool) -> Planar | None:
    """Planar collisions by the kernel; None if none is available."""
    found = run_kernel(impacts, rtol, False, threads, few=few)
    if found is None:
        return None
    touch = found["status"] == Status.PROVED_AT_TOUCH
    reason = np.full(found.size, "", object)
    gap = np.where(touch, 1.0, found["final_gap"])
    opening, slide, _, roll = found["shown"].T[:4]
    left = found["status"] > LAST_ANSWER
    sure = found["certified"] != 0
    return Planar(found["outcome"], sure, reason, left, found["time"], gap, opening, slide, roll)


def planar_by_casadi(impacts: Impacts, rtol: float) -> Planar:
    """Planar collisions by Rosenbrock, one after the other."""
    size = impacts.speed.size
    time, gap, opening, slide, roll = (np.full(size, np.nan) for _ in range(5))
    outcome, reason = np.full(size, FAILED), np.full(size, "", object)
    found = Planar(outcome, np.zeros(size, bool), reason, np.zeros(size, bool), time, gap, opening, slide, roll)
    for k in range(size):
        scene = impacts.scene.with_entries({"impact.spin": float(impacts.others["impact_spin"][k])})
        try:
            n = nondimensionalise(scene, float(impacts.speed[k]), float(impacts.angle[k]))
            try:
                path = locate(load(select_model(scene, True)), n.groups, rtol, (), False)
            except ComputationError as error:
                raise n.in_si(error) from None
        except WetDoubletError as error:
            found.reason[k] = str(error)
            continue
        shown = path.model.values("outputs", path.y, path.p)
        outcome[k], found.certified[k] = OUTCOMES.index(path.outcome), path.certified
        time[k], gap[k], opening[k] = path.time, float(path.y[0]), shown["restitution"]
        slide[k], roll[k] = shown["tangential_restitution"], shown["final_spin"]
    return found


def beside_wall(pairs: Pairs, planar: Callable[[Impacts], Planar | None]) -> tuple[Ends, np.ndarray] | None:
    """Ends of collisions with a wall, and a mask of those left to another engine; None if `planar` has no engine.

    Arguments:
        planar: computes planar collisions.
    """
    radius = float(pairs.scene.material["reduced_radius"])
    speed, angle = -pairs.opening, np.full(pairs.size, _SLIDES)
    slides = planar(Impacts(pairs.scene, speed, angle, {"impact_spin": np.zeros(pairs.size)}))
    both = planar(Impacts(pairs.scene, speed, angle, {"impact_spin": speed / radius}))
    if slides is None or both is None:
        return None
    # sliding is that of the sphere along the wall; rolling turns it about normal x sliding
    sliding = -pairs.sliding
    rolling = radius * np.cross(pairs.normal, pairs.spins[:, 0])
    ends = Ends.blank(pairs.size)
    for name in ("outcome", "certified", "reason"):
        getattr(ends, name)[:] = getattr(slides, name)
    thickness = float(pairs.scene.material["film_thickness"])
    ends.time[:] = slides.time * thickness / speed
    ends.gap[:] = slides.gap * thickness
    ends.opening[:] = speed * slides.opening
    ends.normal[:] = pairs.normal
    ends.turning[:] = 0.0
    alone = slides.slide[:, None], slides.roll[:, None]
    more = (both.slide - slides.slide)[:, None], (both.roll - slides.roll)[:, None]
    later = [one * sliding + other * rolling for one, other in zip(alone, more, strict=True)]
    ends.sliding[:] = later[0]
    twist = dot(pairs.spins[:, 0], pairs.normal) * pairs.normal
    ends.spins[:, 0] = np.cross(later[1], pairs.normal) / radius + twist
    first, last = length(sliding - rolling), length(later[0] - later[1])
    with np.errstate(all="ignore"):
        ends.slip[:] = np.where((first > 0) & (ends.outcome > 0), last / first, np.nan)
    return ends, slides.left | both.left
