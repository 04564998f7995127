"""Proofs that a doublet never separates, so that a flight can end as soon as its outcome is decided.

With an attraction (or head-on, strings): mechanical energy never increases and angular momentum is conserved, so energy
below the barrier of the effective potential U_eff = L^2/(2 I) + W_c (+ U_s) on the far side cannot be made up for.
Head-on with a film alone: the film's momentum integral decides. Beside a wall all is as head-on: nothing turns. On
strings, turning: the strings outweigh the centrifugal force for good, and the film stops every rebound
(derive/tethered.py).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np
from casadi import SX, Function

from .model import Model
from .orbital import Orbital
from .orbital import knows as knows_orbital
from .phases import CLOSING, Phase, tethered_margin

# A proof holds by more than this many times the relative tolerance of the largest energy of the flight: an error made
# when the motion was fastest stays in the energy, and errors accumulate over some tens of steps.
_SAFETY = 30.0
_BEYOND = 1.0  # more of it at the level a flight stops at, so that rounding there does not leave the proof undecided
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


class Proof(Protocol):
    """What a flight asks of a proof. `y` is the locating state: the model's states, then works against attractions."""

    theorem: bool  # a stick found by it is proved, not only certain for practical purposes
    watches: str | None  # what a flight watches for (`Watch.certificate`); by "energy", `y` carries the works

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


class FilmProof:
    """Head-on, film alone: du/dx = -(6 pi mu a^2/m) resistance, so the velocity at every gap is known in advance."""

    theorem = True
    watches: str | None = None

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        self.model, self.p = model, p
        groups = dict(zip(model.groups, p, strict=True))
        self.stokes = groups["stokes"]
        self.contact = max(groups["elastic_gap"], groups["rough_gap"])
        self.glass = groups["glass_number"]
        self.margin = _SAFETY * rtol

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return None

    def decided(self, y: np.ndarray, phase: Phase) -> bool:
        gap, opening = float(y[0]), float(y[1])
        if phase.resting:
            return True
        if phase.motion != CLOSING:
            return self.held(gap, opening)
        # closing: neither the solids nor the glass pressure are met before the film stops the motion
        grid = np.geomspace(gap, max(self.contact, gap * np.exp(-100.0)), 801)
        speed = self.slowed(-opening, grid)
        if speed[-1] > -self.margin:
            return False
        # along a panel the speed falls and the pressure per speed rises: its ends bound the pressure from above
        return self.clear(grid[1:], np.maximum(speed[:-1], 0.0))

    def held(self, gap: float, opening: float) -> bool:
        """Whether the film stops an opening doublet: u falls by its integral up to x = x0; not if it cavitates."""
        loss = 0.0 if self.model.cavitates else self._momentum_loss(np.linspace(gap, 1.0, 65))[-1]
        return bool(opening - loss < -self.margin)

    def slowed(self, speed: float, grid: np.ndarray) -> np.ndarray:
        """Closing speed along a falling gap; losses are negative there. Below zero: it has been stopped before."""
        found: np.ndarray = speed + self._momentum_loss(grid)
        return found

    def clear(self, gaps: np.ndarray, speeds: np.ndarray) -> bool:
        """Whether no glass pressure is met at these gaps and closing speeds."""
        beside = np.zeros((len(self.model.state) - 2, gaps.size))  # what moves across the line of centres
        clearance = np.asarray(_glass(self.model)(np.vstack([gaps, -speeds, beside]), self.p).full())
        return bool(np.min(clearance) > self.margin * self.glass)

    def _momentum_loss(self, grid: np.ndarray) -> np.ndarray:
        """Loss of u along a path of gaps, cumulative."""
        low, high = grid[:-1], grid[1:]
        nodes = low + np.outer(_NODES + 1, high - low) / 2
        resistance = np.asarray(_resistance(self.model)(nodes.reshape(1, -1), self.p).full()).reshape(nodes.shape)
        panels = (_WEIGHTS @ resistance) * (high - low) / 2
        losses: np.ndarray = np.concatenate([[0.0], np.cumsum(panels)]) / self.stokes
        return losses


@lru_cache(maxsize=64)
def _glass(model: Model) -> Function:
    return Function("glass", [model.column, model.parameters], [model("events")["glass"]])


@lru_cache(maxsize=64)
def _resistance(model: Model) -> Function:
    gap = SX.sym("gap")
    more = model.extra("film", "resistance")
    return Function("resistance", [gap, model.parameters], [model.laws.film.resistance(gap, *more)])


