"""The same film as each tracker writes it gives the same impact, and one sentence says what it was taken for."""

import io
import itertools
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from wetdoublet.solvers import InputError, tracks

from tests.helpers.command import run
from tests.helpers.films import PIXEL, PLACES, RATE, bounce, long_table, read

Film = dict[str, np.ndarray]


@pytest.fixture(scope="module")
def film() -> Film:
    """A bounce, written with three decimals."""
    return {name: values if name == "frame" else values.round(3) for name, values in bounce().items()}


def same(found: object, film: Film, within: float = 1e-9) -> None:
    expected = read(film).columns
    assert found.columns["outcome"] == expected["outcome"]
    either = ([[*map(float, each.split())] for each in of["correlation"]] for of in (found.columns, expected))
    np.testing.assert_allclose(*either, atol=1e-2 if within > 1e-9 else 2e-6)
    for name in set(expected) - {"outcome", "correlation"}:
        assert found.columns[name] == pytest.approx(expected[name], rel=within, abs=1e-15), name


def trackmate(film: Film, unit: str = "pixel", size: float = 1.0, clock: str = "frame", step: float = 1.0) -> str:
    """Spots with four rows of names; units stand in the third one below."""
    names = "LABEL,ID,TRACK_ID,QUALITY,POSITION_X,POSITION_Y,POSITION_Z,POSITION_T,FRAME,RADIUS,VISIBILITY"
    rows = [names, "Label,Spot ID,Track ID,Quality,X,Y,Z,T,Frame,Radius,Visibility",
            "Label,Spot ID,Track ID,Quality,X,Y,Z,T,Frame,R,Visibility",
            f",,,(quality),({unit}),({unit}),({unit}),({clock}),,({unit}),"]  # fmt: skip
    rows += [
        f"ID{k},{k},{row.particle:.0f},5,{size * row.x:.9g},{480 - size * row.y:.9g},0,{step * row.frame:.9g},"
        f"{row.frame:.0f},77,1" for k, row in enumerate(long_table(film).itertuples())
    ]  # fmt: skip
    return "\n".join([*rows, "ID999,999,None,5,10,10,0,3,3,77,1"]) + "\n"


def xml(film: Film) -> str:
    """TrackMate's file: spots by frame, hidden ones too, and edges in no order."""
    table = long_table(film)
    ids = {(row.particle, row.frame): 100 + k for k, row in enumerate(table.itertuples())}
    spots, hidden = "", '<Spot ID="7" VISIBILITY="0" POSITION_X="400" POSITION_Y="400" POSITION_T="3" FRAME="3"/>'
    for frame, rows in table.groupby("frame"):
        spots += f'<SpotsInFrame frame="{frame:.0f}">{hidden if frame == 3 else ""}' + "".join(
            f'<Spot ID="{ids[row.particle, row.frame]}" POSITION_X="{row.x}" POSITION_Y="{row.y}" VISIBILITY="1" '
            f'POSITION_T="{row.frame:.1f}" FRAME="{row.frame:.0f}"/>' for row in rows.itertuples()
        ) + "</SpotsInFrame>"  # fmt: skip
    tracks_of, random = "", np.random.default_rng(2)
    for particle, rows in table.groupby("particle"):
        edges = list(itertools.pairwise(ids[particle, frame] for frame in rows.frame))
        tracks_of += f'<Track TRACK_ID="{particle:.0f}">' + "".join(
            f'<Edge SPOT_SOURCE_ID="{a}" SPOT_TARGET_ID="{b}"/>' for a, b in random.permutation(edges)
        ) + "</Track>"  # fmt: skip
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<TrackMate version="7"><Model spatialunits="pixel" timeunits="frame">'
        f"<AllSpots>{spots}</AllSpots><AllTracks>{tracks_of}</AllTracks></Model></TrackMate>"
    )


