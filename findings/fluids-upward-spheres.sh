#!/usr/bin/env bash
# fluids 1.3.1: spheres that rise, and spheres that were thrown upward
#
# Guess: `integrate_drag_sphere` and `v_terminal` know which way a sphere moves: drag opposes it, and a sphere that is
#   lighter than the liquid rises at a speed that the drag curve gives.
# What happens: a sphere of 1 mm in water, 10 % lighter than it, is said to rise at 54 mm/s; heavier by as much it sinks
#   at 23 mm/s, and as fast it rises. The value is Stokes's, at a Reynolds number of 54. A bead thrown upward with
#   0.5 m/s in water is *accelerated* by its drag: after a tenth of a second it is 12.8 mm above the start, where
#   it should be 1.4 mm below. No message.
# Why: the drag term is c V**2, whatever the sign of V, and the test for the Stokes regime, Re < 0.01, holds for each
#   negative Reynolds number.
# Why it matters here: the rebound of an immersed sphere from a wall is an upward throw. Height and speed of it give
#   the wet restitution. Integrate upward motion with V |V|.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'fluids==1.3.1' 'numpy==2.4.6' 'scipy==1.17.1'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import math

import fluids
from fluids.drag import drag_sphere, integrate_drag_sphere, v_terminal
from scipy.integrate import solve_ivp

DIAMETER, LIQUID, VISCOSITY, GRAVITY = 1e-3, 1000.0, 1e-3, 9.80665


def moved(density, speed, time):
    """Speed and way downward, with the same drag curve and drag against the motion."""

    def rates(_, state):
        reynolds = max(LIQUID * abs(state[1]) * DIAMETER / VISCOSITY, 1e-30)
        drag = 0.75 * LIQUID / (DIAMETER * density) * drag_sphere(reynolds) * state[1] * abs(state[1])
        return state[1], GRAVITY * (1 - LIQUID / density) - drag

    way, speed = solve_ivp(rates, (0, time), (0.0, speed), rtol=1e-9, atol=1e-12).y[:, -1]
    return speed, way


print("fluids", fluids.__version__, "- a sphere of 1 mm in water, downward positive")
sinking, rising = (v_terminal(DIAMETER, density, LIQUID, VISCOSITY) for density in (1100.0, 900.0))
true = moved(900.0, 0.0, 2.0)[0]
stokes = -GRAVITY * DIAMETER**2 * 100 / (18 * VISCOSITY)
reynolds = LIQUID * abs(rising) * DIAMETER / VISCOSITY
print(f"terminal speed, 100 kg/m3 heavier: {sinking * 1e3:6.1f} mm/s")
print(f"terminal speed, 100 kg/m3 lighter: {rising * 1e3:6.1f} mm/s, Re {reynolds:.0f}; by the drag curve {true * 1e3:.1f}")
print("thrown, 2500 kg/m3, after 0.1 s       fluids: m/s, mm      drag against the motion")
results = {}
for start in (0.5, -0.5):
    results[start] = integrate_drag_sphere(DIAMETER, 2500.0, LIQUID, VISCOSITY, 0.1, V=start, distance=True)
    own = moved(2500.0, start, 0.1)
    words = "downward" if start > 0 else "upward"
    print(
        f"  {words:8s} with 0.5 m/s            {results[start][0]:8.4f} {results[start][1] * 1e3:8.2f}"
        f"      {own[0]:8.4f} {own[1] * 1e3:8.2f}"
    )
    if start > 0:
        assert math.isclose(results[start][1], own[1], rel_tol=1e-4), "the comparison"
assert math.isclose(rising, stokes, rel_tol=1e-9) and true / rising < 0.5, "changed: rising"
assert abs(sinking + true) < 1e-3, "changed: sinking"
assert results[-0.5][1] < -0.0125 and moved(2500.0, -0.5, 0.1)[1] > 0.001, "changed: thrown upward"
PY
