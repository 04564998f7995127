"""A collision in space, in the laboratory's axes: positions, velocities and angular velocities of both bodies.

Nothing is eliminated; the gap is a state of its own because the difference of two positions has lost its digits. Beside
a wall the second body is a plane at rest. Twist about the line of centres meets no resistance.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .flow import Guard, Rates, State
from .phases import Course, End
from .spinning import Impact
from .two_bodies import Bodies

Vector = tuple[float, float, float]
ZERO: Vector = (0.0, 0.0, 0.0)
PLACE, VELOCITY, SPIN, OTHER_PLACE, OTHER_VELOCITY, OTHER_SPIN = range(0, 18, 3)
GAP, FILM, SHEAR, WORK = range(18, 22)


def dot(p: Vector, q: Vector) -> float:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p: Vector, q: Vector) -> Vector:
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


def plus(p: Vector, s: float, q: Vector) -> Vector:
    """P + s q."""
    return p[0] + s * q[0], p[1] + s * q[1], p[2] + s * q[2]


def across(p: Vector, n: Vector) -> Vector:
    """What of p is perpendicular to n."""
    return plus(p, -dot(p, n), n)


def at(y: Sequence[float], where: int) -> Vector:
    return y[where], y[where + 1], y[where + 2]


@dataclass(frozen=True)
class Arrival:
    """Initial contact: unit normal from the first body to the second, velocities (m/s), angular velocities (rad/s)."""

    normal: Vector
    velocities: tuple[Vector, Vector]
    spins: tuple[Vector, Vector]

    @property
    def speed(self) -> float:
        """Normal approach speed."""
        return -dot(plus(self.velocities[1], -1.0, self.velocities[0]), self.normal)


class Spatial(Course):
    """A collision in space; the first body's centre is at the origin at initial contact."""

    def __init__(self, bodies: Bodies, arrival: Arrival) -> None:
        self.fixed = arrival.normal
        self.fastest = max(math.hypot(*each) for each in (*arrival.velocities, (arrival.speed,)))
        surfaces = zip(arrival.spins, bodies.radii, strict=True)
        self.spinning = max(math.hypot(*each) * radius for each, radius in surfaces if any(each) or radius < math.inf)
        reach = 0.0 if bodies.wall else bodies.contact + bodies.film_thickness
        places = (ZERO, plus(ZERO, reach, arrival.normal))
        start = [
            each
            for k in range(2)
            for vector in (places[k], arrival.velocities[k], arrival.spins[k])
            for each in (ZERO if bodies.wall and k else vector)
        ]
        super().__init__(bodies, arrival.speed, [*start, bodies.film_thickness, 0.0, 0.0, 0.0])

    # ---- geometry

    def normal(self, y: Sequence[float]) -> Vector:
        """Unit vector from the first body to the second."""
        if self.bodies.wall:
            return self.fixed
        apart = plus(at(y, OTHER_PLACE), -1.0, at(y, PLACE))
        r = math.hypot(*apart)
        return apart[0] / r, apart[1] / r, apart[2] / r

    def relative(self, y: Sequence[float]) -> Vector:
        return plus(at(y, OTHER_VELOCITY), -1.0, at(y, VELOCITY))

    def gap(self, y: Sequence[float]) -> float:
        return y[GAP]

    def opening(self, y: Sequence[float], dy: Sequence[float]) -> tuple[float, float]:
        n, v = self.normal(y), self.relative(y)
        u = dot(n, v)
        turning = 0.0 if self.bodies.wall else (dot(v, v) - u * u) / (self.bodies.contact + y[GAP])
        return u, dot(n, self.relative(dy)) + turning

    def centrifugal(self, y: Sequence[float], dy: Sequence[float]) -> tuple[float, float]:
        if self.bodies.wall:
            return 0.0, 0.0
        n, v, r = self.normal(y), self.relative(y), self.bodies.contact + y[GAP]
        return dot(across(v, n), v) / r, 2 * dot(across(v, n), self.relative(dy)) / r

    def stop(self) -> None:
        self._push(-dot(self.normal(self.y), self.relative(self.y)))

    def put(self, gap: float) -> None:
        self.y[GAP] = gap

    # ---- motion

    def rates(self) -> Rates:
        return self._beside_a_wall() if self.bodies.wall else self._pair()

    def _pair(self) -> Rates:
        b, resists, sheared = self.bodies, self.bodies.wets(self.inside, not self.closing), self.sheared
        (own, mixed, other), (inertia, second) = b.friction_matrix, b.inertias
        contact, edge, midgap, (mass, second_mass) = b.contact, b.edge, b.arm == "midgap", b.masses
        m, resting = b.m, self.resting

        def rates(_: float, y: Sequence[float]) -> State:
            x, n, v = y[GAP], self.normal(y), self.relative(y)
            spin, partner = at(y, SPIN), at(y, OTHER_SPIN)
            r, u = contact + x, dot(n, v)
            drag, pull = b.drag(x) * u if resists else 0.0, b.pull(x)
            log = math.log(edge / x) if sheared else 0.0
            if midgap:
                log *= r / contact
            turning = plus(ZERO, 1 / r, cross(n, v))
            slip, partner_slip = plus(turning, -1.0, across(spin, n)), plus(turning, -1.0, across(partner, n))
            torque = plus(plus(ZERO, log * own, slip), log * mixed, partner_slip)
            back = plus(plus(ZERO, log * mixed, slip), log * other, partner_slip)
            sideways = plus(ZERO, -1 / (r if midgap else contact), cross(plus(torque, 1.0, back), n))
            held = m * dot(across(v, n), v) / r if resting else drag + pull
            force = plus(sideways, -held, n)  # on the second
            power = -dot(sideways, v) - dot(torque, spin) - dot(back, partner)
            if resting and b.friction is not None:
                slipping = self.slip(y)
                rub = plus(ZERO, -b.friction * (pull - held) / math.hypot(*slipping), slipping)
                force, (own_arm, other_arm), turn = plus(force, 1.0, rub), self._arms(x), cross(n, rub)
                torque, back = plus(torque, -own_arm, turn), plus(back, -other_arm, turn)
            return [
                *at(y, VELOCITY),
                *plus(ZERO, -1 / mass, force),
                *plus(ZERO, 1 / inertia, torque),
                *at(y, OTHER_VELOCITY),
                *plus(ZERO, 1 / second_mass, force),
                *plus(ZERO, 1 / second, back),
                u,
                drag * u,
                power,
                pull * u,
            ]

        return rates

    def _beside_a_wall(self) -> Rates:
        b, resists, sheared = self.bodies, self.bodies.wets(self.inside, not self.closing), self.sheared
        (own, mixed, other), inertia, m, edge, n = b.friction_matrix, b.inertias[0], b.m, b.edge, self.fixed
        free = 0.0 if self.resting else 1.0

        def rates(_: float, y: Sequence[float]) -> State:
            x, v, spin = y[GAP], at(y, VELOCITY), at(y, SPIN)
            u = -dot(n, v)
            drag, pull = b.drag(x) * u if resists else 0.0, b.pull(x)
            log = math.log(edge / x) if sheared else 0.0
            torque = plus(plus(ZERO, -log * own, across(spin, n)), -log * mixed, cross(n, v))
            sideways = plus(plus(ZERO, -log * other, across(v, n)), -log * mixed, cross(spin, n))
            power = -dot(sideways, v) - dot(torque, spin)
            return [
                *v,
                *plus(plus(ZERO, 1 / m, sideways), free * (drag + pull) / m, n),
                *plus(ZERO, 1 / inertia, torque),
                *(*ZERO, *ZERO, *ZERO),
                u,
                drag * u,
                power,
                pull * u,
            ]

        return rates

    def sizes(self) -> list[float]:
        b, fast = self.bodies, self.fastest + self.spinning
        body = [*(3 * [b.radii[0]]), *(3 * [fast]), *(3 * [fast / b.radii[0]])]
        return [*body, *body, 1e-3 * b.film_thickness, self.energy, self.energy, self.energy]

    def reverse(self, solid: bool) -> None:
        """With Walton and Braun's tangential impulse against the slip: mu times the normal one, or what sticks."""
        b, y, n = self.bodies, self.y, self.normal(self.y)
        opening, slip = dot(n, self.relative(y)), self.slip(y)
        self._push(-(1 + b.dry_restitution) * opening)
        size = math.hypot(*slip)
        if b.friction is None or not (solid or b.friction_in_glass) or not size:
            return
        assert not b.wall
        (own, other), (inertia, second) = self._arms(y[GAP]), b.inertias
        resistance = 1 / (1 / b.m + own**2 / inertia + other**2 / second)
        limit = -b.friction * (1 + b.dry_restitution) * b.m * opening
        impulse = plus(ZERO, -min(limit, (1 + (b.beta_0 or 0.0)) * size * resistance) / size, slip)  # on the second
        y[VELOCITY : VELOCITY + 3] = plus(at(y, VELOCITY), -1 / b.masses[0], impulse)
        y[OTHER_VELOCITY : OTHER_VELOCITY + 3] = plus(at(y, OTHER_VELOCITY), 1 / b.masses[1], impulse)
        y[SPIN : SPIN + 3] = plus(at(y, SPIN), -own / inertia, cross(n, impulse))
        y[OTHER_SPIN : OTHER_SPIN + 3] = plus(at(y, OTHER_SPIN), -other / second, cross(n, impulse))

    def _arms(self, x: float) -> tuple[float, float]:
        """Lever arms of the tangential force about the centres."""
        b = self.bodies
        stretch = (b.contact + x) / b.contact if b.arm == "midgap" else 1.0
        return stretch * b.radii[0], stretch * b.radii[1]

    def slip(self, y: Sequence[float]) -> Vector:
        """Velocity of the second surface past the first, at the lever arms."""
        n, (own, other) = self.normal(y), self._arms(y[GAP])
        turning = plus(plus(ZERO, own, at(y, SPIN)), other, at(y, OTHER_SPIN))
        return across(plus(self.relative(y), -1.0, cross(turning, n)), n)

    def slides(self) -> Guard | None:
        """Positive where the slip is below a thousandth of the largest speed."""
        if self.bodies.wall:
            return None
        least, (own, other) = 1e-3 * (self.fastest + self.spinning), self._arms(self.y[GAP])

        def guard(y: Sequence[float], dy: Sequence[float]) -> tuple[float, float]:
            n, slip = self.normal(y), self.slip(y)
            line = plus(ZERO, 1 / (self.bodies.contact + y[GAP]), across(self.relative(y), n))
            turning = plus(plus(ZERO, own, at(y, SPIN)), other, at(y, OTHER_SPIN))
            speeding = plus(plus(ZERO, own, at(dy, SPIN)), other, at(dy, OTHER_SPIN))
            change = plus(plus(self.relative(dy), -1.0, cross(speeding, n)), -1.0, cross(turning, line))
            size = math.hypot(*slip)
            return 1 - size / least, -dot(slip, change) / (size * least)

        return guard

    def _push(self, change: float) -> None:
        """Change the rate of the gap by an impulse."""
        b, y, n = self.bodies, self.y, self.normal(self.y)
        for where, mass, sign in ((VELOCITY, b.masses[0], -1), (OTHER_VELOCITY, b.masses[1], 1)):
            if math.isfinite(mass):
                y[where : where + 3] = plus(at(y, where), sign * b.m * change / mass, n)

    # ---- energy and momenta

    def centre(self, y: Sequence[float]) -> tuple[Vector, Vector]:
        """Place and velocity of the centre of mass; of the wall beside one."""
        if self.bodies.wall:
            return ZERO, ZERO
        one, other = self.bodies.masses
        share = other / (one + other)
        place = plus(at(y, PLACE), share, plus(at(y, OTHER_PLACE), -1.0, at(y, PLACE)))
        return place, plus(at(y, VELOCITY), share, self.relative(y))

    def kinetic(self, y: Sequence[float]) -> float:
        b, moving = self.bodies, self.relative(y)
        spins = b.inertias[0] * dot(at(y, SPIN), at(y, SPIN))
        if not b.wall:
            spins += b.inertias[1] * dot(at(y, OTHER_SPIN), at(y, OTHER_SPIN))
        return (b.m * dot(moving, moving) + spins) / 2

    def angular_momentum(self, y: Sequence[float]) -> Vector:
        """About the centre of mass."""
        b = self.bodies
        apart = plus(at(y, OTHER_PLACE), -1.0, at(y, PLACE))
        orbital = plus(ZERO, b.m, cross(apart, self.relative(y)))
        return plus(plus(orbital, b.inertias[0], at(y, SPIN)), b.inertias[1], at(y, OTHER_SPIN))

    def momentum(self, y: Sequence[float]) -> float:
        return 0.0 if self.bodies.wall else math.hypot(*self.angular_momentum(y))


