#!/usr/bin/env bash
# affapy 0.1: exponential and absolute value of an affine form
#
# Guess: affine arithmetic may be wide, but its result encloses the function's values.
# What happens: `exp` of [0, 1] ends at 2.6123 (e is 2.7183), `cosh` of [-1, 2] at 3.37 (3.76), and `abs` of [-1, 2]
#   is [-0.5, 1]: negative at one end and half of the greatest value at the other. Over [1, 2] `exp` encloses, by
#   [-2.8, 11.8]. No message.
# Why: the band between a tangent of exp and its chord is centred on the tangent, and its width has a wrong sign (so
#   that it grows with the place); abs halves the form without a term for what is left. The interval class of the same
#   package encloses.
# Why it matters here: a proof about a decaying or damped motion is an enclosure of exp; one that doesn't enclose
#   "proves" anything.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'affapy==0.1' 'mpmath==1.3.0'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
from importlib.metadata import version

from affapy.aa import Affine
from affapy.ia import Interval

print("affapy", version("affapy"))
print("function     of          affine form           values")
lost = {}
for name, function, ends, values in (
    ("exp", lambda x: x.exp(), (0, 1), (1.0, math.e)),
    ("exp", lambda x: x.exp(), (1, 2), (math.e, math.exp(2))),
    ("cosh", lambda x: x.cosh(), (-1, 2), (1.0, math.cosh(2))),
    ("abs", abs, (-1, 2), (0.0, 2.0)),
    ("sin", lambda x: x.sin(), (-1, 2), (-math.sin(1), 1.0)),
):
    result = function(Affine(list(ends))).interval
    low, high = float(result.inf), float(result.sup)
    lost[name, ends] = values[1] - high, low
    note = "" if low <= values[0] and high >= values[1] else "   does not enclose"
    print(f"{name:8s} {str(ends):9s}   [{low:9.5f}, {high:9.5f}]   [{values[0]:8.5f}, {values[1]:8.5f}]{note}")
plain = Interval(0, 1).exp()
print(f"interval class: exp of (0, 1) is [{float(plain.inf):.5f}, {float(plain.sup):.5f}]")
assert float(plain.inf) <= 1 and float(plain.sup) >= math.e - 1e-15, "the interval class"
assert 0.1 < lost["exp", (0, 1)][0] < 0.11, "changed: exp"
assert lost["exp", (1, 2)][0] < -4, "changed: exp of [1, 2]"
assert 0.38 < lost["cosh", (-1, 2)][0] < 0.4, "changed: cosh"
assert lost["abs", (-1, 2)] == (1.0, -0.5), "changed: abs"
PY
