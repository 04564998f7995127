"""Criterion for a doublet that tumbles in space: held, whatever its angular momentum does, but without a proof."""

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import tumbles_for_good
from ..model.phases import Phase
from .base import Certificate
from .energy_barrier import EnergyCertificate


class TumblingCertificate(Certificate):
    """A stick of two spheres in space that move as one body.

    Twist about the line of centres has no friction to leading logarithm. Where the film lets little slip, a doublet
    with twist precesses like a top, and loses energy slowly while the line of centres turns across the angular momentum
    L. Its energy stays above the barrier meanwhile, although twist cannot separate the spheres. The criterion leaves
    twist out and takes all of L across the line of centres, where it turns to: the doublet is held if this energy is
    below the barrier. It is taken only where little else is left than the motion of one body. As slip takes some energy
    out of twist, this is no theorem.

    Arguments:
        beside: the energy certificate.
    """

    theorem = False
    beside: EnergyCertificate

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        rest, rigid = self.values("wobble", y)["wobble"], self.values("effective_potential", y)["energy"]
        ahead = self.beside.ahead(y)
        work, largest = self.beside.work(y), self.beside.largest
        return ahead is not None and bool(tumbles_for_good(rest, rigid, work, ahead.height, self.margin, largest))
