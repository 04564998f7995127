#!/usr/bin/env bash
# ptvpy 0.10.2: speeds where a sphere was not found in a frame
#
# Guess: `particle_velocity` always gives pixels *per frame*, as its documentation says, with the column of frames as
#   the axis of time.
# What happens: a sphere of 4 pixels per frame has 8 behind one lost frame and 12 behind two. With `step=2`, which
#   smooths, one lost frame gives 6 twice. No message.
# Why: rows are subtracted, and the difference is divided by `step`; the numbers of the frames are used for sorting
#   alone.
# Why it matters here: trackers lose spheres where they nearly touch, and their `memory` links across the gap. So the
#   false speeds stand beside the impact and count as the speed of approach or of rebound: a restitution of 0.5
#   becomes 0.25 or 1. Divide by the difference of the column `frame`.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'numpy==2.4.6' 'scipy==1.17.1' 'pandas==3.1.1' \
    'numba==0.68.1'
# its list of requirements has what its command line and its plots need as well
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'ptvpy==0.10.2'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import pandas as pd
from ptvpy.process import particle_velocity

SPEED, IMPACT, RESTITUTION = 4.0, 12, 0.5  # pixels per frame; frame; of a sphere on a resting wall


def speeds(lost, step=1):
    """Speeds before and after an impact, by frame, if these frames are lost."""
    rows = []
    for frame in range(25):
        time = frame - IMPACT
        if frame not in lost:
            rows.append((frame, 100 + SPEED * (time if time < 0 else -RESTITUTION * time), 20.0))
    table = pd.DataFrame(rows, columns=["frame", "x", "y"]).assign(particle=0)  # linked across the gap
    return particle_velocity(table, step=step).set_index("frame")["dx"]


print("ptvpy", version("ptvpy"), f"- {SPEED} pixels per frame, rebound with {RESTITUTION}, frame {IMPACT}")
print("lost frames   step   dx in frames 9 to 15")
for lost, step, expected in (
    ((), 1, {10: 4, 11: 4, 12: 4, 13: -2, 14: -2}),
    ((11,), 1, {10: 4, 12: 8, 13: -2}),
    ((10, 11), 1, {9: 4, 12: 12, 13: -2}),
    ((13,), 1, {12: 4, 14: -4, 15: -2}),
    ((9,), 2, {10: 6, 11: 6, 12: 4}),
):
    found = speeds(lost, step)
    text = "  ".join(f"{frame}: {value:+.0f}" for frame, value in found.loc[9:15].items())
    print(f"{', '.join(map(str, lost)) or 'none':11s} {step:6d}   {text}")
    for frame, value in expected.items():
        assert abs(found[frame] - value) < 1e-9, f"changed: {lost}, {frame}"
PY
