#!/usr/bin/env bash
# desolver 5.1.0: events whose function is large
#
# Guess: an event is a zero crossing, so that a height in metres and the same height in millimetres end the integration
#   at the same time; a crossing that the steps bracket is never lost.
# What happens: a ball that is dropped from 0.5 to 2 m stops on the ground each time if its height is given in metres,
#   or in kilometres; in millimetres it falls through in most cases, to 19 m below the ground, and the state is
#   "Integration completed successfully". In metres, too, crossings go missing: about a tenth of those of an
#   oscillator at rtol 1e-9. Nothing warns.
# Why: the root that the search found is taken only if the event function is there at most 2.2e-16, an *absolute*
#   limit, in whatever unit. Next to a root the values of a function are multiples of its slope times the last bit of
#   the time, here 1e-16 to 1e-13: it is luck if one of them is small enough.
# Why it matters here: onset and rupture are such events, with gaps over the film's thickness (dimensionless, and
#   therefore 10^4 times larger than in metres). Divide the event function by 1000 or more; look whether each fall of
#   the gap has its event.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'desolver==5.1.0' 'numpy==2.4.6' 'scipy==1.17.1'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import math
from importlib.metadata import version

import desolver
import numpy as np
from scipy.integrate import solve_ivp

GRAVITY = 9.81
HEIGHTS = np.linspace(0.5, 2, 8)


def fall(time, state, **constants):
    return np.array([state[1], -GRAVITY])


def swing(time, state, **constants):
    return np.array([state[1], -state[0]])


def solve(law, state, end, scale, terminal, rtol):
    def event(time, state, **constants):
        return scale * state[0]

    event.is_terminal = terminal
    options = {"dense_output": True, "dt": 0.1, "rtol": rtol, "atol": rtol / 100}
    system = desolver.OdeSystem(law, y0=np.array(state), t=(0, end), **options)
    system.method = "RK45CK"
    system.integrate(events=[event])
    return system


print("desolver", version("desolver"))
print("height in    stopped by the ground    lowest place (m)   last state of the integration")
stopped = {}
for unit, scale in (("km", 1e-3), ("m", 1.0), ("mm", 1e3), ("um", 1e6)):
    falls = [solve(fall, [height, 0.0], 2.0, scale, True, 1e-9) for height in HEIGHTS]
    stopped[unit] = sum(float(system.t[-1]) < 1 for system in falls)
    lowest = min(float(system.y[-1, 0]) for system in falls)
    print(f"{unit:9s}    {stopped[unit]:3d} of {len(falls)}{lowest:25.3f}        {falls[-1].integration_status}")
    for height, system in zip(HEIGHTS, falls):
        if system.t[-1] < 1:
            assert math.isclose(float(system.t[-1]), math.sqrt(2 * height / GRAVITY), rel_tol=1e-9), "a time found"


def ground(time, state):
    return 1e6 * state[0]


ground.terminal = True
by_scipy = sum(solve_ivp(lambda t, y: [y[1], -GRAVITY], (0, 2), [h, 0], events=ground).status for h in HEIGHTS)
print(f"um           {by_scipy:3d} of {len(HEIGHTS)} by scipy's solve_ivp")
assert by_scipy == len(HEIGHTS)
assert stopped["km"] == len(HEIGHTS) and stopped["m"] >= len(HEIGHTS) - 1, "changed: small functions"
assert stopped["mm"] <= len(HEIGHTS) / 2 and stopped["um"] <= len(HEIGHTS) / 2, "changed: large functions"

seen = crossings = 0
for phase in np.linspace(0.1, 6.1, 6):
    seen += len(solve(swing, [math.cos(phase), -math.sin(phase)], 20.0, 1.0, False, 1e-9).events)
    crossings += math.floor((20 + phase) / math.pi + 0.5) - math.floor(phase / math.pi + 0.5)
print(f"an oscillator's zeros, amplitude 1: {seen} of {crossings}")
assert 0.75 * crossings < seen < crossings, "changed: functions of order 1"
PY
