#!/usr/bin/env bash
# pyMRAW 0.33.0: films of Photron cameras of which not all frames were saved
#
# Guess: the header of `load_video` says the same for a film with a .cih and with a .cihx file: which frame is the
#   first, how many of the camera's frames make one saved one, and the exposure in seconds under "Shutter Speed(s)".
# What happens: with .cihx the first frame and the step are missing, only the camera's rate is there: images 50 ms apart
#   are 20 microseconds apart. "Shutter Speed(s)" is 200000.0 for 1/200000 s (with .cih the text "1/200000"). With .cih
#   a comment with " : " in it is missing.
# Why: the reader takes a fixed list of entries of the XML, without `startFrame` and `skipFrame`; `shutterSpeed` is the
#   reciprocal. Lines of .cih are split at each " : " and are dropped if they give more than two pieces.
# Why it matters here: cameras record more than fits a disk, and long approaches are saved thinned out. Speeds from
#   these times are wrong by the step; Stokes numbers too, and nothing in the header lets one notice. The package's own
#   sample `beam.cihx` is such a film: 4 frames with a step of 2500 at 50000 frames/s.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
# its list of requirements has nose and py as well, which only its tests need
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'numpy==2.4.6' 'numba==0.68.1' 'xmltodict==1.0.4'
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'pymraw==0.33.0'
cd "$work"
cat > plain.cih <<'HEADER'
#Camera Information Header
Date : 2017/7/13
Camera Type : FASTCAM SA-Z type 2100K-M-64GB
Record Rate(fps) : 50000
Shutter Speed(s) : 1/200000
Original Total Frame : 10000
Total Frame : 4
Start Frame : -300
Save Step : 2500
Image Width : 8
Image Height : 8
Color Bit : 16
File Format : MRaw
EffectiveBit Depth : 12
EffectiveBit Side : Lower
Comment Text : scale : 8.2 um

HEADER
cat > markup.cihx <<'HEADER'
!!! This file can not be edited. !!!
CIHX
<?xml version="1.0" encoding="utf-8"?>
<cih>
    <fileInfo><version>1.0</version><date>2017/7/13</date><time>13:13</time></fileInfo>
    <imageFileInfo>
        <fileFormat>Mraw</fileFormat><resolution><width>8</width><height>8</height></resolution>
    </imageFileInfo>
    <imageDataInfo>
        <resolution><width>8</width><height>8</height></resolution>
        <colorInfo><type>Mono</type><bit>16</bit></colorInfo>
        <effectiveBit><depth>12</depth><side>Lower</side></effectiveBit>
    </imageDataInfo>
    <frameInfo>
        <recordedFrame>10000</recordedFrame><totalFrame>4</totalFrame>
        <startFrame>-300</startFrame><skipFrame>2500</skipFrame>
    </frameInfo>
    <basicInfo><comment>scale : 8.2 um</comment></basicInfo>
    <recordInfo>
        <recordRate>50000</recordRate>
        <shutterSpeed>200000</shutterSpeed><shutterSpeedNsec>5000</shutterSpeedNsec>
    </recordInfo>
    <deviceInfo><deviceName>FASTCAM SA-Z type 2100K-M-64GB</deviceName></deviceInfo>
</cih>
HEADER
"$work/venv/bin/python" - <<'PY'
from importlib.metadata import version

import numpy as np
from pyMRAW import load_video

film = np.arange(4 * 8 * 8, dtype=np.uint16).reshape(4, 8, 8)
for name in ("plain", "markup"):
    film.tofile(f"{name}.mraw")
print("pymraw", version("pymraw"))
headers = {}
for name in ("plain.cih", "markup.cihx"):
    images, headers[name] = load_video(name)
    assert np.array_equal(images, film), "the images"
entries = ("Record Rate(fps)", "Total Frame", "Start Frame", "Save Step", "Shutter Speed(s)", "Comment Text")
print(f"{'':20s} {'.cih':>16s} {'.cihx':>16s}")
for entry in entries:
    print(f"{entry:20s} " + " ".join(f"{str(header.get(entry, 'missing')):>16s}" for header in headers.values()))
plain, markup = headers.values()
assert plain["Record Rate(fps)"] == markup["Record Rate(fps)"] == 50000, "the rate"
assert (plain["Start Frame"], plain["Save Step"]) == (-300, 2500), "changed: .cih"
assert not any(word in entry.lower() for entry in markup for word in ("start", "skip", "step")), "changed: .cihx"
assert 2500 not in markup.values() and -300 not in markup.values(), "changed: .cihx"
assert plain["Shutter Speed(s)"] == "1/200000" and markup["Shutter Speed(s)"] == 200000, "changed: exposure"
assert "Comment Text" not in plain and markup["Comment Text"] == "scale : 8.2 um", "changed: comment"
print(f"between two saved frames: {2500 / 50000} s; from the header of .cihx: {1 / markup['Record Rate(fps)']} s")
PY
