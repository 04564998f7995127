"""Many collisions by the kernel with derivatives: one direction for each group that the quantities affect."""

import ctypes
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ....generated.automaton import LOOSEST
from ...errors import ComputationError
from ...results import DEFINITIONS
from ...scene.groups import si_values
from ...scene.scene import Scene
from ..settings import KERNEL_STEPS
from .build import kernel, kernel_supports
from .call import KernelImpacts, task, variant
from .layout import ANSWER, MOST_STEPS, NEARNESS, RESULTS, derivative_column, names, result
from .orders import order_backward, order_for
from .source import Variant

CHATTERS, GRIPS = 5, 10  # boundaries: of a trajectory with resting contact; of a rebound with friction
DISTANCES = {  # boundaries whose measure is a distance reported by `sensitivities`
    7: ("glass criterion met at initial contact", "impact.stokes"),
    GRIPS: ("switch between sliding and sticking contact", "particles.friction"),
}
STRICTER = 4.0  # stricter tolerance, by this factor, of steps that are not limited by directions
_SPINS = {"impact_spin": "initial_spin", "impact_partner_spin": "initial_partner_spin"}
_CHUNK = 1024  # number of collisions whose derivatives are computed at a time


Scales = Mapping[str, tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class Carried:
    """Answers, and derivatives of their dimensionless results by quantities in SI.

    Arguments:
        answers: of ANSWER, one per collision.
        slopes: (collisions, quantities, RESULTS); zero unless the doublet separated.
        near: (collisions, 3), for separated doublets: the least measure of the distance to a boundary, that boundary
            (runtime/tangents.h), and the least measure of those not in DISTANCES.
        quantities: names in the vocabulary, in the order of `slopes`.
    """

    answers: np.ndarray
    slopes: np.ndarray
    near: np.ndarray
    quantities: tuple[str, ...]

    def along(self, name: str, moved: Mapping[str, np.ndarray], scales: Scales) -> tuple[np.ndarray, np.ndarray]:
        """A result, (collisions,), and its derivatives, (collisions, parameters or 1), SI, by the chain rule.

        Arguments:
            moved: quantity -> its derivatives by the parameters, (collisions or 1, parameters).
            scales: scale of a result -> its values (collisions,), and the derivatives of its logarithm, likewise.
        """
        value, column = result(self.answers, name), derivative_column(name)
        slopes = np.zeros((value.size, 1))
        for quantity, by_parameter in moved.items():
            if quantity in self.quantities:
                slopes = slopes + self.slopes[:, self.quantities.index(quantity), column, None] * by_parameter
        if (unit := DEFINITIONS[name].scale) is not None:
            scale, relative = scales[unit]
            return value * scale, (slopes + value[:, None] * relative) * scale[:, None]
        return value, slopes


def run_tangent(
    impacts: KernelImpacts,
    oblique: bool,
    rtol: float,
    rotation: bool,
    moved: Sequence[str] | None = None,
    order: int | None = None,
    budget: int = KERNEL_STEPS,
    backward: bool = False,
    fold: bool = True,
    nearest: float = 0.0,
) -> Carried:
    """Derivatives of impacts that are all oblique, or all head-on; ComputationError if no kernel is available.

    Arguments:
        moved: quantities to differentiate by; None: all.
        order: of the series; None: that of the tolerance.
        backward: of the restitution alone, by the adjoint, at about the cost of one direction.
            Trajectories of more than some hundred steps get no answer.
        fold: treat a pair of equal spheres as such; False where a quantity of one sphere alone varies.
        nearest: by the adjoint, derivatives of collisions nearer to a boundary by their measure are left at zero.
    """
    order = order or (order_backward if backward else order_for)(min(rtol, LOOSEST))
    scene = impacts.scene
    wanted = variant_of(scene, oblique, order, rotation, backward, fold, impacts.small)
    check_derivatives(scene, oblique)
    library = kernel(wanted)
    if backward:
        budget, rtol = min(budget, MOST_STEPS), min(rtol, LOOSEST) / STRICTER
    quantities, groups = names(library, "quantity_names"), names(library, "group_names")
    spinning = any(np.any(si_values(scene, None, None).get(name, 0.0)) for name in _SPINS)
    count, results = impacts.angle.size, 1 if backward else RESULTS
    answers, slopes = np.zeros(count, ANSWER), np.zeros((count, len(quantities), results))
    near = np.full(count, np.inf, NEARNESS)
    for first in range(0, count, _CHUNK):
        rows = slice(first, min(first + _CHUNK, count))
        call = task(library, impacts.subset(rows), min(rtol, LOOSEST), budget, answers[rows])
        call.number("nearest", nearest)
        call.number("requested", _groups_moved(library, quantities, moved, spinning))
        call.buffer("by_group", np.zeros((rows.stop - first, len(groups), results)))
        call.buffer("gradients", slopes[rows])
        call.buffer("near", near[rows])
        call.run()
    measures = near.view("f8").reshape(count, -1)
    return Carried(answers, slopes, measures, quantities)


def check_derivatives(scene: Scene, oblique: bool) -> None:
    """Raise ComputationError unless the kernel differentiates the scene's collisions on this machine."""
    if not kernel_supports(scene, (oblique,), gradients=True):
        raise ComputationError(
            "derivatives by the compiled kernel are needed, which this scene or machine has not",
            advice="install a C compiler, or leave out declared events and laws that have no derivative",
        )


def variant_of(
    scene: Scene,
    oblique: bool,
    order: int,
    rotation: bool,
    backward: bool = False,
    fold: bool = True,
    small: bool = False,
) -> Variant:
    """The variant of the kernel that differentiates a scene's collisions."""
    plain = variant(scene, oblique, LOOSEST, rotation, fold=fold, small=small)
    return replace(plain, order=order, gradients=True, backward=backward)


def _groups_moved(
    library: ctypes.CDLL, quantities: tuple[str, ...], moved: Sequence[str] | None, spinning: bool
) -> int:
    """The groups affected by these quantities, as bits; groups of spins that are zero are moved by spins alone."""
    bits = (ctypes.c_uint * len(quantities)).in_dll(library, "moved_groups")
    still = sum(1 << k for k, group in enumerate(names(library, "group_names")) if group in _SPINS.values())
    affected = 0
    for name, moves in zip(quantities, bits, strict=True):
        if moved is None or name in moved:
            affected |= moves if spinning or name in _SPINS else moves & ~still
    return affected
