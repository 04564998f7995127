"""What a proof is that a doublet never separates, and by how much it must hold."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ..model.phases import Phase

BEYOND = (
    1.0  # more of SAFETY at the level a trajectory stops at, so that rounding there does not leave the proof undecided
)


class Proof(Protocol):
    """The interface of a proof. `y` is the locating state: the model's states, then the works against attractions."""

    theorem: bool  # a stick found by it is proved, not only certain for practical purposes
    watches: (
        str | None
    )  # what a trajectory watches for (`WatchedEvents.certificate`); by "energy", `y` carries the works

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        """What is watched for: the energy (over m v0^2) below which the doublet at `y` is proved to stick, or the
        relative margin of the proof on strings; None if there is nothing to watch for.
        """

    def decided(self, y: np.ndarray, phase: Phase) -> bool:
        """Whether the stick is proved at `y`."""


class NoProof:
    """No certificate: an oblique doublet with a film alone always parts; on strings none but `TetherProof` is known."""

    theorem = False
    watches: str | None = None

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return None

    def decided(self, y: np.ndarray, phase: Phase) -> bool:
        return False