def simple_xml(film: Film) -> str:
    """TrackMate's export of tracks alone."""
    paths = "".join(
        "<particle>" + "".join(f'<detection t="{row.frame:.0f}" x="{row.x}" y="{row.y}" z="0"/>'
                               for row in rows.itertuples()) + "</particle>"
        for _, rows in long_table(film).groupby("particle")
    )  # fmt: skip
    return f'<Tracks nTracks="2" spaceUnits="pixel" frameInterval="1.0" timeUnits="frame">{paths}</Tracks>'


def tracker(film: Film) -> str:
    """Two masses side by side, in seconds and metres."""
    rows = ["#multi:", "\tmass A\t\tmass B\t\t", "\t".join(["t", *"xyxy", ""])]
    for k, *places in zip(film["frame"], *(PIXEL * film[name] for name in PLACES)):
        rows.append("\t".join(f"{value:.12E}" for value in (k / RATE, *places)) + "\t")
    return "\n".join(rows) + "\n"


def tracker_with_frames(film: Film, pixels: bool = False) -> str:
    """Of each mass the frame, empty where it is not marked, the position and that in pixels, or the latter alone."""
    names = ["pixelx", "pixely"] if pixels else ["frame", "x", "y", "pixelx", "pixely"]
    rows = ["#multi:", ",mass A" + "," * len(names) + "mass B" + "," * len(names), ",".join(["t", *names, *names, ""])]
    for k, frame in enumerate(film["frame"]):
        row = [f"{frame / 30:.6E}"]
        for body in "12":
            x, y = (film[axis + body][k] for axis in "xy")
            own = {"frame": f"{frame:.6E}", "x": f"{PIXEL * x:.12E}", "y": f"{PIXEL * y:.12E}", "pixelx": f"{x:.3f}"}
            row += ["" if k == 3 and body == "2" else (own | {"pixely": f"{480 - y:.3f}"})[name] for name in names]
        rows.append(",".join([*row, ""]))
    return "\n".join(rows) + "\n"


def deeplabcut(film: Film) -> str:
    """Three rows of names, a likelihood of each body."""
    columns = {("DLC_resnet", body, name): film[f"{name}{k}"] if name in "xy" else [1 - 0.1 * k]
               for k, body in ((1, "left"), (2, "right")) for name in ("x", "y", "likelihood")}  # fmt: skip
    size = film["frame"].size
    table = pd.DataFrame({name: np.resize(values, size) for name, values in columns.items()}, index=film["frame"])
    return table.rename_axis(columns=["scorer", "bodyparts", "coords"]).to_csv()


def imagej(film: Film) -> str:
    """Results: a blank first name, counting from 1, no particle; the larger spheres first on some frames."""
    table = long_table(film).sort_values(["frame", "y"])
    table = pd.DataFrame({" ": np.arange(1, len(table) + 1), "Area": 900, "X": table.x, "Y": 479 - table.y,
                          "Slice": table.frame.astype(int) + 1})  # fmt: skip
    return table.to_csv(index=False)


def wide(film: Film, names: tuple[str, ...]) -> str:
    return pd.DataFrame({name: film[place] for name, place in zip(names, PLACES)}).to_csv(index=False)


def long(film: Film, names: dict[str, str], others: dict[str, float], **csv: object) -> str:
    table = long_table(film).rename(columns=names).assign(**others)
    return table.to_csv(**{"index": False} | csv)


def napari_points(film: Film, names: dict[str, str]) -> str:
    """Points of a film, or of a stack of planes of which it is one: an index, and no particle."""
    return long_table(film).assign(z=7)[list(names)].rename(columns=names).to_csv(index_label="index")


def saved(film: Film, between: str) -> str:
    """As numpy.savetxt writes a table with a header."""
    table = long_table(film)
    np.savetxt(text := io.StringIO(), table, header=between.join(table), delimiter=between)
    return text.getvalue()


