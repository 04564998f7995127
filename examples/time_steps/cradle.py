"""Stokes' cradle: a wet sphere strikes two that touch, with the exported law as a force over time steps.

    python cradle.py [FOLDER]      prints the outcomes and the checks, and draws cradle.png into FOLDER (here)

Needs `wetdoublet`, a C compiler and matplotlib. Every film is a pair with a history of its own. Pairs are taken one
after the other, each with the velocities that the last has left, so that energy is never created however many films act
at once.
"""

import sys
import tempfile
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from law import Force, History, Law, Motion, exported
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike
from wetdoublet.solvers import Scene

WORDS = ("fully agglomerated", "cradle", "reverse cradle", "fully separated")
COLOURS = ("#4c72b0", "#dd8452", "#55a868", "#c44e52")


class Spheres:
    """Equal wet spheres in space, with a history for each pair."""

    def __init__(self, law: Law, positions: ArrayLike, velocities: Any) -> None:
        self.law, self.x, self.v = law, np.array(positions, float), np.array(velocities, float)
        self.spin = np.zeros_like(self.x)
        self.mass, self.radius = 2 * law.material.reduced_mass, 2 * law.material.reduced_radius
        self.inertia = 0.4 * self.mass * self.radius**2
        count = len(self.x)
        self.pairs = {(i, j): History() for j in range(count) for i in range(j)}
        self.turn = 1

    def step(self, dt: float) -> None:
        """Kick every pair in turn, in the other order at every other step; then drift."""
        self.turn = -self.turn
        motion, force = Motion(), Force()
        for (i, j), history in list(self.pairs.items())[:: self.turn]:
            motion.position[:], motion.velocity[:] = self.x[j] - self.x[i], self.v[j] - self.v[i]
            motion.spins[0][:], motion.spins[1][:] = self.spin[i], self.spin[j]
            self.law.force(motion, dt, history, force)
            kick = dt / self.mass * np.array(force.force)
            self.v[i] -= kick
            self.v[j] += kick
            for ball, k in ((i, 0), (j, 1)):
                self.spin[ball] += dt / self.inertia * np.array(force.torques[k])
        self.x += dt * self.v

    def sums(self) -> tuple[np.ndarray, np.ndarray, float]:
        """Momentum, angular momentum and kinetic energy."""
        turning = self.mass * np.cross(self.x, self.v).sum(axis=0) + self.inertia * self.spin.sum(axis=0)
        energy = 0.5 * (self.mass * (self.v**2).sum() + self.inertia * (self.spin**2).sum())
        return self.mass * self.v.sum(axis=0), turning, float(energy)

    def joined(self, i: int, j: int) -> bool:
        """Whether two are in contact."""
        return bool(self.pairs[i, j].joined)


def oil() -> Scene:
    """The steel balls of the paper without their strings."""
    given = Scene.load("pendulum").given
    return Scene("oil", tuple((key, value) for key, value in given if not key.startswith("pendulum")))


def cradle(law: Law, speed: float, target_gap: float, parts: int = 20) -> int:
    """The outcome of a head-on cradle, an index of WORDS; `target_gap`: of the target beforehand, over the film."""
    film, apart = law.material.film_thickness, 4 * law.material.reduced_radius
    places = [0.0, apart + 1.01 * film, 2 * apart + (1.01 + target_gap) * film]
    spheres = Spheres(law, [[place, 0, 0] for place in places], [[speed, 0, 0], [0, 0, 0], [0, 0, 0]])
    spheres.law.join(target_gap * film, speed, spheres.pairs[1, 2])
    dt = film / speed / parts
    for k in range(600 * parts):
        spheres.step(dt)
        if k > 3 * parts and k % 50 == 0 and settled(spheres, speed):
            break
    return 2 * (not spheres.joined(0, 1)) + (not spheres.joined(1, 2))


def settled(spheres: Spheres, speed: float) -> bool:
    """Nothing moves any more but what separates."""
    for i in range(2):
        opening = spheres.v[i + 1, 0] - spheres.v[i, 0]
        if spheres.joined(i, i + 1) and abs(opening) > 1e-4 * speed:
            return False
        if not spheres.joined(i, i + 1) and opening < -1e-6 * speed:
            return False
    return True


