#!/usr/bin/env bash
# pyball-arithmetic 0.1.0: sinh of negative arguments
#
# Guess: `sinh` of a ball encloses, as every function of the package is said to, and is odd; what
#   `prove_positive_negative` calls positive is positive, and `isolate_roots` leaves no root out.
# What happens: sinh of [-3, -1] is [-5.17, -2.08], where the function runs from -10.02 to -1.18; no ball below zero
#   that has a radius is enclosed, however small. With it sinh(x) + 6 is proved positive on [-3, 0], while it is -4.02
#   at the left end, and its root at -2.49 is not isolated: the list is empty. Mirrored, all three are right.
# Why: the radius is multiplied by the slope at the upper end, which is the largest one for positive arguments alone.
#   `cosh` takes the end farther from zero.
# Why it matters here: an overdamped contact moves with exp(-a t) sinh(b t), and times before a contact are negative: a
#   bound on a gap is proved that the gap breaks, and a root that is missing is a contact that is missing. Take
#   (exp(x) - exp(-x)) / 2, or -sinh(-x).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'pyball-arithmetic==0.1.0'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
from importlib.metadata import version

from pyball import Ball, isolate_roots, prove_positive_negative

print("pyball-arithmetic", version("pyball-arithmetic"))
print("argument                 sinh                       true range                 encloses")
for middle, radius in ((2, 1), (1, 0.1), (0.1, 1e-3), (-0.1, 1e-3), (-1, 0.1), (-2, 1)):
    ball = Ball(float(middle), float(radius)).sinh()
    low, high = math.sinh(middle - radius), math.sinh(middle + radius)
    encloses = ball.lo <= low and high <= ball.hi
    print(
        f"{f'[{middle - radius:g}, {middle + radius:g}]':20s} {f'[{ball.lo:.7f}, {ball.hi:.7f}]':26s}"
        f" {f'[{low:.7f}, {high:.7f}]':26s} {'yes' if encloses else 'no'}"
    )
    assert encloses == (middle > 0), f"changed: {middle}"


def right(x):
    return Ball(6.0, 0.0) - x.sinh()


def left(x):
    return Ball(6.0, 0.0) + x.sinh()


def swapped(x):
    return Ball(6.0, 0.0) - (-x).sinh()


answers = {}
for name, function, slope, domain in (
    ("6 - sinh(x)", right, lambda x: -x.cosh(), (0.0, 3.0)),
    ("6 + sinh(x)", left, lambda x: x.cosh(), (-3.0, 0.0)),
    ("6 - sinh(-x)", swapped, lambda x: x.cosh(), (-3.0, 0.0)),
):
    roots = isolate_roots(function, slope, *domain)
    answers[name] = prove_positive_negative(function, *domain), [root.interval.mid for root in roots if root.certified]
    print(f"{name:12s} on {list(domain)}: {answers[name][0]}, roots {answers[name][1]}")
root = math.asinh(6)
for name, place in (("6 - sinh(x)", root), ("6 - sinh(-x)", -root)):
    sign, roots = answers[name]
    assert sign == "inconclusive" and len(roots) == 1 and abs(roots[0] - place) < 1e-9, name
assert 6 + math.sinh(-3) < -4 and answers["6 + sinh(x)"] == ("positive", []), "changed: the proof"
PY
