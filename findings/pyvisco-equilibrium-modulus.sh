#!/usr/bin/env bash
# pyvisco 2.1.3: Prony series of a solid from storage and loss moduli
#
# Guess: the standard solid, one spring beside one Maxwell element, comes back from its own moduli over eight decades
#   of frequency: the equilibrium modulus, one term of the right relaxation time, both moduli.
# What happens: the equilibrium modulus is 0, whatever it was: each solid becomes a liquid, whose longest relaxation
#   time takes what the spring had. With 0.9 of the modulus at equilibrium nothing else is left: the loss modulus at
#   its peak is 0.002 of what was given, ten times too much a hundredth below. The storage modulus looks right, to
#   11 %. `opt=True`, meant for less terms, gives all of it back to four digits.
# Why: the moduli are divided by the difference of the last and the first storage modulus, and the weights are made to
#   sum up to 1; but then these weights are multiplied by the last one alone. That is right for a liquid. The first
#   storage modulus is not taken off before, and the sum of the weights makes the equilibrium modulus 0.
# Why it matters here: the loss modulus near the inverse of the time of contact is what a soft bead or a gelled coating
#   takes from a rebound; here such a bead rebounds as if it were elastic. Give `opt=True`.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'pyvisco==2.1.3' \
    'contourpy==1.3.3' 'cycler==0.12.1' 'fonttools==4.68.0' 'kiwisolver==1.5.1' 'matplotlib==3.11.2' 'numpy==2.4.6' \
    'packaging==26.4' 'pandas==2.3.3' 'pillow==13.0.0' 'pyparsing==3.3.3' 'python-dateutil==4.0.0' 'pytz==2026.6' \
    'scipy==1.17.1' 'six==1.17.0' 'tzdata==2026.6'
cd "$work"
MPLBACKEND=Agg "$work/venv/bin/python" -W ignore - <<'PY'
import contextlib
import io
from importlib.metadata import version

import numpy as np
from pyvisco import load, master, prony

TAU, TOTAL = 1e-3, 1.0  # s; MPa, at once
omega = np.logspace(-4, 4, 161) / TAU


def moduli(omega, rest):
    x = omega * TAU
    return rest + (TOTAL - rest) * x**2 / (1 + x**2), (TOTAL - rest) * x / (1 + x**2)


def fit(rest, optimise):
    """Equilibrium modulus and the moduli at PLACES."""
    rows = np.column_stack([omega / 2 / np.pi, *moduli(omega, rest)])
    table = "f,G_stor,G_loss\nHz,MPa,MPa\n" + "\n".join(",".join(map(repr, row)) for row in rows.tolist()) + "\n"
    curve, _ = load.user_master(table.encode(), "freq", 20, "G")
    curve = master.smooth(curve)
    with contextlib.redirect_stdout(io.StringIO()):
        series, _ = prony.fit(prony.discretize(curve), curve, opt=optimise)
    tau, weight = series["df_terms"]["tau_i"].to_numpy(), series["df_terms"]["G_i"].to_numpy()
    rest = series["E_0"] - weight.sum()
    x = PLACES[:, None] * tau
    return rest, rest + (weight * x**2 / (1 + x**2)).sum(axis=1), (weight * x / (1 + x**2)).sum(axis=1)


PLACES = np.array([0.01, 1]) / TAU  # rad/s: far below the peak of the loss modulus, and there
print("pyvisco", version("pyvisco"), "- equilibrium modulus in MPa; moduli over those given, at 0.01 and 1 of the peak")
print("opt    given   found   storage            loss")
for optimise in (False, True):
    for rest in (0.0, 0.3, 0.5, 0.9):
        found, storage, loss = fit(rest, optimise)
        storage, loss = storage / moduli(PLACES, rest)[0], loss / moduli(PLACES, rest)[1]
        places = f"{storage[0]:9.4f}" if rest else f"{'-':>9s}"  # next to nothing there
        print(f"{optimise!s:5s} {rest:6g} {found:7.4f} {places} {storage[1]:8.4f} {loss[0]:9.4f} {loss[1]:8.4f}")
        assert abs(storage[1] - 1) < 0.06, "the storage modulus"
        if optimise:
            assert abs(found - rest) < 1e-3 and abs(loss - 1).max() < 1e-3, "changed: opt=True"
            continue
        assert abs(found) < 1e-4, "changed: equilibrium modulus"
        assert loss[1] > 0.9 or rest >= 0.5, "changed: liquids"
        assert rest < 0.9 or (loss[1] < 0.01 and loss[0] > 9), "changed: loss of a nearly elastic solid"
PY
