"""Protocol of certificates, and the margin by which they must hold."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from typing import Protocol

import numpy as np

from ...generated.automaton import CLOSING, STILL
from ..model.model import Model
from ..model.phases import Phase

# added to SAFETY at the watched level, so that rounding does not leave the certificate undecided at the event
BEYOND = 1.0


class Certainty(IntEnum):
    """Verdict of a certificate on a state; true if the pair never separates."""

    OPEN = 0
    CERTAIN = 1  # certain for practical purposes
    PROVED = 2

    @classmethod
    def of(cls, sticks: bool, theorem: bool = True) -> Certainty:
        return cls.OPEN if not sticks else cls.PROVED if theorem else cls.CERTAIN


def at_maximum(y: np.ndarray, phase: Phase) -> bool:
    """True if a phase starts here from a maximum of the gap."""
    return not phase.resting and phase.motion == CLOSING and abs(y[1]) <= STILL


def rests_for_good(model: Model, phase: Phase) -> bool:
    """True if nothing drives the rotation of a resting doublet but dry friction, which is proportional to the reaction.

    The reaction N obeys dN/dt = -k N with a finite k (`derive.checks.friction`), and never vanishes.
    """
    return phase.resting and (model.wall or not model.oblique or not (phase.shear or model.strings))


class Certificate(Protocol):
    """Interface of a certificate; it keeps no mutable state.

    `y` is the located state: the model's states, then the works against attractions.
    """

    # the watched event (`WatchedEvents.certificate`); for "energy", `y` includes the works
    watches: str | None

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        """The watched level: the energy (over m v0^2) below which the doublet at `y` is proved to stick, or the
        relative margin of the pendulum certificate; None if no event is watched.
        """

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        """The verdict on a stick at `y`.

        Arguments:
            maxima: states at the last maxima of the gap, `y` among them if it is one.
        """


class NoCertificate:
    """No certificate: an oblique doublet with a film alone separates, unless its angular momentum vanishes."""

    watches: str | None = None

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return None

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        return Certainty.OPEN