@dataclass(frozen=True)
class Barrier:
    """A maximum of the effective potential: its gap, and its height over m v0^2 (capillary work from first touch)."""

    gap: float
    height: float


class BarrierProof:
    """Energy below a barrier of the effective potential that lies further out.

    For the surface arm angular momentum drifts (dL/dt = -x F_t) and the tangential rate is not sign-definite; there
    the level is lowered by what the drift can still do, and the stick is not called a theorem.
    """

    watches: str | None = "energy"

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        self.model, self.p, self.rtol = model, p, rtol
        self.groups = dict(zip(model.groups, p, strict=True))
        self.theorem = model.choice.law("arm") != "surface"
        self._largest = float(sum(model.values(model.escape, model.start(p), p).values()))
        self._known: tuple[float, tuple[Barrier, ...]] | None = None

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return self._level(y, phase, _SAFETY + _BEYOND)

    def _level(self, y: np.ndarray, phase: Phase, safety: float) -> float | None:
        ahead = [barrier for barrier in self.barriers(y) if barrier.gap > y[0]]
        if not ahead:
            return None
        scale = self._largest + abs(
            ahead[0].height
        )  # the same all along the flight, or a stop would move its own level
        return ahead[0].height - safety * self.rtol * scale - self._drift(y, phase, ahead[0].gap)

    def decided(self, y: np.ndarray, phase: Phase) -> bool:
        if phase.resting and (not self.model.oblique or self.model.wall or not phase.shear):
            return True  # nothing moves that could part them, or changes what turns; and the force is inward
        level = self._level(y, phase, _SAFETY)
        return level is not None and self.energy(y) < level

    def energy(self, y: np.ndarray) -> float:
        """Mechanical energy over m v0^2."""
        work = sum(y[y.size - len(self.model.works) :])
        return float(sum(self.model.values(self.model.escape, y, self.p).values()) + work)

    def barriers(self, y: np.ndarray) -> tuple[Barrier, ...]:
        """Maxima that no later one exceeds, from the inside out, for the angular momentum of `y`."""
        momentum = self._momentum(y)
        if self._known is None or (self._known[0] != momentum and not self.theorem):
            self._known = (momentum, self._search(y))
        return self._known[1]

    def _momentum(self, y: np.ndarray) -> float:
        """Angular momentum as the search sees it; where it is conserved the value does not matter."""
        return 0.0 if self.theorem else self.model.values("angular_momentum", y, self.p)["angular_momentum"]

    def _drift(self, y: np.ndarray, phase: Phase, barrier: float) -> float:
        """What a drifting angular momentum can still add to the energy, over m v0^2 (surface arm; else 0).

        |dL| <= (8/5) m a x |dxi|, from dL/dt = -x F_t and (16/5) m a^2 dxi/dt = 2a F_t; xi can still change by the
        slip, and while the doublet breathes by the change of the rigid rate L/I. Energy and barrier move by omega dL.
        """
        if self.theorem:
            return 0.0
        state = dict(zip(self.model.state, y, strict=False))
        aspect, obliquity = self.groups["aspect"], self.groups["obliquity"]
        inside, outside = 4 + aspect * state["gap"], 4 + aspect * barrier
        rate = state["orbit"] / inside**2
        change = abs(rate - state["spin"])
        reach = state["gap"]
        if not phase.resting:
            reach = barrier
            change += rate * (outside**2 - 16.0) / (16.0 + 6.4)
        lost = 1.6 * aspect * reach * change
        return float(2 * max(rate, state["spin"]) * lost * obliquity**2 / 16)

    def _slope(self, gaps: np.ndarray, y: np.ndarray) -> np.ndarray:
        states = np.repeat(y[: len(self.model.state), None], gaps.size, axis=1)
        states[0] = gaps
        both = np.asarray(self.model.function("effective_potential")(states, self.p).full())
        slope: np.ndarray = both[1]
        return slope

    def _search(self, y: np.ndarray) -> tuple[Barrier, ...]:
        """Local maxima from the sign of the slope on a grid in ln(gap), refined by bisection, heights by quadrature."""
        end = self.groups.get("rupture_gap", 1.0)
        contact = max(self.groups["elastic_gap"], self.groups["rough_gap"])
        start = min(max(contact, 1e-6), 0.5)
        inside = np.geomspace(start, 1.0, 81)
        grid = np.unique(np.concatenate([inside, np.linspace(1.0, end, 81)])) if end > 1 else inside
        slope = self._slope(grid, y)
        tops = [self._root(grid[k], grid[k + 1], y) for k in range(grid.size - 1) if slope[k] > 0 >= slope[k + 1]]
        if slope[-1] > 0:
            tops.append(float(grid[-1]))
        at_touch = np.array([1.0, *y[1:]])
        base = self.model.values("effective_potential", at_touch, self.p)["energy"]
        found = [Barrier(top, base + self._rise(top, y)) for top in tops]
        highest_after: list[Barrier] = []
        for barrier in reversed(found):
            if not highest_after or barrier.height > highest_after[-1].height:
                highest_after.append(barrier)
        return tuple(reversed(highest_after))

    def _root(self, low: float, high: float, y: np.ndarray) -> float:
        """Where the slope turns negative, by repeated division."""
        for _ in range(3):
            parts = np.linspace(low, high, 201)
            slope = self._slope(parts, y)
            last = int(np.argmax(slope[1:] <= 0))
            low, high = parts[last], parts[last + 1]
        # over 1e-7 of the bracket the slope is straight
        return float(low + (high - low) * slope[last] / (slope[last] - slope[last + 1]))

    def _rise(self, top: float, y: np.ndarray) -> float:
        """Effective potential at `top` less that at first touch, by Gauss-Legendre panels in ln(gap)."""
        edges = np.linspace(0.0, np.log(top), 2 + int(8 * abs(np.log(top))))
        low, high = edges[:-1], edges[1:]
        logs = (low + np.outer(_NODES + 1, high - low) / 2).ravel()
        gaps = np.exp(logs)
        integrand = (self._slope(gaps, y) * gaps).reshape(_NODES.size, -1)
        return float(np.sum((_WEIGHTS @ integrand) * (high - low) / 2))


