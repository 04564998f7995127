#!/usr/bin/env bash
# doestat 0.1.0: confidence intervals of a factorial design with repeated runs
#
# Guess: `Regression(...).coefficient` has the 95 % interval of ordinary least squares, and a factor that does nothing
#   is "Significant" in one of twenty experiments.
# What happens: the intervals are too narrow by the root of settings over repeats: 2.83 times for 16 settings with two
#   runs each, 2 times for 8 with two, right only with as many repeats as settings. With 16 settings such a factor is
#   "Significant" in 48 % of experiments; with eight and two, in 30 %. The coefficients and the residual variance are
#   right. No message.
# Why: the inverse of the normal matrix of one repeat is to be divided by the number of repeats, as a remark in the
#   source says; the length of the table is taken, which is the number of settings.
# Why it matters here: whether viscosity, film or roughness changes the restitution is asked with such designs, and half
#   of what has no influence seems to have one. `significant_coeff=True` then leaves it in the equation. Multiply the
#   intervals by that root.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-compile 'doestat==0.1.0' 'numpy==2.4.6' \
    'scipy==1.17.1' 'pandas==3.1.1' 'matplotlib==3.11.2' 'seaborn==0.13.2' 'plotly==7.1.0' 'ipython==9.18.1'
cd "$work"
MPLBACKEND=Agg "$work/venv/bin/python" -W ignore - <<'PY'
import contextlib
import io
import itertools
import math
from importlib.metadata import version

import numpy as np
import pandas as pd
from doestat import Regression
from scipy.stats import t

RESTITUTION, SCATTER, EXPERIMENTS = 0.5, 0.02, 100
random = np.random.default_rng(1)


def experiment(factors, repeats):
    """Settings -1 and 1 of factors of which none does anything, and measured restitutions."""
    settings = pd.DataFrame(list(itertools.product((-1, 1), repeat=factors)), columns=list("abcde")[:factors])
    noise = SCATTER * random.standard_normal((len(settings), repeats))
    return settings, pd.DataFrame(RESTITUTION + noise)


def least_squares(settings, measured):
    """Coefficients and half widths of their 95 % intervals: columns of an orthogonal design."""
    repeats = measured.shape[1]
    columns = np.repeat(np.column_stack([np.ones(len(settings)), settings]), repeats, axis=0)
    y = measured.to_numpy().ravel()
    coefficients = columns.T @ y / len(y)
    free = len(y) - columns.shape[1]
    variance = np.sum((y - columns @ coefficients) ** 2) / free
    return coefficients, np.full(len(coefficients), t.ppf(0.975, free) * math.sqrt(variance / len(y)))


def reported(settings, measured):
    """The same from the table, and which are said to be significant."""
    with contextlib.redirect_stdout(io.StringIO()):  # remarks about the lack of fit
        table = Regression(settings, measured, effect_error="replica", regression="linear").coefficient
    widths = table["Error"].str.removeprefix("±").astype(float).to_numpy()
    return table["Coefficient"].to_numpy(), widths, table["Significant"].to_numpy(bool)


print("doestat", version("doestat"), f"- factors that do nothing, {EXPERIMENTS} experiments")
print("factors settings repeats   intervals of least squares / reported   significant: reported, least squares")
for factors, repeats, share in ((2, 4, 0.05), (3, 2, 0.30), (4, 2, 0.48)):
    ratios, false, rightly = [], [], []
    for _ in range(EXPERIMENTS):
        settings, measured = experiment(factors, repeats)
        coefficients, widths, significant = reported(settings, measured)
        expected, right = least_squares(settings, measured)
        assert np.allclose(coefficients, expected, atol=6e-5), "coefficients"  # printed with four decimals
        ratios.append(np.mean(right / widths))
        false.append(np.mean(significant[1:]))
        rightly.append(np.mean(np.abs(expected[1:]) > right[1:]))
    ratio = np.mean(ratios)
    print(f"{factors:7d} {len(settings):8d} {repeats:7d} {ratio:22.3f} {np.mean(false):37.3f} {np.mean(rightly):15.3f}")
    assert math.isclose(ratio, math.sqrt(len(settings) / repeats), rel_tol=0.02), "changed: intervals"
    assert abs(np.mean(false) - share) < 0.1, "changed: significance"
    assert np.mean(rightly) < 0.12, "least squares"
PY
