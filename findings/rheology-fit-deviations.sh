#!/usr/bin/env bash
# rheology-fit 0.1.0: flow curves with standard deviations
#
# Guess: the optional column `shear_stress_std` of the table weights the points, and the errors of the parameters
#   follow from it.
# What happens: it is read, its length is checked, and nothing else: parameters, errors and the choice of the model
#   are the same to the last digit without it, and if the deviations are a hundred times greater. All points count
#   alike in pascals. A Newtonian liquid of 0.1 Pa s, measured to 5 % between 0.1 and 1000 per second, is fitted by the
#   last few points alone: with tau0 = 0.12 Pa (twice its error), and an exponent of 1.058 +- 0.004.
# Why: the fit calls least squares without `sigma`.
# Why it matters here: a film is sheared at 1 to 1000 per second, and the few points at the top decide a law that is
#   used at the bottom: at 0.1 per second the fitted viscosity is 12.5 times the liquid's.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check \
    'rheology-fit==0.1.0' 'numpy==2.4.6' 'scipy==1.17.1' 'pandas==3.0.6'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
import pandas as pd
from rheology_fit.data import load_flow_curve_csv
from rheology_fit.models import fit_model
from scipy.optimize import curve_fit

VISCOSITY, SPREAD = 0.1, 0.05
rate = np.logspace(-1, 3, 20)
stress = VISCOSITY * rate * (1 + SPREAD * np.random.default_rng(0).standard_normal(rate.size))


def fit(**columns):
    """Herschel and Bulkley's law, fitted to a table with these further columns."""
    pd.DataFrame({"shear_rate": rate, "shear_stress": stress, **columns}).to_csv("curve.csv", index=False)
    return fit_model(load_flow_curve_csv("curve.csv"), "HerschelBulkley")


print("rheology-fit", version("rheology-fit"), f"- a liquid of {VISCOSITY} Pa s, stresses good to {SPREAD:.0%}")
fits = {
    "no deviations": fit(),
    "with deviations": fit(shear_stress_std=SPREAD * stress),
    "a hundred times these": fit(shear_stress_std=100 * SPREAD * stress),
}
for name, result in fits.items():
    values = "  ".join(f"{key} = {value:.5f} +- {result.param_errors[key]:.5f}" for key, value in result.params.items())
    print(f"{name:22s} {values}")


def law(rate, tau0, k, n):
    return tau0 + k * rate**n


weighted, _ = curve_fit(law, rate, stress, p0=(0.0, 0.1, 1.0), sigma=SPREAD * stress, absolute_sigma=True)
print("weighted, by scipy:    " + "  ".join(f"{key} = {value:.5f}" for key, value in zip(("tau0", "K", "n"), weighted)))
plain = fits["no deviations"]
apparent = law(0.1, **{"tau0": plain.params["tau0"], "k": plain.params["K"], "n": plain.params["n"]}) / 0.1
print(f"viscosity at 0.1 per second: {apparent:.3f} Pa s fitted, {law(0.1, *weighted) / 0.1:.3f} weighted")
for result in fits.values():
    assert result.params == plain.params and result.param_errors == plain.param_errors, "changed: deviations count"
assert plain.params["n"] - 1 > 10 * plain.param_errors["n"], "changed: exponent"
assert abs(weighted[2] - 1) < 0.05 and apparent / VISCOSITY > 10, "changed: viscosity"
PY
