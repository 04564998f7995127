"""Derivatives by the Taylor kernel in a scene's parameters, of one collision or of many of the same scene."""

from collections.abc import Collection, Sequence

import numpy as np

from ...generated.automaton import LAST_ANSWER, OUTCOMES
from ..engines.kernels import differentiates
from ..engines.settings import KERNEL_STEPS
from ..engines.taylor.call import KernelImpacts
from ..engines.taylor.orders import order_for
from ..engines.taylor.tangent import GRIPS, Carried, Scales, run_tangent
from ..results import DEFINITIONS, TANGENTS
from ..scene.groups import si_values
from ..scene.scene import Scene
from ..scene.schema import SPINS
from .boundary_distance import check_grip
from .parameters import SCALES, Kind, parameter_map, references
from .problem import Problem, Query, Slopes

BACKWARD = ("restitution",)  # results that the kernel's adjoint differentiates
DIRECTIONS = 4  # most parameters for which forward tangents cost no more than the adjoint (docs/engineering/kernel.md)
_OF_UNEQUAL = frozenset(("radius_ratio", "mass_ratio"))  # quantities that make equal spheres unequal


def offers(scene: Scene, of: Sequence[str], oblique: Collection[bool] = (True, False)) -> bool:
    """True if the kernel differentiates these results of the scene, for oblique and head-on collisions as requested."""
    return all(name in TANGENTS for name in of) and differentiates(scene, oblique)


Along = tuple[Carried, np.ndarray, np.ndarray]
"""The kernel's records, results (results, collisions), and their derivatives (results, collisions, parameters), SI.

Sticks and undefined results are NaN.
"""


def gradients_by_kernel(
    impacts: KernelImpacts,
    kind: Kind,
    wrt: tuple[str, ...],
    of: tuple[str, ...],
    rtol: float,
    order: int | None = None,
    budget: int = KERNEL_STEPS,
    backward: bool = False,
    nearest: float = 0.0,
) -> Along:
    """Derivatives of impacts that are all oblique or all head-on; ComputationError without a kernel.

    Arguments:
        impacts: impacts of one scene, which differ only in speed and angle.
        order: order of the Taylor series; None for the cheapest at the tolerance.
        backward: differentiate the restitution alone by the adjoint (`run_tangent`).
        nearest: as for `run_tangent`.
    """
    scene, head_on, oblique = impacts.scene, not impacts.angle[0] > 0, bool(impacts.oblique[0])
    moved, scales, units = _in_theta(impacts, kind, wrt)
    fold = not _OF_UNEQUAL & moved.keys()
    run = run_tangent(impacts, oblique, rtol, "rotation" in of, tuple(moved), order, budget, backward, fold, nearest)
    value, first = np.full((len(of), impacts.size), np.nan), np.zeros((len(of), impacts.size, len(wrt)))
    separated, at_once = run.answers["outcome"] > 0, run.answers["time"] == 0
    unspun = scene.particles.friction is None and not scene.turns(0.0)
    for place, name in enumerate(of):
        odd = DEFINITIONS[name].odd
        if name == "tangential_restitution" and (head_on or not oblique):
            continue
        if odd and not oblique:
            value[place, separated] = 0.0
            continue
        plain, first[place] = run.along(name, moved, scales)
        if name == "final_spin" and unspun:  # parted at initial contact: the spin is zero up to rounding
            plain = np.where(at_once, 0.0, plain)
            first[place] *= np.isin(wrt, SPINS) | ~at_once[:, None]
        value[place, separated] = plain[separated]
    return run, value, first / units


def _in_theta(
    impacts: KernelImpacts, kind: Kind, wrt: tuple[str, ...]
) -> tuple[dict[str, np.ndarray], Scales, np.ndarray]:
    """Derivatives of quantities and scales in theta, as `Carried.along` takes them, and dp/dtheta of each impact.

    Only those of speed, angle and scales differ from impact to impact.
    """
    scene, own = impacts.scene, ("speed", "angle")
    reference = references(scene, kind.entries, impacts.speed, impacts.angle)
    names = tuple(name for name in si_values(scene, None, None) if name != "density")
    alike = parameter_map(kind, wrt, names).at(reference[:, 0])[1]
    numbers, in_theta, units = parameter_map(kind, wrt, own).at(reference)
    slopes = dict(zip((*own, *SCALES), in_theta, strict=True)) | {name: alike[k][None] for k, name in enumerate(names)}
    values = dict(zip(SCALES, numbers[len(own) :], strict=True))
    with np.errstate(divide="ignore", invalid="ignore"):  # head-on nothing has the scale of rates
        scales = {name: (value, slopes[name] / value[:, None]) for name, value in values.items()}
    return {name: slopes[name] for name in (*names, *own) if slopes[name].any()}, scales, units


def slopes(problem: Problem, query: Query) -> Slopes | None:
    """Derivatives of one collision; None if the kernel has none, or at its tolerance another outcome."""
    path, of, rtol = problem.path, query.of, query.rtol
    if not path.separated or not offers(problem.scene, of, (problem.n.oblique,)):
        return None
    sharp = query.sharpened(path.parting)
    impact, order = KernelImpacts.single(problem.n), order_for(rtol)
    run, value, first = gradients_by_kernel(impact, problem.kind, problem.wrt, of, sharp, order)
    answer, (distance, boundary, _) = run.answers[0], run.near[0]
    if answer["status"] > LAST_ANSWER or OUTCOMES[answer["outcome"]] != path.outcome:
        return None
    if boundary == GRIPS:
        check_grip(float(distance), rtol)
    return value[:, 0], first[:, 0]
