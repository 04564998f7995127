#!/usr/bin/env bash
# stracking 0.1.10: frames without a particle, and distances in three dimensions
#
# Guess: tracks reach the last frame in which the particle was detected; frames in which there is none are gaps. The
#   length of a path is in the units of `scale`, in two and in three dimensions.
# What happens: for each frame without any particle one frame at the end is dropped: a bead that is seen in frames 0 to
#   4 and 8 to 19 is followed to frame 16, one that enters in frame 20 of 40 is not found at all. No message. In
#   three dimensions `scale` is not used: with slices of 2 mm and pixels of 0.5 mm a path of 6 mm has the length 3, one
#   of 2.5 mm the length 5. In two dimensions it is.
# Why: the linker takes as many frames as there are different frame numbers, and counts them from 0. The scale is used
#   if it has three numbers, and in three dimensions it has four, one for the time.
# Why it matters here: a film begins before the bead is in the picture, and is cut or triggered so that it ends with the
#   rebound: this is what is lost. Renumber the frames from the first that shows a bead, and fill empty ones; multiply
#   the places by the scale before.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps --no-compile 'stracking==0.1.10' \
    'numpy==2.4.6' 'scipy==1.17.1'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from stracking.containers import SParticles, STracks
from stracking.features import DisplacementFeature, DistanceFeature
from stracking.linkers import EuclideanCost, SPLinker


def followed(frames, gap):
    """The frames in which the linker finds a bead that moves by half a pixel a frame."""
    spots = np.array([[frame, 10, 0.5 * frame] for frame in frames])
    linker = SPLinker(cost=EuclideanCost(max_cost=9), gap=gap)  # squared
    tracks = linker.run(SParticles(data=spots, properties={}, scale=(1, 1, 1))).data
    return sorted(int(row[1]) for row in tracks)


print("stracking", version("stracking"))
print("bead in frames           empty   gap   followed in frames")
for frames, empty, gap, expected in (
    ([*range(20)], 0, 1, [*range(20)]),
    ([*range(5), *range(6, 20)], 1, 2, [*range(5), *range(6, 19)]),
    ([*range(5), *range(8, 20)], 3, 4, [*range(5), *range(8, 17)]),
    ([*range(8, 20)], 8, 1, [*range(8, 12)]),
    ([*range(20, 40)], 20, 1, []),
):
    found = followed(frames, gap)
    name = f"{frames[0]} to {frames[-1]}"
    print(f"{name:24s} {empty:5d} {gap:5d}   {len(found)} of {len(frames)}" + (f", to {found[-1]}" if found else ""))
    assert found == expected, "changed: frames"

print("path from the origin in pixels, and its scale       exact   distance   displacement")
for scale, end, expected in (
    ((1, 0.5, 0.5), (3, 4), 2.5),
    ((1, 2.0, 0.5, 0.5), (3, 0, 0), 3),
    ((1, 2.0, 0.5, 0.5), (0, 3, 4), 5),
):
    exact = np.linalg.norm(np.multiply(end, scale[1:]))
    tracks = STracks(data=np.array([[0, 0, *np.zeros(len(end))], [0, 1, *end]]), scale=scale)
    tracks = DisplacementFeature().run(DistanceFeature().run(tracks))
    found = tracks.features["distance"][0], tracks.features["displacement"][0]
    print(f"{end!s:20s} {scale[1:]!s:20s} {exact:16.1f} {found[0]:10.1f} {found[1]:14.1f}")
    assert np.allclose(found, expected), "changed: scale"
PY
