#!/usr/bin/env bash
# auto-uncertainties 1.1.0: arrays that are rounded, or whose axes are exchanged
#
# Guess: `np.round(x, 3)` of 1.2345 +- 0.004 mm leaves the uncertainty as it is, as Python's `round` of each element
#   does, or adds half of a micrometre; `np.swapaxes(x, 0, 1)` takes the uncertainties along, as `x.T` does.
# What happens: rounded to whatever place, 0.5 is added: 1.234 +- 0.504 mm, from a restitution of 0.5 +- 0.001 one of
#   0.5 +- 0.501. `np.rint` and `np.floor` make it exact, `np.ceil` gives 2 +- 1. A square table with its axes exchanged
#   keeps each uncertainty where it was, beside another value; one that is not square is refused. No message.
# Why: half a unit is added whatever number of decimals is asked for. The others apply the same function to values and
#   uncertainties; of `swapaxes` the numbers of the axes are taken for values with uncertainties of 0, so that the
#   uncertainties have axis 0 exchanged with axis 0.
# Why it matters here: one rounds before a table is printed, and takes the table for the measurement: each restitution
#   could be anything. Round elements with `round`, and transpose with `x.T`.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-compile 'auto-uncertainties==1.1.0' 'numpy==2.4.6' \
    'jax==0.10.2' 'jaxlib==0.10.2'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import math
from importlib.metadata import version

import numpy as np
from auto_uncertainties import Uncertainty

sizes = Uncertainty(np.array([1.2345, 0.5]), np.array([0.004, 0.001]))  # mm; a restitution
print("auto-uncertainties", version("auto_uncertainties"), "- of", *sizes)
for text, found, expected in (
    ("np.round(x, 3)", np.round(sizes, 3), (0.504, 0.501)),
    ("np.round(x, 6)", np.round(sizes, 6), (0.504, 0.501)),
    ("x.round(3)", sizes.round(3), (0.504, 0.501)),
    ("round, one by one", [round(x, 3) for x in sizes], (0.004, 0.001)),
    ("np.rint(x)", np.rint(sizes), (0, 0)),
    ("np.floor(x)", np.floor(sizes), (0, 0)),
    ("np.ceil(x)", np.ceil(sizes), (1, 1)),
):
    print(f"{text:18s}", *found, sep="   ")
    assert all(math.isclose(x.error, error) for x, error in zip(found, expected)), f"changed: {text}"

deviations = np.array([[0.1, 0.2], [0.3, 0.4]])
table = Uncertainty(10 * deviations, deviations)  # each a tenth of its value
for text, found, right in (("x.T", table.T, True), ("np.swapaxes(x, 0, 1)", np.swapaxes(table, 0, 1), False)):
    shares = found.error / found.value
    print(f"{text:21s} uncertainties as shares of the values: {shares.tolist()}")
    assert (found.value == table.value.T).all() and np.allclose(shares, 0.1) == right, f"changed: {text}"
refused = False
try:
    np.swapaxes(Uncertainty(np.ones((2, 3)), np.ones((2, 3))), 0, 1)
except ValueError as error:
    refused = True
    print("two rows of three:", error)
assert refused, "changed: a table that is not square"
PY
