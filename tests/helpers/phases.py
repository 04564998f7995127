"""The course of a collision, event after event, for any state that has a gap: shared by plane and space.

Written from the documents: rebound criteria while closing, edges, rupture while opening, and when a stick is one.
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field

from .flow import Flow, Guard, Rates, State, Unfinished
from .two_bodies import Bodies

PHASES = 200
LONGEST = 1e13  # of x0/v0, for one phase
RESTS = 1e-9  # of v0: a slower rebound against attraction rests
MARGIN = 1e-6  # of all energies, by which a stick has to lie below the barrier
DRIFTS = 0.02  # the same, of the energy of rotation, where angular momentum is not conserved


class Chatter(ArithmeticError):
    """Rebounds without end, or a contact that rolls, or rests in the plane, with friction: not followed here."""


@dataclass
class End:
    """How a collision ended, SI; `dry` is what rebounds took."""

    outcome: str
    time: float
    state: State
    start: State
    dry: float = 0.0
    events: list[tuple[str, float]] = field(default_factory=list)
    reversal: str | None = None


class Course(ABC):
    """One collision from initial contact, at this normal speed."""

    def __init__(self, bodies: Bodies, speed: float, start: State) -> None:
        self.bodies, self.speed, self.y = bodies, speed, start
        self.end = End("stick", 0.0, self.y, list(start))
        self.energy = self.kinetic(start)
        self.closing = self.inside = True
        self.resting = False
        self.sheared = bodies.edge >= bodies.film_thickness
        self.elastic = bodies.elastic_gap(speed)
        self.solid = max(self.elastic, bodies.roughness)

    # ---- what a state is

    @abstractmethod
    def rates(self) -> Rates:
        """Rates of the state in the present phase."""

    @abstractmethod
    def sizes(self) -> list[float]:
        """What rounding of each component is relative to."""

    @abstractmethod
    def gap(self, y: Sequence[float]) -> float: ...

    @abstractmethod
    def opening(self, y: Sequence[float], dy: Sequence[float]) -> tuple[float, float]:
        """Rate of the gap, and its rate."""

    @abstractmethod
    def centrifugal(self, y: Sequence[float], dy: Sequence[float]) -> tuple[float, float]:
        """Acceleration of the gap by rotation, and its rate at rest; 0 beside a wall."""

    @abstractmethod
    def put(self, gap: float) -> None:
        """Set the gap."""

    @abstractmethod
    def stop(self) -> None:
        """Take away the rate of the gap."""

    @abstractmethod
    def reverse(self, solid: bool) -> None:
        """The rebound's impulses."""

    def slides(self) -> Guard | None:
        """Guard of the end of sliding at rest; None where friction at rest is not followed."""
        return None

    @abstractmethod
    def kinetic(self, y: Sequence[float]) -> float:
        """Kinetic energy, the centre of mass at rest."""

    @abstractmethod
    def momentum(self, y: Sequence[float]) -> float:
        """Magnitude of the angular momentum about the centre of mass; 0 beside a wall."""

    # ---- events

    def guards(self) -> dict[str, Guard]:
        b, v0 = self.bodies, self.speed
        found: dict[str, Guard] = {}

        def reaching(gap: float, sign: int) -> Guard:
            return lambda y, dy: (sign * (self.gap(y) / gap - 1), sign * self.opening(y, dy)[0] / gap)

        def moving(sign: int) -> Guard:
            def guard(y: Sequence[float], dy: Sequence[float]) -> tuple[float, float]:
                u, rate = self.opening(y, dy)
                return sign * u / v0, sign * rate / v0

            return guard

        def glass(y: Sequence[float], dy: Sequence[float]) -> tuple[float, float]:
            pressure, rate = b.pressure(self.gap(y), *self.opening(y, dy))
            return pressure / b.glass - 1, rate / b.glass

        def lifted(y: Sequence[float], dy: Sequence[float]) -> tuple[float, float]:
            scale = b.film_thickness / v0**2
            outward, rate = self.centrifugal(y, dy)
            return (outward - b.pull(self.gap(y)) / b.m) * scale, rate * scale

        if self.resting:
            slides = self.slides() if b.friction is not None else None
            return {"released": lifted} | ({"rolls": slides} if slides else {})
        if self.closing:
            found |= {"turned": moving(1), "glass": glass}
            if self.solid:
                found["solid"] = reaching(self.solid, -1)
        else:
            found |= {"fell back": moving(-1), "rupture": reaching(b.rupture, 1)}
        if b.rupture > b.film_thickness and self.inside != self.closing:
            found["film edge"] = reaching(b.film_thickness, 1 if self.inside else -1)
        if b.film_thickness != b.edge < b.rupture and self.sheared != self.closing:
            found["tangential edge"] = reaching(b.edge, 1 if self.sheared else -1)
        return found

    def sticks(self, _: float, y: Sequence[float]) -> bool:
        """Whether the bodies cannot part any more, by a comfortable margin."""
        b, x = self.bodies, self.gap(y)
        u = self.opening(y, y)[0]
        kinetic = self.kinetic(y)
        rotation = kinetic - b.m * u**2 / 2
        if b.wall:
            kinetic, rotation = b.m * u**2 / 2, 0.0
        if b.cohesive:
            held = b.potential(x)
            margin = MARGIN * (kinetic + abs(held))
            if b.arm == "surface":
                margin += DRIFTS * rotation
            return kinetic + held + margin < b.barrier(x, self.momentum(y))
        if not b.wets(self.inside, not self.closing):
            return False
        outward, rate = self.centrifugal(y, self.rates()(0.0, y))
        time = b.film_thickness / self.speed
        if max(abs(outward), abs(rate) * time) > 1e-20 * self.speed / time:
            return False
        far = b.pressure(x, u, 0.0)[0] < 0.5 * b.glass and x > 1.001 * self.solid
        return abs(u) < 1e-12 * self.speed and (far or not self.closing)

    def met(self) -> str | None:
        """A criterion that holds as an approach begins."""
        x, u = self.gap(self.y), self.opening(self.y, self.y)[0]
        if self.bodies.pressure(x, u, 0.0)[0] >= self.bodies.glass:
            return "glass"
        return "solid" if x <= self.solid else None

    def run(self) -> End:
        """Follow the collision to separation, or until it certainly sticks.

        Raises:
            Chatter: rebounds without end, or rest with friction.
            Unfinished: no end was reached.
        """
        for _ in range(PHASES):
            name = self.met() if self.closing else None
            if name is None:
                flow = Flow(self.rates(), self.sizes(), LONGEST * self.bodies.film_thickness / self.speed)
                arrival = flow.until(self.end.time, self.y, self.guards(), self.sticks)
                self.end.time, self.y[:] = arrival.t, arrival.y
                if arrival.guard is None:
                    if not (self.bodies.cohesive or self.sticks(arrival.t, self.y)):
                        raise Unfinished(f"neither parted nor held after {arrival.t} s")
                    return self.end
                name = arrival.guard
            if self._after(name):
                return self.end
        raise Chatter(f"{PHASES} phases")

    def _after(self, name: str) -> bool:
        """Take the effect of an event; whether it is the last."""
        b = self.bodies
        self.end.events.append((self._word(name), self.end.time))
        if name in ("glass", "solid"):
            return self._rebound(name)
        if name in ("turned", "fell back"):
            self.closing = not self.closing
        elif name == "released":
            self.resting = False
        elif name == "rolls":
            raise Chatter(f"rolls at {self.end.time} s")
        elif name == "film edge":
            self.put(b.film_thickness)
            self.inside = not self.inside
            self.sheared = self.inside if b.edge == b.film_thickness else self.sheared
        elif name == "tangential edge":
            self.put(b.edge)
            self.sheared = not self.sheared
        else:
            self.put(b.rupture)
            return self._separated()
        return False

    def _word(self, name: str) -> str:
        if name != "solid":
            return name
        return "elastic" if self.elastic >= self.bodies.roughness else "rough"

    def _separated(self) -> bool:
        self.end.outcome = "bounce" if self.end.reversal else "stick-rotate-separate"
        return True

    def _rebound(self, name: str) -> bool:
        b, y = self.bodies, self.y
        self.end.reversal = self.end.reversal or self._word(name)
        if name == "solid":
            self.put(min(self.gap(y), self.solid))
        before = self.kinetic(y)
        self.reverse(name == "solid")
        self.end.dry += before - self.kinetic(y)
        self.closing, x = False, self.gap(y)
        if x >= b.rupture:
            self.end.events.append(("rupture", self.end.time))
            return self._separated()
        if x >= b.film_thickness:
            self.inside = False
            self.sheared = self.sheared and b.edge > b.film_thickness
        u, rate = self.opening(y, self.rates()(0.0, y))
        if abs(u) < RESTS * self.speed and rate <= 0.0:
            if b.friction is not None and self.slides() is None:
                raise Chatter(f"rest with friction at {self.end.time} s")
            self.end.events.append(("rests", self.end.time))
            self.end.dry += b.m * u**2 / 2
            self.stop()
            self.resting = True
        return False
