"""What a proof is that a doublet never separates, and by how much it must hold."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from typing import Protocol

import numpy as np

from ...generated.automaton import CLOSING
from ..model.phases import Phase

STILL = 1e-9  # of v0: slower is a turning point
# more of SAFETY at the level where a trajectory stops, so that rounding there does not leave the proof undecided
BEYOND = 1.0


class Certainty(IntEnum):
    """Verdict of a proof on a state; true if the two never separate."""

    OPEN = 0
    CERTAIN = 1  # for practical purposes
    PROVED = 2

    @classmethod
    def of(cls, sticks: bool, theorem: bool = True) -> Certainty:
        return cls.OPEN if not sticks else cls.PROVED if theorem else cls.CERTAIN


def at_maximum(y: np.ndarray, phase: Phase) -> bool:
    """Whether a phase starts here from a maximum of the gap."""
    return not phase.resting and phase.motion == CLOSING and abs(y[1]) <= STILL


class Certificate(Protocol):
    """The interface of a proof, which has no state of its own.

    `y` is the locating state: the model's states, then the works against attractions.
    """

    # what a trajectory watches for (`WatchedEvents.certificate`); with "energy", `y` carries the works
    watches: str | None

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        """What is watched for: the energy (over m v0^2) below which the doublet at `y` is proved to stick, or the
        relative margin of the proof on strings; None if there is nothing to watch for.
        """

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        """Whether the stick is decided at `y`.

        Arguments:
            maxima: states at the last maxima of the gap, `y` among them if it is one.
        """


class NoCertificate:
    """No certificate. With a film alone an oblique doublet always parts; on strings see `PendulumCertificate`."""

    watches: str | None = None

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return None

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        return Certainty.OPEN
