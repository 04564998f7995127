"""The equations in SI, written down once more and integrated with scipy: what the package is held against.

Nothing here comes from the package but the numbers of a scene.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp
from wetdoublet.solvers import Scene

CLOSING, OPENING = -1, 1
Event = Callable[[float, np.ndarray], float]


@dataclass
class Trajectory:
    """How an independent trajectory ended: state is gap, normal velocity, omega, xi, beta (SI)."""

    separated: bool = False
    time: float = 0.0
    smallest_gap: float = math.inf
    events: list[str] = field(default_factory=list)
    times: list[float] = field(default_factory=list)
    state: np.ndarray = field(default_factory=lambda: np.zeros(5))


@dataclass(frozen=True)
class Spheres:
    """A scene's numbers, and the right-hand side made of them."""

    scene: Scene
    speed: float

    @property
    def a(self) -> float:
        return self.scene.particles.reduced_radius

    @property
    def m(self) -> float:
        return self.scene.particles.reduced_mass

    @property
    def x_f(self) -> float:
        """Rupture gap: 2a V^(1/3) (1 + phi/2), or x0 without a bridge."""
        bridge = self.scene.bridge
        if bridge is None:
            return self.scene.liquid.film_thickness
        return 2 * self.a * bridge.volume ** (1 / 3) * (1 + bridge.contact_angle / 2)

    @property
    def x_r(self) -> float:
        """Elastic length (3 pi theta_e mu a^(3/2) v0/sqrt 2)^(2/5); 0 without elastic constants."""
        modulus, ratio = self.scene.particles.youngs_modulus, self.scene.particles.poisson_ratio
        if modulus is None or ratio is None:
            return 0.0
        theta = 2 * (1 - ratio**2) / (math.pi * modulus)
        mu = self.scene.liquid.viscosity
        return float((3 * math.pi * theta * mu * self.a**1.5 * self.speed / math.sqrt(2)) ** 0.4)

    def pull(self, x: float) -> float:
        """Capillary force of the scene's law (all but Willett's full fit)."""
        bridge = self.scene.bridge
        if bridge is None:
            return 0.0
        radius, phi, v = 2 * self.a, bridge.contact_angle, bridge.volume
        h, log = x / radius, math.log(v)
        if bridge.law in ("mikami", "mikami-log10", "soulie"):
            used = math.log10(v) if bridge.law == "mikami-log10" else log
            b, c = (-0.34 * used - 0.96) * phi**2 - 0.019 * used + 0.48, 0.0042 * used + 0.078
            if bridge.law == "soulie":
                b, c = (-0.148 * log - 0.96) * phi**2 - 0.0082 * log + 0.48, 0.0018 * log + 0.078
            shape = math.exp(-1.1 * v**-0.53 * h + b) + c
        elif bridge.law == "constant":
            shape = 2 * math.cos(phi)
        elif bridge.law == "willett-simple":
            s = h / math.sqrt(v)
            shape = 2 * math.cos(phi) / (1 + 1.05 * s + 2.5 * s * s)
        else:
            s = math.sqrt(h * h + 2 * v / math.pi)
            shape = 2 * math.cos(phi) * (1 - h / s)
            if bridge.law == "rabinovich":
                al = math.sqrt(s - h)
                shape += 2 * math.sin(al) * math.sin(al + phi)
        return math.pi * radius * bridge.surface_tension * shape

    def rates(self, y: np.ndarray, film: bool, shear: bool) -> list[float]:
        """Rates of gap, normal velocity, omega, xi, beta."""
        x, u, omega, xi, beta = y.tolist()
        a, m, mu, x0 = self.a, self.m, self.scene.liquid.viscosity, self.scene.liquid.film_thickness
        r = 4 * a + x
        f_n = 6 * math.pi * mu * a**2 * u / x * (1 - x / x0) ** 2 if film else 0.0
        edge = x0 if self.scene.model.tangential == "film" else 2 * a
        f_t = 8 * math.pi * mu * a**2 * (omega - xi) * math.log(edge / x) if shear else 0.0
        s_n = s_t = 0.0
        if self.scene.pendulum is not None:
            length, g = self.scene.pendulum.length, self.scene.pendulum.gravity
            d2 = (r * r + 16 * a * a - 8 * a * r * math.cos(beta)) / 4
            height = length if self.scene.pendulum.law == "small-angle" else math.sqrt(length**2 - d2)
            s_n = m * g * (r - 4 * a * math.cos(beta)) / height
            s_t = m * g * 4 * a * math.sin(beta) / height
        arm = 2 * a + x / 2 if self.scene.model.arm == "midgap" else 2 * a
        return [
            u,
            r * omega**2 - (f_n + self.pull(x) + s_n) / m,
            (-(f_t + s_t) / m - 2 * u * omega) / r,
            f_t * arm / (3.2 * m * a * a),
            omega,
        ]

    def pressure(self, y: np.ndarray) -> float:
        """Glass criterion's pressure on the axis."""
        x0 = self.scene.liquid.film_thickness
        cut = 1 / x0**2 if self.scene.model.glass == "film-corrected" else 0.0
        return float(-3 * self.scene.liquid.viscosity * self.a * y[1] * (1 / y[0] ** 2 - cut))


