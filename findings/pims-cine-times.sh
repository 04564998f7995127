#!/usr/bin/env bash
# pims 0.7: times of the frames of Phantom high-speed films (.cine)
#
# Guess: the format stamps each frame to a quarter of a nanosecond, so `Cine.get_time_to_trigger` and the metadata's
#   `time_to_trigger` are good to some nanoseconds.
# What happens: the times lie on a grid of 0.238 microseconds. At 100 000 frames/s the interval between even frames
#   scatters by 2 %, at 1 000 000 frames/s by 5 to 19 %, and `frame_rate_avg` is 0.8 % high there.
# Why: whole seconds since 1970 and the fraction are added in double precision *before* the trigger's time is
#   subtracted; at 1.7e9 s the last bit is worth 2^-22 s. `frame_rate_avg` averages the reciprocals of these
#   intervals.
# The exact way: `metadata["frame_time"]` has `datetime` and `second_fraction` apart; subtract them one by one.
# Why it matters here: speeds before and after an impact are differences of neighbouring frames.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'pims==0.7' 'numpy==2.4.6'
cd "$work"
PYTHONPATH="$here" PYTHONDONTWRITEBYTECODE=1 "$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
import phantom_film
import pims

print("pims", version("pims"))
print("frames/s   intervals / true interval   frame_rate_avg / rate   with the fractions")
for rate, low, high in ((10_000, 0.9985, 0.9995), (100_000, 0.97, 0.99), (1_000_000, 0.94, 0.96)):
    phantom_film.write("even.cine", np.zeros((401, 4, 4)), first=-200, rate=rate)
    film = pims.Cine("even.cine")
    intervals = np.diff([film.get_time_to_trigger(number) for number in range(len(film))]) * rate
    stamps = [film[number].metadata["frame_time"] for number in range(len(film))]
    exact = np.array([(s["datetime"] - stamps[0]["datetime"]).total_seconds() + s["second_fraction"] for s in stamps])
    exact = np.diff(exact) * rate
    average = film.frame_rate_avg / rate
    spans = (f"{values.min():.4f} to {values.max():.4f}" for values in (intervals, exact))
    print(f"{rate:8d}   {next(spans):27s} {average:21.5f}   {next(spans)}")
    assert low < intervals.min() < high and intervals.max() > 1.001, "changed"
    assert np.abs(exact - 1).max() < 1e-3, "the film itself"
assert average > 1.005, "changed: frame_rate_avg"
PY
