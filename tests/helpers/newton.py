"""Two unequal spheres, or a sphere and a wall, by Newton's law in the laboratory: nothing of the package but numbers.

Positions, velocities and spins of both bodies in the plane; friction by the leading logarithms as Jeffrey & Onishi
(1984) print them, in the ratio of radii; films and attractions written down once more.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

PI = math.pi


@dataclass(frozen=True)
class Bodies:
    """SI numbers of a collision. `film` is one of finite, infinite, cavitating, constant-volume."""

    radii: tuple[float, float]
    masses: tuple[float, float]
    viscosity: float
    film_thickness: float
    surface_tension: float = 0.0  # with the constant law, 2 pi R sigma; R = 2a
    volume: float = 0.0
    hamaker: float = 0.0
    film: str = "finite"

    @property
    def a(self) -> float:
        one, other = self.radii
        return one * other / (one + other)

    @property
    def m(self) -> float:
        one, other = self.masses
        return one * other / (one + other)

    @property
    def rupture(self) -> float:
        return 2 * self.a * self.volume ** (1 / 3) if self.surface_tension else self.film_thickness

    def along(self, x: float, u: float) -> float:
        """All that pulls the surfaces together along the line of centres."""
        a, x0, unit = self.a, self.film_thickness, 6 * PI * self.viscosity * self.a**2 * u / x
        if self.film == "constant-volume":
            drag = unit * (1 - x / math.sqrt(x * x + self.volume * 8 * a**3 / (PI * a))) ** 2
        elif x >= x0 or (self.film == "cavitating" and u > 0):
            drag = 0.0
        else:
            drag = unit if self.film == "infinite" else unit * (1 - x / x0) ** 2
        return drag + 4 * PI * a * self.surface_tension + self.hamaker * a / (6 * x * x)

    def torques(self, x: float, omega: float, spins: tuple[float, float]) -> tuple[float, float]:
        """Torques on the spheres: Y^C and, through the line of centres' turning, what else there is."""
        one, other = self.radii
        lam, mu = other / one, self.viscosity
        log = max(math.log(2 * self.a / x), 0.0)
        stretch = (one + other + x) / (one + other)
        slip = omega - spins[0], omega - spins[1]
        first = 8 * PI * mu * one**3 * 0.4 * lam / (1 + lam)
        second = 8 * PI * mu * other**3 * 0.4 / lam / (1 + 1 / lam)
        both = PI * mu * (one + other) ** 3 * 0.8 * lam**2 / (1 + lam) ** 4
        return (
            log * stretch * (first * slip[0] + both * slip[1]),
            log * stretch * (both * slip[0] + second * slip[1]),
        )


@dataclass
class End:
    """How it ended: `separated`, gap, normal velocity, rates of the line of centres and both spins, momenta."""

    separated: bool
    time: float
    gap: float
    opening: float
    omega: float
    spins: tuple[float, float]
    work: float
    momentum: np.ndarray = field(default_factory=lambda: np.zeros(3))  # P_x, P_y and L, less their start values


def integrated(bodies: Bodies, speed: float, angle: float, longest: float, rtol: float = 1e-11) -> End:
    """From initial contact, without any criterion of reversal, to rupture or for `longest` s."""
    (one, other), (mass, second_mass) = bodies.radii, bodies.masses
    contact = one + other
    r0 = contact + bodies.film_thickness
    # omega0 = v0 tan(theta0)/(R1 + R2), as the paper has it
    relative = np.array([-speed, speed * math.tan(angle) / contact * r0])
    share = second_mass / (mass + second_mass)
    y0 = np.array([-share * r0, 0, (1 - share) * r0, 0, *(-share * relative), *((1 - share) * relative), 0, 0, 0])

    def geometry(y: np.ndarray) -> tuple[float, float, float, np.ndarray]:
        apart, moving = y[2:4] - y[0:2], y[6:8] - y[4:6]
        r = math.hypot(*apart)
        n = apart / r
        return r - contact, float(moving @ n), float(n[0] * moving[1] - n[1] * moving[0]) / r, n

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        x, u, omega, n = geometry(y)
        first, second = bodies.torques(x, omega, (y[8], y[9]))
        pull, drag = bodies.along(x, u), (first + second) / (contact + x)
        force = -pull * n - drag * np.array([-n[1], n[0]])  # on the second
        inertia, second_inertia = 0.4 * mass * one**2, 0.4 * second_mass * other**2
        attracting = bodies.along(x, 0.0) * u
        return np.array(
            [*y[4:8], *(-force / mass), *(force / second_mass), first / inertia, second / second_inertia, attracting]
        )

    def momenta(y: np.ndarray) -> np.ndarray:
        p = mass * y[4:6] + second_mass * y[6:8]
        spin = 0.4 * mass * one**2 * y[8] + 0.4 * second_mass * other**2 * y[9]
        orbital = mass * (y[0] * y[5] - y[1] * y[4]) + second_mass * (y[2] * y[7] - y[3] * y[6])
        return np.array([*p, orbital + spin])

    def rupture(_: float, y: np.ndarray) -> float:
        return (geometry(y)[0] - bodies.rupture) / bodies.film_thickness

    def turns(_: float, y: np.ndarray) -> float:
        return geometry(y)[1] / speed

    def edge(_: float, y: np.ndarray) -> float:
        return geometry(y)[0] / bodies.film_thickness - 1

    rupture.terminal, rupture.direction = True, 1  # type: ignore[attr-defined]  # as scipy wants it
    for event in (turns, edge):
        event.terminal = True  # type: ignore[attr-defined]  # as above
    scale = np.array([1e-3 * bodies.film_thickness] * 4 + [speed] * 4 + [speed / contact] * 2 + [bodies.m * speed**2])
    time, y, separated = 0.0, y0, False
    for _ in range(12):  # piece by piece, where the forces have kinks
        found = solve_ivp(
            rates,
            (time, longest),
            y,
            method="LSODA",
            rtol=rtol,
            atol=rtol * 1e-2 * scale,
            events=[rupture, turns, edge],
        )
        time, y = float(found.t[-1]), found.y[:, -1]
        separated = bool(found.t_events[0].size)
        if separated or found.status != 1:
            break
        # off the event's surface by more than the interpolated state's error, some rtol of the film
        y, time = y + rates(time, y) * (rtol * longest), time + rtol * longest
    x, u, omega, _n = geometry(y)
    return End(separated, time, x, u, omega, (float(y[8]), float(y[9])), float(y[10]), momenta(y) - momenta(y0))
