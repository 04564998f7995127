#!/usr/bin/env bash
# particula 0.2.10: which of two beads settles faster
#
# Guess: `get_particle_settling_velocity_with_drag` is Stokes's law up to a Reynolds number of `re_threshold`, 0.1, and
#   has a variable drag coefficient from there on, as documented; of the same glass a larger bead settles faster.
# What happens: it is Stokes's law up to a Reynolds number of 1, whatever `re_threshold` is, 14 % too fast there. Glass
#   beads of 58 to 61 micrometres in air settle the slower the larger they are, at 0.254 to 0.246 m/s; in water one of
#   112 micrometres is slower than one of 110.
# Why: the drag coefficient has a step of 15 % at a Reynolds number of 1, from 24 / Re to 27.6 / Re. Beads in between
#   have no balance of weight and drag; the minimum of the squared difference that is looked for is at the step, where
#   the speed goes with the inverse of the diameter.
# Why it matters here: settling sprays and powders collide with the difference of these speeds. Here it changes its
#   sign, so that the smaller bead runs into the larger one from above, or never.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'particula==0.2.10' 'numpy==2.4.6' \
    'scipy==1.17.1'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import logging
from importlib.metadata import version

import numpy as np
from scipy.optimize import brentq

logging.disable(logging.CRITICAL)
from particula.particles import get_particle_settling_velocity_with_drag as settling

GLASS, GRAVITY = 2500.0, 9.80665


def balance(diameter, density, viscosity):
    """The speed at which the drag of Schiller and Naumann is the weight less buoyancy."""

    def excess(speed):
        reynolds = density * diameter * speed / viscosity
        drag = 3 * np.pi * viscosity * diameter * speed * (1 + 0.15 * reynolds**0.687)
        return drag - (GLASS - density) * GRAVITY * np.pi / 6 * diameter**3

    return brentq(excess, 1e-12, 10, xtol=1e-15)


print("particula", version("particula"), "- settling of glass beads")
for fluid, density, viscosity, sizes in (
    ("air", 1.2, 1.8e-5, (20, 30, 50, 56, 58, 59, 60, 61, 62, 64, 80, 200)),
    ("water", 1000.0, 1e-3, (50, 90, 105, 110, 112, 114, 116, 120, 200)),
):
    diameters = 1e-6 * np.array(sizes)
    found = settling(diameters / 2, np.full(len(sizes), GLASS), density, viscosity, 1.0)
    same = settling(diameters / 2, np.full(len(sizes), GLASS), density, viscosity, 1.0, re_threshold=1e-6)
    exact = np.array([balance(diameter, density, viscosity) for diameter in diameters])
    reynolds = density * diameters * exact / viscosity
    print(f"{fluid}: diameter in micrometres, Reynolds number, speed in mm/s: found and by the drag curve")
    for row in zip(sizes, reynolds, 1e3 * found, 1e3 * exact, found / exact):
        print("{:6d} {:7.3f} {:9.3f} {:9.3f} {:7.3f}".format(*row))
    fast = reynolds > 1.1
    assert abs(found[fast] / exact[fast] - 1).max() < 1e-3, "beyond a Reynolds number of 1"
    assert np.all(np.diff(exact) > 0), "larger is faster"
    assert abs(same / found - 1).max() < 1e-4, "changed: re_threshold"
    slower = np.flatnonzero(np.diff(found) < 0)
    print("larger and slower:", ", ".join(f"{sizes[k]} to {sizes[k + 1]}" for k in slower))
    assert len(slower) >= 1 and (found / exact).max() > 1.1, "changed: speeds"
PY
