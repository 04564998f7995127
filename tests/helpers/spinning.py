"""A collision in the plane, with spins, from the physics alone: SI units, both spins always, events of its own.

Two spheres, equal or not, or a sphere beside a wall. The state is gap, its rate, the angular velocity of the line of
centres (beside a wall: the velocity along it), both spins, the angle turned, and what film, shear and attraction took.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from wetdoublet.solvers import Scene

from .flow import Rates, State
from .phases import Course, End
from .two_bodies import Bodies

X, U, TURNING, SPIN, PARTNER, ANGLE, FILM, SHEAR, WORK = range(9)


@dataclass(frozen=True)
class Impact:
    """Normal approach speed, angle and spins at initial contact."""

    speed: float
    angle: float
    spin: float = 0.0
    partner_spin: float = 0.0


def impact_of(scene: Scene) -> Impact:
    """Speed, angle and spins of a scene; a partner's spin that is left out equals the first's."""
    speed, angle = scene.need_impact()
    spin = float(scene.entries.get("impact.spin", 0.0))
    return Impact(speed, angle, spin, float(scene.entries.get("impact.partner_spin", spin)))


class Planar(Course):
    """A collision in the plane."""

    def __init__(self, bodies: Bodies, impact: Impact) -> None:
        along = impact.speed * math.tan(impact.angle)
        turning = along if bodies.wall else along / bodies.contact
        partner = 0.0 if bodies.wall else impact.partner_spin
        start = [bodies.film_thickness, -impact.speed, turning, impact.spin, partner, 0.0, 0.0, 0.0, 0.0]
        super().__init__(bodies, impact.speed, start)

    def rates(self) -> Rates:
        return self._beside_a_wall() if self.bodies.wall else self._pair()

    def _beside_a_wall(self) -> Rates:
        b, resists, sheared = self.bodies, self.bodies.wets(self.inside, not self.closing), self.sheared
        (own, cross, other), inertia, m, edge = b.friction_matrix, b.inertias[0], b.m, b.edge
        free = 0.0 if self.resting else 1.0

        def rates(_: float, y: Sequence[float]) -> State:
            x, u, v, spin = y[X], y[U], y[TURNING], y[SPIN]
            drag, pull = b.drag(x) * u if resists else 0.0, b.pull(x)
            log = math.log(edge / x) if sheared else 0.0
            torque, force = log * (cross * v - own * spin), log * (other * v - cross * spin)
            power = force * v - torque * spin
            return [u, -free * (drag + pull) / m, -force / m, torque / inertia, 0.0, 0.0, drag * u, power, pull * u]

        return rates

    def _pair(self) -> Rates:
        b, resists, sheared = self.bodies, self.bodies.wets(self.inside, not self.closing), self.sheared
        (own, cross, other), (inertia, second) = b.friction_matrix, b.inertias
        m, contact, edge, midgap = b.m, b.contact, b.edge, b.arm == "midgap"
        free = 0.0 if self.resting else 1.0

        def rates(_: float, y: Sequence[float]) -> State:
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
                free * (r * omega * omega - (drag + pull) / m),
                -(force / m + 2 * u * omega) / r,
                torque / inertia,
                back / second,
                omega,
                drag * u,
                power,
                pull * u,
            ]

        return rates

    def sizes(self) -> list[float]:
        b, v0 = self.bodies, self.speed
        turning = v0 if b.wall else v0 / b.contact
        spin = v0 / b.radii[0]
        return [1e-3 * b.film_thickness, 0.1 * v0, turning, spin, spin, 1.0, self.energy, self.energy, self.energy]

    def gap(self, y: Sequence[float]) -> float:
        return y[X]

    def opening(self, y: Sequence[float], dy: Sequence[float]) -> tuple[float, float]:
        return y[U], dy[U]

    def centrifugal(self, y: Sequence[float], dy: Sequence[float]) -> tuple[float, float]:
        if self.bodies.wall:
            return 0.0, 0.0
        r = self.bodies.contact + y[X]
        return r * y[TURNING] ** 2, 2 * r * y[TURNING] * dy[TURNING]

    def stop(self) -> None:
        self.y[U] = 0.0

    def put(self, gap: float) -> None:
        self.y[X] = gap

    def kinetic(self, y: Sequence[float]) -> float:
        b = self.bodies
        across = y[TURNING] if b.wall else (b.contact + y[X]) * y[TURNING]
        spins = b.inertias[0] * y[SPIN] ** 2 + (0.0 if b.wall else b.inertias[1] * y[PARTNER] ** 2)
        return (b.m * (y[U] ** 2 + across**2) + spins) / 2

    def momentum(self, y: Sequence[float]) -> float:
        b = self.bodies
        if b.wall:
            return 0.0
        orbital = b.m * (b.contact + y[X]) ** 2 * y[TURNING]
        return orbital + b.inertias[0] * y[SPIN] + b.inertias[1] * y[PARTNER]

    # ---- the dry contact

    def _arms(self, x: float) -> tuple[float, float]:
        """Lever arms of the tangential force about the centres; the second is 0 beside a wall."""
        b = self.bodies
        if b.wall:
            return b.radii[0], 0.0
        stretch = (b.contact + x) / b.contact if b.arm == "midgap" else 1.0
        return stretch * b.radii[0], stretch * b.radii[1]

    def slip(self, y: Sequence[float]) -> float:
        """Relative velocity of the surfaces across the line of centres, at the lever arms."""
        across = y[TURNING] if self.bodies.wall else (self.bodies.contact + y[X]) * y[TURNING]
        own, other = self._arms(y[X])
        return across - own * y[SPIN] - other * y[PARTNER]

    def _resistance(self, x: float) -> float:
        """Tangential impulse per change of slip."""
        (own, other), b = self._arms(x), self.bodies
        return 1 / (1 / b.m + own**2 / b.inertias[0] + (0.0 if b.wall else other**2 / b.inertias[1]))

    def reverse(self, solid: bool) -> None:
        """With Walton and Braun's tangential impulse: mu times the normal one, or what makes v_s' = -beta_0 v_s."""
        b, y = self.bodies, self.y
        normal = -(1 + b.dry_restitution) * b.m * y[U]
        y[U] *= -b.dry_restitution
        if b.friction is None or not (solid or b.friction_in_glass):
            return
        slip, (own, other) = self.slip(y), self._arms(y[X])
        sticking = (1 + (b.beta_0 or 0.0)) * abs(slip) * self._resistance(y[X])
        impulse = math.copysign(min(b.friction * normal, sticking), slip)
        y[TURNING] -= impulse / b.m / (1.0 if b.wall else b.contact + y[X])
        y[SPIN] += own * impulse / b.inertias[0]
        if not b.wall:
            y[PARTNER] += other * impulse / b.inertias[1]


def collided(bodies: Bodies, impact: Impact) -> End:
    """Follow a collision to separation, or until it certainly sticks (`Course.run`)."""
    return Planar(bodies, impact).run()
