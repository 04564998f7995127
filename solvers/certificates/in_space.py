"""Two spheres in space that stay together: every rebound ends below the last maximum, or they tumble as one body."""

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import comes_back, tumbles_for_good
from ..model.phases import Phase
from .base import Certificate, at_maximum
from .energy_barrier import EnergyCertificate


class ReboundCertificate(Certificate):
    """Two spheres in space, with attractions that fall with the gap: what a rebound takes outweighs the rotation.

    At a maximum x of the gap let P be the attraction, and C a bound of the centrifugal force at this gap and below. If
    C < (1 - e_dry^2) P, the gap stays at x or below: the net force is inward, so that only a rebound, at some gap y,
    ends the approach. The speed there is at most that by the attraction's work W from x. After the rebound e_dry^2 W is
    left of this energy, and it takes at least W - C (x - y) to come back to x; W is at least P (x - y).

    The kinetic energy of rotation grows by the attraction's work down to the contact at most, and what of it is beyond
    L^2/(2 I) bounds the orbital momentum (`derive.checks.space.least_energy_in_space`). At smaller gaps the bound is
    larger by the fourth power of the ratio of the centre distances at most (`outward_at_smaller_gaps` there).
    """

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        if not at_maximum(y, phase) or not 0.0 < self.contact < y[0]:
            return False
        ratio, aspect = self.groups["radius_ratio"], self.groups["aspect"]
        centres = (1 + ratio) ** 2 / ratio  # R_1 + R_2 over a
        here = self.values("resting_bound", y)
        at_contact = self.values("resting_bound", np.array([self.contact, *y[1:]]))
        work = max(0.0, at_contact["inward"]) * (float(y[0]) - self.contact)
        far, near = (centres + aspect * gap for gap in (float(y[0]), self.contact))
        outward = (np.sqrt(here["outward"]) + np.sqrt(2 * work * aspect / far)) ** 2 * (far / near) ** 4
        return bool(comes_back(outward, (1 - self.groups["dry_restitution"] ** 2) * here["inward"], self.margin))


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