def beside(film: Film, unit: str, size: float, clock: tuple[str, float] = ("frame", 1.0), **csv: object) -> str:
    """Two paths side by side, in another unit."""
    table = {clock[0]: film["frame"] * clock[1]} | {f"{place}{unit}": film[place] * size for place in PLACES}
    return pd.DataFrame(table).to_csv(index=False, **csv)


DLTDV = ("pt1_cam1_X", "pt1_cam1_Y", "pt2_cam1_X", "pt2_cam1_Y")
SPELT: dict[str, tuple[str, Callable[[Film], str]]] = {
    "trackpy": ("trackpy", lambda film: long(film, {}, {"mass": 9.5, "ep": 0.1}, index=True)),
    "trackpy;": ("trackpy", lambda film: long(film, {}, {"mass": 9.5}, sep=";", decimal=",")),
    "laptrack": ("LapTrack", lambda film: long(film, {"particle": "track_id"}, {"tree_id": 0, "index": 4})),
    "napari": ("napari", lambda film: long(film, {"particle": "track_id", "frame": "t"}, {})),
    "napari-layer": ("napari", lambda film: long(film, {"particle": "ID", "frame": "T", "y": "Y", "x": "X"}, {})),
    "napari-stack": (
        "napari", lambda film: napari_points(film, {"frame": "axis-0", "z": "axis-1", "y": "axis-2", "x": "axis-3"})
    ),
    "trackmate": ("TrackMate", trackmate),
    "trackmate-micron": ("TrackMate", lambda film: trackmate(film, "micron", 1e6 * PIXEL)),
    "trackmate-mm": ("TrackMate", lambda film: trackmate(film, "mm", 1e3 * PIXEL)),
    "trackmate-sec": ("TrackMate", lambda film: trackmate(film, clock="sec", step=1 / RATE)),
    "trackmate-uncalibrated": ("TrackMate", lambda film: trackmate(film, clock="sec")),
    "xml": ("TrackMate's XML", xml),
    "simple-xml": ("TrackMate's XML", simple_xml),
    "tracker": ("Tracker", tracker),
    "deeplabcut": ("bodies", deeplabcut),
    "trackpy-filter-stubs": (
        "trackpy", lambda film: long_table(film).assign(mass=9.5).set_index("frame", drop=False).to_csv()
    ),
    "dltdv": ("DLTdv", lambda film: wide(film, DLTDV)),
    "imagej": ("ImageJ's Results", imagej),
    "blanks": ("trackpy", lambda film: long(film, {}, {}, sep=" ")),
    "numpy": ("trackpy", lambda film: saved(film, " ")),
    "numpy,": ("trackpy", lambda film: saved(film, ",")),
    "inches": ("side by side", lambda film: beside(film, "_inch", PIXEL / 0.0254)),
    "nanoseconds": ("side by side", lambda film: beside(film, "", 1.0, ("time_ns", 1e9 / RATE))),
    "units in blanks": ("side by side", lambda film: beside(film, " [mm]", 1e3 * PIXEL, sep=" ").replace('"', "")),
}  # fmt: skip


@pytest.mark.parametrize("kind", SPELT)
def test_the_film_of_a_tracker_is_that_film(tmp_path: Path, film: Film, kind: str) -> None:
    """All columns within rounding, one sentence; Y may point either way."""
    name, write = SPELT[kind]
    path = tmp_path / ("film.xml" if "xml" in kind else "film.csv")
    path.write_text(write(film), encoding="utf-8")
    found = read(path)
    same(found, film, 1e-6)
    said = [each for each in found.remarks if "taken for" in each and "table" in each]
    assert len(said) == 1 and name in said[0]


def test_a_frame_of_deeplabcut(tmp_path: Path, film: Film) -> None:
    """As pandas reads its .h5: columns of three names. A file of another kind, before the scene, is no broken scene."""
    path = tmp_path / "film.csv"
    path.write_text(deeplabcut(film), encoding="utf-8")
    same(read(pd.read_csv(path, header=[0, 1, 2], index_col=0)), film, 1e-6)
    (tmp_path / "film.mdf").write_text("MTrackJ 1.5.1 Data File")
    done = run("tracks", tmp_path / "film.mdf", "lactose-pvp")
    assert done.exit_code == 2 and "columns x1, y1, x2, y2" in done.output


