#!/usr/bin/env bash
# mdfreader 4.3: a channel resampled to the times of another one
#
# Guess: `resample(interpolation_kind="next")` gives the next sample and `"previous"` the one before, as those kinds of
#   scipy's `interp1d`, which the docstring names; where a channel was not recorded it has no value.
# What happens: "next" gives the previous sample, everywhere. "previous" does too, but at a time at which there is a
#   sample it gives the one before that. Before the first and behind the last sample each kind, and the default, goes on
#   with that sample for ever; so do whole numbers. No message.
# Why: both kinds look up the place behind which a time would be put in, and take one off; they differ only in what
#   becomes of equal times. Beyond its ends the interpolation of numpy is constant.
# Why it matters here: a force sensor and a film are brought to one clock. Beside the film's frames a sphere seems to
#   rest; within them its places come up to a frame too late, which at 8 kHz is four times the contact of glass beads of
#   a centimetre at 1 m/s. Use the default, linear for floating numbers, and only within the times of both.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-compile 'mdfreader==4.3' 'numpy==2.4.6' \
    'scipy==1.17.1'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import mdfreader
import numpy as np
from scipy.interpolate import interp1d

FORCE = np.arange(1025) / 131072  # s
FILM = np.arange(16, 49) / 8192  # s, each at a time of the force
SPEED = 1000.0  # mm/s

file = mdfreader.Mdf()
for master, channel, unit, time, data in (
    ("force time", "force", "N", FORCE, np.sin(100 * FORCE)),
    ("film time", "place", "mm", FILM, SPEED * FILM),
    ("count time", "frame", "", FILM, np.arange(16, 49)),
):
    file.add_channel(master, time, master, master_type=1, unit="s")
    file.add_channel(channel, data, master, master_type=1, unit=unit)
file.write("impact.mf4")


def resampled(kind):
    """Place and frame number at the times of the force."""
    file = mdfreader.Mdf("impact.mf4")
    file.resample(channel="force", interpolation_kind=kind)
    time = file.get_channel_data(file.get_channel_master("place"))
    assert np.array_equal(time, FORCE), "times of the force"
    return file.get_channel_data("place"), file.get_channel_data("frame")


inside = (FORCE >= FILM[0]) & (FORCE <= FILM[-1])
equal = np.isin(FORCE, FILM)
print("mdfreader", version("mdfreader"), "- place in mm of a sphere at 1 m/s, 8192 frames/s, over time in frames")
print("kind       at       20   20.25   20.75      21   errors within the film (scipy)   before it   behind it")
found = {}
for kind in (None, "previous", "next"):
    place, frame = found[kind] = resampled(kind)
    expected = interp1d(FILM, SPEED * FILM, kind=kind or "linear")(FORCE[inside])
    errors = (place[inside] - expected) / SPEED * 8192  # in frames
    shown = "".join(f"{place[round(16 * at)]:8.3f}" for at in (20, 20.25, 20.75, 21))
    where = (FORCE < FILM[0], FORCE > FILM[-1])
    ends = ["constant" if np.ptp(place[side]) == 0 else "varies" for side in where]
    spread = f"{errors.min():.3f} to {errors.max():.3f} frames"
    print(f"{kind or 'default':8s}{shown:>36s}{spread:>31s}{ends[0]:>12s}{ends[1]:>12s}")
    assert ends == ["constant", "constant"], "changed: beyond the ends"
    assert all(np.ptp(frame[side]) == 0 for side in where), "changed: whole numbers beyond the ends"
    if kind is None:
        assert abs(errors).max() < 1e-6, "linear"
    if kind == "next":
        assert np.allclose(errors[~equal[inside]], -1) and np.allclose(errors[equal[inside]], 0), "changed: next"
    if kind == "previous":  # at the film's first frame there is none before
        assert np.allclose(errors[~equal[inside]], 0), "previous between samples"
        assert np.allclose(errors[equal[inside]][1:], -1), "changed: previous"
PY
