"""What certificates have in common, and the margin by which they must hold."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum

import numpy as np

from ...generated.automaton import CLOSING, SAFETY, STILL
from ..model.model import Model
from ..model.phases import Phase
from ..scene.contact import contact_gap

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


def is_never_released(model: Model, phase: Phase) -> bool:
    """True if nothing drives the rotation of a resting doublet but dry friction, which is proportional to the reaction.

    The reaction N obeys dN/dt = -k N with a finite k (`derive.checks.friction`), and never vanishes.
    """
    return phase.resting and (model.wall or not model.oblique or not (phase.shear or model.strings))


class Certificate:
    """A certificate of a model, tried after the one beside it; it keeps no mutable state.

    `y` is the located state: the model's states, then the works against attractions.

    Arguments:
        beside: another certificate for the same model; its level is the watched event.
    """

    # the watched event (`WatchedEvents.certificate`); for "energy", `y` includes the works
    watches: str | None = None
    theorem: bool = True  # a stick is proved, not only certain for practical purposes
    beside: Certificate | None = None

    def __init__(self, model: Model, p: np.ndarray, rtol: float, beside: Certificate | None = None) -> None:
        self.model, self.p, self.rtol, self.margin, self.beside = model, p, rtol, SAFETY * rtol, beside
        self.groups = dict(zip(model.groups, p, strict=True))
        self.contact, self.end = contact_gap(self.groups), self.groups.get("rupture_gap", 1.0)
        if beside is not None:
            self.watches = beside.watches

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        """The watched level: the energy (over m v0^2) below which the doublet at `y` is proved to stick, or the
        relative margin of the pendulum certificate; None if no event is watched.
        """
        return self.beside.level(y, phase) if self.beside is not None else None

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        """The verdict on a stick at `y`; `maxima` are states at the last maxima of the gap, with `y` if it is one."""
        certainty = self.beside.decided(y, phase, maxima) if self.beside is not None else Certainty.OPEN
        return certainty or Certainty.of(self.sticks(y, phase, maxima), self.theorem)

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        """True if this certificate alone shows that the doublet at `y` sticks."""
        raise NotImplementedError

    def values(self, name: str, y: np.ndarray) -> dict[str, float]:
        """The results of a function of the model at the states `y`."""
        return self.model.values(name, y[: len(self.model.state)], self.p)


class NoCertificate(Certificate):
    """No certificate: an oblique doublet with a film alone separates, unless its angular momentum vanishes."""

    def __init__(self) -> None:
        """It needs no model."""

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        return False


def states_at(model: Model, gaps: np.ndarray, y: np.ndarray, orbital_momentum: float | None = None) -> np.ndarray:
    """The model's states of `y` at other gaps, a column each; with another orbital momentum, if there is one."""
    states = np.repeat(y[: len(model.state), None], gaps.size, axis=1)
    states[0] = gaps
    if orbital_momentum is not None:
        states[2] = orbital_momentum
    return states


def inward(
    model: Model, p: np.ndarray, gaps: np.ndarray, y: np.ndarray, orbital_momentum: float | None = None
) -> np.ndarray:
    """Inward force at these gaps, with the momenta of a state."""
    states = states_at(model, gaps, y, orbital_momentum)
    force: np.ndarray = np.asarray(model.function("inward_force")(states, p).full())[0]
    return force