def test_frames_and_pixels_of_tracker(tmp_path: Path, film: Film) -> None:
    """A frame beside each mass, empty where one is not marked: it counts with a rate, the time does not.

    Pixels alone are read with a scale; different cells under one name are refused.
    """
    path, rows = tmp_path / "film.csv", np.arange(film["frame"].size) != 3
    path.write_text(text := tracker_with_frames(film))
    found = read(path, scale=None)
    same(found, {name: values[rows] for name, values in film.items()}, 1e-6)
    assert any("Tracker" in each and "the times are not used" in each for each in found.remarks)
    slow = tracks(path, "lactose-pvp").columns["speed"]
    np.testing.assert_allclose(slow, np.array(found.columns["speed"]) * 30 / RATE, rtol=1e-4)
    path.write_text(tracker_with_frames(film, pixels=True))
    by_pixel = tracks(path, "lactose-pvp", scale=PIXEL)
    np.testing.assert_allclose(by_pixel.columns["speed"], slow, rtol=1e-6)
    assert any("Tracker" in each for each in by_pixel.remarks)
    path.write_text(text.replace("7.000000E+00", "8.000000E+00", 1))
    with pytest.raises(InputError, match='"frame" is given twice, with different cells'):
        read(path)


def test_what_a_file_lacks_can_be_supplied_as_it_is_asked_for(tmp_path: Path, film: Film) -> None:
    """TrackMate before version 7 writes no units: first the scale is asked for, then the rate. Remarks above the names
    are read with "#" before them.
    """
    path, table = tmp_path / "film.csv", long_table(film)
    old = table.assign(TRACK_ID=table.particle, POSITION_X=1e6 * PIXEL * table.x, POSITION_Y=1e6 * PIXEL * table.y,
                       POSITION_T=table.frame / RATE, FRAME=table.frame, VISIBILITY=1)  # fmt: skip
    old[[name for name in old if name.isupper()]].to_csv(path)
    with pytest.raises(InputError, match="accepted: --scale, scale="):
        tracks(path, "lactose-pvp")
    with pytest.raises(InputError, match='"frame" has no unit; accepted: --rate, rate='):
        tracks(path, "lactose-pvp", scale="1 um")
    same(read(path, scale="1 um"), film, 1e-6)
    text = "\n".join(["Phantom v2512", "at 150 kHz", *wide(film, PLACES).splitlines()])
    path.write_text(text)
    with pytest.raises(InputError, match="as many as the first line names: 1 .# before"):
        read(path)
    path.write_text("#" + text.replace("at", "# at", 1).replace(",".join(PLACES), "x1,y1,x2,y2"))
    same(read(path), film, 1e-6)


def test_text_of_windows(tmp_path: Path, film: Film) -> None:
    """Fiji writes µ in the code page of Windows, Excel tables in UTF-16; a file that is no text is refused."""
    path = tmp_path / "film.csv"
    path.write_text(trackmate(film, "µm", 1e6 * PIXEL), encoding="cp1252")
    found = read(path)
    same(found, film, 1e-6)
    assert any("positions in µm" in each for each in found.remarks)
    assert any("scale" in each and "is not used for the positions" in each for each in found.remarks)
    assert not any("is not used for the positions" in each for each in read(film).remarks)
    path.write_text(trackmate(film, "µm", 1e6 * PIXEL), encoding="utf-16")
    same(read(path), film, 1e-6)
    for content in (bytes(range(256)), b"\xff\xfe" + bytes(range(255))):
        path.write_bytes(content)
        with pytest.raises(InputError, match="is not UTF-8 text"):
            read(path)


