"""`wetdoublet tracks`: two tracked centres become the table that `fit` reads."""

from dataclasses import replace
from functools import partial
from typing import Annotated

from ..errors import InputError
from . import options, texts
from .signature import as_command, passed


@as_command("Two tracked centres over time become the table that `fit` reads.")
def command(
    film: str | None,
    rate: str | None,
    scale: str | None,
    scale_sd: Annotated[float | None, partial(texts.share, "a number, as 0.005, or 0.5 %")],
    noise: str | None,
    near: str | None,
    particles: str | None,
    request: options.EntriesRequest,
    output: options.Written,
) -> None:
    """Speed, angle, e_n, e_t, contact time and rotation from the tracked centres of two spheres in FILM.csv.

    The columns are frame,x1,y1,x2,y2 in pixels, or time [s] and units of length; `impact` tells several films apart.
    Tables of trackpy, TrackMate (CSV, XML), Tracker, DLTdv, ImageJ, LapTrack and napari are read as they are.
    SCENE gives radii, film thickness and rupture gap. With -o FILE.csv the table is written as `fit` reads it.

    \b
    Examples:
      wetdoublet tracks film.csv scene.toml --rate 4000 --scale "12.5 um" -o impacts.csv

    Options:
        FILM.csv (film):
        --rate F: Frames per second, or with a unit, as "150 kHz".
        --scale LENGTH: Length of a pixel, as "12.5 um", "2 um/px" or "80 px/mm".
        --scale-sd S: Relative standard deviation of the scale, as 0.005 [0].
        --noise N: Standard deviation of a tracked coordinate, in the unit of the columns or its own [from the scatter].
        --near GAP: Leave out frames in which the gap is smaller, as "0.1 mm" or "8 px" [those off a straight path].
        --particles A,B: The two of several, as "3,7"; "3+8,7" if the tracker went on with 3 as 8 [those that meet].
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..fitting.tracks import tracks

    source = request.source or ""
    if source.lower().endswith((".csv", ".tsv", ".txt", ".xml", ".dat", ".xls")):
        request, film = replace(request, source=film), source
    if film is None:
        raise InputError("FILM.csv", None, "a tracker's table, such as a CSV file with a row for each frame")
    options_of = passed(rate=rate, scale=scale, scale_sd=scale_sd, noise=noise, near=near, particles=particles)
    impacts = tracks(film, request.scene(), **options_of)
    output.show(impacts)
