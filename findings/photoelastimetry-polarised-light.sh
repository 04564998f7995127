#!/usr/bin/env bash
# photoelastimetry 0.6.0: degree and angle of linear polarisation
#
# Guess: `DoLP` and `AoLP` of an image that `split_channels` made of a polarisation camera's raw frame: light that came
#   through a polariser at 20 degrees has degree 1 and angle 20.
# What happens: the degree is 0.04, at other angles up to 0.5; the angle is -22.5 or 67.5 degrees, whatever it is.
# Why: the channels of the package, of its camera, its simulation and its own Stokes parameters, are 0, 45, 90, 135
#   degrees; these two functions take them for 0, 90, 45, 135. And the sum of all four is twice the intensity.
# Why it matters here: photoelastic discs show the forces of impacts and force chains of wet grains. The maps look like
#   data: a half of the plane at one angle, the other at the other. `compute_stokes_components` is right.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'numpy==2.4.6' 'tqdm==4.70.1'
# the rest of its list of requirements is not loaded by these two modules
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'photoelastimetry==0.6.0'
cd "$work"
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from photoelastimetry.image import AoLP, DoLP, compute_stokes_components
from photoelastimetry.io import split_channels

SENSOR = np.radians([[0, 45], [135, 90]])  # analysers of the camera's pixels, as `split_channels` documents them


def raw_frame(angle, degree):
    """What the camera sees of partly polarised light."""
    return np.tile(0.5 + 0.5 * degree * np.cos(2 * (SENSOR - angle)), (4, 4))


print("photoelastimetry", version("photoelastimetry"))
print("light: degree, angle      DoLP     AoLP      by compute_stokes_components")
for degree in (1.0, 0.5):
    for angle in (-60, -20, 0, 20, 45, 60, 85):
        image = split_channels(raw_frame(np.radians(angle), degree))
        found, direction = DoLP(image).ravel(), np.degrees(AoLP(image)).ravel()
        total, first, second = compute_stokes_components(*np.moveaxis(image, -1, 0))
        right, along = (np.hypot(first, second) / total).ravel(), np.degrees(np.arctan2(second, first) / 2).ravel()
        values = f"{found[0]:11.4f} {direction[0]:8.2f} {right[0]:13.4f} {along[0]:8.2f}"
        print(f"{degree:13.1f} {angle:7d} {values}")
        assert np.allclose(right, degree) and np.allclose(along, angle), "changed: Stokes parameters"
        assert (found < 0.5 * degree).all(), "changed: degree"
        assert np.allclose(direction % 90, 67.5), "changed: angle"
PY
