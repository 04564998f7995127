#!/usr/bin/env bash
# rheopy-caber 0.1.0: viscosity from a film of a thinning filament
#
# Guess: `thinning_summary(..., fps=10000)` gives the camera's rate to a film whose container says 30 frames/s, as that
#   of every camera that plays in slow motion does.
# What happens: the number is taken and not used: the viscosity stays that of 30 frames/s, 333 times too high, with
#   r^2 of 0.9995.
# Why: times come from `measure_video`, which has an `fps` of its own; `thinning_summary` has the argument and never
#   reads it.
# Why it matters here: it is the viscosity of a film's liquid, from a drop of it and the same camera. 333 times the
#   viscosity is 1/333 of the Stokes number: what bounces is said to stick.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'numpy==2.4.6' 'pandas==3.1.1' \
    'opencv-python-headless==5.0.0.93'
# its list of requirements has OpenCV with windows, and scipy and matplotlib, which this part does not load
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'rheopy-caber==0.1.0'
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import caber
import cv2
import numpy as np

VISCOSITY, TENSION, RATE, PIXEL = 0.1, 63.4, 10000.0, 2e-3  # Pa s, mN/m, frames/s, mm
SLOPE = 0.0709 * TENSION / VISCOSITY  # mm/s: Papageorgiou's thinning of a Newtonian filament, as the package has it
BREAKUP = 100  # frame

across, along = np.arange(400)[None, :] - 200, np.arange(64)[:, None] - 32
film = cv2.VideoWriter("filament.avi", cv2.VideoWriter_fourcc(*"MJPG"), 30, (400, 64))
for frame in range(BREAKUP + 5):
    neck = SLOPE * (BREAKUP - frame) / RATE / PIXEL
    half = np.where((neck <= 0) & (abs(along) < 6), -1, max(neck, 0) + 0.02 * along**2)
    image = np.where(abs(across) < half, 0, 255).astype(np.uint8)
    film.write(np.repeat(image[..., None], 3, axis=2))
film.release()

print("rheopy-caber", version("rheopy-caber"))
print("fps of measure_video   fps of thinning_summary   viscosity / true        r^2")
given = {"mm_per_px": PIXEL, "surface_tension_mN_per_m": TENSION}
seen = {}
for measured in (None, RATE):
    table = caber.measure_video("filament.avi", polarity="dark", axis="vertical", fps=measured)
    for summed in (None, RATE):
        summary = caber.thinning_summary(table, fps=summed, **given)
        seen[measured, summed] = ratio = summary["viscosity_Pa_s"] / VISCOSITY
        print(f"{measured!s:>20s} {summed!s:>25s} {ratio:18.4g} {summary['fit']['r_squared']:10.5f}")
assert seen[None, RATE] == seen[None, None] and abs(seen[None, RATE] / (RATE / 30) - 1) < 0.02, "changed: rate"
assert seen[RATE, None] == seen[RATE, RATE] and abs(seen[RATE, RATE] - 1) < 0.02, "changed: rate of measure_video"
PY
