"""Certificates beside declared events of a user's model: they hold where no such event can happen any more.

The energy certificate is taken for the forces that act now: its barriers are searched anew at every decision, and the
work of the attractions is that from the gap of initial contact at these forces, not what was spent while others acted.
"""

from collections.abc import Sequence

import numpy as np

from ...generated.automaton import CLOSING, OPENING
from ..model.model import Model
from ..model.phases import Phase
from ..scene.user_model import OwnEvent
from .base import Certainty, Certificate, is_never_released
from .energy_barrier import Barrier, EnergyCertificate
from .quadrature import panels

PARTS = 24  # of the film, and as many beyond it, within which the potential is bounded by its parts at their ends
_LEAST = 1e-6  # gap down to which heights are known
_BOTH = (CLOSING, OPENING)


class EnergyBesideEvents(EnergyCertificate):
    """The energy certificate of a model with declared events, where energy excludes those that have not happened."""

    watches: str | None = None

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return None

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        return Certificate.decided(self, y, phase, maxima)  # floating knows of no declared event

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        """The verdict; in motion nothing is shown for a lever arm with which angular momentum drifts."""
        if phase.resting:  # declared events are watched in motion only
            return is_never_released(self.model, phase) or self.rests(y)
        ahead = self.ahead(y) if self.theorem else None
        if ahead is None:
            return False
        energy = self.energy(y)
        margin = self.margin * (max(self.largest, abs(energy)) + abs(ahead.height))
        return energy < ahead.height - margin and self.excluded(y, energy + margin, _BOTH)

    def barriers(self, y: np.ndarray) -> tuple[Barrier, ...]:
        return self._searched(tuple(y[2 : len(self.model.state)].tolist()))

    def energy(self, y: np.ndarray) -> float:
        """Kinetic energy over m v0^2 and the potential of the attractions at this gap, as heights are counted."""
        there = y[: len(self.model.state)]
        potential = sum(self.model.values(self.model.escape, there, self.p).values())
        return float(potential + self.height(there, float(y[0])) - self._least(there, float(y[0])))

    def height(self, y: np.ndarray, gap: float) -> float:
        return self._least(y, 1.0) + self._rise(gap, y)

    def _floors(self, gaps: Sequence[float], y: np.ndarray) -> list[float]:
        """Lower bounds of the effective potential between ascending gaps, of which the one at PARTS is 1.

        The energy of rotation falls with the gap while that of the attractions rises, so that their sum may have its
        minimum between two gaps: each is taken at its lower end, and that of the attractions less what it rises, for
        laws of a user's own.
        """
        parts = panels(lambda logs: self._slope(np.exp(logs), y) * np.exp(logs), np.log(gaps))
        risen = np.concatenate([[0.0], np.cumsum(parts)])
        rotating = self._potential(np.asarray(gaps), y)[0]
        attracted = rotating[PARTS] + risen - risen[PARTS] - rotating
        floors = np.minimum(rotating[1:], rotating[:-1]) + np.minimum(attracted[1:], attracted[:-1])
        lowest: list[float] = (floors - np.abs(np.diff(attracted))).tolist()
        return lowest

    def attracts(self, y: np.ndarray) -> bool:
        """True if the potential of the attractions varies with the gap, at the marks as they are."""
        gaps = np.concatenate([np.geomspace(_LEAST, 1.0, PARTS), np.linspace(1.0, self.end, PARTS)])
        return bool(self.model.works) and bool(np.any(self._slope(gaps, y) != 0))

    def _least(self, y: np.ndarray, gap: float) -> float:
        return self.model.values("effective_potential", np.array([gap, *y[1:]]), self.p)["energy"]

    def _turning(self, y: np.ndarray, orbital_momentum: float) -> np.ndarray:
        state = super()._turning(y, orbital_momentum)
        marks = list(self.model.marks)
        state[marks] = y[marks]
        return state

    def excluded(self, y: np.ndarray, energy: float, motions: Sequence[int], inside: bool = False) -> bool:
        """True if this energy does not suffice for a declared event that has not happened, in these directions.

        The speed at a gap is at most that of the energy above the height there. A guard is positive in a part of the
        gap and at the speeds there if it is in the worst corner, by the signs of its slopes. Harmless events change no
        barrier.

        Arguments:
            inside: the doublet stays inside the film.
        """
        model = self.model
        left = [
            each
            for each, mark in zip(model.own_events, model.marks, strict=True)
            if y[mark] > 0.5 and not each.harmless and dict(each.row.where).get("motion", motions[0]) in motions
        ]
        if not left:
            return True
        end, start = self.end, min(max(self.contact, _LEAST), 0.5)
        if any(each.reach is None or (_film(each) != 0 and self.contact < start) for each in left):
            return False
        gaps = [*np.geomspace(start, 1.0, PARTS + 1).tolist(), *np.linspace(1.0, end, PARTS + 1)[1:].tolist()]
        there = y[: len(model.state)]
        for k, floor in enumerate(self._floors(gaps[: PARTS + 1] if inside or end <= 1 else gaps, there)):
            above = energy - floor
            if above <= 0:
                continue
            film = int(k < PARTS)
            for each in left:
                if _film(each) in (None, film) and not self._clear(each, there, gaps[k : k + 2], above, motions):
                    return False
        return True

    def _clear(
        self, each: OwnEvent, y: np.ndarray, gaps: Sequence[float], above: float, motions: Sequence[int]
    ) -> bool:
        """True if a guard is positive between two gaps at every speed of this energy."""
        assert each.reach is not None
        watched = dict(each.row.where).get("motion")
        at = np.array(y)
        at[0] = gaps[0] if (each.reach["by_gap"] or 0) > 0 else gaps[1]
        for motion in motions:
            if watched not in (None, motion):
                continue
            slope = each.reach["opening" if motion == OPENING else "closing"] or 0
            at[1] = 0.0 if slope > 0 else motion * np.sqrt(2 * above)
            if not self.model.values("events", at, self.p)[each.name] > 0:
                return False
        return True


class FilmBesideEvents(Certificate):
    """The film certificate of a model with declared events, where energy excludes those of the present direction.

    It holds while nothing attracts: without attractions, or after the event that ends them. Else energy decides.
    """

    def __init__(self, film: Certificate, energy: EnergyBesideEvents) -> None:
        self.film, self.energy = film, energy

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        """The verdict; a doublet that the film stops while closing never opens."""
        if self.energy.attracts(y):
            return self.energy.decided(y, phase, maxima)
        certainty = self.film.decided(y, phase, maxima)
        if not certainty or phase.resting:
            return certainty
        energy = self.energy.energy(y) * (1 + self.energy.margin)
        return certainty if self.energy.excluded(y, energy, (phase.motion,), inside=True) else Certainty.OPEN


def _film(each: OwnEvent) -> int | None:
    return dict(each.row.where).get("film")


def beside_events(model: Model, p: np.ndarray, rtol: float, film: Certificate | None) -> Certificate | None:
    """The certificate of a model with declared events; None where nothing is shown.

    Arguments:
        film: the certificate of the film alone, where the model has one if nothing attracts.
    """
    if not model.has("effective_potential"):
        return None
    beside = EnergyBesideEvents(model, p, rtol)
    if film is not None:
        return FilmBesideEvents(film, beside)
    return beside if model.works or model.strings else None
