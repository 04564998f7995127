#!/usr/bin/env bash
# roifile 2026.2.10 and read-roi 1.6.0: places below a pixel in ImageJ's regions of interest (.roi)
#
# Guess: the format keeps subpixel places as single-precision numbers; both readers return them for points and circles
#   alike.
# What happens: each is right where the other is wrong. Points that roifile writes (and reads back) at 30.75 and 20.5
#   are 31 and 20 in read-roi. A circle about (14.5, 24.75) with a diameter of 8.5 is that in read-roi, and its outline
#   in roifile has the centre (14.5, 24.5) and the diameter 9.
# Why: read-roi looks for subpixel places only if their bit is the *only* option that is set (roifile sets others
#   beside it); roifile's `coordinates()` draws ovals and rectangles from the whole-pixel box that the format has
#   beside the fields `xd`, `yd`, `widthd`, `heightd`.
# Why it matters here: circles fitted to spheres are stored as such regions. Half a pixel in the diameter is a gap
#   between two spheres at contact that isn't there. Read `xd` and the others of roifile.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'roifile==2026.2.10' 'read-roi==1.6.0' 'numpy==2.4.6'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
import read_roi
from roifile import ROI_OPTIONS, ROI_TYPE, ImagejRoi

print("roifile", version("roifile"), "- read-roi", version("read-roi"))
centres = np.array([[10.25, 20.5], [30.75, 40.125]])
ImagejRoi.frompoints(centres, name="centres").tofile("centres.roi")
ours = ImagejRoi.fromfile("centres.roi").coordinates()
theirs = read_roi.read_roi_file("centres.roi")["centres"]
print(f"points   written {centres.tolist()}, roifile {ours.tolist()}, read-roi x {theirs['x']} y {theirs['y']}")
only = ImagejRoi.frompoints(centres, name="only")
only.options = ROI_OPTIONS.SUB_PIXEL_RESOLUTION
only.tofile("only.roi")
alone = read_roi.read_roi_file("only.roi")["only"]
print(f"the same with no other option set: read-roi x {alone['x']} y {alone['y']}")

box = {"xd": 10.25, "yd": 20.5, "widthd": 8.5, "heightd": 8.5}  # beside it the pixels that hold it
ImagejRoi(
    roitype=ROI_TYPE.OVAL,
    options=ROI_OPTIONS.SUB_PIXEL_RESOLUTION,
    version=228,
    left=10,
    top=20,
    right=19,
    bottom=29,
    name="sphere",
    **box,
).tofile("sphere.roi")
outline = ImagejRoi.fromfile("sphere.roi").coordinates()
low, high = outline.min(axis=0), outline.max(axis=0)
sphere = read_roi.read_roi_file("sphere.roi")["sphere"]
middle = sphere["left"] + sphere["width"] / 2, sphere["top"] + sphere["height"] / 2
print("circle   centre (14.5, 24.75), diameter 8.5")
print(f"         roifile  centre {((low + high) / 2).tolist()}, diameter {float(high[0] - low[0])}")
print(f"         read-roi centre {list(middle)}, diameter {sphere['width']}")
again = ImagejRoi.fromfile("sphere.roi")
print(f"         roifile's fields: {again.xd} {again.yd} {again.widthd} {again.heightd}")
assert np.array_equal(ours, centres), "changed: roifile's points"
assert np.abs(np.column_stack([theirs["x"], theirs["y"]]) - centres).max() == 0.5, "changed: read-roi's points"
assert alone["x"] == [10.25, 30.75], "changed: the only option"
assert middle == (14.5, 24.75) and sphere["width"] == 8.5, "changed: read-roi's circle"
assert high[0] - low[0] == 9 and (low + high)[1] / 2 == 24.5, "changed: roifile's circle"
PY
