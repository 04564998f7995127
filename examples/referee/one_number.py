"""One law e(St) for hosts that want two numbers: CriticalStokes and MaximumRestitution, fitted to our model.

    python examples/referee/one_number.py granulation --stokes 0.05:2 --angle 0

LIGGGHTS (`gran model hooke`, viscous on) documents the restitution of Legendre et al. (Phys. Fluids 17, 097105, 2005),
e = e_max exp(-St_c/St); others write e = e_max (1 - St_c/St) above St_c and 0 below. LIGGGHTS, however, applies the
first to the speed of the moment, and so rebounds otherwise (src/normal_model_hooke.h): that is `liggghts` below.
Its Stokes number is ours, m v/(6 pi mu a^2).
"""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import RegularGridInterpolator
from scipy.optimize import minimize_scalar
from wetdoublet import Scene, collide_many


def exponential(ratio: Any, most: float) -> Any:
    """The documented law, of St_c/St and e_max."""
    return most * np.exp(-ratio)


def linear(ratio: Any, most: float) -> Any:
    """No rebound below the critical Stokes number."""
    return most * np.maximum(1 - ratio, 0.0)


def liggghts(ratio: Any, most: float) -> Any:
    """What LIGGGHTS 3.8 gives: its damping follows the Stokes number of the moment.

    In units of mass, stiffness and impact speed: d'' = -d - 2 |L|/hypot(L, pi) d' with L = ln e_max - (St_c/St)/d', the
    spheres apart at overlap d = 0. Interpolated in a table, to about 1e-3.
    """
    logs, tops, table = _table()
    at = np.clip(np.log(ratio), logs[0], logs[-1])
    return np.maximum(table(np.stack(np.broadcast_arrays(at, np.clip(most, tops[0], 1.0)), -1)), 0.0)


@cache
def _table() -> Any:
    logs, tops = np.linspace(math.log(1e-3), math.log(3), 40), np.array([0.3, 0.6, 0.8, 0.9, 0.95, 0.98, 0.99, 1.0])
    e = [[rebound(math.exp(log), float(top)) for top in tops] for log in logs]
    return logs, tops, RegularGridInterpolator((logs, tops), e)


def rebound(ratio: float, most: float) -> float:
    """The equation of `liggghts`, solved."""

    def motion(_: float, y: Any) -> list[float]:
        log = math.log(most) - (ratio / y[1] if y[1] else math.inf)
        return [y[1], -y[0] - 2 * (abs(log) / math.hypot(log, math.pi) if math.isfinite(log) else 1.0) * y[1]]

    def apart(t: float, y: Any) -> float:
        return float(y[0]) if t > 1e-3 else 1.0

    apart.terminal = True  # type: ignore[attr-defined]  # as scipy asks
    solution = solve_ivp(motion, (0, 40), [0.0, 1.0], events=apart, rtol=1e-6, atol=1e-9)
    return float(-solution.y[1, -1]) if solution.t_events[0].size else 0.0


FORMS = {"exponential": exponential, "linear": linear, "liggghts": liggghts}


@dataclass(frozen=True)
class Fit:
    """Two numbers, and how far the law with them is from our model: on the fit's own points, and attacked."""

    form: str
    critical_stokes: float
    maximum_restitution: float
    rms: float
    largest: float
    stokes: float
    angle: float


def fit(
    scene: Scene, form: str, stokes: tuple[float, float], angles: Any, count: int = 60, attack: int = 20_000
) -> Fit:
    """Least squares over Stokes numbers (evenly in the logarithm) and angles (rad); sticking is e = 0.

    The errors (root mean square, largest, and where it lies) are those at `attack` other collisions at random in the
    same range. e_max is held to at most 1: beyond that, LIGGGHTS takes its inverse.
    """
    law = FORMS[form]
    angles = np.atleast_1d(angles)
    St, turned = (axis.ravel() for axis in np.meshgrid(np.geomspace(*stokes, count), angles))
    ours = collide_many(scene, stokes=St, angle=turned).restitution.values

    def best(log_critical: float) -> tuple[float, float]:
        ratio = math.exp(log_critical) / St
        if law is liggghts:  # not linear in e_max
            optimum = minimize_scalar(
                lambda e: np.sum((liggghts(ratio, e) - ours) ** 2), bounds=(0.3, 1), method="bounded"
            )
            return float(optimum.fun), float(optimum.x)
        shape = law(ratio, 1.0)
        most = min(1.0, float(shape @ ours / max(shape @ shape, 1e-300)))
        return float(np.sum((most * shape - ours) ** 2)), most

    tried = np.linspace(math.log(stokes[0] / 10), math.log(stokes[1]), 40 if law is liggghts else 200)
    start = int(np.argmin([best(guess)[0] for guess in tried]))
    bounds = (tried[max(start - 1, 0)], tried[min(start + 1, len(tried) - 1)])
    optimum = minimize_scalar(lambda log: best(log)[0], bounds=bounds, method="bounded", options={"xatol": 1e-6})
    critical, most = math.exp(optimum.x), best(optimum.x)[1]

    rng = np.random.default_rng(17)
    St = np.exp(rng.uniform(math.log(stokes[0]), math.log(stokes[1]), attack))
    turned = rng.uniform(angles.min(), angles.max(), attack)
    error = law(critical / St, most) - collide_many(scene, stokes=St, angle=turned).restitution.values
    worst = int(np.argmax(np.abs(error)))
    rms = math.sqrt(float(np.mean(error**2)))
    return Fit(form, critical, most, rms, float(error[worst]), float(St[worst]), math.degrees(turned[worst]))


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description="Fit two numbers to our e_n over a range of Stokes numbers.")
    parser.add_argument("scene", help="a scene file or a preset")
    parser.add_argument("--stokes", default="0.05:2", help="first:last")
    parser.add_argument("--angle", default="0", help="in degrees: one, or several with commas, fitted together")
    args = parser.parse_args()
    scene = Scene.load(args.scene)
    first, last = (float(end) for end in args.stokes.split(":"))
    angles = np.radians([float(degrees) for degrees in args.angle.split(",")])
    print("| form | CriticalStokes | MaximumRestitution | rms error | largest error | at St | at angle |")
    print("|---|---|---|---|---|---|---|")
    for form in FORMS:
        f = fit(scene, form, (first, last), angles)
        numbers = f"{f.critical_stokes:.4g} | {f.maximum_restitution:.4f} | {f.rms:.3f} | {f.largest:+.3f}"
        print(f"| {form} | {numbers} | {f.stokes:.3g} | {f.angle:.1f} deg |")
    print(f"""
# for pair_style gran model hooke ... viscous on, with the row `liggghts` (f)
fix mu all property/global FluidViscosity peratomtypepair 1 {scene.liquid.viscosity:g}
fix st all property/global CriticalStokes peratomtypepair 1 {f.critical_stokes:.6g}
fix em all property/global MaximumRestitution peratomtypepair 1 {f.maximum_restitution:.6g}""")


if __name__ == "__main__":
    main()
