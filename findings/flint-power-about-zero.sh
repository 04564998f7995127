#!/usr/bin/env bash
# python-flint 0.9.0: powers of a ball that is centred at zero
#
# Guess: the square of the ball [-1, 1] encloses [0, 1].
# What happens: `x**2` is nan for each ball whose midpoint is exactly 0, even `x**1`, and `pow(x, 2)`; `x * x`
#   encloses, and so does x**2 once the midpoint is moved to 1e-300. 0.1 - 0.1 is such a ball where 0.1 was read
#   from text or enclosed.
# Why: `**` makes each exponent a ball and calls FLINT's general power, whose way for small integers (and
#   half-integers) is not taken if the midpoint is zero; the other way is exp(y log x), and the logarithm of a ball
#   around zero is not finite.
# Why it matters here: at the turn of a collision u = 0, and a ball about zero is the natural enclosure of it. Its
#   energy m u**2 / 2 is nan there, and each comparison with nan is False, as is one that can't be decided: the
#   proof is lost without a message. Write u * u.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'python-flint==0.9.0'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import flint
from flint import arb

print("python-flint", flint.__version__)
print("ball x                 x * x              x**2               x**1")
balls = {
    "arb(0, 1)": arb(0, 1),
    "arb(1e-300, 1)": arb(1e-300, 1),
    "arb(0.5, 1)": arb(0.5, 1),
    "arb('0.1') - arb('0.1')": arb("0.1") - arb("0.1"),
}
for name, x in balls.items():
    print(f"{name:23s}", *(f"{value!s:18s}" for value in (x * x, x**2, x**1)))
    assert (x * x).contains(0) and (x * x).is_finite(), "changed: product"
    assert (x**2).is_finite() == (x.mid() != 0), f"changed: square of {name}"
assert (arb(1e-300, 1) ** 2).contains(1) and not (arb(0, 1) ** 1).is_finite(), "changed"
PY
