"""Derivatives by the Taylor kernel in a scene's parameters, of one collision or of many of the same scene."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...generated.automaton import LAST_ANSWER, OUTCOMES
from ..engines.kernels import differentiates
from ..engines.settings import KERNEL_STEPS
from ..engines.taylor.call import Impacts
from ..engines.taylor.layout import derivative_column, result
from ..engines.taylor.orders import order_for
from ..engines.taylor.tangent import GRIPS, Carried, run_tangent
from ..model.dimensionless import nondimensionalise
from ..results import DEFINITIONS, TANGENTS
from ..scene.groups import si_values
from ..scene.scene import Scene
from ..scene.schema import SPINS
from .boundary_distance import check_grip
from .parameters import RELATIVE, SCALES, Kind, parameter_map, references
from .problem import Problem, Query, Slopes

BACKWARD = ("restitution",)  # results that the kernel's adjoint differentiates
DIRECTIONS = 4  # most parameters for which forward tangents cost no more than the adjoint (docs/engineering/kernel.md)
SPEED, ANGLE = 1.0, 0.5  # impact (m/s, rad) at which parameters are mapped; others follow by their powers
_OF_UNEQUAL = frozenset(("radius_ratio", "mass_ratio"))  # quantities that make equal spheres unequal
_TURNS = tuple(name for name in TANGENTS if DEFINITIONS[name].odd or name == "tangential_restitution")


def offers(scene: Scene, of: Sequence[str], oblique: Collection[bool] = (True, False)) -> bool:
    """True if the kernel differentiates these results of the scene, for oblique and head-on collisions as requested."""
    return all(name in TANGENTS for name in of) and differentiates(scene, oblique)


@dataclass(frozen=True)
class Along:
    """Results of collisions and their derivatives in theta, p = p_ref (1 + theta), SI.

    Arguments:
        run: the kernel's records.
        value: (results, collisions); NaN for sticks and undefined results.
        first: (results, collisions, parameters).
        units: dp/dtheta at SPEED and, of oblique collisions, ANGLE, (parameters,).
    """

    run: Carried
    value: np.ndarray
    first: np.ndarray
    units: np.ndarray


def gradients_by_kernel(
    impacts: Impacts,
    kind: Kind,
    wrt: tuple[str, ...],
    of: tuple[str, ...],
    rtol: float,
    order: int | None = None,
    budget: int = KERNEL_STEPS,
    backward: bool = False,
    nearest: float = 0.0,
) -> Along | None:
    """Derivatives of impacts that are all oblique or all head-on; None without a kernel.

    Arguments:
        impacts: impacts of one scene, which differ only in speed and angle.
        order: order of the Taylor series; None for the cheapest at the tolerance.
        backward: differentiate the restitution alone by the adjoint (`run_tangent`).
        nearest: as for `run_tangent`.
    """
    scene, size = impacts.scene, impacts.angle.size
    angle, oblique = ANGLE if impacts.angle[0] > 0 else 0.0, bool(impacts.oblique[0])
    at = _at_reference(scene, kind, wrt, angle)
    fold = not _OF_UNEQUAL & at.moved.keys()
    derivatives = run_tangent(
        impacts, oblique, rtol, "rotation" in of, tuple(at.moved), order, budget, backward, fold, nearest
    )
    if derivatives is None:
        return None
    # the quantities' derivatives are those at the reference, except for speed and angle
    paces = {"speed": impacts.speed / SPEED, "angle": impacts.angle / angle if angle else np.ones(impacts.angle.size)}
    steep = _steep(impacts.angle) if kind.held == RELATIVE and angle > 0 and "impact.angle" in wrt else None
    value, first = np.full((len(of), size), np.nan), np.zeros((len(of), size, len(wrt)))
    separated, at_once = derivatives.answers["outcome"] > 0, derivatives.answers["time"] == 0
    unspun = scene.particles.friction is None and not scene.turns(0.0)
    bent = np.ones((1 if steep is None else size, len(wrt)))  # of rows of the speed, over those of the reference
    if steep is not None:
        bent[:, wrt.index("impact.angle")] = steep / _steep(np.array(angle))
    scales = _scales(impacts, at.scales, wrt, steep) if any(DEFINITIONS[name].scale for name in of) else {}
    for place, name in enumerate(of):
        if name == "tangential_restitution" and angle == 0:
            continue
        if not oblique and name in _TURNS:
            if DEFINITIONS[name].odd:
                value[place, separated] = 0.0
            continue
        plain, column = result(derivatives.answers, name), derivative_column(name)
        sums = np.zeros((len(wrt), size))
        for quantity, row in at.moved.items():  # a quantity moves with few parameters
            if quantity not in derivatives.quantities:
                continue
            paced = derivatives.slopes[:, derivatives.quantities.index(quantity), column] * paces.get(quantity, 1.0)
            for k in np.flatnonzero(row).tolist():
                sums[k] += row[k] * paced
            if steep is not None and quantity == "speed":
                sums += (row * (bent - 1)).T * paced
        first[place] = sums.T
        if name == "final_spin" and unspun:  # parted at initial contact: the spin is zero up to rounding
            plain = np.where(at_once, 0.0, plain)
            first[place] *= np.isin(wrt, SPINS) | ~at_once[:, None]
        if (unit := DEFINITIONS[name].scale) is not None:
            scale, relative = scales[unit]
            first[place] = (first[place] + plain[:, None] * relative) * scale[:, None]
            plain = plain * scale
        value[place, separated] = plain[separated]
    return Along(derivatives, value, first, at.units)


@dataclass(frozen=True)
class _Reference:
    """Derivatives in theta at SPEED: of the quantities in SI that the parameters move, and of the scales; dp/dtheta."""

    moved: Mapping[str, np.ndarray]
    scales: Mapping[str, np.ndarray]
    units: np.ndarray


@lru_cache(maxsize=64)
def _at_reference(scene: Scene, kind: Kind, wrt: tuple[str, ...], angle: float) -> _Reference:
    names = tuple(name for name in si_values(scene, SPEED, angle) if name != "density")
    mapped, units = parameter_map(kind, wrt, names).slopes(references(scene, kind, SPEED, angle))
    slopes = np.asarray(mapped.full())
    moved = {name: row for name, row in zip(names, slopes, strict=False) if row.any()}
    scales = dict(zip(SCALES, slopes[len(names) :], strict=True))
    return _Reference(moved, scales, np.asarray(units.full()).ravel())


def slopes(problem: Problem, query: Query) -> Slopes | None:
    """Derivatives of one collision; None if the kernel has none, or at its tolerance another outcome."""
    path, of, rtol = problem.path, query.of, query.rtol
    if not path.separated or not offers(problem.scene, of, (problem.n.oblique,)):
        return None
    sharp = query.sharpened(path.parting)
    along = gradients_by_kernel(Impacts.single(problem.n), problem.kind, problem.wrt, of, sharp, order_for(rtol))
    if along is None:
        return None
    answer = along.run.answers[0]
    if answer["status"] > LAST_ANSWER or OUTCOMES[answer["outcome"]] != path.outcome:
        return None
    if along.run.near[0, 1] == GRIPS:
        check_grip(float(along.run.near[0, 0]), rtol)
    return Slopes(along.value[:, 0], along.first[:, 0])


def _steep(angle: np.ndarray) -> np.ndarray:
    """-d ln(normal speed)/d ln(angle) at fixed relative speed."""
    return np.asarray(angle * np.tan(angle))


def _scales(
    impacts: Impacts, slopes: Mapping[str, np.ndarray], wrt: tuple[str, ...], angle_slope: np.ndarray | None
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """SI scales of results by name: values (collisions,), and derivatives of their logarithms (collisions, parameters).

    Arguments:
        angle_slope: -d ln(normal speed)/d ln(angle) at fixed relative speed; None where the normal speed is held.
    """
    n = nondimensionalise(impacts.scene, SPEED, ANGLE if impacts.angle[0] > 0 else 0.0)
    values = {"length": np.full_like(impacts.speed, n.length), "time": n.time / (impacts.speed / SPEED)}
    values["rate"] = impacts.rates
    reference = {"length": n.length, "time": n.time, "rate": n.rate or 1.0}
    relative = {name: np.tile(slopes[name] / reference[name], (impacts.size, 1)) for name in reference}
    if angle_slope is not None and "impact.angle" in wrt:
        k = wrt.index("impact.angle")
        relative["time"][:, k], relative["rate"][:, k] = angle_slope, -angle_slope
    return {name: (values[name], relative[name]) for name in values}
