#!/usr/bin/env bash
# FPT-Diffusion 0.1.5: linking of particles with `gcHungarian`
#
# Guess: it links each particle to the nearest one of the next frame, whatever the unit of the places is, and none
#   beyond `max_distance`.
# What happens: with a whole number as `birth_death_cost`, as by default, distances are cut to whole numbers. Of places
#   in millimetres nearly all distances are 0, and particles are linked in the order of the rows: where one bead falls
#   past another one 0.6 mm beside it, the two exchange their names, which the same places in pixels do not. Beyond
#   `max_distance` the reverse happens: on x86-64 two beads 250 pixels apart exchange names in each frame, since what is
#   too far is linked first; NumPy warns of an invalid value. With `birth_death_cost=50.0` all this is right.
# Why: the table of costs is filled with the number given and takes its type. Too far is infinity, which as a whole
#   number is the least one on x86-64, the greatest on other processors.
# Why it matters here: where two spheres meet, the names decide which one rebounds. Give the cost with a decimal point.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-compile 'setuptools==80.9.0' 'numpy==2.4.6' \
    'scipy==1.17.1' 'pandas==3.1.1' 'tqdm==4.70.1'
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-build-isolation 'FPT-Diffusion==0.1.5'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
import pandas as pd
from FPTdiffusion.analysis import gcHungarian

FRAMES = 6


def names(scale, places, **given):
    """Name of each bead in each frame; the rows of a frame are from top to bottom, as a search lists them."""
    rows = [(frame, bead, x, y) for frame in range(FRAMES) for bead, (x, y) in enumerate(places(frame))]
    table = pd.DataFrame(rows, columns=["frame", "bead", "x", "y"]).sort_values(["frame", "y"], ignore_index=True)
    table[["x", "y"]] *= scale
    linked = gcHungarian(table, **given)
    return linked.sort_values(["frame", "bead"])["particle"].to_numpy().reshape(FRAMES, -1).astype(int).tolist()


def passing(frame):
    """A bead that falls by 0.05 mm a frame past one that rests 0.6 mm beside it."""
    return (1.0, 1.0 + 0.05 * frame), (1.6, 1.12)


def meeting(frame):
    """Two beads, 250 pixels apart, that come closer by four pixels a frame."""
    return (50.0 + 2 * frame, 50.0), (300.0 - 2 * frame, 51.0)


print("FPT-Diffusion", version("FPT-Diffusion"), "- names of two beads in six frames")
lowest = np.array([np.inf]).astype(int)[0] < 0
kept, passed, exchanged = [[0, 1]] * 6, [[0, 1]] * 3 + [[1, 0]] * 3, [[0, 1], [1, 0]] * 3
for text, found, expected in (
    ("passing, in pixels", names(100, passing, max_distance=200, birth_death_cost=300), kept),
    ("passing, in millimetres", names(1, passing, max_distance=2, birth_death_cost=3), passed),
    ("  the same, cost 3.0", names(1, passing, max_distance=2, birth_death_cost=3.0), kept),
    ("meeting, by default", names(1, meeting), exchanged if lowest else kept),
    ("  the same, cost 50.0", names(1, meeting, birth_death_cost=50.0), kept),
):
    print(f"{text:24s}", *found)
    assert found == expected, f"changed: {text}"
PY
