"""Makes the synthetic measurements in this folder: `python docs/data/make_synthetic.py`.

They are collisions of the model with known entries, with scatter in speed and angle and noise in the restitution;
nobody measured them. The random numbers are fixed, so that the files come out the same.
"""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

import numpy as np
from wetdoublet import Scene, collide_many

HERE = Path(__file__).resolve().parent
TRUTH = {"liquid.film_thickness": "380 um", "liquid.glass_transition_pressure": "15 MPa"}
"""What differs from the preset `pendulum`."""
SPEED_SD, ANGLE_SD, RESTITUTION_SD = 0.02, math.radians(1.0), 0.02
STOKES, DEGREES = np.geomspace(0.8, 4.0, 6), (0.0, 20.0, 40.0, 60.0)


def steel_spheres() -> str:
    """24 impacts of steel spheres on strings, as the CSV file that `fit` reads."""
    scene, random = Scene.load("pendulum").with_entries(TRUTH), np.random.default_rng(2012)
    grid = np.meshgrid(STOKES / Scene.load("pendulum").stokes_per_speed, np.radians(DEGREES))
    speed, angle = (column.ravel().round(4) for column in grid)
    data = collide_many(
        scene,
        speed=speed * (1 + SPEED_SD * random.standard_normal(speed.size)),
        angle=np.abs(angle + ANGLE_SD * random.standard_normal(speed.size)),
    )
    noise = RESTITUTION_SD * random.standard_normal(speed.size)
    words = ("stick", "stick-rotate-separate", "bounce")
    file = io.StringIO()
    file.write("# Synthetic: drawn from the model by make_synthetic.py, not measured.\n")
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(
        ["speed [m/s]", "speed_sd [%]", "angle [deg]", "angle_sd [deg]", "outcome", "restitution", "restitution_sd"]
    )
    for k, code in enumerate(data.outcome.values.tolist()):
        seen = ["", ""] if code == 0 else [f"{max(float(data.restitution[k]) + noise[k], 0):.3f}", f"{RESTITUTION_SD}"]
        row = [f"{speed[k]:.4f}", f"{100 * SPEED_SD:g}", f"{math.degrees(angle[k]):.0f}", "1", words[code]]
        writer.writerow(row + seen)
    return file.getvalue()


def flow_curve() -> str:
    """17 viscosities of a liquid by Carreau's law with 3 % of scatter, as the CSV file that `flow-curve` reads."""
    random, rate = np.random.default_rng(3), np.geomspace(0.1, 1000, 17)
    viscosity = 5 * (1 + (0.3 * rate) ** 2) ** ((0.4 - 1) / 2) * (1 + 0.03 * random.standard_normal(rate.size))
    lines = [f"{at:.4g},{value:.4g}" for at, value in zip(rate, viscosity, strict=True)]
    first = (
        "# Synthetic: Carreau's law with 5 Pa s, 0.3 s, n = 0.4 and 3 % of scatter, by make_synthetic.py, not measured."
    )
    return "\n".join([first, "shear rate [1/s],viscosity [Pa s]", *lines, ""])


FILES = {"synthetic-steel-spheres.csv": steel_spheres, "synthetic-flow-curve.csv": flow_curve}

if __name__ == "__main__":
    for name, content in FILES.items():
        (HERE / name).write_text(content(), encoding="utf-8")
