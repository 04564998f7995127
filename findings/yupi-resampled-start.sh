#!/usr/bin/env bash
# yupi 1.0.2: the times of a resampled trajectory
#
# Guess: `resample(trajectory, new_dt=...)` has the trajectory's own times, in new steps.
# What happens: it begins at 0, whenever the trajectory does: its places are right, its times are early by all that went
#   before. `resample(trajectory, new_t=...)`, `subsample` and the files of `CSVSerializer` keep the times. No message.
# Why: the places are interpolated from the first time on; the result is then made with the step alone, and starts at
#   0 by default.
# Why it matters here: tracks are resampled to bring two spheres to one clock. Each starts when its sphere comes into
#   the picture; afterwards both start together. Two spheres that keep a gap of 1 mm overlap by 1 mm, and a sphere that
#   passes a place after another one has gone meets it there. Give `new_t`.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'yupi==1.0.2' 'numpy==2.4.6' \
    'nudged==0.3.1' 'opencv-python-headless==5.0.0.93'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from yupi import Trajectory
from yupi.transformations import resample, subsample

DIAMETER, GAP, SPEED = 3.0, 1.0, 1000.0  # mm, mm, mm/s: one sphere follows the other
FRAME = 1 / 8192  # s
ENTER = 16 * FRAME  # when the second one comes into the picture

first_times, second_times = np.arange(80) * FRAME, ENTER + np.arange(60) * FRAME
first = Trajectory(x=SPEED * first_times, y=0 * first_times, t=first_times)
second = Trajectory(x=SPEED * second_times - DIAMETER - GAP, y=0 * second_times, t=second_times)


def gap(one, two):
    """Least and largest gap at the times that both have."""
    start, end = max(one.t[0], two.t[0]), min(one.t[-1], two.t[-1])
    time = np.linspace(start, end, 50)
    places = [np.interp(time, track.t, np.asarray(track.r.x)) for track in (one, two)]
    distance = np.abs(places[0] - places[1]) - DIAMETER
    return distance.min(), distance.max()


print("yupi", version("yupi"), f"- second sphere from {1e3 * ENTER:g} ms on, gap {GAP:g} mm")
clock = np.arange(0, 58 * FRAME, 0.5 * FRAME)
for name, one, two, late in (
    ("as tracked", first, second, False),
    ("subsample(2)", subsample(first, 2), subsample(second, 2), False),
    ("resample(new_t)", resample(first, new_t=clock), resample(second, new_t=ENTER + clock), False),
    ("resample(new_dt)", resample(first, new_dt=0.5 * FRAME), resample(second, new_dt=0.5 * FRAME), True),
):
    found = gap(one, two)
    start = f"second from {1e3 * two.t[0]:.2f} ms and x = {two.r.x[0]:.3f} mm"
    print(f"{name:18s} {start}; gap {found[0]:6.3f} to {found[1]:6.3f} mm")
    assert np.isclose(two.r.x[0], SPEED * ENTER - DIAMETER - GAP), "places"
    assert np.isclose(two.t[0], 0 if late else ENTER, atol=1e-12), "changed: times"
    assert np.allclose(found, GAP - SPEED * ENTER if late else GAP, atol=1e-6), "changed: gaps"
PY
