#!/usr/bin/env bash
# pycine 0.3.2: frame numbers of Phantom high-speed films (.cine)
#
# Guess: `read_frames(film, start_frame_cine=N)` begins at the frame that the camera's software calls N (negative
#   before the trigger), as its docstring says; N = 0 is the trigger.
# What happens: it begins one frame early; asked for the first frame of the film it returns the *last* image; asked
#   for frame 0, the trigger, it begins at the start of the film, however long before the trigger that is. No error,
#   no warning.
# Why: N is made an index from 0 and then used as a number from 1 (the film's first frame becomes index -1, which
#   Python counts from the end); and the test whether a start was given at all is a comparison with False, which 0
#   equals.
# Why it matters here: frames are counted from the trigger, which sits at the impact. One frame is 5 to 50 % of a
#   wet contact's duration; times read off such frames are shifted.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check \
    'pycine==0.3.2' 'cine-handler==0.1.1' 'pims==0.7' 'numpy==2.4.6'
cd "$work"
PYTHONPATH="$here" PYTHONDONTWRITEBYTECODE=1 "$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
import phantom_film
import pims
from cine_reader import Cine
from pycine.raw import read_frames

# frames -5 to 5; the brightness of frame N is 1000 + N
numbers = np.arange(-5, 6)
phantom_film.write("impact.cine", np.broadcast_to(1000 + numbers[:, None, None], (11, 8, 8)), first=-5, rate=100_000)


def pycine(number):
    images, _, _ = read_frames("impact.cine", start_frame_cine=number, count=1)
    return int(next(images)[4, 4]) - 1000


def cine_handler(number):
    film = Cine("impact.cine")
    film.load_frame(number)
    return int(film.frame[4, 4]) - 1000


film = pims.Cine("impact.cine")
print(", ".join(f"{name} {version(name)}" for name in ("pycine", "cine-handler", "pims")) + "; frames -5 to 5")
print("frame asked   pycine   cine-handler   pims")
answers = {}
for number in (-5, -4, -1, 0, 1, 5):
    answers[number] = pycine(number)
    others = cine_handler(number), int(film[number + 5][4, 4]) - 1000
    print(f"{number:11d} {answers[number]:8d} {others[0]:14d} {others[1]:6d}")
    assert others == (number, number), "the film itself"
assert answers == {-5: 5, -4: -5, -1: -2, 0: -5, 1: 0, 5: 4}, "changed"
PY