def test_a_scale_is_right_and_uncertain_by_a_share(film: Film) -> None:
    for spread in ("5 %", 5, -0.1, math.nan):
        with pytest.raises(InputError, match="scale_sd.*a number from 0"):
            read(film, scale_sd=spread)
    for source, scale in itertools.product((film, crowd(film)), (PIXEL / 10, 1000 * PIXEL)):
        with pytest.raises(InputError, match="is the scale off|look at the scale"):
            read(source, scale=scale)


@pytest.mark.parametrize("kind", ["trackpy", "trackmate"])
def test_numbers_and_order_of_rows_do_not_matter(tmp_path: Path, film: Film, kind: str) -> None:
    """Particles renumbered, frames counted from 1000, rows in any order."""
    later = film | {"frame": film["frame"] + 1000}
    head, *rows = SPELT[kind][1](later).splitlines()
    names = 3 if kind == "trackmate" else 0
    shuffled = [rows[k] for k in np.random.default_rng(3).permutation(np.arange(names, len(rows)))]
    (tmp_path / "film.csv").write_text("\n".join([head, *rows[:names], *shuffled]) + "\n", encoding="utf-8")
    same(read(tmp_path / "film.csv"), film, 1e-6)
    table = long_table(film).assign(particle=lambda each: np.where(each.particle == 0, 17, 4))
    same(read(table.sample(frac=1, random_state=1)), film)
    same(read(table.set_index("frame", drop=False)), film)
    same(read(table.set_index(["frame", table.index])), film)


def crowd(film: Film) -> pd.DataFrame:
    """The film with one particle that rests and one that passes far away."""
    frames, table = film["frame"], long_table(film)
    others = [pd.DataFrame({"frame": frames, "x": x, "y": y, "particle": k})
              for k, x, y in ((8, 900.0, 900.0), (9, 50 + 3.0 * frames, 20.0))]  # fmt: skip
    return pd.concat([table, *others]).sort_values(["frame", "particle"], ignore_index=True)


def test_of_several_the_two_that_meet_or_that_are_named(tmp_path: Path, film: Film) -> None:
    """Without an option those that meet; a track that goes on under another number is joined by "+"."""
    table = crowd(film)
    found = read(table)
    same(found, film)
    assert any("particles 0 and 1" in each for each in found.remarks)
    for pair in ("0,1", (1, 0), ["0", "1"]):
        same(read(table, particles=pair), film)
    late = (table.particle == 1) & (table.frame > 35)
    broken = table.assign(particle=np.where(late, 12, table.particle))
    with pytest.raises(InputError, match="particles"):
        read(broken.assign(particle=np.where((broken.particle == 0) & (broken.frame > 35), 11, broken.particle)))
    same(read(broken, particles="0,1+12"), film)
    with pytest.raises(InputError, match="particles"):
        read(table, particles="0,5")
    table.to_csv(tmp_path / "film.csv")
    words = ("tracks", tmp_path / "film.csv", "lactose-pvp", "--rate", RATE, "--scale", "2 um")
    done = run(*words, "--particles", "0,1")
    assert done.exit_code == 0 and "trackpy" in done.output
    assert run(*words, "--particles", "0,1,8").exit_code == 2
    close = table[table.particle == 1].assign(particle=5, y=lambda each: each.y + 155)
    with pytest.raises(InputError, match="0,1; 0,5; 1,5"):
        read(pd.concat([table, close]))
    three = film | {"x3": 0 * film["x1"], "y3": 0 * film["x1"]}
    same(read(three), film)
    same(read(three, particles="1,2"), film)


