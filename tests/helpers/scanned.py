"""A collision in space followed by LSODA in Cartesian velocities, its events searched for on a grid of dense output.

Written from the table of events alone, so that it shares no method with the engines: every step is sampled, and between
samples each event function that dips is minimised: a graze is not stepped over. Strings, and rolling at rest, are
followed in a plane alone.
"""

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.integrate import LSODA
from scipy.optimize import brentq, minimize_scalar
from wetdoublet.solvers import Scene

from .mechanics import PARTNER, SPIN, ZERO, Arrival, Mechanics, N, W, X, at, cross, dot, planar_arrival, plus
from .two_bodies import Bodies, bodies_of

SAMPLES = 12  # of each step
STEPS, PHASES, ACCURACY = 12_000, 600, 1e-11
REST_SPEED, RELEASE_SPEED, NO_SLIP = 1e-9, 1e-12, 1e-12  # in v0
Guard = Callable[[np.ndarray], Any]


class UndecidedError(Exception):
    """The budget of steps or phases is exhausted, or what happens is not followed here."""


@dataclass
class Outcome:
    """What a collision came to; the quantities of a stick are those where it was certain."""

    outcome: str = ""
    restitution: float = 0.0
    time: float = 0.0
    state: Sequence[float] = ()
    events: list[tuple[str, float]] = field(default_factory=list)

    @property
    def reversal(self) -> str | None:
        return next((kind for kind, _ in self.events if kind in ("glass", "elastic", "rough")), None)

    @property
    def spins(self) -> tuple[float, float]:
        """About the axis z."""
        return self.state[SPIN + 2], self.state[PARTNER + 2]

    @property
    def across(self) -> float:
        """The velocity across the line of centres, about the axis z."""
        return float(cross(at(self.state, N), at(self.state, W))[2])


