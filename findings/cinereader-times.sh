#!/usr/bin/env bash
# cinereader 1.4.3: times of the frames of Phantom high-speed films (.cine), by the camera's maker
#
# Guess: `read(film, start, count)` returns `count` images and the time of each, from the trigger on.
# What happens: it returns the times of *all* frames of the film. With images 3 to 5 of a film from -5 to 5, the first
#   time is that of frame -5; zipped, each image is 80 microseconds early, and nothing tells that the lengths differ.
#   In a film that runs past a full minute the times behind it jump back by 60 s: from 20 to -59 999 970 microseconds.
# Why: the times are taken from the whole file; and of each date only the seconds within its minute are kept before the
#   trigger's are subtracted.
# Why it matters here: of a long film the few frames of the impact are read, and speeds are differences of place over
#   time. Take `times[start - metadata.FirstImageNo:]`, and add 60 s where they fall.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check \
    'cinereader==1.4.3' 'numba==0.68.1' 'numpy==2.4.6' 'pandas==3.1.1'
cd "$work"
PYTHONPATH="$here" PYTHONDONTWRITEBYTECODE=1 "$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import cinereader
import numpy as np
import phantom_film

RATE, FIRST = 100_000, -5
numbers = np.arange(FIRST, 6)
MINUTE = 1_700_000_040  # seconds since 1970, a multiple of 60


def read(trigger, start, count):
    """Numbers of the frames (from their brightness) and their times in microseconds."""
    images = np.broadcast_to(1000 + numbers[:, None, None], (len(numbers), 8, 8))
    phantom_film.write("impact.cine", images, first=FIRST, rate=RATE, trigger=trigger)
    _, images, times = cinereader.read("impact.cine", start, count)
    return [int(image[4, 4]) - 1000 for image in images], times


print("cinereader", version("cinereader"), f"- frames {FIRST} to 5, {RATE} per second")
frames, times = read(MINUTE + 20.25, FIRST, len(numbers))
print("all frames:    ", *(f"{number}: {time:g}" for number, time in zip(frames, times)))
assert frames == list(numbers) and np.allclose(times, 10 * numbers), "the film itself"
frames, times = read(MINUTE + 20.25, 3, 3)
print("frames 3 to 5: ", *(f"{number}: {time:g}" for number, time in zip(frames, times)), f"of {len(times)} times")
assert frames == [3, 4, 5] and len(times) == len(numbers) and np.allclose(times, 10 * numbers), "changed: a part"
frames, times = read(MINUTE - 25e-6, FIRST, len(numbers))
print("past a minute: ", *(f"{number}: {time:.0f}" for number, time in zip(frames, times)))
assert np.allclose(times, 10 * numbers - 60e6 * (numbers > 2), atol=0.1), "changed: a minute"
PY
