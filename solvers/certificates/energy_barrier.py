"""Energy certificate: the energy is below a barrier of the effective potential at a larger gap.

Mechanical energy never increases and, without strings, angular momentum is conserved: a pair with less energy than the
barrier of U_eff = L^2/(2 I) + W_c (+ U_s) never crosses it. A wall is treated as head-on, as no line of centres
rotates.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ...generated.automaton import SAFETY, is_below_barrier, rests_for_good
from ..model.model import Model
from ..model.phases import Phase
from .approach import Approach, starts
from .base import BEYOND, Certainty, Certificate, is_never_released, states_at
from .floating import floats
from .quadrature import panels

_GAPS = 49  # number of gaps ahead up to which the potential's rise is integrated


@dataclass(frozen=True)
class Barrier:
    """A maximum of the effective potential: gap, and height over m v0^2 (capillary work from initial contact)."""

    gap: float
    height: float


class EnergyCertificate(Certificate):
    """Certificate that the energy is below a barrier of the effective potential at a larger gap.

    With a lever arm of one's own that is not at mid-gap the angular momentum drifts, and the tangential rate is not
    sign-definite. The level is then lowered by the largest effect of the drift, and the stick is not a theorem.
    """

    watches: str | None = "energy"

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        super().__init__(model, p, rtol)
        self.theorem = model.choice.law("arm") in (None, "midgap")
        self.largest = float(sum(model.values(model.escape, model.start(p), p).values()))
        self._approach = Approach(model, p, self.margin)
        start = model.start(p)
        self._conserved = self._search(start) if self.theorem else ()
        self._searched = lru_cache(2)(lambda momenta: self._search(np.array([*start[:2], *momenta])))

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        ahead = self.ahead(y)
        if ahead is None:
            return None
        # constant along the trajectory, as the level must not depend on the event's own state
        scale = self.largest + abs(ahead.height)
        return ahead.height - (SAFETY + BEYOND) * self.rtol * scale - self._drift(y, phase, ahead.gap)

    def decided(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray] = ()) -> Certainty:
        if not phase.resting and floats(self.model, self.p, y, self.margin):
            return Certainty.PROVED
        return super().decided(y, phase, maxima)

    def sticks(self, y: np.ndarray, phase: Phase, maxima: Sequence[np.ndarray]) -> bool:
        if is_never_released(self.model, phase) or (phase.resting and self.rests(y)):
            return True
        if (ahead := self.ahead(y)) is not None:
            drift = self._drift(y, phase, ahead.gap)
            if is_below_barrier(self.energy(y), ahead.height, self.margin, self.largest, drift):
                return True
        return self._held_on_approach(y, phase) or self._in_a_well(y)

    def _in_a_well(self, y: np.ndarray) -> bool:
        """True if the effective potential rises, up to some gap ahead, by more than the energy above it.

        Near the gap at which a minimum and the maximum after it merge, the rise is less than the error of the energies.
        It is integrated here from the present gap, whose error is that of the slope: so only a doublet whose
        equilibrium an error of the momenta could remove stays undecided.
        """
        gap, end = float(y[0]), self.groups.get("rupture_gap", 1.0)
        if not (self.theorem and gap < end):
            return False
        gaps = gap + (end - gap) * np.linspace(0.0, 1.0, _GAPS) ** 3  # denser at small distances
        kinetic = float(sum(self.model.values(self.model.escape, y, self.p).values()))
        turning, slopes = self._potential(gaps, y)
        above, released = kinetic - turning[0], turning[0] - turning[1:]
        rise = np.cumsum(panels(lambda at: self._slope(at, y), gaps))
        size = np.sqrt(abs(above) * kinetic) + self.margin * kinetic + np.abs(released) + np.abs(rise + released)
        return bool(np.any(above - rise < -self.margin * (size + gap * abs(slopes[0]))))

    def _held_on_approach(self, y: np.ndarray, phase: Phase) -> bool:
        """True if the film takes enough energy from an approach from initial contact before it meets a criterion."""
        if not self._approach.covers or not starts(y, phase):
            return False
        beyond = [barrier.height for barrier in self.barriers(y) if barrier.gap >= y[0]]
        if not beyond:
            return False
        rest, outward = self.energy(y) - float(y[1]) ** 2 / 2, self._approach.outward(y)
        energies = (part.slowed**2 / 2 + rest + outward * (float(y[0]) - part.gap) for part in self._approach.clear(y))
        return any(is_below_barrier(energy, beyond[0], self.margin, self.largest, 0.0) for energy in energies)

    def rests(self, y: np.ndarray) -> bool:
        """True if a doublet at rest in its gap stays there while its slip decays.

        The slip energy never grows, and at given angular momentum the kinetic energy is that of rigid rotation plus
        that of the deviation from it (`derive.checks.partners.slip_energy_adds`). The slip energy thus bounds the
        excess of the orbital momentum over its rigid value. Twice this bound is used where angular momentum drifts.
        """
        model = self.model
        if model.space:
            bound = self.values("resting_bound", y)
            return bool(rests_for_good(bound["inward"] - bound["outward"], self.margin, bound["inward"]))
        orbital_momentum = abs(self._rigid(y, float(y[0])))
        if model.reduced:  # a single slip, which decreases without changing sign: J stays between its ends
            orbital_momentum = max(abs(float(y[2])), orbital_momentum)
        else:
            rigid = list(self.values("rigid_rotation", y).values())
            deviation = np.array([y[0], 0.0, *(y[2 : len(model.state)] - rigid[2:])])
            excess = float(np.sqrt(self._kinetic(deviation) / self._kinetic(self._turning(y, 1.0))))
            orbital_momentum += excess if self.theorem else 2 * excess
        held, still = (
            self.values("inward_force", self._turning(y, each))["inward_force"] for each in (orbital_momentum, 0.0)
        )
        return bool(rests_for_good(held, self.margin, still))

    def _kinetic(self, y: np.ndarray) -> float:
        return self.values("energies", y)["kinetic"]

    def _turning(self, y: np.ndarray, orbital_momentum: float) -> np.ndarray:
        """A state with zero normal velocity at this gap, and momentum only in the orbital motion."""
        state = np.zeros(len(self.model.state))
        state[[0, 2]] = y[0], orbital_momentum
        return state

    def energy(self, y: np.ndarray) -> float:
        """Mechanical energy over m v0^2."""
        return float(sum(self.values(self.model.escape, y).values()) + self.work(y))

    def work(self, y: np.ndarray) -> float:
        """Work against the attractions since initial contact, over m v0^2."""
        return float(sum(y[y.size - len(self.model.works) :]))

    def ahead(self, y: np.ndarray) -> Barrier | None:
        """The first barrier at a larger gap."""
        return next((barrier for barrier in self.barriers(y) if barrier.gap > y[0]), None)

    def barriers(self, y: np.ndarray) -> tuple[Barrier, ...]:
        """Maxima not exceeded at larger gaps, in order of the gap, for the angular momentum of `y`."""
        return self._conserved if self.theorem else self._searched(tuple(y[2 : len(self.model.state)].tolist()))

    def _drift(self, y: np.ndarray, phase: Phase, barrier: float) -> float:
        """Bound of the energy that a drift of angular momentum can add, over m v0^2; 0 with the lever arm at mid-gap.

        |dL| = |1 - 2 lever/r| |dJ|. J can change by its deviation from rigid rotation and, as the gap varies, by the
        change of its rigid value; with friction by this deviation again at each rebound that reverses it. Energy and
        barrier change by omega dL each, where |omega| is taken as the larger of the present one and that of rigid
        rotation.
        """
        if self.theorem:
            return 0.0
        orbital_momentum = y[list(self.model.state).index("orbital_momentum")]
        rigid = self._rigid(y, float(y[0]))
        change, reach = abs(orbital_momentum - rigid), float(y[0])
        if self.model.friction and change > 0:  # impulses reverse the slip again and again
            reversed_part = self.groups["contact_tangential_restitution"]
            change *= (1 + reversed_part) / (1 - reversed_part) if reversed_part < 1 else np.inf
        if not phase.resting:
            change += abs(self._rigid(y, barrier) - self._rigid(y, 0.0))
            reach = barrier
        lost = change * self._share(reach)
        energy = self._kinetic(self._turning(y, 1.0))  # of J = 1, half of omega/J
        return float(4 * energy * max(abs(orbital_momentum), abs(rigid)) * lost)

    def _share(self, gap: float) -> float:
        """Change of the angular momentum over that of the orbital one, at a gap."""
        distance = 4 + self.groups["aspect"] * gap
        more = (self.groups[str(symbol)] for symbol in self.model.extra("arm", "lever"))
        return float(abs(1 - 2 * self.model.laws.arm.lever(distance, *more) / distance))

    def _rigid(self, y: np.ndarray, gap: float) -> float:
        """Orbital angular momentum of rigid rotation at this gap, with the total angular momentum of `y`."""
        return self.values("rigid_rotation", np.array([gap, *y[1:]]))["orbital_momentum"]

    def _slope(self, gaps: np.ndarray, y: np.ndarray) -> np.ndarray:
        slope: np.ndarray = self._potential(gaps, y)[1]
        return slope

    def _potential(self, gaps: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Least energy of rotation at these gaps, and the slope of the effective potential: two rows."""
        states = states_at(self.model, gaps, y)
        return np.asarray(self.model.function("effective_potential")(states, self.p).full())

    def _search(self, y: np.ndarray) -> tuple[Barrier, ...]:
        """Local maxima from the sign of the slope on a grid in ln(gap), refined by bisection, heights by quadrature."""
        inside = np.geomspace(min(max(self.contact, 1e-6), 0.5), 1.0, 81)
        grid = np.unique(np.concatenate([inside, np.linspace(1.0, self.end, 81)])) if self.end > 1 else inside
        slope = self._slope(grid, y)
        tops = [self._root(grid[k], grid[k + 1], y) for k in range(grid.size - 1) if slope[k] > 0 >= slope[k + 1]]
        if slope[-1] > 0:
            tops.append(float(grid[-1]))
        at_touch = np.array([1.0, *y[1:]])
        base = self.values("effective_potential", at_touch)["energy"]
        maxima = [Barrier(top, base + self._rise(top, y)) for top in tops]
        highest_after: list[Barrier] = []
        for barrier in reversed(maxima):
            if not highest_after or barrier.height > highest_after[-1].height:
                highest_after.append(barrier)
        return tuple(reversed(highest_after))

    def _root(self, low: float, high: float, y: np.ndarray) -> float:
        """Gap at which the slope becomes negative, by repeated subdivision."""
        for _ in range(3):
            parts = np.linspace(low, high, 201)
            slope = self._slope(parts, y)
            last = int(np.argmax(slope[1:] <= 0))
            low, high = parts[last], parts[last + 1]
        # over 1e-7 of the bracket the slope is linear
        return float(low + (high - low) * slope[last] / (slope[last] - slope[last + 1]))

    def _rise(self, top: float, y: np.ndarray) -> float:
        """Effective potential at `top` minus that at initial contact, by Gauss-Legendre panels in ln(gap)."""
        edges = np.linspace(0.0, np.log(top), 2 + int(8 * abs(np.log(top))))
        return float(np.sum(panels(lambda logs: self._slope(np.exp(logs), y) * np.exp(logs), edges)))
