"""Model files with declared events, and the same collisions integrated independently of the package."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from .two_bodies import Bodies

# By its defaults no event happens; a test chooses by [custom] which one does.
EVENTS = '''"""A bridge that snaps when it is stretched too fast, or lets go and the collision goes on; a brake."""
from wetdoublet.derive.user import *

critical = quantity("critical_rate", r"\\dot\\epsilon_c", unit="1/s", default="1e12 1/s", meaning="rate of snapping")
leaving = quantity("leaving_speed", r"u_l", unit="m/s", default="1e6 m/s", meaning="speed at which the bridge lets go")
kept = quantity("kept", r"k", default=0.5, bounds=">= 0", meaning="part of the speed that a brake leaves")
braking = quantity("braking_gap", r"x_k", unit="m", default="1 m", meaning="gap of the brake")

event("snap", guard=critical - u / x, where="opening beyond the film", ends="separated",
      meaning="the bridge is stretched too fast")
intact = event("let_go", guard=leaving - u, where="opening", meaning="the bridge lets go")
event("brake", guard=braking - x, where="opening", jump={u: kept * u}, word="braked")
law("bridge", "letting-go", force=intact * 4 * pi * a * sigma, source="a test")
'''


TIMED = '''"""Cut-offs at an angle, a time and a spin; a bridge that lets go after a time; a kick."""
from wetdoublet.derive.user import *

largest = quantity("largest", default=1e9, meaning="angle at which it ends, rad")
last = quantity("last", unit="s", default="1e9 s", meaning="time at which it ends")
fastest = quantity("fastest", unit="1/s", default="1e30 1/s", meaning="spin at which it ends")
holding = quantity("holding", unit="s", default="1e9 s", meaning="time for which the bridge holds")
kicked = quantity("kicked", unit="s", default="1e9 s", meaning="time of the kick")
kick = quantity("given", unit="m/s", default="0 m/s", bounds="> -1e9", meaning="speed that it gives")

event("far enough", guard=largest - beta, ends="stick")
event("late", guard=last - t, ends="stick")
event("spun", guard=fastest - xi, ends="stick")
event("kick", guard=kicked - t, jump={u: u + kick}, releases=m * kick**2)
'''
BRIDGE = 'intact = event("lets go", guard=holding - t)\nlaw("bridge", "holding", force=intact * 4 * pi * a * sigma)\n'
TORQUE = """twist = quantity("twist", unit="N m", default="0 N m", bounds="> -1", meaning="torque on the rotation")
force_on("rotation", twist)
"""


@dataclass(frozen=True)
class Ended:
    """The end of an independent collision: time (s), gap (m), its rate (m/s), rates of turning and spin (rad/s)."""

    time: float
    gap: float
    velocity: float
    rate: float
    spin: float


def integrated(
    bodies: Bodies, speed: float, angle: float, guard: Callable[[float, float], float], beyond: bool
) -> Ended:
    """A collision of equal spheres to an event, or beyond it without a bridge to the rupture gap.

    Arguments:
        guard: of the gap (m) and its rate (m/s), positive before the event, which happens while opening.
        beyond: go on without the bridge's force.
    """
    a, m, x0 = bodies.a, bodies.m, bodies.film_thickness
    own, cross, _ = bodies.friction_matrix

    def rates(pull: float) -> Callable[[float, np.ndarray], list[float]]:
        def of(_: float, y: np.ndarray) -> list[float]:
            x, u, omega, xi = y
            r = 4 * a + x
            torque = max(math.log(2 * a / x), 0.0) * r / (4 * a) * (own + cross) * (omega - xi)
            along = (bodies.drag(x) * u if x < x0 else 0.0) + pull * bodies.pull(x)
            turned = (-2 * torque / r / m - 2 * u * omega) / r
            return [u, -along / m + r * omega**2, turned, torque / bodies.inertias[0]]

        return of

    def events(*functions: Callable[[float, np.ndarray], float]) -> list[Callable[[float, np.ndarray], float]]:
        for each in functions:
            each.terminal = True  # type: ignore[attr-defined]  # as scipy wants it
        return list(functions)

    y = np.array([x0, -speed, speed * math.tan(angle) / (4 * a), 0.0])
    time, pull, opening = 0.0, 1.0, False
    for _ in range(6):  # piece by piece, where the forces have kinks
        turn = events(lambda _, y: y[1] / speed)
        happens = events(lambda _, y: guard(y[0], y[1])) if opening and pull else []
        edge = events(lambda _, y: y[0] / x0 - 1) if y[0] < x0 else []
        ends = events(lambda _, y: y[0] / bodies.rupture - 1)
        scale = np.array([1e-3 * x0, speed, speed / a, speed / a])
        found = solve_ivp(rates(pull), (time, time + 1.0), y, method="LSODA", rtol=1e-11, atol=1e-12 * scale,
                          events=[*(turn if not opening else []), *happens, *edge, *ends])  # fmt: skip
        time, y = float(found.t[-1]), found.y[:, -1]
        if not opening:
            opening = abs(y[1]) < 1e-6 * speed
            y[1] = max(y[1], 0.0) if opening else y[1]
        elif happens and found.t_events[0].size:
            if not beyond:
                break
            pull = 0.0
        elif found.t_events[-1].size:
            break
        y = y + np.array(rates(pull)(time, y)) * 1e-14
    return Ended(time, *map(float, y))
