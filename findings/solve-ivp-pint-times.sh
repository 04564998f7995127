#!/usr/bin/env bash
# solve-ivp-pint 1.0.0: an initial value problem with units of time
#
# Guess: with quantities, each time may be given in its own unit: points every half minute of a run over 60 s, or a
#   state that counts how long two spheres have touched, in milliseconds.
# What happens: the points asked for at 0, 0.5 and 1 minute are those at 0, 0.5 and 1 s, with seconds as their unit. A
#   state in milliseconds that grows by 1 s in each second has 2 ms after 2 s; in minutes it is 60 times too much, in
#   hours 3600 times. In seconds both are right, and so is a length in millimetres whose rate is in metres per second.
# Why: the points are converted only if their dimension differs from that of the span, which is then refused. A rate
#   without dimension is taken as it stands, before the unit of the state is looked at. 1.0.2, for Python 3.12, converts
#   the points, and still not the rate.
# Why it matters here: the time of contact decides how far a film drains, and units are used so that this cannot happen.
#   Give all times in the unit of the span.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'solve-ivp-pint==1.0.0' \
    'flexcache==0.3' 'flexparser==0.4' 'numpy==2.4.6' 'pint==0.25.3' 'platformdirs==4.14.9' 'scipy==1.17.1' \
    'typing_extensions==4.16.0'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
from importlib.metadata import version

import pint
from solve_ivp_pint import solve_ivp

Q = pint.UnitRegistry().Quantity
print("solve-ivp-pint", version("solve-ivp-pint"), "with pint", version("pint"))


def drained(time, state):
    return [-state[0] / Q(20, "s")]


print("film of 1 mm, drained as exp(-t / 20 s), at 0, 30 and 60 s:")
true = [math.exp(-time / 20) for time in (0, 30, 60)]
found = {}
for unit, times in (("s", [0, 30, 60]), ("min", [0, 0.5, 1])):
    result = solve_ivp(drained, (Q(0, "s"), Q(60, "s")), [Q(1, "mm")], t_eval=Q(times, unit))
    found[unit] = [thickness.to("mm").magnitude for thickness in result.y[0]]
    row = ", ".join(f"{time.magnitude:g} s: {each:.4f} mm" for time, each in zip(result.t, found[unit], strict=True))
    print(f"asked for in {unit:3s}   {row}")
assert all(abs(each - exact) < 1e-3 for each, exact in zip(found["s"], true, strict=True)), "in seconds"
wrong = [math.exp(-time / 20) for time in (0, 0.5, 1)]
assert all(abs(each - exact) < 1e-3 for each, exact in zip(found["min"], wrong, strict=True)), "changed: in minutes"


def grown(rate, start):
    result = solve_ivp(lambda time, state: [rate], (Q(0, "s"), Q(2, "s")), [start])
    return result.y[0][-1].to_base_units().magnitude


print("state that grows for 2 s, at the end:")
second = Q(1, "s") / Q(1, "s")
for name, rate, unit, true in (
    ("time of contact", second, "s", 2),
    ("time of contact", second, "ms", 2),
    ("time of contact", second, "min", 2),
    ("time of contact", second, "hour", 2),
    ("distance", Q(1, "m/s"), "mm", 2),
):
    factor = grown(rate, Q(0, unit)) / true
    print(f"{name:15s} in {unit:4s} {factor:9.4g} times what it should be")
    one = Q(1, unit).to_base_units().magnitude if name.startswith("time") else 1
    assert math.isclose(factor, one, rel_tol=1e-6), "changed: the state"
PY
