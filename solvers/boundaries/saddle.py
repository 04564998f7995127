"""The saddle of an escape: rigid rotation at the maximum of the effective potential, and its modes."""

from dataclasses import dataclass

import numpy as np
from casadi import Function, jacobian

from ..certificates import Barrier, energy_proof
from ..engines.casadi.locate import EventLocator
from ..host.thread_caches import own_cache
from ..model.model import Model
from ..model.phases import Region


def barrier_of(probe: EventLocator) -> Barrier | None:
    """The highest maximum of the effective potential for the angular momentum at the end of the trajectory."""
    proof = energy_proof(probe.proof)
    if proof is None:
        return None
    barriers = proof.barriers(probe.y)
    return barriers[0] if barriers else None


@dataclass(frozen=True)
class Saddle:
    """Rigid rotation at the barrier, and its linearised dynamics.

    Arguments:
        modes: left eigenvectors as rows; the product with a deviation is each mode's amplitude, as its part of the gap.
        rates: the eigenvalues.
        unstable: index of the growing mode.
    """

    gap: float
    state: np.ndarray
    modes: np.ndarray
    rates: np.ndarray
    unstable: int

    def nearest(self, states: np.ndarray) -> tuple[int, np.ndarray]:
        """Index of the nearest of the states (columns), and its amplitudes."""
        amplitudes = self.modes @ (states[: self.state.size] - self.state[:, None])
        k = int(np.argmin(np.sum(np.abs(amplitudes) ** 2, axis=0)))
        return k, amplitudes[:, k]


def saddle_of(probe: EventLocator, barrier: Barrier) -> Saddle | None:
    """The saddle at a barrier for the trajectory's angular momentum; None without a growing mode."""
    film = int(barrier.gap < 1 or not probe.model.edged)
    # cavitated: a doublet that escapes passes the saddle with a growing gap
    region = Region(film, shear=int(barrier.gap < probe.edge), resting=False, cavitated=probe.model.cavitates)
    model, gap, p = probe.model, barrier.gap, probe.p
    rest = np.concatenate([[gap, 0.0], probe.y[2 : len(model.state)]])
    # where the tangential force is cut off, nothing drives a doublet to rigid rotation: it is at rest in its gap
    rigid = np.array(list(model.values("rigid_rotation", rest, p).values())) if region.shear else rest
    matrix = np.asarray(_jacobian(model, region)(rigid, p).full())
    values, vectors = np.linalg.eig(matrix)
    unstable = int(np.argmax(values.real))
    if values[unstable].real <= 0 or vectors[0, unstable] == 0:
        return None
    shapes = vectors / np.where(vectors[0] == 0, 1, vectors[0])
    return Saddle(gap, rigid, np.linalg.inv(shapes), values, unstable)


@own_cache(128)
def _jacobian(model: Model, region: Region) -> Function:
    rates = model.function("right_hand_side", **region.flags)
    y, p = model.column, model.parameters
    return Function("jacobian", [y, p], [jacobian(rates(y, p), y)])
