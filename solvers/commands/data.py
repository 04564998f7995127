"""Measured impacts: films become tables, tables are looked through and fitted, the next impacts are chosen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import click

from ..errors import CheckFailed, InputError
from ..scene.scenefile import PRESETS
from ..scene.schema import FIELDS
from . import texts
from .bar import Bar
from .options import Entries, SceneRequest, Shown, Written, check_apart, group, several
from .signature import command, passed

_IMPACTS = "a CSV file with a row for each impact"
_ENTRIES = "entries to estimate, as --free particles.roughness,liquid.viscosity"
_Share = Annotated[float | None, partial(texts.share, "a number, as 0.005, or 0.5 %")]
_FILMS = (".csv", ".tsv", ".txt", ".xml", ".dat", ".xls")


def _ordered(
    request: SceneRequest, file: str | None, suffixes: tuple[str, ...], name: str, accepted: str
) -> tuple[str, SceneRequest]:
    """The data and the scene, which may stand in either order."""
    source = request.source or ""
    if source.lower().endswith(suffixes) or (_is_scene(file or "") and not _is_scene(source)):
        request, file = replace(request, source=file), source
    if file is None:
        raise InputError(name, None, accepted)
    return file, request


def _is_scene(source: str) -> bool:
    return source in PRESETS or source.lower().endswith(".toml")


@command("fitting.tracks:tracks")
def tracks(film: str | None, scale_sd: _Share, request: Entries, output: Written, **chosen: Any) -> None:
    """Two tracked centres over time become the table that `fit` reads.

    Speed, angle, e_n, e_t, contact time and rotation from the tracked centres of two spheres in FILM.csv.
    The columns are frame,x1,y1,x2,y2 in pixels, or time [s] and units of length; `impact` tells several films apart.
    Tables of trackpy, TrackMate (CSV, XML), Tracker, DLTdv, ImageJ, LapTrack and napari are read as they are.
    SCENE gives radii, film thickness and rupture gap. With -o FILE.csv the table is written as `fit` reads it.
    The two may stand in either order.

    Example:
      wetdoublet tracks scene.toml film.csv --rate 4000 --scale "12.5 um" -o impacts.csv

    Options:
        FILM.csv (film):
        --rate F
        --scale LENGTH: Length of a pixel, as "12.5 um", "2 um/px" or "80 px/mm".
        --scale-sd S: Relative standard deviation of the scale, as 0.005 [0].
        --noise SD
        --near GAP: Leave out frames in which the gap is smaller, as "0.1 mm" or "8 px" [those off a straight path].
        --particles A,B
    """
    from ..fitting.tracks import tracks

    accepted = "a tracker's table, such as a CSV file with a row for each frame"
    film, request = _ordered(request, film, _FILMS, "FILM.csv", accepted)
    output.show(tracks(film, request.scene(), **passed(scale_sd=scale_sd), **chosen))


@command()
def check(data: str | None, request: Entries, output: Written) -> None:
    """Measured impacts in DATA.csv looked through before a fit: units, outliers, what they can tell of SCENE.

    The two may stand in either order. Exit status 1 if something is odd.

    Examples:
      wetdoublet check impacts.csv granulation
      wetdoublet check impacts.csv scene.toml --json

    Options:
        DATA.csv (data):
    """
    from ..fitting.examine import check_data

    data, request = _ordered(request, data, (".csv",), "DATA.csv", _IMPACTS)
    report = check_data(data, request.scene(remark=True))
    output.show(report)
    if report.findings:
        count = len(report.findings)
        raise CheckFailed(f"{count} finding{'s' * (count > 1)}, the first: {report.findings[0].text}")


def _measured(source: Sequence[str], **given: Any) -> list[tuple[SceneRequest, str | None]]:
    """Scenes, each with the file of its impacts, which may stand in either order."""
    pairs: list[tuple[str, str | None]] = []
    for scene, file in zip(source[::2], [*source[1::2], None]):
        exchanged = file is not None and _is_scene(file) and not _is_scene(scene)
        pairs.append((file or "", scene) if exchanged else (scene, file))
    return list(zip(several([scene for scene, _ in pairs], **given), [file for _, file in pairs], strict=True))


_Measured = Annotated[Any, group(_measured, "source", "changes", "hold", "model")]


@command(free=_ENTRIES)
def fit(
    free: list[str], own: tuple[str, ...], write: Path | None, measured: _Measured, output: Shown, **chosen: Any
) -> None:
    """Entries of SCENE from the measured impacts in DATA.csv, with what the data cannot tell.

    The scene's own values are a first guess. Several scenes, each followed by its data, share the entries that are not
    --own.

    The first line of DATA.csv names its columns:
      speed [m/s],angle [deg],restitution,restitution_sd,outcome

    Examples:
      wetdoublet fit granulation impacts.csv --free particles.roughness,liquid.viscosity --plot fit.png
      wetdoublet fit scene.toml impacts.csv --free liquid.viscosity --prior liquid.viscosity="2 Pa s +- 10 %"
      wetdoublet fit oil.toml oil.csv water.toml water.csv --free particles.roughness,liquid.viscosity,noise.restitution
        --own liquid.viscosity

    Options:
        SCENE DATA.csv [SCENE DATA.csv ...] (source):
        --free NAMES: Entries to estimate, as particles.roughness,liquid.viscosity; noise.restitution is a factor of
            the standard deviations in the data.
        --own NAME: A free entry of which each scene has a value of its own, or NAME=LABEL,LABEL,... with a label for
            each scene, of which equal ones share; repeatable.
        --prior
        --write FILE.toml: Write the fitted scene, intervals as comments; of several FILE-1.toml, FILE-2.toml, ...
        --rtol
    """
    from ..fitting.fit import fit

    check_apart(output.file, write, "--write")
    if any(data is None for _, data in measured):
        raise InputError("DATA.csv", None, _IMPACTS)
    scenes = [request.scene(remark=True, whole=False) for request, _ in measured]
    tables = [data for _, data in measured]
    parted = [text.partition("=") for text in own]
    groups = {name: labels.split(",") if labels else labels for name, _, labels in parted}
    with Bar("evaluations") as progress:
        fitted = fit(scenes, tables, free, own=groups, progress=progress, **chosen)
    output.put(str(fitted), fitted.to_dict())
    if fitted.rows.contradicted and (output.as_json or output.file is not None):
        click.echo(fitted.remarks[0], err=True)  # a table on standard output says so itself
    if write is not None:
        fitted.write(write)
    if output.picture is not None:
        with Bar("evaluations") as progress:
            fitted.plot(output.picture, progress=progress)


@command(curve="a CSV file with a shear rate and a viscosity or stress")
def flow_curve(curve: str, output: Shown) -> None:
    """The law of a liquid from its flow curve in CURVE.csv: Newtonian, power-law, Cross, Carreau or Herschel-Bulkley.

    Columns are a shear rate and a viscosity or stress, with units, as rheometers export them. The table `[liquid]` that
    is printed can be pasted into a scene.

    Examples:
      wetdoublet flow-curve curve.csv
      wetdoublet flow-curve curve.csv --json --plot curve.png

    Options:
        CURVE.csv (curve):
    """
    from ..fitting.flow_curve import flow_curve

    output.show(flow_curve(curve))


def _window(text: str) -> dict[str, object]:
    """The window of --over: names with LO:HI or one value; bare angles in degrees, a unit at either end."""
    window: dict[str, object] = {}
    for name, value in texts.assigned("stokes=LO:HI,angle=LO:HI", text.split(",")).items():
        entry = FIELDS.get(f"impact.{name}")  # `design` says what may be in a window
        window[name] = value if entry is None else texts.with_degrees(entry, value)
        if entry is not None and ":" in value:
            window[name] = texts.span(entry, value, f"--over {name}")
    return window


_Window = Annotated[Mapping[str, object], _window]
_Degrees = Annotated[str | None, partial(texts.with_degrees, FIELDS["impact.angle"])]


@command(
    "fitting.design:design", free=_ENTRIES, over="the impacts that can be made, as --over stokes=0.02:0.5,angle=0:80"
)
def design(free: list[str], over: _Window, angle_sd: _Degrees, request: Entries, output: Shown, **chosen: Any) -> None:
    """Where the next impacts should be: those from which `fit` will learn most about entries of SCENE.

    With -o FILE.csv they are also written as the table that `fit` reads, to be filled in.

    Examples:
      wetdoublet design granulation --free liquid.viscosity,liquid.film_thickness --over stokes=0.02:0.5,angle=0:80
      wetdoublet design granulation --free liquid.viscosity --over stokes=0.05:0.3,angle=0 -n 4 --restitution-sd none

    Options:
        --free NAMES: Entries that will be estimated, as liquid.viscosity,particles.roughness.
        --over WINDOW: Impacts that can be made: stokes=LO:HI,angle=LO:HI (degrees); also speed or relative_speed,
            with a unit.
        -n N
        --data DATA.csv
        --prior
        --speed-sd S: Scatter of the speed [2 %, or that of the data].
        --angle-sd S: Scatter of the angle, degrees [1, or that of the data].
        --restitution-sd S
        --rtol
    """
    from ..fitting.design import design

    with Bar("impacts") as progress:
        plan = design(request.scene(whole=False), free, over, progress=progress, **passed(angle_sd=angle_sd), **chosen)
    output.show(plan)
