"""A collision in the plane, with spins, from the physics alone: SI units, both spins always, events of its own.

Two spheres, equal or not, or a sphere beside a wall. The state is gap, its rate, the angular velocity of the line of
centres (beside a wall: the velocity along it), both spins, the angle turned, and what film, shear and attraction took.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from .flow import Flow, Guard, State, Unfinished
from .two_bodies import Bodies

X, U, TURNING, SPIN, PARTNER, ANGLE, FILM, SHEAR, WORK = range(9)
RESTS = 1e-9  # of v0: a slower rebound against attraction chatters
MARGIN = 1e-6  # of all energies, by which a stick has to lie below the barrier
DRIFTS = 0.02  # the same, of the energy of rotation, where angular momentum is not conserved


class Chatter(ArithmeticError):
    """A rebound too weak to leave the contact, which this reference does not follow."""


@dataclass(frozen=True)
class Impact:
    """Normal approach speed, angle and spins at initial contact."""

    speed: float
    angle: float
    spin: float = 0.0
    partner_spin: float = 0.0


@dataclass
class End:
    """How a collision ended: SI, `state` as the module says; `dry` is what rebounds took."""

    outcome: str
    time: float
    state: State
    start: State
    dry: float = 0.0
    events: list[tuple[str, float]] = field(default_factory=list)
    reversal: str | None = None

    def restitution(self, impact: Impact) -> float:
        return 0.0 if self.outcome == "stick" else self.state[U] / impact.speed


@dataclass
class Mechanics:
    """Energies, momenta and slip of a state."""

    bodies: Bodies

    def kinetic(self, y: Sequence[float]) -> float:
        b = self.bodies
        across = y[TURNING] if b.wall else (b.contact + y[X]) * y[TURNING]
        spins = b.inertias[0] * y[SPIN] ** 2 + (0.0 if b.wall else b.inertias[1] * y[PARTNER] ** 2)
        return (b.m * (y[U] ** 2 + across**2) + spins) / 2

    def momentum(self, y: Sequence[float]) -> float:
        """Angular momentum about the centre of mass; 0 beside a wall."""
        b = self.bodies
        if b.wall:
            return 0.0
        orbital = b.m * (b.contact + y[X]) ** 2 * y[TURNING]
        return orbital + b.inertias[0] * y[SPIN] + b.inertias[1] * y[PARTNER]

    def stretch(self, x: float) -> float:
        """Lever arm of the tangential force about a sphere's centre over its radius."""
        b = self.bodies
        return 1.0 if b.wall or b.arm == "surface" else (b.contact + x) / b.contact

    def slip(self, y: Sequence[float]) -> float:
        """Relative velocity of the surfaces across the line of centres, at the lever arms."""
        b, arm = self.bodies, self.stretch(y[X])
        if b.wall:
            return y[TURNING] - b.radii[0] * y[SPIN]
        rolling = b.radii[0] * y[SPIN] + b.radii[1] * y[PARTNER]
        return (b.contact + y[X]) * y[TURNING] - arm * rolling

    def strike(self, y: State, impulse: float) -> None:
        """Change the state by a tangential impulse that resists positive slip."""
        b, arm = self.bodies, self.stretch(y[X])
        y[TURNING] -= impulse / b.m / (1.0 if b.wall else b.contact + y[X])
        y[SPIN] += arm * b.radii[0] * impulse / b.inertias[0]
        if not b.wall:
            y[PARTNER] += arm * b.radii[1] * impulse / b.inertias[1]

    def yielding(self, x: float) -> float:
        """Change of slip per tangential impulse."""
        b, arm = self.bodies, self.stretch(x)
        found = 1 / b.m + (arm * b.radii[0]) ** 2 / b.inertias[0]
        return found if b.wall else found + (arm * b.radii[1]) ** 2 / b.inertias[1]


