"""A collision followed by LSODA in Cartesian velocities, its events searched for on a grid of its dense output.

Written from the model's description and the table of events alone, so that it shares no method with the engines: the
relative velocity is a vector in the laboratory's axes, which turns by no centrifugal term. Every step is sampled, and
between samples each event function that dips is minimised: a graze is not stepped over.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.integrate import LSODA
from scipy.optimize import brentq, minimize_scalar
from wetdoublet.solvers import Scene

from .spinning import impact_of
from .two_bodies import bodies_of

X, NX, NY, WX, WY, SPIN, PARTNER = range(7)
SAMPLES = 12  # of each step
STEPS, PHASES = 12_000, 600
REST_SPEED, RELEASE_SPEED, NO_SLIP = 1e-9, 1e-12, 1e-12  # in v0
Guard = Callable[[np.ndarray], Any]


class UndecidedError(Exception):
    """The budget of steps or phases is exhausted."""


@dataclass
class Outcome:
    """What a collision came to; the quantities of a stick are those where it was certain."""

    outcome: str = ""
    restitution: float = 0.0
    time: float = 0.0
    spins: tuple[float, float] = (0.0, 0.0)
    across: float = 0.0
    events: list[tuple[str, float]] = field(default_factory=list)

    @property
    def reversal(self) -> str | None:
        return next((kind for kind, _ in self.events if kind in ("glass", "elastic", "rough")), None)


class Scan:
    """One collision of a scene; `run` follows it. `rtol` is that of the engine beside which it stands."""

    def __init__(self, scene: Scene, rtol: float = 1e-9, accuracy: float = 1e-11, speed: float | None = None) -> None:
        self.b, impact, self.rtol, self.accuracy = bodies_of(scene), impact_of(scene), rtol, accuracy
        b, self.v0 = self.b, speed or impact.speed
        across = self.v0 * math.tan(impact.angle) * (1.0 if b.wall else 1 + b.film_thickness / b.contact)
        partner = 0.0 if b.wall else impact.partner_spin
        self.y = np.array([b.film_thickness, 1.0, 0.0, -self.v0, across, impact.spin, partner])
        self.rotates = bool(across or impact.spin or partner)
        self.strings = scene.pendulum
        self.elastic = b.elastic_gap(self.v0)
        self.solid = max(self.elastic, b.roughness)
        self.rim = bool(b.law) and b.film != "constant-volume"  # whether passing x0 is an event
        self.inside, self.sheared = True, b.edge >= b.film_thickness
        self.closing, self.resting = True, False
        self.sliding = 0.0  # in resting contact with friction: the sign of the slip; 0 while rolling
        self.t, self.steps = 0.0, 0
        self.result = Outcome()

    # ---- mechanics

    def motion(self, y: np.ndarray) -> tuple[Any, Any]:
        """Opening velocity, and the velocity across the line of centres."""
        return y[WX] * y[NX] + y[WY] * y[NY], y[WY] * y[NX] - y[WX] * y[NY]

    def arms(self, x: float) -> tuple[float, float]:
        b = self.b
        if b.wall:
            return b.radii[0], 0.0
        stretch = 1 + x / b.contact if b.arm == "midgap" else 1.0
        return b.radii[0] * stretch, b.radii[1] * stretch

    def slip(self, y: np.ndarray) -> Any:
        one, other = self.arms(y[X])
        return self.motion(y)[1] - one * y[SPIN] - other * y[PARTNER]

    def loads(self, y: np.ndarray) -> tuple[float, float, float, float]:
        """Forces that are no contact's: along and across the line of centres, and the torques on both spheres."""
        b, (u, across) = self.b, self.motion(y)
        x, one, two = y[X], y[SPIN], y[PARTNER]
        along = -b.pull(x)
        if b.wets(self.inside, not self.closing) and not self.resting:
            along -= b.drag(x) * u
        log = math.log(b.edge / x) if self.sheared else 0.0
        own, cross, other = b.friction_matrix
        if b.wall:
            return along, -log * (other * across - cross * one), log * (cross * across - own * one), 0.0
        omega, stretch = across / (b.contact + x), 1 + x / b.contact if b.arm == "midgap" else 1.0
        first = log * stretch * (own * (omega - one) + cross * (omega - two))
        second = log * stretch * (cross * (omega - one) + other * (omega - two))
        sideways = -(first + second) / (b.contact * stretch)
        if self.strings:
            pull = self.swing(y)
            along += pull[0] * y[NX] + pull[1] * y[NY]
            sideways += pull[1] * y[NX] - pull[0] * y[NY]
        return along, sideways, first, second

    def swing(self, y: np.ndarray) -> tuple[float, float]:
        """Force of the strings on the relative coordinate, from how far it is from where both hang."""
        b, r = self.b, self.b.contact + y[X]
        off = (r * y[NX] - b.contact, r * y[NY])
        stretched = (off[0] ** 2 + off[1] ** 2) / 4 if self.strings.law == "exact" else 0.0
        k = -b.m * self.strings.gravity / math.sqrt(self.strings.length**2 - stretched)
        return k * off[0], k * off[1]

    def reaction(self, y: np.ndarray) -> float:
        """What holds a resting gap: the net force inward."""
        across = self.motion(y)[1]
        turned = 0.0 if self.b.wall else self.b.m * across**2 / (self.b.contact + y[X])
        return -self.loads(y)[0] - turned

    def yields(self, x: float) -> tuple[float, float, float]:
        """Change of the slip by a unit of impulse that a contact gives against it, and what the spins get."""
        b, (one, other) = self.b, self.arms(x)
        spins = one / b.inertias[0], 0.0 if b.wall else other / b.inertias[1]
        return 1 / b.m + one * spins[0] + other * spins[1], *spins

    def needed(self, y: np.ndarray) -> float:
        """The contact's force against the slip that keeps it zero at rest."""
        b, (one, other) = self.b, self.arms(y[X])
        _, sideways, first, second = self.loads(y)
        driven = sideways / b.m - one * first / b.inertias[0] - (0.0 if b.wall else other * second / b.inertias[1])
        return driven / self.yields(y[X])[0]

    def rates(self, _: float, y: np.ndarray) -> list[float]:
        b, (u, across) = self.b, self.motion(y)
        along, sideways, first, second = self.loads(y)
        if self.resting:
            u = 0.0
            along = 0.0 if b.wall else -b.m * across**2 / (b.contact + y[X])
            if b.friction is not None:
                force = self.sliding * b.friction * self.reaction(y) if self.sliding else self.needed(y)
                one, other = self.arms(y[X])
                sideways, first, second = sideways - force, first + one * force, second + other * force
        turning = 0.0 if b.wall else across / (b.contact + y[X])
        fx, fy = along * y[NX] - sideways * y[NY], along * y[NY] + sideways * y[NX]
        second = 0.0 if b.wall else second / b.inertias[1]
        return [u, -turning * y[NY], turning * y[NX], fx / b.m, fy / b.m, first / b.inertias[0], second]

    # ---- events

    def guards(self) -> list[tuple[str, Guard]]:
        """Event functions that are watched, in the order in which coincident ones count; vectorised."""
        b, watched = self.b, []

        def watch(name: str, guard: Guard) -> None:
            watched.append((name, guard))

        if self.resting:
            watch("released", lambda y: each(self.reaction, y))
            if b.friction is not None and self.rotates:
                if self.sliding:
                    watch("stops", lambda y: self.sliding * each(self.slip, y))
                else:
                    watch("slides", lambda y: each(lambda z: b.friction * self.reaction(z) - abs(self.needed(z)), y))
        else:
            sign = -1.0 if self.closing else 1.0
            watch("turned" if self.closing else "fell back", lambda y: sign * self.motion(y)[0])
            if self.closing:
                if math.isfinite(b.glass):
                    watch("glass", lambda y: 1 - b.pressure(y[X], self.motion(y)[0], 0.0)[0] / b.glass)
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
            watch("half turn", lambda y: math.pi - np.arctan2(y[NY], y[NX]) % (2 * math.pi))
            watch("rotation reverses", lambda y: self.motion(y)[1])
        return watched

    @property
    def apart(self) -> bool:
        """Whether the edge of the tangential force is another than that of the film."""
        return not (self.rim and self.b.edge == self.b.film_thickness)

    def criterion(self) -> str:
        """The rebound criterion that holds at present."""
        b, u = self.b, self.motion(self.y)[0]
        if b.pressure(self.y[X], u, 0.0)[0] >= b.glass:
            return "glass"
        return "elastic" if self.y[X] <= self.elastic else "rough" if self.y[X] <= b.roughness else ""

    def rebound(self, kind: str) -> None:
        """The dry contact: it may separate the pair, or hold it."""
        b, (u, _) = self.b, self.motion(self.y)
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
        if self.resting:
            normal = -b.m * u  # the outgoing part is given up
            self.push(-self.motion(self.y)[0])
        if b.friction is not None and (kind != "glass" or b.friction_in_glass):
            self.rub(normal)
        if self.resting:
            self.log("rests")
            self.grip()

    def push(self, change: float) -> None:
        """Change the opening velocity."""
        self.y[WX] += change * self.y[NX]
        self.y[WY] += change * self.y[NY]

    def rub(self, normal: float) -> None:
        """The tangential impulse of a contact: Walton and Braun's."""
        b, slip = self.b, self.slip(self.y)
        whole, one, other = self.yields(self.y[X])
        impulse = math.copysign(min(b.friction * normal, (1 + (b.beta_0 or 0.0)) * abs(slip) / whole), slip)
        self.y[WX] += impulse / b.m * self.y[NY]
        self.y[WY] -= impulse / b.m * self.y[NX]
        self.y[SPIN] += one * impulse
        self.y[PARTNER] += other * impulse

    def grip(self) -> None:
        """Sliding or rolling at the beginning of rest."""
        if self.b.friction is None or not self.rotates:
            return
        slip = self.slip(self.y)
        size = self.v0 + abs(self.motion(self.y)[1])
        self.sliding = math.copysign(1.0, slip)
        if abs(slip) <= NO_SLIP * size:
            self.stops()

    def stops(self) -> None:
        """Zero slip: friction holds it, or it slides in the direction in which it is driven."""
        need = self.needed(self.y)
        held = abs(need) <= self.b.friction * self.reaction(self.y)
        self.sliding = 0.0 if held else math.copysign(1.0, need)
        self.log("rolls" if held else "slides")

    def happen(self, kind: str) -> None:
        """The effect of an event."""
        b = self.b
        if kind in ("turned", "fell back"):
            self.push(-self.motion(self.y)[0])
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
            self.push(RELEASE_SPEED * self.v0 - self.motion(self.y)[0])
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
        r, (u, across) = self.result, self.motion(self.y)
        r.outcome = "bounce" if r.reversal else "stick-rotate-separate"
        r.restitution, r.across = u / self.v0, across

    def log(self, kind: str) -> None:
        self.result.events.append((kind, self.t))

    # ---- certain sticks

    def certain(self) -> bool:
        """Whether the pair can not part any more, by energy or by the film's momentum."""
        b, y = self.b, self.y
        u, across = self.motion(y)
        x, r = y[X], b.contact + y[X]
        if self.strings:
            return not self.rotates and b.m * u * u / 2 + self.hung(x) < self.hung(b.film_thickness)
        if not b.cohesive:
            if self.rotates and not b.wall:
                return False
            return bool(abs(u) < 1e-10 * self.v0 and not self.resting)
        spun = 0.0 if b.wall else b.inertias[0] * y[SPIN] ** 2 + b.inertias[1] * y[PARTNER] ** 2
        kinetic = b.m * (u * u + (0.0 if b.wall else across**2)) / 2 + spun / 2
        momentum = 0.0 if b.wall else b.m * r * across + b.inertias[0] * y[SPIN] + b.inertias[1] * y[PARTNER]
        reserve = 1e-9 if b.arm == "midgap" or b.wall else 0.05  # that arm lets the momentum drift
        scale = kinetic + abs(b.potential(x))
        return bool(kinetic + b.potential(x) + reserve * scale < b.barrier(x, momentum))

    def hung(self, x: float) -> float:
        length, stiff = self.strings.length, 4 * self.b.m * self.strings.gravity
        if self.strings.law != "exact":
            return float(stiff * (x / 2) ** 2 / (2 * length))
        return float(stiff * (length - math.sqrt(length**2 - (x / 2) ** 2)))

    # ---- the search

    def run(self) -> Outcome:
        """Follow it to separation, or until it certainly sticks."""
        for _ in range(PHASES):
            kind = self.criterion() if self.closing and not self.resting else ""
            if kind:
                if kind != "glass":
                    self.y[X] = self.solid
                self.rebound(kind)
                if self.y[X] >= self.b.rupture:
                    self.part()
            elif self.certain():
                self.result.outcome = "stick"
            else:
                self.phase()
            if self.result.outcome:
                self.result.time, self.result.spins = self.t, (self.y[SPIN], self.y[PARTNER])
                return self.result
        msg = "phases"
        raise UndecidedError(msg)

    def phase(self) -> None:
        """Integrate to the first event of the present mode, or until the stick is certain."""
        b, watched = self.b, self.guards()
        spin = (self.v0 + abs(self.motion(self.y)[1])) / b.radii[0]
        sizes = np.array([1e-6 * self.y[X], 1e-2, 1e-2, *2 * [1e-2 * self.v0], *2 * [1e-2 * spin]])
        first = 1e-6 * self.y[X] / (abs(self.motion(self.y)[0]) + 1e-6 * self.v0)
        solver = LSODA(self.rates, self.t, self.y, math.inf, first, rtol=self.accuracy, atol=self.accuracy * sizes)
        before = None
        while solver.status == "running":
            self.steps += 1
            if self.steps > STEPS:
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
        values = np.array([guard(dense(times)) for _, guard in watched])
        found, last = [], len(times) - 1
        for k, (name, guard) in enumerate(watched):

            def at(t: float, guard: Guard = guard) -> float:
                return float(guard(dense(t)))

            def zero(start: float, end: float, at: Callable[[float], float] = at) -> float:
                return float(brentq(at, start, end, xtol=1e-300, rtol=1e-14))

            row = values[k].tolist()
            for j, mid in enumerate(row):
                start, end = times[max(j - 1, 0)], times[min(j + 1, last)]
                low = row[j - 1] if j else row[0] if before is None else before[k]
                if j and mid <= 0 and (low > 0 or mid < low):
                    found.append((zero(start, times[j]) if low > 0 else float(start), k, name))
                    break
                high = row[j + 1] if j < last else mid
                if 0 < mid <= min(low, high) and mid < 2 * (max(low, high) - mid) and at(start) > 0:
                    least = minimize_scalar(at, bounds=(start, end), method="bounded", options={"xatol": 1e-9 * end})
                    if least.fun < 0:
                        found.append((zero(start, least.x), k, name))
                        break
        return found, values[:, -2]


def each(function: Callable[[np.ndarray], float], states: np.ndarray) -> Any:
    """A function of one state, at each of many."""
    return function(states) if states.ndim == 1 else np.array([function(column) for column in states.T])


def scanned(scene: Scene, rtol: float = 1e-9, speed: float | None = None) -> Outcome:
    """A collision of the scene at its impact, or with another normal speed."""
    return Scan(scene, rtol, speed=speed).run()
