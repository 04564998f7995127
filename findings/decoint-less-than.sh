#!/usr/bin/env bash
# decoint 1.0.1: comparisons of intervals
#
# Guess: in a library for verified computing a < b is true if it holds for all numbers of both, and false or an error
#   otherwise. `Interval(0.1)` is the number 0.1.
# What happens: [0.9, 1.1] < [1.0, 1.2] is True, although the two overlap. So is [0.9, 1.1] < 1.1, and both x < x and
#   x > x, of each interval. `<=` does not exist. `Interval(0.1)` is [0.1, inf], while 0.1 in a sum is a number.
# Why: `<` is the relation "less" of the standard, IEEE 1788: each end at most the other's end, the like of <=. What one
#   expects of `<` is `strictly_precedes`. One argument is the lower end, the upper is infinite if not given.
# Why it matters here: a proof of a stick ends in "the enclosed energy is below the enclosed barrier". With `<` it is
#   true while the outcome is open, the one mistake that intervals are there to exclude.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check \
    'decoint==1.0.1' 'gmpy2==2.3.2' 'python-flint==0.9.0' 'mpmath==1.3.0'
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

from decoint import Interval
from flint import arb
from mpmath import iv

PAIRS = {  # ends of two intervals: does the first lie below the second, for all numbers of both?
    ((0.5, 0.75), (1.0, 1.25)): True,
    ((0.875, 1.125), (1.0, 1.25)): False,
    ((0.875, 1.125), (1.125, 1.125)): False,
    ((0.875, 1.125), (0.875, 1.125)): False,
    ((0.875, 1.5), (1.0, 1.25)): False,
}


def ball(low, high):
    return arb((low + high) / 2, (high - low) / 2)


print(", ".join(f"{name} {version(name)}" for name in ("decoint", "python-flint", "mpmath")))
print("a               b                all of both   decoint a < b   strictly_precedes   flint a < b   mpmath a < b")
for (a, b), holds in PAIRS.items():
    less = Interval(*a) < Interval(*b)
    precedes = Interval(*a).strictly_precedes(Interval(*b))
    by_flint, by_mpmath = ball(*a) < ball(*b), iv.mpf(a) < iv.mpf(b)
    print(f"{a!s:15s} {b!s:15s} {holds!s:>12s} {less!s:>15s} {precedes!s:>19s} {by_flint!s:>13s} {by_mpmath!s:>14s}")
    assert precedes == holds and by_flint == holds and bool(by_mpmath) == holds, "the comparison"
    assert less == (a[0] <= b[0] and a[1] <= b[1]), "changed: less"
x = Interval(0.875, 1.125)
print("x < x:", x < x, "  x > x:", x > x, "  x < 1.125:", x < 1.125)
assert (x < x) and (x > x) and (x < 1.125), "changed: an interval and itself"
print("Interval(0.5):", Interval(0.5), "  0.5 + Interval(0, 0):", 0.5 + Interval(0, 0))
assert Interval(0.5).hi == float("inf") and (0.5 + Interval(0, 0)).hi == 0.5, "changed: one argument"
PY