class _Collision:
    """One collision, phase after phase."""

    def __init__(self, bodies: Bodies, impact: Impact) -> None:
        b = self.bodies = bodies
        self.mechanics, self.impact = Mechanics(b), impact
        along = impact.speed * math.tan(impact.angle)
        partner = 0.0 if b.wall else impact.partner_spin
        turning = along if b.wall else along / b.contact
        self.y: State = [b.film_thickness, -impact.speed, turning, impact.spin, partner, 0.0, 0.0, 0.0, 0.0]
        self.end = End("stick", 0.0, self.y, list(self.y))
        self.energy = self.mechanics.kinetic(self.y)
        self.closing = self.inside = True
        self.sheared = b.edge >= b.film_thickness
        self.elastic = b.elastic_gap(impact.speed)
        self.solid = max(self.elastic, b.roughness)

    # ---- motion between events

    def rates(self) -> Callable[[float, Sequence[float]], State]:
        b, resists = self.bodies, self.bodies.wets(self.inside, not self.closing)
        (own, cross, other), (inertia, second) = b.friction_matrix, b.inertias
        m, contact, edge, sheared, wall = b.m, b.contact, b.edge, self.sheared, b.wall
        midgap = b.arm == "midgap"

        def beside_a_wall(_: float, y: Sequence[float]) -> State:
            x, u, v, spin = y[X], y[U], y[TURNING], y[SPIN]
            drag, pull = b.drag(x) * u if resists else 0.0, b.pull(x)
            log = math.log(edge / x) if sheared else 0.0
            torque, force = log * (cross * v - own * spin), log * (other * v - cross * spin)
            power = force * v - torque * spin
            return [u, -(drag + pull) / m, -force / m, torque / inertia, 0.0, 0.0, drag * u, power, pull * u]

        def pair(_: float, y: Sequence[float]) -> State:
            x, u, omega, spin, partner = y[X], y[U], y[TURNING], y[SPIN], y[PARTNER]
            r = contact + x
            drag, pull = b.drag(x) * u if resists else 0.0, b.pull(x)
            log = math.log(edge / x) if sheared else 0.0
            if midgap:
                log *= r / contact
            slip, partner_slip = omega - spin, omega - partner
            torque, back = log * (own * slip + cross * partner_slip), log * (cross * slip + other * partner_slip)
            force = (torque + back) / (r if midgap else contact)
            power = force * r * omega - torque * spin - back * partner
            return [
                u,
                r * omega * omega - (drag + pull) / m,
                -(force / m + 2 * u * omega) / r,
                torque / inertia,
                back / second,
                omega,
                drag * u,
                power,
                pull * u,
            ]

        return beside_a_wall if wall else pair

    def sizes(self) -> list[float]:
        b, v0 = self.bodies, self.impact.speed
        turning = v0 if b.wall else v0 / b.contact
        spin = v0 / b.radii[0]
        return [1e-3 * b.film_thickness, 0.1 * v0, turning, spin, spin, 1.0, self.energy, self.energy, self.energy]

    def guards(self) -> dict[str, Guard]:
        b, v0 = self.bodies, self.impact.speed
        found: dict[str, Guard] = {}

        def reaching(gap: float, sign: int) -> Guard:
            return lambda y, dy: (sign * (y[X] / gap - 1), sign * dy[X] / gap)

        def glass(y: Sequence[float], dy: Sequence[float]) -> tuple[float, float]:
            pressure, rate = b.pressure(y[X], y[U], dy[U])
            return pressure / b.glass - 1, rate / b.glass

        if self.closing:
            found["turned"] = lambda y, dy: (y[U] / v0, dy[U] / v0)
            found["glass"] = glass
            if self.solid:
                found["solid"] = reaching(self.solid, -1)
        else:
            found["fell back"] = lambda y, dy: (-y[U] / v0, -dy[U] / v0)
            found["rupture"] = reaching(b.rupture, 1)
        if b.rupture > b.film_thickness and self.inside != self.closing:
            found["film edge"] = reaching(b.film_thickness, 1 if self.inside else -1)
        if b.film_thickness != b.edge < b.rupture and self.sheared != self.closing:
            found["tangential edge"] = reaching(b.edge, 1 if self.sheared else -1)
        return found

    def sticks(self, _: float, y: Sequence[float]) -> bool:
        """Whether the bodies cannot part any more, by a comfortable margin."""
        b = self.bodies
        kinetic = self.mechanics.kinetic(y)
        rotation = kinetic - b.m * y[U] ** 2 / 2
        if b.wall:
            kinetic, rotation = b.m * y[U] ** 2 / 2, 0.0
        if b.cohesive:
            held = b.potential(y[X])
            margin = MARGIN * (kinetic + abs(held))
            if b.arm == "surface" and not b.wall:
                margin += DRIFTS * rotation
            return kinetic + held + margin < b.barrier(y[X], self.mechanics.momentum(y))
        if rotation > 1e-20 * self.energy or not b.wets(self.inside, not self.closing):
            return False
        far = b.pressure(y[X], y[U], 0.0)[0] < 0.5 * b.glass and y[X] > 1.001 * self.solid
        return abs(y[U]) < 1e-12 * self.impact.speed and (far or not self.closing)

    # ---- events

    def met(self) -> str | None:
        """A criterion that holds as an approach begins."""
        b, y = self.bodies, self.y
        if b.pressure(y[X], y[U], 0.0)[0] >= b.glass:
            return "glass"
        return "solid" if y[X] <= self.solid else None

    def run(self) -> End:
        for _ in range(200):
            name = self.met() if self.closing else None
            if name is None:
                flow = Flow(self.rates(), self.sizes(), 1e9 * self.bodies.film_thickness / self.impact.speed)
                arrival = flow.until(self.end.time, self.y, self.guards(), self.sticks)
                self.end.time, self.y[:] = arrival.t, arrival.y
                if arrival.guard is None:
                    return self.end
                name = arrival.guard
            if self.after(name):
                return self.end
        raise Chatter("200 phases")

    def after(self, name: str) -> bool:
        """Take the effect of an event; whether it is the last."""
        b, y = self.bodies, self.y
        self.end.events.append((self.word(name), self.end.time))
        if name in ("glass", "solid"):
            return self.rebound(name)
        if name in ("turned", "fell back"):
            y[U], self.closing = 0.0, not self.closing
        elif name == "film edge":
            y[X], self.inside = b.film_thickness, not self.inside
            self.sheared = self.inside if b.edge == b.film_thickness else self.sheared
        elif name == "tangential edge":
            y[X], self.sheared = b.edge, not self.sheared
        else:
            y[X] = b.rupture
            return self.separated()
        return False

    def word(self, name: str) -> str:
        if name != "solid":
            return name
        return "elastic" if self.elastic >= self.bodies.roughness else "rough"

    def separated(self) -> bool:
        self.end.outcome = "bounce" if self.end.reversal else "stick-rotate-separate"
        return True

    def rebound(self, name: str) -> bool:
        b, y, mechanics = self.bodies, self.y, self.mechanics
        self.end.reversal = self.end.reversal or self.word(name)
        if name == "solid":
            y[X] = min(y[X], self.solid)
        before, normal = mechanics.kinetic(y), -(1 + b.dry_restitution) * b.m * y[U]
        y[U] *= -b.dry_restitution
        if b.friction is not None and (name == "solid" or b.friction_in_glass):
            slip = mechanics.slip(y)
            sticking = (1 + (b.beta_0 or 0.0)) * abs(slip) / mechanics.yielding(y[X])
            mechanics.strike(y, math.copysign(min(b.friction * normal, sticking), slip))
        self.end.dry += before - mechanics.kinetic(y)
        self.closing = False
        if y[X] >= b.rupture:
            self.end.events.append(("rupture", self.end.time))
            return self.separated()
        if y[X] >= b.film_thickness:
            self.inside = False
            self.sheared = self.sheared and b.edge > b.film_thickness
        if abs(y[U]) < RESTS * self.impact.speed and self.rates()(0.0, y)[U] <= 0.0:
            raise Chatter(f"rebound of {y[U]} m/s at {self.end.time} s")
        return False


def collided(bodies: Bodies, impact: Impact) -> End:
    """Follow a collision to separation, or until it certainly sticks.

    Raises:
        Chatter: a rebound too weak to leave the contact.
        Unfinished: no end was reached.
    """
    try:
        return _Collision(bodies, impact).run()
    except OverflowError as error:
        raise Unfinished(str(error)) from error
