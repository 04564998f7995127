#!/usr/bin/env bash
# CasADi 3.8.2: `interpolant` outside its table
#
# Guess: beyond the last knot a table goes on (as its last cell, or its last value), or an error says that it ended;
#   the two methods, 'linear' and 'bspline', differ by their smoothness only.
# What happens: 'linear' goes on along the last cell (and a decaying force changes its sign); 'bspline' drops to
#   exactly 0, with derivative 0, just beyond the knot at which it still returns the table's value. No warning in
#   either.
# Why: the spline is the sum of its basis functions, each of which is zero outside the knots.
# Why it matters here: a bridge force, a flow curve or a measured viscosity is given as a table. An integrator's
#   trial step beyond it meets a jump of the force (or an attraction that repels), and sensitivities there are 0.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'casadi==3.8.2' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math

import casadi
import numpy as np

gaps = np.linspace(0.0, 1.0, 11)
force = np.exp(-5 * gaps)
x = casadi.MX.sym("x")
print("CasADi", casadi.__version__)
print("table of exp(-5 x), x = 0 to 1;   at x =" + "".join(f"{place:10g}" for place in (-0.1, 1.0, 1.001, 1.1, 1.5)))
value, slope = {}, {}
for method in ("linear", "bspline"):
    table = casadi.interpolant("table", method, [gaps], force)
    rate = casadi.Function("rate", [x], [casadi.jacobian(table(x), x)])
    for place in (-0.1, 1.0, 1.001, 1.1, 1.5):
        value[method, place], slope[method, place] = float(table(place)), float(rate(place))
    print(f"{method:8s} value" + " " * 27 + "".join(f"{v:10.5f}" for (m, _), v in value.items() if m == method))
    print(f"{method:8s} slope" + " " * 27 + "".join(f"{v:10.5f}" for (m, _), v in slope.items() if m == method))
for method in ("linear", "bspline"):
    assert math.isclose(value[method, 1.0], force[-1], rel_tol=1e-9), "changed: at the last knot"
assert value["linear", 1.5] < 0 and value["linear", -0.1] > 1.3, "changed: linear"
for place in (-0.1, 1.001, 1.1, 1.5):
    assert value["bspline", place] == slope["bspline", place] == 0, "changed: bspline"
PY
