"""The hosts' laws of lubrication as differential equations, integrated by scipy: what their time step tends to.

Written from the hosts' documentation and sources, and so a check that a translation means what it says.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

State = Any  # gap x, its rate, rotation rate of the line of centres, spin of either sphere, and what the law adds


@dataclass(frozen=True)
class Pair:
    """Radius of a sphere, reduced mass, and the relative velocities at the start, SI."""

    radius: float
    mass: float
    speed: float
    tangential: float


@dataclass(frozen=True)
class Law:
    """Forces of a state: normal (drawing together), tangential, and the rates of the states that the law adds."""

    force: Callable[[State], tuple[float, float, tuple[float, ...]]]
    lever: Callable[[float], float]  # arm of the tangential force at a gap
    added: tuple[float, ...] = ()  # states at the start


def collide(law: str, parameters: dict[str, Any], pair: Pair, end: float, longest: float) -> tuple[float, float] | None:
    """Radial and transverse velocity where the gap opens to `end`; None if it does not within the longest time."""
    chosen = LAWS[law](parameters, pair.mass)
    radius, start = pair.radius, parameters["cutoff"]

    def motion(_: float, y: State) -> State:
        x, u, omega = y[:3]
        normal, shear, rates = chosen.force(y)
        r = 2 * radius + x
        turning = (-shear / pair.mass - 2 * u * omega) / r
        return [u, r * omega**2 - normal / pair.mass, turning, shear * chosen.lever(x) / inertia, *rates]

    def apart(_: float, y: State) -> float:
        return float(y[0] - end) if y[1] > 0 else -1.0

    apart.terminal = True  # type: ignore[attr-defined]  # as scipy asks
    inertia = 0.4 * 2 * pair.mass * radius**2  # of one sphere
    begin = [start, -pair.speed, pair.tangential / (2 * radius + start), 0.0, *chosen.added]
    scale = np.array([start, pair.speed, pair.speed / radius, pair.speed / radius, *(1.0 for _ in chosen.added)])
    solution = solve_ivp(
        motion, (0, longest), begin, "Radau", events=apart, rtol=1e-8, atol=1e-10 * scale, max_step=longest / 50
    )
    if not solution.success:
        raise SystemExit(f"{law} as differential equations: {solution.message}")
    x, u, omega = (float(number) for number in solution.y[:3, -1])
    return (u, (2 * radius + x) * omega) if solution.t_events[0].size else None


def yade_lubrication(p: dict[str, Any], mass: float) -> Law:  # noqa: ARG001 -- as the other
    """The gap u between deformed surfaces as a state (its logarithm), and a Maxwell element in shear.

    Without friction, and without the torque of rolling, which is zero for equal spheres that turn alike.
    """
    radius, eta = p["radius"], p["viscosity"]
    stiff = p["youngs_modulus"] * radius
    shear_stiff = stiff * p["poisson_ratio"]
    resistance = 1.5 * math.pi * eta * radius**2
    least = 2 * p["eps"] * radius

    def force(y: State) -> tuple[float, float, tuple[float, ...]]:
        x, _, omega, spin, log_gap, shear = y
        u = math.exp(log_gap) * p["cutoff"]
        normal = stiff * (x - u)  # attractive where the spheres are drawn apart
        contact = stiff * max(least - u, 0.0)  # of the asperities; keps = 1
        slip = 2 * radius * (omega - spin)  # getIncidentVel() that avoids ratcheting
        viscous = math.pi * eta / 2 * (-2 * radius + (2 * radius + u) * math.log((2 * radius + u) / u))
        return normal, shear, ((normal + contact) / resistance, shear_stiff * (slip - shear / viscous))

    return Law(force, lambda x: radius + x / 2, (0.0, 0.0))


def lammps_lubricate(p: dict[str, Any], mass: float) -> Law:
    """Resistances that are constant below the least gap, and a Hertzian contact damped by `coeff_restitution`."""
    radius, eta = p["radius"], p["viscosity"]
    stiff = 2 / 3 * p["youngs_modulus"] / (1 - p["poisson_ratio"] ** 2) * math.sqrt(radius / 2)
    log = math.log(p["restitution"])
    damping = -math.sqrt(5) * log / math.hypot(math.pi, log)  # sqrt(3/2) 2 sqrt(5/6), gran_sub_mod_damping.cpp

    def force(y: State) -> tuple[float, float, tuple[float, ...]]:
        x, u, omega, spin = y
        h = max(x, p["inner"]) / radius
        far = math.log(1 / h)
        normal = 6 * math.pi * eta * radius * (1 / (4 * h) + 9 / 40 * far) * u
        if x < 0:
            elastic = stiff * (-x) ** 1.5
            normal += damping * math.sqrt(mass * elastic / -x) * u - elastic
        slip = (2 * radius + x) * omega - 2 * radius * spin
        return normal, math.pi * eta * radius * far * slip, ()

    return Law(force, lambda _: radius)


LAWS = {"lubrication": yade_lubrication, "lubricate": lammps_lubricate}
