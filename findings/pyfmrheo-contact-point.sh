#!/usr/bin/env bash
# pyfmrheo 0.1.3: the contact point of a fitted indentation
#
# Guess: `HertzModel.fit` finds modulus and contact point of a curve that Hertz's law itself made, without noise.
# What happens: it stops at once. With contact at 50, 200 and 500 nm of a curve to 1500 nm, a modulus of 1000 Pa is
#   fitted as 953, 829 and 575 Pa, the contact point as 9, 54 and 153 nm, the force before contact as below zero. R^2
#   is 0.9996, 0.994 and 0.955. Only a contact at 0, where the fit starts, is right. No message; noise changes nothing.
# Why: the model moves the contact point to the nearest point of the curve, so that it is a staircase in this parameter:
#   the small steps by which the fit takes its derivatives change nothing, and the contact point moves, if at all, by
#   chance.
# Why it matters here: the modulus of coated or soft beads, and with it the elastic part of the rebound, comes from such
#   curves. One shifts the curve by a guess of the contact and takes the fit for a correction of that guess. A modulus
#   that rises when the curve is shifted shows it.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
# pyfmreader, in its list of requirements, reads the files of microscopes
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'lmfit==1.3.4' 'numpy==2.4.6' 'pandas==3.1.1' \
    'requests' 'scipy==1.17.1'
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'pyfmrheo==0.1.3'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from pyfmrheo.models.hertz import HertzModel
from scipy.optimize import curve_fit

RADIUS, MODULUS, POISSON = 5e-6, 1000.0, 0.5  # m, Pa
SHAPE = 4 / 3 * np.sqrt(RADIUS) / (1 - POISSON**2)
path = np.linspace(-1e-6, 1.5e-6, 1000)
random = np.random.default_rng(1)


def law(path, contact, modulus):
    return SHAPE * modulus * np.clip(path - contact, 0, None) ** 1.5


print("pyfmrheo", version("pyfmrheo"), f"- modulus {MODULUS:g} Pa, sphere of {RADIUS * 1e6:g} micrometres")
print("contact/nm   noise/pN   fitted contact/nm   fitted modulus/Pa      R^2   another fit of the same curve")
fitted = {}
for contact in (0.0, 50e-9, 200e-9, 500e-9):
    for noise in (0.0, 2e-12):
        force = law(path, contact, MODULUS) + random.normal(0, noise, path.size)
        model = HertzModel("paraboloid", RADIUS)
        model.fit(path, force)
        fitted[contact, noise] = model.E0
        scaled, _ = curve_fit(lambda x, c, e: 1e9 * law(x, c * 1e-6, 1e3 * e), path, 1e9 * force, p0=(0, 0.5))
        print(
            f"{contact * 1e9:10.0f} {noise * 1e12:10.0f} {model.delta0 * 1e9:19.1f} {model.E0:19.1f}"
            f" {model.Rsquared:8.4f}   {scaled[0] * 1e3:.1f} nm, {scaled[1] * 1e3:.1f} Pa"
        )
        assert abs(scaled[1] * 1e3 / MODULUS - 1) < 0.02, "the curve"
assert abs(fitted[0.0, 0.0] / MODULUS - 1) < 0.01, "contact where the fit starts"
for contact, low, high in ((50e-9, 0.93, 0.97), (200e-9, 0.78, 0.87), (500e-9, 0.4, 0.7)):
    for noise in (0.0, 2e-12):
        assert low < fitted[contact, noise] / MODULUS < high, f"changed: contact at {contact * 1e9:.0f} nm"
PY
