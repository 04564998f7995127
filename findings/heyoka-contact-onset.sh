#!/usr/bin/env bash
# heyoka 7.13.2: a contact force that begins at zero overlap
#
# Guess: Hertz' force -k x^1.5 can start at the touch, x = 0; written with `select` so that it acts in
#   contact only, an integrator that controls its error to 1e-16 sees it begin.
# What happens: three things. x^1.5 from x = 0: the state is NaN, with the outcome `err_nf_state` and no exception.
#   With `select(x > 0, x^1.5, 0)` the ball flies through the body in *one* step and the outcome is `time_limit`,
#   success, from x = 0 and from before the touch. The same from x = 1e-300 without `select`. From x = 1e-12 all is
#   right.
# Why: a step is the Taylor series at its start, and as long as the series converges there. x^1.5 has none at 0
#   (division by zero); on the force-free side the series is the straight line, exact for ever, so no error is
#   estimated and nothing is rejected; at 1e-300 x^1.5 is 0 in double precision, and the later terms are computed
#   from it.
# Why it matters here: contacts begin at zero overlap, films at x = x0. Make the touch an event, and start behind
#   it.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'heyoka==7.13.2' 'numpy==2.4.6' 'scipy==1.17.1'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import heyoka
import numpy as np
from scipy.integrate import solve_ivp

x, u = heyoka.make_vars("x", "u")
hertz = x**1.5
FORCES = {"x^1.5": hertz, "select(x > 0, x^1.5, 0)": heyoka.select(heyoka.gt(x, 0.0), hertz, 0.0)}


def taylor(force, start):
    """Outcome, steps and place at t = 1 of a ball of mass 1 that enters with speed 1."""
    integrator = heyoka.taylor_adaptive([(x, u), (u, -force)], [start, 1.0])
    outcome, _, _, steps, *_ = integrator.propagate_until(1.0)
    return str(outcome).rpartition(".")[2], steps, float(integrator.state[0])


def reference(start):
    """The same by explicit Runge-Kutta, from the touch."""
    touch = max(-start, 0.0)
    answer = solve_ivp(
        lambda t, y: [y[1], -(max(y[0], 0.0) ** 1.5)], (touch, 1.0), [max(start, 0.0), 1.0], rtol=1e-11, atol=1e-12
    )
    return answer.y[0, -1]


print("heyoka", heyoka.__version__)
print("force                      start     outcome        steps   place at t = 1   true")
seen = {}
for name, start in (
    ("x^1.5", 0.0),
    ("x^1.5", 1e-300),
    ("x^1.5", 1e-12),
    ("select(x > 0, x^1.5, 0)", -0.1),
    ("select(x > 0, x^1.5, 0)", 0.0),
    ("select(x > 0, x^1.5, 0)", 1e-12),
):
    outcome, steps, place = seen[name, start] = taylor(FORCES[name], start)
    print(f"{name:26s} {start:<9g} {outcome:14s} {steps:5d}   {place:14.6f}   {reference(start):.6f}")
assert seen["x^1.5", 0.0][0] == "err_nf_state" and np.isnan(seen["x^1.5", 0.0][2]), "changed: from the touch"
for case in (("x^1.5", 1e-300), ("select(x > 0, x^1.5, 0)", -0.1), ("select(x > 0, x^1.5, 0)", 0.0)):
    outcome, steps, place = seen[case]
    free = 1 + case[1]
    assert outcome == "time_limit" and steps == 1 and abs(place - free) < 1e-12, f"changed: {case}"
for name in FORCES:
    assert abs(seen[name, 1e-12][2] - reference(1e-12)) < 1e-8, f"changed: {name} behind the touch"
PY
