#!/usr/bin/env bash
# GrainLearning 2.0.5: the spread of a calibrated parameter
#
# Guess: the coefficient of variation of a "Bayesian uncertainty quantification" is large for scattered observations and
#   small for exact ones; more iterations make it more accurate.
# What happens: it is the same for observations with an error of 0.0001 and of 0.2: 13 % after one iteration, 1.2 %
#   after three, 0.42 % after five, although least squares of the first have 0.003 % and of the last 5 %.
# Why: the error of the observations, sigma, is no input of `run`: each iteration chooses the one with which
#   `ess_target` (30 %) of its samples count, and draws the next samples from those. The spread is a share of the last
#   samples' range, and falls with each iteration until sigma is below `sigma_tol`. `load_and_process` takes a sigma.
# Why it matters here: restitution, friction and surface tension of a DEM are calibrated with it. What it gives as an
#   error bar is a setting: where the data say 0.98 +- 0.05 one reads 0.979 +- 0.004.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'numpy==2.4.6' 'scipy==1.17.1' 'matplotlib==3.11.2' \
    'scikit-learn==1.9.1'
# its list of requirements has NumPy below 2, which not each Python from 3.11 on can install
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'grainlearning==2.0.5'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import contextlib
import io
from importlib.metadata import version

import numpy as np
from grainlearning import BayesianCalibration

TRUTH, POINTS = 1.0, np.linspace(-1, 1, 40)  # y = k x, such as a force over an overlap
SCATTER = np.random.default_rng(7).standard_normal(40)


def model(calibration):
    system = calibration.system
    system.set_sim_data(system.param_data[:, :, None] * POINTS)


def calibrated(observed, iterations):
    """Estimate and standard deviation of k, and the sigma that was chosen."""
    calibration = BayesianCalibration.from_dict({
        "num_iter": iterations,
        "callback": model,
        "save_fig": -1,
        "system": {
            "param_names": ["k"],
            "param_min": [0.5],
            "param_max": [2.0],
            "num_samples": 60,
            "obs_data": observed[None, :],
            "ctrl_data": POINTS,
            "sim_name": "line",
            "sigma_tol": 1e-9,
        },
        "inference": {
            "Bayes_filter": {"ess_target": 0.3, "scale_cov_with_max": True},
            "sampling": {"max_num_components": 1, "random_state": 0},
        },
    })
    with contextlib.redirect_stdout(io.StringIO()):
        calibration.run()
    system = calibration.system
    mean, variation = system.estimated_params[-1, 0], system.estimated_params_cv[-1, 0]
    return mean, mean * variation, float(np.ravel(system.sigma_max)[0])


print("grainlearning", version("grainlearning"))
print("error of y   least squares           iterations   GrainLearning       its sigma   spread / least squares'")
spreads = {}
for error in (0.0001, 0.01, 0.2):
    observed = TRUTH * POINTS + error * SCATTER
    fit, spread = POINTS @ observed / (POINTS @ POINTS), error / np.sqrt(POINTS @ POINTS)
    for iterations in (1, 3, 5):
        mean, found, sigma = calibrated(observed, iterations)
        spreads[error, iterations] = found
        print(
            f"{error:10g} {fit:10.5f} +- {spread:.5f} {iterations:13d} {mean:10.5f} +- {found:.5f} {sigma:11.2g}"
            f" {found / spread:15.4g}"
        )
for iterations, expected in ((1, 0.126), (3, 0.012), (5, 0.0042)):
    values = [spreads[error, iterations] for error in (0.0001, 0.01, 0.2)]
    assert np.allclose(values, expected, rtol=0.1), "changed: spread"
PY