class Scan(Mechanics):
    """One collision; `run` follows it. `rtol` is that of the engine beside which it stands."""

    def __init__(
        self, b: Bodies, arrival: Arrival, strings: Any = None, rtol: float = 1e-9, accuracy: float = ACCURACY
    ) -> None:
        super().__init__(b, arrival, strings)
        self.rtol, self.accuracy = rtol, accuracy
        self.t, self.steps, self.most = 0.0, 0, STEPS
        self.result = Outcome()

    # ---- events

    def guards(self) -> list[tuple[str, Guard]]:
        """Event functions that are watched, in the order in which coincident ones count; vectorised."""
        b, watched = self.b, []

        def watch(name: str, guard: Guard) -> None:
            watched.append((name, guard))

        if self.resting:
            watch("released", lambda y: each(self.reaction, y))
            if b.friction is not None and self.rotates:
                least = 0.0 if self.flat else 1e-3 * self.fastest()
                if self.sliding:
                    watch("stops", lambda y: each(lambda z: self.sliding * self.signed(self.slip(z), z) - least, y))
                else:
                    watch("slides", lambda y: each(lambda z: b.friction * self.reaction(z) - abs(self.needed(z)), y))
        else:
            sign = -1.0 if self.closing else 1.0
            watch("turned" if self.closing else "fell back", lambda y: sign * self.opening(y))
            if self.closing:
                if math.isfinite(b.glass):
                    watch("glass", lambda y: 1 - b.pressure(y[X], self.opening(y)) / b.glass)
                watch("solid", lambda y: y[X] - self.solid)
            elif not (self.rim and self.inside):
                watch("rupture", lambda y: b.rupture - y[X])
            if self.rim:
                side = 1.0 if self.inside else -1.0
                watch("film edge", lambda y: side * (b.film_thickness - y[X]))
            if self.apart and b.edge < b.rupture:
                way = 1.0 if self.sheared else -1.0
                watch("tangential edge", lambda y: way * (b.edge - y[X]))
        if self.strings and self.rotates:
            watch("half turn", lambda y: math.pi - np.arctan2(y[N + 1], y[N]) % (2 * math.pi))
            watch("rotation reverses", lambda y: cross(at(y, N), at(y, W))[2])
        return watched

    @property
    def apart(self) -> bool:
        """Whether the edge of the tangential force is another than that of the film."""
        return not (self.rim and self.b.edge == self.b.film_thickness)

    def fastest(self) -> float:
        return self.v0 + math.hypot(*self.sideways(self.y))

    def criterion(self) -> str:
        """The rebound criterion that holds at present."""
        b = self.b
        if b.pressure(self.y[X], self.opening(self.y)) >= b.glass:
            return "glass"
        return "elastic" if self.y[X] <= self.elastic else "rough" if self.y[X] <= b.roughness else ""

    def rebound(self, kind: str) -> None:
        """The dry contact: it may separate the pair, or hold it."""
        b, u = self.b, self.opening(self.y)
        self.log(kind)
        back = -b.dry_restitution * u
        normal = b.m * (back - u)
        self.closing = False
        self.push(back - u)
        inward, x = self.reaction(self.y), self.y[X]
        dry = not b.wets(self.inside, opening=True)
        rises = math.inf if inward <= 0 else b.m * back**2 / (2 * inward)
        self.resting = inward > 0 and (back < REST_SPEED * self.v0 or (dry and rises < self.rtol * x))
        self.resting = self.resting and x < b.rupture
        if self.rim and x >= b.film_thickness:  # left at once
            self.inside, self.sheared = False, self.sheared and self.apart
        if self.resting:
            normal = -b.m * u  # the outgoing part is given up
            self.push(-self.opening(self.y))
        if b.friction is not None and (kind != "glass" or b.friction_in_glass):
            self.rub(normal)
        if self.resting:
            self.log("rests")
            self.grip()

    def push(self, change: float) -> None:
        """Change the opening velocity."""
        self.y[W : W + 3] += change * self.y[N : N + 3]

    def rub(self, normal: float) -> None:
        """The tangential impulse of a contact: Walton and Braun's."""
        b, y = self.b, self.y
        slip = self.signed(self.slip(y), y)
        whole, one, other = self.yields(y[X])
        size = math.copysign(min(b.friction * normal, (1 + (b.beta_0 or 0.0)) * abs(slip) / whole), slip)
        impulse = plus(ZERO, size, self.against(y))
        turn = np.array(cross(at(y, N), impulse))
        y[W : W + 3] += np.array(impulse) / b.m
        y[SPIN : SPIN + 3] -= one * turn
        y[PARTNER : PARTNER + 3] -= other * turn

    def grip(self) -> None:
        """Sliding or rolling at the beginning of rest."""
        if self.b.friction is None or not self.rotates:
            return
        slip = self.signed(self.slip(self.y), self.y)
        self.sliding = math.copysign(1.0, slip)
        if abs(slip) <= (NO_SLIP if self.flat else 2e-3) * self.fastest():
            self.stops()

    def stops(self) -> None:
        """Zero slip: friction holds it, or it slides in the direction in which it is driven."""
        if not self.flat:
            raise UndecidedError("rolls in space")
        need = self.needed(self.y)
        held = abs(need) <= self.b.friction * self.reaction(self.y)
        self.sliding = 0.0 if held else math.copysign(1.0, need)
        self.log("rolls" if held else "slides")

    def happen(self, kind: str) -> None:
        """The effect of an event."""
        b = self.b
        if kind in ("turned", "fell back"):
            self.push(-self.opening(self.y))
            self.closing = not self.closing
            self.log(kind)
        elif kind == "glass":
            self.rebound(kind)
        elif kind == "solid":
            self.y[X] = self.solid
            self.rebound("elastic" if self.elastic >= b.roughness else "rough")
        elif kind == "film edge":
            self.inside, self.y[X] = not self.inside, b.film_thickness
            if not self.apart:
                self.sheared = not self.sheared
            self.log(kind)
        elif kind == "tangential edge":
            self.sheared, self.y[X] = not self.sheared, b.edge
            self.log(kind)
        elif kind == "released":
            self.resting, self.closing = False, False
            self.push(RELEASE_SPEED * self.v0 - self.opening(self.y))
            self.log(kind)
        elif kind == "stops":
            self.stops()
        elif kind == "slides":
            self.sliding = math.copysign(1.0, self.needed(self.y))
            self.log(kind)
        elif kind == "rupture":
            self.y[X] = b.rupture
            self.part()
        else:
            self.log(kind)
            self.result.outcome = "stick"

    def part(self) -> None:
        self.log("rupture")
        self.result.outcome = "bounce" if self.result.reversal else "stick-rotate-separate"
        self.result.restitution = float(self.opening(self.y) / self.v0)

    def log(self, kind: str) -> None:
        self.result.events.append((kind, self.t))

    # ---- certain sticks

    def certain(self) -> bool:
        """Whether the pair can not part any more, by energy or by the film's momentum."""
        b, y = self.b, self.y.tolist()
        u, beside = self.opening(y), self.sideways(y)
        x, r = y[X], b.contact + y[X]
        if self.resting and not self.rotates:
            return True  # nothing changes any more
        if self.strings:
            return not self.rotates and b.m * u * u / 2 + self.hung(x) < self.hung(b.film_thickness)
        if not b.cohesive:
            if self.rotates and not b.wall:
                return False
            return bool(abs(u) < 1e-10 * self.v0 and not self.resting)
        kinetic, momentum = b.m * u * u / 2, ZERO
        if not b.wall:
            kinetic += b.m * dot(beside, beside) / 2
            momentum = plus(ZERO, b.m * r, cross(at(y, N), beside))
            for inertia, where in zip(b.inertias, (SPIN, PARTNER)):
                kinetic += inertia * dot(at(y, where), at(y, where)) / 2
                momentum = plus(momentum, inertia, at(y, where))
        reserve = 1e-7 if b.arm == "midgap" or b.wall else 0.05  # of the accuracy; that arm lets the momentum drift
        scale = kinetic + abs(b.potential(x))
        return bool(kinetic + b.potential(x) + reserve * scale < b.barrier(x, math.hypot(*momentum)))

    # ---- the search

    def run(self) -> Outcome:
        """Follow it to separation, or until it certainly sticks."""
        with np.errstate(all="ignore"), warnings.catch_warnings():  # of trial steps
            warnings.simplefilter("ignore")
            return self._run()

    def _run(self) -> Outcome:
        for _ in range(PHASES):
            kind = self.criterion() if self.closing and not self.resting else ""
            if kind:
                if kind != "glass":
                    self.y[X] = min(self.y[X], self.solid)
                self.rebound(kind)
                if self.y[X] >= self.b.rupture:
                    self.part()
            elif self.certain():
                self.result.outcome = "stick"
            else:
                self.phase()
            if self.result.outcome:
                self.result.time, self.result.state = self.t, self.y.tolist()
                return self.result
        msg = "phases"
        raise UndecidedError(msg)

    def phase(self) -> None:
        """Integrate to the first event of the present mode, or until the stick is certain."""
        b, watched = self.b, self.guards()
        sizes = np.array(
            [1e-6 * self.y[X], *3 * [1e-2], *3 * [1e-2 * self.v0], *6 * [1e-2 * self.fastest() / b.radii[0]]]
        )
        first = 1e-6 * self.y[X] / (abs(self.opening(self.y)) + 1e-6 * self.v0)
        solver = LSODA(self.rates, self.t, self.y, math.inf, first, rtol=self.accuracy, atol=self.accuracy * sizes)
        before = None
        while solver.status == "running":
            self.steps += 1
            if self.steps > self.most:
                msg = f"steps, at {self.t:.3g} s"
                raise UndecidedError(msg)
            said = solver.step()
            if solver.status == "failed":
                raise UndecidedError(said)
            dense = solver.dense_output()
            times = np.linspace(solver.t_old, solver.t, SAMPLES + 1)
            hits, before = self.hits(dense, times, watched, before)
            if hits:
                self.t, _, kind = min(hits)
                self.y = dense(self.t)
                self.happen(kind)
                return
            self.t, self.y = solver.t, solver.y.copy()
            if self.steps % 4 == 0 and self.certain():
                self.result.outcome = "stick"
                return

    def hits(
        self, dense: Any, times: np.ndarray, watched: list[tuple[str, Guard]], before: np.ndarray | None
    ) -> tuple[list[tuple[float, int, str]], np.ndarray]:
        """First zeros of the event functions within a step, and their values where the next step needs them."""
        states = dense(times)
        values = np.array([guard(states) for _, guard in watched])
        found, last = [], len(times) - 1
        for k, (name, guard) in enumerate(watched):

            def value(t: float, guard: Guard = guard) -> float:
                return float(guard(dense(t)))

            def zero(start: float, end: float, value: Callable[[float], float] = value) -> float:
                return float(brentq(value, start, end, xtol=1e-300, rtol=1e-14))

            row = values[k].tolist()
            for j, mid in enumerate(row):
                start, end = times[max(j - 1, 0)], times[min(j + 1, last)]
                low = row[j - 1] if j else row[0] if before is None else before[k]
                if j and mid <= 0 and (low > 0 or mid < low):
                    found.append((zero(start, times[j]) if low > 0 else float(start), k, name))
                    break
                high = row[j + 1] if j < last else mid
                if 0 < mid <= min(low, high) and mid < 2 * (max(low, high) - mid) and value(start) > 0:
                    least = minimize_scalar(value, bounds=(start, end), method="bounded", options={"xatol": 1e-9 * end})
                    if least.fun < 0:
                        found.append((zero(start, least.x), k, name))
                        break
        return found, values[:, -2]


def each(function: Callable[[Any], float], states: np.ndarray) -> Any:
    """A function of one state, at each of many."""
    return function(states) if states.ndim == 1 else np.array([function(column) for column in states.T.tolist()])


def scan_of(scene: Scene, rtol: float = 1e-9, speed: float | None = None, accuracy: float = ACCURACY) -> Scan:
    """The collision of a scene at its impact, or with another normal speed, about to be followed."""
    return Scan(bodies_of(scene), planar_arrival(scene, speed), scene.pendulum, rtol, accuracy)


def scanned(scene: Scene, rtol: float = 1e-9, speed: float | None = None) -> Outcome:
    """A collision of a scene, followed."""
    return scan_of(scene, rtol, speed).run()