def integrated(scene: Scene, stokes: float, angle: float, rtol: float = 1e-10, longest: float = 1e7) -> Trajectory:
    """Follow a collision, event after event, up to separation, a cut-off, or `longest` x0/v0 of one phase."""
    a, m, mu = scene.particles.reduced_radius, scene.particles.reduced_mass, scene.liquid.viscosity
    x0, speed = scene.liquid.film_thickness, stokes * 6 * math.pi * mu * a**2 / m
    body = Spheres(scene, speed)
    edge = x0 if scene.model.tangential == "film" else 2 * a
    rate = max(speed * math.tan(angle) / (4 * a), 1e-30)
    scale = np.array([x0, speed, rate, rate, 1.0])
    trajectory = Trajectory(state=np.array([x0, -speed, speed * math.tan(angle) / (4 * a), 0.0, 0.0]))
    contact = max(body.x_r, scene.particles.roughness)
    motion, film, shear = CLOSING, True, edge >= x0
    for _ in range(60):
        y = trajectory.state
        name = ""
        if motion == CLOSING:
            name = "glass" if body.pressure(y) >= scene.liquid.glass_transition_pressure else ""
            name = name or ("contact" if y[0] <= contact else "")
        if not name:
            watched = _watched(body, scene, contact, motion, film, shear, edge)
            rates = _right_hand_side(body, film, shear)
            found = solve_ivp(
                rates, (0, longest * x0 / speed), y, method="Radau", rtol=rtol, atol=rtol * 1e-3 * scale,
                events=list(watched.values()),
            )  # fmt: skip
            trajectory.time += float(found.t[-1])
            trajectory.state = y = found.y[:, -1].copy()
            if found.status != 1:
                return trajectory
            name = next(key for key, times in zip(watched, found.t_events, strict=True) if times.size)
        trajectory.smallest_gap = min(trajectory.smallest_gap, float(y[0]))
        if name == "contact":
            name = "elastic" if body.x_r >= scene.particles.roughness else "rough"
        trajectory.events.append(name)
        trajectory.times.append(trajectory.time)
        if name in ("glass", "elastic", "rough"):
            trajectory.state[1] *= -scene.particles.dry_restitution
            if y[0] == x0 and scene.bridge is None:
                trajectory.separated = True
                return trajectory
            motion, film = OPENING, film and y[0] < x0
        elif name in ("turned", "fell back"):
            motion = -motion
        elif name == "film edge":
            film = not film
            shear = film if edge == x0 else shear
        elif name == "tangential edge":
            shear = not shear
        else:
            trajectory.separated = name == "rupture"
            return trajectory
    return trajectory


def _right_hand_side(body: Spheres, film: bool, shear: bool) -> Callable[[float, np.ndarray], Sequence[float]]:
    return lambda t, y: body.rates(y, film, shear)


def _watched(
    body: Spheres, scene: Scene, contact: float, motion: int, film: bool, shear: bool, edge: float
) -> dict[str, Event]:
    """Terminal event functions of a phase, by what they are called; each falls (or rises) through zero."""
    x0 = scene.liquid.film_thickness
    table: dict[str, tuple[Event, int]] = {}
    if motion == CLOSING:
        limit = scene.liquid.glass_transition_pressure
        table["glass"] = (lambda t, y: 1 - body.pressure(y) / limit, -1)
        table["contact"] = (lambda t, y: y[0] / contact - 1, -1)
        table["turned"] = (lambda t, y: y[1] / body.speed, 1)
    else:
        table["fell back"] = (lambda t, y: y[1] / body.speed, -1)
        table["rupture"] = (lambda t, y: y[0] / body.x_f - 1, 1)
    if body.x_f > x0:
        table["film edge"] = (lambda t, y: y[0] / x0 - 1, 1 if film else -1)
        if edge != x0:
            table["tangential edge"] = (lambda t, y: y[0] / edge - 1, 1 if shear else -1)
    if scene.pendulum is not None:
        table["half turn"] = (lambda t, y: y[4] / math.pi - 1, 1)
        table["rotation reverses"] = (lambda t, y: y[2] * x0 / body.speed, -1)
    events: dict[str, Event] = {}
    for name, (function, direction) in table.items():
        function.terminal, function.direction = True, direction  # type: ignore[attr-defined]  # as scipy wants it
        events[name] = function
    return events