def clusters(law: Law, strike: np.ndarray) -> dict[str, float]:
    """A doublet that turns, struck off centre by a sphere or by another doublet: what is conserved, over its size."""
    film, apart = law.material.film_thickness, 4 * law.material.reduced_radius
    near, unit = apart + 0.3 * film, 1.0 / 20
    speed = float(np.linalg.norm(strike))
    report: dict[str, float] = {}
    for word, extra in (("sphere", 0), ("doublet", 1)):
        places = [[0, 0, 0], [0, near, 0], [-1.3 * apart, 0.6 * apart, 0], [-1.3 * apart - near, 0.6 * apart, 0]]
        moves = [[0, 0, 0.1 * speed], [0, 0, -0.1 * speed], strike, strike]
        spheres = Spheres(law, places[: 3 + extra], moves[: 3 + extra])
        law.join(0.3 * film, speed, spheres.pairs[0, 1])
        if extra:
            law.join(0.3 * film, speed, spheres.pairs[2, 3])
        first = spheres.sums()
        sizes = (spheres.mass * speed, spheres.mass * speed * apart, first[2])
        worst, most = [0.0, 0.0], 0.0
        for _ in range(3000):
            spheres.step(unit * film / speed)
            now = spheres.sums()
            worst = [
                max(w, float(np.abs(a - b).max()) / s)
                for w, a, b, s in zip(worst, now[:2], first[:2], sizes, strict=False)
            ]
            most = max(most, now[2] / first[2])
        report |= {f"{word}: momentum": worst[0], f"{word}: angular momentum": worst[1], f"{word}: energy": most}
        report[f"{word}: contacts at the end"] = sum(history.joined for history in spheres.pairs.values())
    return report


def main() -> None:
    """Outcomes over speed, for viscosities and gaps of the target; the picture; clusters."""
    out = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent)
    with tempfile.TemporaryDirectory() as folder:
        law = Law(exported(oil(), Path(folder)), "oil")
    usual, film = float(law.material.viscosity), law.material.film_thickness
    stokes = np.geomspace(0.5, 30.0, 25)
    figure, axes = plt.subplots(1, 2, figsize=(11, 3.6), sharey=False, layout="constrained")
    for ax, rows, label in (
        (axes[0], [(factor, 0.1) for factor in (0.25, 0.5, 1.0, 2.0)], "viscosity, Pa s"),
        (axes[1], [(1.0, gap) for gap in (0.9, 0.5, 0.2, 0.1, 0.06)], "gap of the target over film"),
    ):
        for place, (factor, gap) in enumerate(rows):
            law.material.viscosity = factor * usual
            size = 6 * np.pi * law.material.viscosity * law.material.reduced_radius**2 / law.material.reduced_mass
            results = np.array([cradle(law, number * size, gap) for number in stokes])
            value = law.material.viscosity if ax is axes[0] else gap
            for k, word in enumerate(WORDS):
                here = results == k
                ax.semilogx(
                    stokes[here], np.full(here.sum(), place), "s", color=COLOURS[k], label=word if place == 0 else ""
                )
            changes = [
                f"{WORDS[a]} to {WORDS[b]} at St {s:.2f}"
                for a, b, s in zip(results, results[1:], stokes[1:], strict=False)
                if a != b
            ]
            print(
                f"{'viscosity' if ax is axes[0] else 'target gap'} {value:g}: {WORDS[results[0]]}; {'; '.join(changes)}"
            )
        ax.set_yticks(range(len(rows)), [f"{usual * f:g}" if ax is axes[0] else f"{g:g}" for f, g in rows])
        ax.set_xlabel("Stokes number of the striker")
        ax.set_ylabel(label)
        ax.set_title("target 0.1 of the film apart" if ax is axes[0] else f"{usual:g} Pa s", fontsize="medium")
    handles = [Line2D([], [], marker="s", ls="", color=c, label=w) for c, w in zip(COLOURS, WORDS, strict=True)]
    figure.legend(handles=handles, loc="outside lower center", ncols=4)
    figure.savefig(out / "cradle.png", dpi=110)
    law.material.viscosity = usual
    for name, value in clusters(law, np.array([30 * film / 0.004, 0.0, 0.0])).items():
        print(f"{name}: {value:.3g}")


if __name__ == "__main__":
    main()
