#!/usr/bin/env bash
# cine-handler 0.1.1: which side of the images of a Phantom high-speed film (.cine) is up
#
# Guess: row 0 of `frame` is the top of the image, as in every array of an image; the reader has the signed height,
#   whose sign says from which side the rows are stored.
# What happens: row 0 is the bottom: spheres that fall rise in the array, and a collision is seen in a mirror. pims
#   and pycine, on the same film, have the top first. No message.
# Why: the format stores its rows from the bottom, as bitmaps do with a positive height. The sign is read and its
#   meaning documented; the decoder takes its absolute value.
# Why it matters here: an impact to the left of the centre becomes one to the right of it, rotations change their
#   sense, and gravity its sign. Speeds and both restitutions stay, so that only a fit of angles or spins tells. Take
#   `frame[::-1]`.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check \
    'cine-handler==0.1.1' 'pycine==0.3.2' 'pims==0.7' 'numpy==2.4.6'
cd "$work"
PYTHONPATH="$here" PYTHONDONTWRITEBYTECODE=1 "$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
import phantom_film
import pims
from cine_reader import Cine
from pycine.raw import read_frames

# sphere 1 falls past a resting sphere 2 on its right, and touches it from above
ROWS, COLUMNS, RATE, FRAMES = 60, 60, 1000, 11
row, column = np.mgrid[:ROWS, :COLUMNS]
images = np.zeros((FRAMES, ROWS, COLUMNS))
for frame, image in enumerate(images):
    for brightness, (y, x) in ((3000, (10 + 2 * frame, 20)), (1500, (40, 30))):
        image[np.hypot(row - y, column - x) < 6] = brightness
phantom_film.write("fall.cine", images, first=-5, rate=RATE)


def measure(film):
    """Speed of sphere 1 down the rows, and the angle of the line of centres in the last image."""
    places = []
    for image in film:
        places.append([np.argwhere(np.isclose(image, level, atol=2)).mean(axis=0) for level in (3000, 1500)])
    places = np.array(places)
    across = places[-1, 1] - places[-1, 0]
    return (places[-1, 0, 0] - places[0, 0, 0]) / (FRAMES - 1), np.degrees(np.arctan2(across[0], across[1]))


film = Cine("fall.cine")
films = {
    "cine-handler": list(np.moveaxis(film.load_frames_batch(film.first_frame_number, film.total_frames), -1, 0)),
    "pims": [np.asarray(image) for image in pims.Cine("fall.cine")],
    "pycine": list(read_frames("fall.cine")[0]),
}
true = measure(images)
height = film.image_header.biHeight
print(f"film: {true[0]:+.1f} rows/frame, line of centres at {true[1]:+.1f} degrees; height in its header {height}")
print("reader               rows/frame   line of centres")
for name, read in films.items():
    speed, angle = measure(read)
    print(f"{name:12s} {version(name):7s} {speed:+10.1f} {angle:+17.1f}")
    sign = -1 if name == "cine-handler" else 1
    assert np.isclose(speed, sign * true[0]) and np.isclose(angle, sign * true[1]), f"changed: {name}"
assert all(np.array_equal(image[::-1], other) for image, other in zip(films["cine-handler"], films["pims"])), "changed"
assert height == ROWS, "the film itself"
PY