def test_pairs_side_by_side_are_impacts(film: Film) -> None:
    """Two pairs on the same frames, in a row for each particle or for each frame, units behind the names."""
    table = crowd(film)
    twins = pd.concat([table, table.assign(particle=table.particle + 20, y=table.y + 5000)], ignore_index=True)
    far = {f"{name[0]}{int(name[1]) + 2}": film[name] + 5000 for name in PLACES}
    wide = {f"{name}_um": 1e6 * PIXEL * places for name, places in (film | far).items() if name != "frame"}
    alone = read(film).columns
    for source, labels in ((twins, ("0-1", "20-21")), (wide | {"frame": film["frame"]}, ("1-2", "3-4"))):
        found = read(source)
        assert found.labels == labels
        for name in ("speed", "angle", "restitution", "delay", "turn"):
            assert found.columns[name] == pytest.approx(2 * alone[name], rel=1e-6)
    with pytest.raises(InputError, match="differ in their units"):
        read({name.replace("x2_um", "x2_mm"): column for name, column in wide.items()} | {"frame": film["frame"]})


def test_films_in_one_table_each_with_its_own_particles(film: Film) -> None:
    """Trackers number anew: in each film the two that meet are taken, films in the order of the table."""
    tables = [crowd(film).assign(particle=lambda each, k=k: 10 * k + each.particle, film=k) for k in (2, 10, 1)]
    found, alone = read(pd.concat(tables)), read(film).columns
    assert found.labels == ("2", "10", "1")
    for name in ("speed", "turn", "delay"):
        assert found.columns[name] == pytest.approx(3 * alone[name], rel=1e-9)
    assert any("particles 20 and 21; 100 and 101; 10 and 11" in each for each in found.remarks)
    tables[1] = tables[1][tables[1].particle != 100]
    with pytest.raises(InputError, match="10,11; 20,21"):
        read(pd.concat(tables))


def test_two_that_are_one_spot_while_they_touch(film: Film) -> None:
    """TrackMate gives both the number of one track, and frames of contact one row."""
    table = long_table(film)
    distance = np.hypot(film["x2"] - film["x1"], film["y2"] - film["y1"])
    merged = table.assign(particle=0)[~(table.frame.isin(film["frame"][distance < 156]) & (table.particle == 1))]
    found = read(merged)
    assert found.columns["speed"] == pytest.approx(read(film).columns["speed"], rel=1e-2)
    assert found.columns["delay"] == pytest.approx(read(film).columns["delay"], rel=2e-2)
    assert any("linked from frame to frame" in each for each in found.remarks)


def test_what_is_none_of_these_says_what_is_accepted(tmp_path: Path, film: Film) -> None:
    """A table without positions, dust among nameless rows, an XML of something else: refused, and how it should be."""
    (tmp_path / "film.xml").write_text("<svg></svg>")
    dusty = pd.concat([long_table(film), pd.DataFrame({"frame": [3.0], "x": [1.0], "y": [1.0], "particle": [5.0]})])
    for wrong, words in (
        ({"frame": [1, 2, 3], "speed": [1, 2, 3]}, "trackpy, LapTrack, napari"),
        (dusty.drop(columns="particle"), "has 3 rows on frame 3"),
        (long_table(film).drop(columns="frame"), "has no frame"),
        (tmp_path / "film.xml", "TrackMate"),
        (tmp_path / "no.csv", "is no file"),
    ):
        with pytest.raises(InputError, match=words):
            read(wrong)


def test_a_clock_that_cannot_be_a_cameras_asks_for_the_rate(film: Film) -> None:
    """600/s of an AVI, whole milliseconds of Matroska, frame numbers: refused without a rate, and said."""
    table, frame = long_table(film), long_table(film).frame
    for times, words in ((frame / 600, "AVI"), ((frame / 0.7).round() / 1e3, "Matroska"), (frame, "numbers of the")):
        timed = table.assign(**{"time [s]": times})
        with pytest.raises(InputError, match=f"^rate: .*{words}"):
            tracks(timed, "lactose-pvp", scale=PIXEL)
        found = read(timed)
        same(found, film)
        assert any(words in each and "not used" in each for each in found.remarks)
    true = table.assign(**{"time [s]": frame / RATE})
    same(tracks(true, "lactose-pvp", scale=PIXEL), film, 1e-6)
    same(read(true.assign(**{"time [s]": frame / 600}).drop(columns="frame")), film, 1e-6)
