#!/usr/bin/env bash
# freud-analysis 3.4.0: which spheres of a packing touch
#
# Guess: pairs that overlap by a millionth of the diameter are nearer than a diameter: 500 of 500; pairs that are
#   apart by as much, none. Distances are good to 15 digits, as positions given in double precision are.
# What happens: 11 % of the overlapping pairs are reported as apart, 14 % of the others as touching, and overlaps of
#   1e-5 come out between 0.7e-5 and 1.3e-5. All in a box of 100 diameters.
# Why: the points are converted to single precision, without a word, before they are subtracted; the error grows with
#   the distance from the box's centre, not with that of the pair.
# Why it matters here: grains of glass overlap by 1e-6 to 1e-5 of their diameter, liquid films by 1e-3. Contact
#   numbers and forces k * overlap are noise there. Subtract in double precision with the pairs that freud found.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'freud-analysis==3.4.0' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import freud
import numpy as np

DIAMETER, PAIRS = 1e-3, 500
box = freud.box.Box.cube(100 * DIAMETER)
rng = np.random.default_rng(0)
starts = rng.uniform(-45 * DIAMETER, 45 * DIAMETER, (PAIRS, 3))
directions = rng.normal(size=(PAIRS, 3))
directions /= np.linalg.norm(directions, axis=1)[:, None]
print("freud", version("freud-analysis"))
print("overlap / diameter    found by freud                in double precision           touching")
touching, found = {}, {}
for overlap in (1e-4, 1e-5, 1e-6, -1e-6):
    seen, exact = [], []
    for start, direction in zip(starts, directions):
        pair = np.array([start, start + direction * DIAMETER * (1 - overlap)])
        query = freud.locality.AABBQuery(box, pair).query(pair, {"r_max": 1.2 * DIAMETER, "exclude_ii": True})
        neighbours = query.toNeighborList()
        seen.append(1 - float(neighbours.distances[0]) / DIAMETER)
        i, j = neighbours.point_indices[0], neighbours.query_point_indices[0]
        exact.append(1 - np.linalg.norm(pair[i] - pair[j]) / DIAMETER)
    touching[overlap], found[overlap] = sum(value > 0 for value in seen), seen
    spans = (f"{min(values):11.3e} to {max(values):10.3e}" for values in (seen, exact))
    print(f"{overlap:10.0e}      {next(spans)}    {next(spans)}    {touching[overlap]:4d} of {PAIRS}")
    assert np.allclose(exact, overlap, rtol=1e-6), "the pairs themselves"
assert touching[1e-4] == PAIRS, "changed: overlaps of 1e-4"
assert 430 < touching[1e-6] < 460 and 55 < touching[-1e-6] < 85, "changed: overlaps of 1e-6"
assert min(found[1e-5]) < 0.75e-5 and max(found[1e-5]) > 1.25e-5, "changed: overlaps of 1e-5"
PY
