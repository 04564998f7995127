"""A collision in space followed by LSODA in Cartesian velocities, its events searched for on a grid of dense output.

Written from the model's description and the table of events alone, so that it shares no method with the engines: the
relative velocity is a vector in the laboratory's axes, which turns by no centrifugal term; nothing is eliminated. Every
step is sampled, and between samples each event function that dips is minimised: a graze is not stepped over. Collisions
in a plane lie in that of x and y; strings, and rolling at rest, are followed there alone.
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

from .two_bodies import Bodies, bodies_of

X, N, W, SPIN, PARTNER = 0, 1, 4, 7, 10
SAMPLES = 12  # of each step
STEPS, PHASES, ACCURACY = 12_000, 600, 1e-11
REST_SPEED, RELEASE_SPEED, NO_SLIP = 1e-9, 1e-12, 1e-12  # in v0
FAR = 1e30
Vector = tuple[Any, Any, Any]
Guard = Callable[[np.ndarray], Any]
ZERO: Vector = (0.0, 0.0, 0.0)


def dot(p: Vector, q: Vector) -> Any:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p: Vector, q: Vector) -> Vector:
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


def plus(p: Vector, s: Any, q: Vector) -> Vector:
    """P + s q."""
    return p[0] + s * q[0], p[1] + s * q[1], p[2] + s * q[2]


def across(p: Vector, n: Vector) -> Vector:
    """What of p is perpendicular to n."""
    return plus(p, -dot(p, n), n)


def at(y: Any, where: int) -> Vector:
    return y[where], y[where + 1], y[where + 2]


class UndecidedError(Exception):
    """The budget of steps or phases is exhausted, or what happens is not followed here."""


@dataclass(frozen=True)
class Arrival:
    """Initial contact: unit normal from the first body to the second, velocities (m/s), angular velocities (rad/s)."""

    normal: Vector
    velocities: tuple[Vector, Vector]
    spins: tuple[Vector, Vector]

    @property
    def relative(self) -> Vector:
        return plus(self.velocities[1], -1.0, self.velocities[0])

    @property
    def speed(self) -> float:
        """Normal approach speed."""
        return float(-dot(self.relative, self.normal))


def planar_arrival(
    scene: Scene, speed: float | None = None, axes: Sequence[Vector] = (), drift: Vector = ZERO
) -> Arrival:
    """The arrival of a scene's impact, in the plane of the normal and a tangential direction; x and y without `axes`.

    The line of centres turns from the first to the second axis; `drift` is the velocity of the centre of mass, left out
    beside a wall, which is at rest. The angle means omega_0 = v0 tan(theta0)/(R_1 + R_2).
    """
    b, (usual, angle) = bodies_of(scene), scene.need_impact()
    speed, (normal, tangent) = speed or usual, axes or ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    along = speed * math.tan(angle) * (1.0 if b.wall else 1 + b.film_thickness / b.contact)
    relative = plus(plus(ZERO, -speed, normal), along, tangent)
    share = 1.0 if b.wall else b.m / b.masses[0]
    drift = ZERO if b.wall else drift
    spin = float(scene.entries.get("impact.spin", 0.0))
    partner = 0.0 if b.wall else float(scene.entries.get("impact.partner_spin", spin))
    out = cross(normal, tangent)
    velocities = plus(drift, -share, relative), plus(drift, 1 - share, relative)
    return Arrival(normal, velocities, (plus(ZERO, spin, out), plus(ZERO, partner, out)))


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


class Scan:
    """One collision; `run` follows it. `rtol` is that of the engine beside which it stands."""

    def __init__(
        self, b: Bodies, arrival: Arrival, strings: Any = None, rtol: float = 1e-9, accuracy: float = ACCURACY
    ) -> None:
        self.b, self.v0, self.strings, self.rtol, self.accuracy = b, arrival.speed, strings, rtol, accuracy
        second = ZERO if b.wall else arrival.spins[1]
        self.y = np.array([b.film_thickness, *arrival.normal, *arrival.relative, *arrival.spins[0], *second])
        beside = plus(arrival.relative, self.v0, arrival.normal)
        self.rotates = any(map(any, (beside, arrival.spins[0], second)))
        self.flat = not (beside[2] or arrival.normal[2] or any((*arrival.spins[0][:2], *second[:2])))
        self.elastic = b.elastic_gap(self.v0)
        self.solid = max(self.elastic, b.roughness)
        self.rim = bool(b.law) and b.film != "constant-volume"  # whether passing x0 is an event
        self.inside, self.sheared = True, b.edge >= b.film_thickness
        self.closing, self.resting = True, False
        self.sliding = 0.0  # in resting contact with friction: the sign of the slip (in space: 1); 0 while rolling
        self.t, self.steps, self.most = 0.0, 0, STEPS
        self.result = Outcome()

    # ---- mechanics

    def opening(self, y: Any) -> Any:
        return dot(at(y, W), at(y, N))

    def sideways(self, y: Any) -> Vector:
        """Velocity across the line of centres."""
        return across(at(y, W), at(y, N))

    def arms(self, x: float) -> tuple[float, float]:
        b = self.b
        if b.wall:
            return b.radii[0], 0.0
        stretch = 1 + x / b.contact if b.arm == "midgap" else 1.0
        return b.radii[0] * stretch, b.radii[1] * stretch

    def slip(self, y: Any) -> Vector:
        one, other = self.arms(y[X])
        return plus(self.sideways(y), -1.0, cross(plus(plus(ZERO, one, at(y, SPIN)), other, at(y, PARTNER)), at(y, N)))

    def signed(self, slip: Vector, y: Any) -> Any:
        """A slip in the plane, positive where the line of centres turns about z; in space its size."""
        return cross(at(y, N), slip)[2] if self.flat else math.hypot(*slip)

    def against(self, y: Any) -> Vector:
        """Unit vector of what the contact gives to the second body against a slip of sign 1."""
        if self.flat:
            return cross(at(y, N), (0.0, 0.0, 1.0))
        slip = self.slip(y)
        return plus(ZERO, -1 / (math.hypot(*slip) or 1.0), slip)

    def loads(self, y: Any) -> tuple[float, Vector, Vector, Vector]:
        """Forces that are no contact's on the second: outward and across, and the torques on both bodies."""
        b, x, n, w = self.b, y[X], at(y, N), at(y, W)
        outward = -b.pull(x)
        if b.wets(self.inside, not self.closing) and not self.resting:
            outward -= b.drag(x) * dot(w, n)
        log = math.log(b.edge / x) if self.sheared else 0.0
        own, mixed, other = b.friction_matrix
        one, two = across(at(y, SPIN), n), across(at(y, PARTNER), n)
        if b.wall:
            force = plus(plus(ZERO, -log * other, across(w, n)), log * mixed, cross(one, n))
            return outward, force, plus(plus(ZERO, -log * own, one), log * mixed, cross(n, w)), ZERO
        r, stretch = b.contact + x, 1 + x / b.contact if b.arm == "midgap" else 1.0
        line = plus(ZERO, 1 / r, cross(n, w))
        slip, partner = plus(line, -1.0, one), plus(line, -1.0, two)
        first = plus(plus(ZERO, log * stretch * own, slip), log * stretch * mixed, partner)
        second = plus(plus(ZERO, log * stretch * mixed, slip), log * stretch * other, partner)
        force = plus(ZERO, -1 / (b.contact * stretch), cross(plus(first, 1.0, second), n))
        if self.strings:
            pull = self.swing(r, n)
            outward += dot(pull, n)
            force = plus(force, 1.0, across(pull, n))
        return outward, force, first, second

    def swing(self, r: float, n: Vector) -> Vector:
        """Force of the strings on the relative coordinate, from how far it is from where both hang."""
        off = plus(plus(ZERO, r, n), -self.b.contact, (1.0, 0.0, 0.0))
        stretched = dot(off, off) / 4 if self.strings.law == "exact" else 0.0
        return plus(ZERO, -self.b.m * self.strings.gravity / math.sqrt(self.strings.length**2 - stretched), off)

    def reaction(self, y: Any) -> float:
        """What holds a resting gap: the net force inward."""
        sideways = self.sideways(y)
        turned = 0.0 if self.b.wall else self.b.m * dot(sideways, sideways) / (self.b.contact + y[X])
        return -self.loads(y)[0] - turned

    def yields(self, x: float) -> tuple[float, float, float]:
        """Change of the slip by a unit of impulse that a contact gives against it, and what the spins get."""
        b, (one, other) = self.b, self.arms(x)
        spins = one / b.inertias[0], 0.0 if b.wall else other / b.inertias[1]
        return 1 / b.m + one * spins[0] + other * spins[1], *spins

    def needed(self, y: Any) -> float:
        """The contact's force against the slip that keeps it zero at rest, in the plane."""
        b, (one, other) = self.b, self.arms(y[X])
        _, force, first, second = self.loads(y)
        driven = cross(at(y, N), force)[2] / b.m - one * first[2] / b.inertias[0]
        return (driven - (0.0 if b.wall else other * second[2] / b.inertias[1])) / self.yields(y[X])[0]

    def rates(self, _: float, state: np.ndarray) -> list[float]:
        try:
            return self.slopes(state.tolist())
        except (ArithmeticError, ValueError):  # a trial step out of the domain: rejected for its error
            return [FAR] * state.size

    def slopes(self, y: list[float]) -> list[float]:
        b = self.b
        n, u, beside = at(y, N), self.opening(y), self.sideways(y)
        outward, force, first, second = self.loads(y)
        r = b.contact + y[X]
        if self.resting:
            u = 0.0
            outward = 0.0 if b.wall else -b.m * dot(beside, beside) / r
            if b.friction is not None and self.rotates:
                rub = self.sliding * b.friction * self.reaction(y) if self.sliding else self.needed(y)
                (one, other), impulse = self.arms(y[X]), plus(ZERO, rub, self.against(y))
                force, turn = plus(force, 1.0, impulse), cross(n, impulse)
                first, second = plus(first, -one, turn), plus(second, -other, turn)
        turning = ZERO if b.wall else plus(ZERO, 1 / r, beside)
        pushed = plus(plus(ZERO, outward / b.m, n), 1 / b.m, force)
        other = ZERO if b.wall else plus(ZERO, 1 / b.inertias[1], second)
        return [u, *turning, *pushed, *plus(ZERO, 1 / b.inertias[0], first), *other]

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
                    watch("glass", lambda y: 1 - b.pressure(y[X], self.opening(y), 0.0)[0] / b.glass)
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
        if b.pressure(self.y[X], self.opening(self.y), 0.0)[0] >= b.glass:
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

    def hung(self, x: float) -> float:
        length, stiff = self.strings.length, 4 * self.b.m * self.strings.gravity
        if self.strings.law != "exact":
            return float(stiff * (x / 2) ** 2 / (2 * length))
        return float(stiff * (length - math.sqrt(length**2 - (x / 2) ** 2)))

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
