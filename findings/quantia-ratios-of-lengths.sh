#!/usr/bin/env bash
# quantia 0.2.2: logarithms of ratios, comparisons and variances of quantities with units
#
# Guess: the ratio of 50 micrometres to 1 mm is the number 0.05, whatever its units are written as, so that its
#   logarithm is -3; lengths and times cannot be compared; the variance of lengths is an area.
# What happens: the logarithm is 3.91, that of 50, and so with log10 and exp: of a strain of 30 mm/m it is 1e13. Sums
#   treat the same ratio rightly, 0.05 + 1 is 1.05. A metre is less than two seconds and equal to one second, without a
#   message; to add them is refused. The variance of lengths in millimetres is in millimetres; in metres it is a
#   thousand times too large.
# Why: a ratio of two units of length keeps both units, counts as dimensionless, and its bare number goes into the
#   function. Comparisons take the numbers in SI units and never look at the dimensions. `variance` has the unit of the
#   samples.
# Why it matters here: the logarithm of a gap over a film or a radius is how much speed a film takes, and it is negative
#   where it is positive here. Say `.to("1")` before each function.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'quantia==0.2.2'
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
from importlib.metadata import version

import quantia
from quantia import ProbUnitFloat, Q
from quantia import math as functions

film = Q(50, "um") / Q(1, "mm")  # thickness over radius
strain = Q(30, "mm") / Q(1, "m")
print("quantia", version("quantia"))
print("                       quantia   of its number      true")
for name, ratio, number in (("log", film, 0.05), ("log10", film, 0.05), ("exp", strain, 0.03)):
    found = float(getattr(functions, name)(ratio))
    bare, true = (getattr(math, name)(value) for value in (float(ratio), number))
    right = float(getattr(functions, name)(ratio.to("1")))
    print(f"{name:5s} of {ratio!s:10s} {found:12.4g} {bare:15.4g} {true:9.4g}")
    assert math.isclose(found, bare) and abs(found - true) > 0.04, f"changed: {name}"
    assert math.isclose(right, true), "of the ratio as a number"
total = (film + 1).to("1")
print(f"1 + {film} = {total}")
assert math.isclose(float(total), 1.05), "the sum"

print(f"1 m < 2 s: {Q(1, 'm') < Q(2, 's')}; 1 m == 1 s: {Q(1, 'm') == Q(1, 's')}; 1 m < 2 mm: {Q(1, 'm') < Q(2, 'mm')}")
assert Q(1, "m") < Q(2, "s") and Q(1, "m") == Q(1, "s"), "changed: comparisons"
assert not Q(1, "m") < Q(2, "mm"), "lengths"

with quantia.config(n_samples=10000, seed=1):
    sizes = ProbUnitFloat.normal(10.0, 1.0, "mm")
deviation, variance = sizes.std().to("m"), sizes.variance().to("m")
print(f"standard deviation {deviation}, variance {variance}")
assert math.isclose(float(variance), 1000 * float(deviation) ** 2), "changed: variance"
PY
