#!/usr/bin/env bash
# dosertools 1.0.2: relaxation times of liquids that are evaluated together
#
# Guess: each film of a thinning thread is fitted between `fitting_bounds`, 0.1 and 0.045 of the first diameter, or from
#   the thread's own critical diameter if that is below 0.1. The other films of the folder do not matter.
# What happens: from the first film whose critical diameter is below 0.1 on, all films are fitted from that diameter:
#   the relaxation time of a liquid is 14.9 ms alone or first in the folder, 14.0 ms behind one that thins to 0.07
#   before it is elastic, 29 of its standard errors less; with bounds of 0.2 and 0.045 15 % less. Files go by name.
# Why: the diameter is put in place of the bound itself, inside the loop over the films.
# Why it matters here: threads of polymer solutions thin faster and faster, so that the relaxation time depends on the
#   part that is fitted; it decides whether a bridge on two parting beads is viscous or elastic. Renaming a liquid
#   changes it. Evaluate one liquid at a time.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'dosertools==1.0.2' \
    'numpy==2.4.6' 'pandas==2.3.3' 'python-dateutil==4.0.0' 'pytz==2026.6' 'scipy==1.17.1' 'six==1.17.0' \
    'tzdata==2026.6'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import sys
import tempfile
from importlib.metadata import version
from pathlib import Path
from unittest.mock import MagicMock

import numpy as np
import pandas as pd

# what reads images and draws is imported with the rest, and not used here
for name in ("holoviews", "skimage", "skimage.filters", "skimage.io", "skimage.morphology"):
    sys.modules[name] = MagicMock()

from dosertools.data_processing import csv, fitting


def thread(critical):
    """Diameter over time: shrinking evenly down to `critical` at 50 ms, then as 60 ms ask, and 0.2/s faster."""
    time = np.arange(0, 0.4, 1e-4)
    after = time - 0.05
    diameter = np.where(after < 0, 1 - (1 - critical) * time / 0.05, critical * np.exp(-after / 0.06) - 0.2 * after)
    return pd.DataFrame({"time (s)": time, "D/D0": np.where(diameter > 0.01, diameter, 0)})


def relaxation(critical, **settings):
    """Relaxation times in ms with standard errors of films with these critical diameters, by name."""
    with tempfile.TemporaryDirectory() as folder:
        for name, each in critical.items():
            thread(each).to_csv(Path(folder) / f"20240101_{name}-1_10000_1.csv", index=False)
        table = csv.generate_df(folder, "date_sampleinfo_fps_run", "polymer-conc", settings)
        result = fitting.make_summary_dataframe(table, "polymer-conc", settings).set_index("polymer")
    return {name: tuple(row) for name, row in result[["Lambda E (ms)", "Lambda E standard error (ms)"]].iterrows()}


print("dosertools", version("dosertools"), "- relaxation time in ms of the film that gets elastic at 0.2")
for settings, least in (({}, 0.04), ({"fitting_bounds": [0.2, 0.045]}, 0.12)):
    print("bounds", settings.get("fitting_bounds", "by default"))
    alone = relaxation({"m": 0.2}, **settings)["m"]
    first = relaxation({"m": 0.2, "z": 0.072}, **settings)["m"]
    behind = relaxation({"a": 0.072, "m": 0.2}, **settings)["m"]
    for name, (value, error) in (("alone", alone), ("before another", first), ("behind the same", behind)):
        print(f"{name:16s} {value:.3f} +- {error:.3f}")
    print(f"{'':16s} {1 - behind[0] / alone[0]:.1%} less, {(alone[0] - behind[0]) / alone[1]:.0f} standard errors")
    assert first == alone, "before another"
    assert 1 - behind[0] / alone[0] > least and alone[0] - behind[0] > 20 * alone[1], "changed: the order"
PY