class TetherProof:
    """Strings that turn, a film and no bridge: all but lubrication pulls inward for good (derive/tethered.py)."""

    theorem = True
    watches: str | None = "tethered"

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        self.model, self.p, self.rtol = model, p, rtol

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return (_SAFETY + _BEYOND) * self.rtol

    def decided(self, y: np.ndarray, phase: Phase) -> bool:
        return float(_tethered(self.model)(y[: len(self.model.state)], self.p, _SAFETY * self.rtol)) < 0


@lru_cache(maxsize=64)
def _tethered(model: Model) -> Function:
    margin = SX.sym("margin")
    return Function("tethered", [model.column, model.parameters, margin], [tethered_margin(model, margin)])


class HeldProof:
    """Something attracts so strongly that the gap's maxima only fall from now on (derive/held.py).

    Arguments:
        beside: another proof for the same model, tried first; it is what a flight watches for.
    """

    def __init__(self, model: Model, p: np.ndarray, rtol: float, beside: Proof | None = None) -> None:
        self.model, self.p, self.margin, self.beside = model, p, _SAFETY * rtol, beside or NoProof()
        self.theorem = True  # a model with a conserving arm; `beside` is then one as well, or proves nothing
        self.watches: str | None = self.beside.watches

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return self.beside.level(y, phase)

    def decided(self, y: np.ndarray, phase: Phase) -> bool:
        return self.beside.decided(y, phase) or self._held(y)

    def _held(self, y: np.ndarray) -> bool:
        found = self.model.values("held", y, self.p)
        hold = found["hold"]
        # each by more than the error of what it is made of; a NaN proves nothing
        energy = max(float(y[1]) ** 2, 1.0)
        return hold > 0 and found["rebound"] < -self.margin * hold and found["flight"] < -self.margin * energy


class OrbitalProof:
    """The momentum of the orbit (orbital.py), after what another proof has to say.

    Arguments:
        beside: another proof for the same model, tried first unless the arm lets angular momentum drift; it is what a
            flight watches for.
    """

    def __init__(self, model: Model, p: np.ndarray, rtol: float, beside: Proof) -> None:
        self.beside, self.orbital = beside, Orbital(model, p, rtol)
        self.theorem = beside.theorem
        self._drifts = model.choice.law("arm") == "surface"
        self.watches = None if self._drifts else beside.watches

    def level(self, y: np.ndarray, phase: Phase) -> float | None:
        return self.beside.level(y, phase)

    def decided(self, y: np.ndarray, phase: Phase) -> bool:
        if not self._drifts and self.beside.decided(y, phase):
            self.theorem = self.beside.theorem
            return True
        self.theorem = self.orbital.theorem
        return self.orbital.decided(y, phase)