def planar_arrival(bodies: Bodies, impact: Impact, axes: tuple[Vector, Vector], drift: Vector = ZERO) -> Arrival:
    """The arrival in space of a collision in the plane of two unit vectors, the normal and the tangential direction.

    The line of centres turns from the first to the second axis; `drift` is the velocity of the centre of mass. Beside a
    wall, which is at rest, the drift is left out. The plane's angle means omega_0 = v0 tan(theta0)/(R_1 + R_2).
    """
    normal, tangent = axes
    out = cross(normal, tangent)
    along = impact.speed * math.tan(impact.angle)
    if not bodies.wall:
        along *= (bodies.contact + bodies.film_thickness) / bodies.contact
    relative = plus(plus(ZERO, -impact.speed, normal), along, tangent)
    shares = (1.0, 0.0) if bodies.wall else (bodies.m / bodies.masses[0], bodies.m / bodies.masses[1])
    at_rest = ZERO if bodies.wall else drift
    velocities = plus(at_rest, -shares[0], relative), plus(at_rest, shares[1], relative)
    partner = 0.0 if bodies.wall else impact.partner_spin
    return Arrival(normal, velocities, (plus(ZERO, impact.spin, out), plus(ZERO, partner, out)))


def collided(bodies: Bodies, arrival: Arrival) -> End:
    """Follow a collision to separation, or until it certainly sticks (`Course.run`)."""
    return Spatial(bodies, arrival).run()
