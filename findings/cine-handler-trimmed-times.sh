#!/usr/bin/env bash
# cine-handler 0.1.1 with cinereader 1.4.3 and pims 0.7: times of a Phantom high-speed film (.cine) that was trimmed
#
# Guess: `save_frames_to_new_file(film, start, end)` writes a film of these frames, each with the time at which it was
#   taken; a reader returns the same times for them as from the whole film.
# What happens: the images and their numbers are right, the times are not, and each reader errs in its own way. Of
#   frames 0 to 5 out of -5 to 6 cinereader, by the camera's maker, gives -50, -30, ... 50 microseconds, every second
#   time stamp of the whole film; of frames 0 to 3 every third. pims gives the stamps of frames -5 to 0. Where the
#   lengths do not divide, cinereader ends in an error.
# Why: the block of time stamps, one for each frame, is copied whole. cinereader takes its size over the number of
#   frames for the size of a stamp, pims takes the first so many.
# Why it matters here: the impact is cut out of a long film and the rest is thrown away. Speeds are then a half or a
#   third, or the impact happened before the trigger. The ratio of two speeds is right, and so is the restitution: the
#   Stokes number is not. Give the rate, and trust no stamp of a trimmed film.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'cine-handler==0.1.1' 'cinereader==1.4.3' 'pims==0.7' \
    'numba==0.68.1' 'numpy==2.4.6' 'pandas==3.1.1'
cd "$work"
PYTHONPATH="$here" PYTHONDONTWRITEBYTECODE=1 "$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import cinereader
import numpy as np
import phantom_film
import pims
from cine_reader import Cine

RATE, FIRST = 100_000, -5
numbers = np.arange(FIRST, 7)
# the brightness of frame N is 1000 + N
phantom_film.write("long.cine", np.broadcast_to(1000 + numbers[:, None, None], (12, 8, 8)), first=FIRST, rate=RATE)


def times(path, start, count):
    """Numbers of the images, from their brightness, and their times in units of a frame, by both readers."""
    _, images, stamps = cinereader.read(path, start, count)
    film = pims.Cine(path)
    others = [round(film.get_time_to_trigger(number) * RATE) for number in range(len(film))]
    for image in (images, film):
        assert [int(one[4, 4]) - 1000 for one in image] == list(range(start, start + count)), "the images"
    return np.round(np.array(stamps) * 1e-6 * RATE).astype(int).tolist(), others


print(", ".join(f"{name} {version(name)}" for name in ("cine-handler", "cinereader", "pims")))
print("times, in frames from the trigger:")
whole = times("long.cine", FIRST, len(numbers))
print("whole film      cinereader", whole[0], "pims", whole[1])
assert whole == (numbers.tolist(), numbers.tolist()), "the film itself"
for end, expected in ((5, [-5, -3, -1, 1, 3, 5]), (3, [-5, -2, 1, 4])):
    with Cine("long.cine") as film:
        film.save_frames_to_new_file("short.cine", 0, end)
    found = times("short.cine", 0, end + 1)
    print(f"frames 0 to {end}   cinereader", found[0], "pims", found[1])
    assert found == (expected, list(range(FIRST, FIRST + end + 1))), "changed"
with Cine("long.cine") as film:
    film.save_frames_to_new_file("short.cine", 0, 4)
try:
    cinereader.read("short.cine", 0, 5)
except Exception as error:
    print("frames 0 to 4   cinereader", type(error).__name__, error)
else:
    raise AssertionError("changed: lengths that do not divide")
PY