def energy_proof(proof: Proof) -> BarrierProof | None:
    """The proof by energy that a flight has, alone or beside another."""
    while isinstance(proof, (HeldProof, OrbitalProof)):
        proof = proof.beside
    return proof if isinstance(proof, BarrierProof) else None


def _holds(model: Model) -> bool:
    """Whether attraction alone can prove a stick: the forces fall with the gap, and the arm conserves L."""
    attracting = [getattr(model.laws, slot) for slot in ("bridge", "attraction") if model.choice.law(slot)]
    falling = all(getattr(law, "FALLS", False) for law in attracting)
    return model.has("held") and falling and model.choice.law("arm") in (None, "midgap")


def _integrable(model: Model) -> bool:
    """Whether the laws say what the film takes and how far the glass criterion reaches (a user's need not)."""
    return hasattr(model.laws.film, "stopping") and hasattr(model.laws.glass, "reach")


class AttractedProof(BarrierProof):
    """Head-on or beside a wall, film and attraction without a bridge: energy, or the film that stops the approach.

    An attraction too weak to show in the energy still holds what the film has stopped. What would close at w under
    the film alone closes at most at w + g with the attraction, g^2/2 being its work from x = x0 on: where v = w + g,
    v >= g, so v grows no faster than w + g does. If w vanishes before the solids are met and w + g meets no glass
    pressure, the solids are met at no more than g, and e_dry <= 1 gives back less than it takes to get to x0.
    """

    def __init__(self, model: Model, p: np.ndarray, rtol: float) -> None:
        super().__init__(model, p, rtol)
        self._film = FilmProof(model, p, rtol)

    def decided(self, y: np.ndarray, phase: Phase) -> bool:
        return super().decided(y, phase) or (not phase.resting and self._stopped(y, phase))

    def _stopped(self, y: np.ndarray, phase: Phase) -> bool:
        film, gap, opening = self._film, float(y[0]), float(y[1])
        grid = np.geomspace(gap, max(film.contact, gap * np.exp(-100.0)), 801)
        if phase.motion == CLOSING:
            speed = film.slowed(-opening, grid)
            if speed[-1] > -film.margin:
                return False
        else:
            if not film.held(gap, opening):
                return False
            speed = np.zeros(grid.size)
        work = self._fallen(np.geomspace(1.0, gap, 65))[-1] + self._fallen(grid)
        fastest = np.maximum(speed[:-1], 0.0) + np.sqrt(2 * work[1:])
        if phase.motion != CLOSING:  # it may rise up to x0 before it falls
            grid = np.geomspace(1.0, grid[-1], 801)
            fastest = np.sqrt(2 * self._fallen(grid)[1:])
        return film.clear(grid[1:], fastest)

    def _fallen(self, grid: np.ndarray) -> np.ndarray:
        """Work of the attraction from the first gap on, cumulative; the slope of the potential is nothing else here."""
        low, high = grid[:-1], grid[1:]
        nodes = low + np.outer(_NODES + 1, high - low) / 2
        still = np.zeros(len(self.model.state))
        pull = self._slope(nodes.ravel(), still).reshape(nodes.shape)
        works: np.ndarray = np.concatenate([[0.0], np.cumsum((_WEIGHTS @ pull) * (low - high) / 2)])
        return works


def proof_for(model: Model, p: np.ndarray, rtol: float) -> Proof:
    """The certificate that holds for a model."""
    found = _usual(model, p, rtol)
    return OrbitalProof(model, p, rtol, found) if knows_orbital(model) else found


def _usual(model: Model, p: np.ndarray, rtol: float) -> Proof:
    if model.has("tethered") and model.choice.law("arm") == "midgap" and _integrable(model):
        return TetherProof(model, p, rtol)
    turning = model.oblique and not model.wall
    if turning and _holds(model):
        return HeldProof(model, p, rtol, None if model.strings else BarrierProof(model, p, rtol))
    if turning and (model.strings or not model.works):
        return NoProof()
    if model.works == ("attraction",) and not turning and not model.strings:
        return AttractedProof(model, p, rtol)
    if model.works or model.strings:
        return BarrierProof(model, p, rtol)
    if any(str(symbol) in model.state for symbol in model.extra("film", "resistance")):
        return NoProof()  # a film whose force is not proportional to u has no momentum integral
    return FilmProof(model, p, rtol)
