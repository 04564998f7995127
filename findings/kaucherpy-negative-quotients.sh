#!/usr/bin/env bash
# kaucherpy 0.1.0: quotients and squares of intervals with negative ends
#
# Guess: a rebound of -0.6 to -0.4 m/s after an impact of 0.9 to 1.1 m/s has the quotient [-0.667, -0.364], as it has
#   with the other sign; the square of a speed between -2 and -1 m/s is [1, 4].
# What happens: the quotient is [-0.545, -0.444], a third as wide as the true one. [-2, -1] / [2, 4] is the single
#   number -0.5, [-2, -1] / [-4, -2] is [1, 0.25], and the square is [4, 1]: in this arithmetic the last two are
#   intervals of another kind ("improper"). The square of [-1, 2] is [1, 4] and has no 0. Products are right, also of an
#   interval with itself. No message.
# Why: a quotient is always lower by upper and upper by lower end, and a power takes each end by itself, which is right
#   for positive intervals only; the products have a case for each sign.
# Why it matters here: a coefficient of restitution is the quotient of two speeds of opposite sign. Divide by hand:
#   multiply with [1 / upper, 1 / lower].
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'kaucherpy==0.1.0' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
from importlib.metadata import version
from itertools import product

from kaucherpy import Kaucher


def close(interval, ends):
    return all(map(math.isclose, (float(interval.lower), float(interval.upper)), ends))


def show(text, interval, true):
    found = float(interval.lower), float(interval.upper)
    print(f"{text:28s}" + "".join(f"[{low:7.3f}, {high:7.3f}]   " for low, high in (found, true)))


def ends(values):
    return min(values), max(values)


print("kaucherpy", version("kaucherpy"))
print("                                 by kaucherpy            true")
for one, two, expected in (
    ((0.4, 0.6), (0.9, 1.1), None),
    ((-0.6, -0.4), (0.9, 1.1), (-0.6 / 1.1, -0.4 / 0.9)),
    ((-2, -1), (2, 4), (-0.5, -0.5)),
    ((1, 2), (-4, -2), (-0.5, -0.5)),
    ((-2, -1), (-4, -2), (1, 0.25)),
):
    true = ends([a / b for a, b in product(one, two)])
    quotient = Kaucher(*one) / Kaucher(*two)
    by_product = Kaucher(*one) * Kaucher(*sorted(1 / b for b in two))
    show(f"{list(one)} / {list(two)}", quotient, true)
    assert close(quotient, expected or true), f"changed: {one} / {two}"
    assert close(by_product, true), "the product with the inverse"
for x, expected in (((1, 2), (1, 4)), ((-2, -1), (4, 1)), ((-1, 2), (1, 4))):
    true = (0, 4) if x[0] < 0 < x[1] else ends([x[0] ** 2, x[1] ** 2])
    square = Kaucher(*x) ** 2
    show(f"{list(x)} ** 2", square, true)
    assert close(square, expected), f"changed: the square of {x}"
itself = Kaucher(-2, -1) * Kaucher(-2, -1)
show("[-2, -1] * [-2, -1]", itself, (1, 4))
assert close(itself, (1, 4)), "the product with itself"
PY
