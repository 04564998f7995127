#!/usr/bin/env bash
# pytrackmate 1.3.4: tracks of two spheres that touch, from TrackMate's XML
#
# Guess: the column `label` numbers particles: one sphere, one label, at most one row a frame; the spots are those
#   that TrackMate shows.
# What happens: two spheres that are one spot while they touch get *one* label, with two rows in every other frame,
#   so that differences of consecutive rows are the distance between the spheres. And a spot whose value *equals*
#   the threshold of a spot filter is dropped, while TrackMate shows it: where all spots have quality 1 and the
#   filter says 1, none is left.
# Why: a track of TrackMate is all that edges connect, merges and splits included, and the label is the track's
#   number. The filters are computed again, with > and <, instead of read from VISIBILITY.
# Why it matters here: this is each collision that sticks, or sticks, rotates and separates. Follow the edges, and
#   cut the track at the merge and at the split.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'pytrackmate==1.3.4' 'numpy==2.4.6' 'pandas==3.0.6'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version
from xml.etree import ElementTree as xml

from pytrackmate import trackmate_peak_import

FEATURES = ("QUALITY", "POSITION_X", "POSITION_Y", "POSITION_Z", "POSITION_T", "FRAME", "RADIUS", "VISIBILITY")
# centres [mm] of two spheres of 1 mm: approach, one spot in frame 3, rebound with half the speed
LEFT = {0: -3.0, 1: -2.0, 2: -1.0, 4: -0.5, 5: -1.0, 6: -1.5}


def film(path, threshold):
    root = xml.Element("TrackMate", version="7.11.1")
    model = xml.SubElement(root, "Model", spatialunits="mm", timeunits="s")
    declared = xml.SubElement(xml.SubElement(model, "FeatureDeclarations"), "SpotFeatures")
    for name in FEATURES:
        xml.SubElement(declared, "Feature", feature=name, name=name, shortname=name, dimension="NONE", isint="false")
    spots = xml.SubElement(model, "AllSpots", nspots="13")
    numbers = {}
    for frame in range(7):
        row = xml.SubElement(spots, "SpotsInFrame", frame=str(frame))
        for side in (-1, 1) if frame in LEFT else (0,):
            numbers[frame, side] = str(len(numbers))
            values = (1.0, -side * LEFT.get(frame, 0.0), 0.0, 0.0, frame * 1e-4, frame, 0.5, 1)
            attributes = {name: str(value) for name, value in zip(FEATURES, values)}
            xml.SubElement(row, "Spot", ID=numbers[frame, side], name=f"ID{numbers[frame, side]}", **attributes)
    track = xml.SubElement(xml.SubElement(model, "AllTracks"), "Track", name="Track_0", TRACK_ID="0")
    for frame in range(6):
        for side in (-1, 1):
            source, target = (numbers.get((f, side), numbers.get((f, 0))) for f in (frame, frame + 1))
            xml.SubElement(track, "Edge", SPOT_SOURCE_ID=source, SPOT_TARGET_ID=target, EDGE_TIME=str(frame + 0.5))
    xml.SubElement(xml.SubElement(model, "FilteredTracks"), "TrackID", TRACK_ID="0")
    settings = xml.SubElement(root, "Settings")
    xml.SubElement(settings, "InitialSpotFilter", feature="QUALITY", value=str(threshold), isabove="true")
    xml.SubElement(settings, "SpotFilterCollection")
    xml.ElementTree(root).write(path)


film("touch.xml", threshold=0.5)
spots = trackmate_peak_import("touch.xml", get_tracks=True)
print("pytrackmate", version("pytrackmate"))
print(spots[["t_stamp", "x", "label"]].to_string(index=False))
rows = spots.groupby(["label", "t_stamp"]).size()
film("threshold.xml", threshold=1.0)
remaining = len(trackmate_peak_import("threshold.xml", get_tracks=True))
print(f"labels: {spots['label'].nunique()}, frames with two rows of one label: {(rows == 2).sum()} of 7")
print(f"spots where the filter's threshold is their quality: {remaining} of {len(spots)}")
assert len(spots) == 13 and spots["label"].nunique() == 1 and (rows == 2).sum() == 6, "changed: labels"
assert remaining == 0, "changed: threshold"
PY
