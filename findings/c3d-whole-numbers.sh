#!/usr/bin/env bash
# c3d 0.6.0 (py-c3d): places that are written as whole numbers, and places that were lost
#
# Guess: with a `point_scale` of 0.05 mm `Writer` rounds places to 0.05 mm, half of them up, and complains of places
#   beyond the format's 32767 units. A sphere that was not seen in a frame has no place there.
# What happens: places are cut towards zero. Two spheres on either side of the origin are up to two units too close,
#   one in the mean, and a sphere that goes through the origin stands still for two units. A place 1640 mm from the
#   origin is read at -1636.8 mm, without a message. A lost sphere is written at its last place, as if it had stopped,
#   with the residual -1 that says so; the column that should say -1 for it, too, says 127, or seven cameras.
# Why: the places over the scale are put into an array of 16-bit numbers as they are, and the next frame uses the same
#   array, in which a lost point only gets its fourth number.
# Why it matters here: gaps and the rebound are near the middle of a calibrated volume, and that is the origin as a
#   rule. A touch is seen where there is a gap. Leave `point_scale` at -1, which writes places as single precision, and
#   take places with a residual of -1 out; ezc3d 1.7.2 reads these as nan.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'c3d==0.6.0' 'ezc3d==1.7.2' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import c3d
import ezc3d
import numpy as np

UNIT = 0.05  # mm
LOST = [0, 0, 0, -1, -1]


def through_a_file(left, right, scale=UNIT):
    """What c3d reads (places along x, residuals, cameras), and what ezc3d reads; nan is lost."""
    writer = c3d.Writer(point_rate=10000.0, point_scale=scale, point_units="mm")
    writer.set_point_labels(["left", "right"])
    for pair in zip(left, right):
        points = np.array([LOST if np.isnan(x) else [x, 0, 0, 0, 1] for x in pair], dtype=float)
        writer.add_frames([(points, np.zeros((0, 0)))])
    with open("spheres.c3d", "wb") as file:
        writer.write(file)
    with open("spheres.c3d", "rb") as file:
        read = np.array([points[:, [0, 3, 4]] for _, points, _ in c3d.Reader(file).read_frames()])
    return read, ezc3d.c3d("spheres.c3d")["data"]["points"][0].T


print("c3d", version("c3d"), "and ezc3d", version("ezc3d"), f"- a unit of {UNIT} mm, film at 10 kHz")
half = np.linspace(0, 3, 1234)
read, other = through_a_file(-half, half)
whole, _ = through_a_file(-half, half, -1.0)
assert np.abs(whole[:, :, 0] - np.stack([-half, half], axis=1)).max() < 1e-6, "single precision"
assert np.abs(read[:, :, 0] - other).max() < 1e-6, "both read the same"
for name, places in (("whole numbers", read[:, :, 0]), ("scale -1", whole[:, :, 0])):
    error = (places[:, 1] - places[:, 0] - 2 * half) / UNIT
    spread = f"{error.min():6.3f} to {error.max():6.3f}, mean {error.mean():6.3f} units"
    print(f"distance of two spheres on either side, {name:14s} error {spread}")
error = (read[:, 1, 0] - read[:, 0, 0] - 2 * half) / UNIT
assert error.min() < -1.95 and error.max() < 0.01 and abs(error.mean() + 1) < 0.05, "changed: cut towards zero"

going = np.arange(-0.2, 0.2, 0.005)  # 50 mm/s
read, _ = through_a_file(going, going + 5)
still = read[np.abs(going) < UNIT - 1e-9, 0, 0]
print(f"sphere at 50 mm/s through the origin: at {set(still.tolist())} mm for {len(still)} frames, 0.005 mm apart each")
assert set(still) == {0.0} and len(still) >= 18, "changed: at the origin"

read, other = through_a_file([1630.0, 1638.0, 1640.0], [0.0] * 3)
print("1630, 1638 and 1640 mm from the origin are", *(f"{x:.2f}" for x in read[:, 0, 0]))
assert np.allclose(read[:, 0, 0], [1630, 1638, -1636.8], atol=0.06), "changed: far from the origin"

falling = 10 - np.arange(8.0)
falling[3:6] = np.nan
for scale in (UNIT, -1.0):
    read, other = through_a_file(falling, falling + 20, scale)
    print(f"scale {scale:5}: 1 mm a frame, lost in frames 3 to 5:", *(f"{x:g}" for x in read[:, 0, 0]), "mm")
    flags = (f"{residual:g}, {cameras:g}" for residual, cameras in read[2:6, 0, 1:])
    print(f"{'':13}residuals and cameras {'; '.join(flags)}; ezc3d:", *(f"{x:.3g}" for x in other[:, 0]))
    assert np.allclose(read[3:6, 0], [8, -1, 127], atol=0.06), "changed: lost places"
    assert np.isnan(other[3:6, 0]).all(), "ezc3d"
PY
