#!/usr/bin/env bash
# laptrack 0.17.1: the greatest displacement between two frames
#
# Guess: `LapTrack(cutoff=3**2)` links nothing that is more than 3 px apart, as trackpy's `search_range=3`; gap closing
#   is for frames in which a particle is missing.
# What happens: a particle that moves by 5 px a frame is one track, and so is a sphere that leaves the picture together
#   with another one that enters 12 px away in the next frame. `cutoff` alone acts only with gap closing turned off.
# Why: what the first step leaves apart are segments, and the second step, gap closing, joins a segment's end and the
#   next one's beginning also where no frame is missing between them, by a limit of its own: `gap_closing_cutoff`,
#   15**2 by default.
# Why it matters here: a limit is set so that two spheres are not exchanged at a rebound. Give both limits, or
#   `gap_closing_cutoff=False`.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'laptrack==0.17.1' 'trackpy==0.7' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import pandas as pd
import trackpy
from laptrack import LapTrack

trackpy.quiet()
films = {
    "5 px a frame": pd.DataFrame({"frame": [0, 1, 2, 3], "x": [0.0, 5.0, 10.0, 15.0], "y": 0.0}),
    "one leaves, one enters": pd.DataFrame({"frame": [0, 1, 2, 3, 4], "x": [6.0, 8.0, 10.0, 22.0, 24.0], "y": 0.0}),
}


def laptrack(film, **options):
    spots, _, _ = LapTrack(cutoff=3**2, **options).predict_dataframe(film, ["x", "y"])
    return spots["track_id"].nunique()


print(", ".join(f"{name} {version(name)}" for name in ("laptrack", "trackpy")) + "; the limit is 3 px")
print("number of tracks          trackpy   laptrack   with gap_closing_cutoff=3**2   without gap closing")
numbers = {}
for name, film in films.items():
    numbers[name] = (
        trackpy.link(film, 3)["particle"].nunique(),
        laptrack(film),
        laptrack(film, gap_closing_cutoff=3**2),
        laptrack(film, gap_closing_cutoff=False),
    )
    print(f"{name:24s} {numbers[name][0]:8d} {numbers[name][1]:10d} {numbers[name][2]:30d} {numbers[name][3]:21d}")
assert numbers == {"5 px a frame": (4, 1, 4, 4), "one leaves, one enters": (2, 1, 2, 2)}, "changed"
PY
