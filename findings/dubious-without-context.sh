#!/usr/bin/env bash
# dubious 0.4.1: a quantity that appears twice, and correlations
#
# Guess: the same `Uncertain` used twice is the same variable, as the package says; a common `Context` only saves
#   time, and `a.corr(b, 0.9)` correlates the two with one or without.
# What happens: with a common context both are so. Without, (a + b) - a scatters as if the two a were different (0.087
#   for 0.05), the reduced mass of two spheres has 2.24 times its standard deviation, and `corr` does nothing. No
#   message. a - a is 0 in both.
# Why: each number has a context of its own, and an operation copies both sides into a new one: a variable that comes
#   in on both sides is copied twice. `corr` merges the contexts and drops the result; both numbers are the first of
#   theirs, and the correlation of number 1 with number 1 is that of a variable with itself.
# Why it matters here: mass, radius and viscosity appear several times in a Stokes number, a reduced mass, a
#   restitution. Its error bars decide whether a law is refuted. Give each number `ctx=`.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'dubious==0.4.1' 'ironforest==0.6.0' \
    'numpy==2.4.6'  # not in its list of requirements; correlations need it
cd "$work"
"$work/venv/bin/python" - <<'PY'
import math
from importlib.metadata import version

from dubious import Context, Sampler, Uncertain
from dubious.distributions import Normal

SPREAD, RHO, SAMPLES = 0.05, 0.9, 200_000
ROOT = math.sqrt(2)


def deviation(value):
    return math.sqrt(value.var(n=SAMPLES, sampler=Sampler(seed=1)))


def quantities(**context):
    """Standard deviations of what is made of two numbers of mean 1."""
    a, b = (Uncertain(Normal(1, SPREAD), **context) for _ in range(2))
    results = [deviation(value) for value in (a - a, (a + b) - a, a * b / (a + b))]
    a.corr(b, RHO)
    return [*results, deviation(a - b)]


names = ("a - a", "(a + b) - a", "a b / (a + b)", f"a - b, correlated by {RHO}")
right = (0, SPREAD, SPREAD / 2 / ROOT, SPREAD * math.sqrt(2 * (1 - RHO)))
copies = (0, SPREAD * math.sqrt(3), SPREAD / 2 * math.sqrt(2 + 1 / 2), SPREAD * ROOT)  # all copies independent
print("dubious", version("dubious"), f"- a and b are 1 +- {SPREAD}")
print("standard deviation of         right   common context   without")
for name, exact, wrong, common, alone in zip(names, right, copies, quantities(ctx=Context()), quantities()):
    print(f"{name:26s} {exact:8.4f} {common:16.4f} {alone:9.4f}")
    assert math.isclose(common, exact, rel_tol=0.02), f"with a common context: {name}"
    assert math.isclose(alone, wrong, rel_tol=0.02), f"changed: {name}"
PY
