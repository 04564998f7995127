"""Checks of the arguments of many impacts: speeds, angles and varied entries, as SI arrays."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ..errors import InputError
from ..host.arguments import check_mapping, check_names
from ..model.validity import NEEDS
from ..results import MAPPED, VALIDITY
from ..scene.fields import Field
from ..scene.held import HOLDS, held_quantity, held_text, impact_quantity, impact_value
from ..scene.scene import Scene
from ..scene.schema import FIELDS, MEETING, SPEEDS, SPINS
from ..scene.user_model import Package, fields, unknown
from ..scene.values import array, carries_unit

T = TypeVar("T")


def of_one_length(arrays: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """1-D columns, single values repeated; InputError if lengths differ."""
    lengths = {name: array.size for name, array in arrays.items() if array.ndim and array.size != 1}
    size = next(iter(lengths.values()), 1)
    for name, length in lengths.items():
        if length != size:
            raise InputError(name, f"{length} values", f"{size} values, or one", "differs in length from the others")
    columns = arrays.items()
    return {name: array.reshape(-1) if array.size == size else np.full(size, array.item()) for name, array in columns}


def check_outputs(of: Sequence[str], choices: Sequence[str] = MAPPED) -> tuple[str, ...]:
    """The quantities to keep, with those that the limits of the model need; InputError for an unknown one."""
    names = check_names(of, choices, "of")
    return tuple(dict.fromkeys((*names, *NEEDS))) if VALIDITY in names else names


def checked_impact(
    scene: Scene, impact: Mapping[str, Any], most: int | None = 1, hold: str | None = None
) -> dict[str, np.ndarray]:
    """Impacts by dotted name, SI; defaults are the scene's. InputError if the scene has none.

    Arguments:
        hold: quantity that stands for the scene's speed: "speed", "stokes" or "relative_speed"; None for the scene's.
    """
    speeds = {name: values for name, values in impact.items() if name != "angle" and values is not None}
    if len(speeds) > 1:
        first, second, *_ = speeds
        accepted = f"only one of {', '.join(name.partition('.')[2] for name in SPEEDS)}"
        raise InputError(second, speeds[second], accepted, f"is given together with {first}")
    if not speeds:
        quantity = hold or impact_quantity(scene)
        value = None if quantity is None else impact_value(scene, quantity)
        if quantity is None or value is None:
            raise InputError("stokes", None, "Stokes numbers, speed or relative_speed, or an [impact] in the scene")
        speeds = {quantity: value}
    angle = scene.angle if impact.get("angle") is None else impact["angle"]
    if angle is None:
        raise InputError("angle", None, "angles in rad, or an [impact] in the scene")
    return {
        f"impact.{name}": checked_numbers(f"impact.{name}", values, most=most)
        for name, values in {**speeds, "angle": angle}.items()
    }


def checked_columns(
    scene: Scene | str | Path,
    impact: Mapping[str, Any],
    vary: Mapping[str, Any] | None,
    hold: str | None = None,
    most: int | None = 1,
    texts: bool = False,
) -> tuple[Scene, dict[str, np.ndarray], str]:
    """The scene, impacts and varied entries by dotted name (SI), and which quantity of the impact is held, in words.

    No quantity is held if nothing varies or if speeds are arguments; the text is empty then.

    Arguments:
        impact: `stokes`, `speed`, `relative_speed` and `angle`; None for the scene's.
        most: dimensions of a column; None for any number.
        texts: choices may vary as well.
    """
    loaded = scene if isinstance(scene, Scene) else Scene.load(scene)
    loaded, varied = checked_vary(loaded, {} if vary is None else vary, most=most, texts=texts)
    loaded = Scene.load(loaded)  # a model's quantities that do not vary are there
    quantity = held_quantity(loaded, hold)
    holds = (varied or hold) and not any(impact.get(name) is not None for name in HOLDS)
    columns = checked_impact(loaded, impact, most, quantity if holds else None) | varied
    return loaded, columns, held_text(loaded, quantity) if holds else ""


def checked_vary(
    scene: Scene, vary: Mapping[str, Any], label: str = "vary", most: int | None = 1, texts: bool = False
) -> tuple[Scene, dict[str, np.ndarray]]:
    """The scene and the columns of entries that vary other than the impact's speed and angle, SI.

    A spin or a model's missing quantity that varies becomes an entry. Values of `bridge.volume` with a unit
    are volumes in m^3 and plain numbers are V/R^3; the scene's own volume is turned into the same. InputError for a
    wrong entry.

    Arguments:
        most: dimensions; None for any number.
        texts: choices may vary as well.
    """
    vary = check_mapping(vary, label, "entries by dotted name, such as {'liquid.viscosity': [1.0, 2.0]}")
    package = scene.package
    missing = package.missing(scene.entries) if package is not None else ()
    tables = {name.partition(".")[0] for name in ("impact.", *scene.entries, *missing)}
    for name, values in vary.items():
        check_varies(name, values, label, package, texts)
        if "." in name and name.partition(".")[0] not in tables:
            accepted = ", ".join(entry for entry, _ in scene.given if entry not in MEETING)
            raise InputError(label, name, accepted, f"is of a table that the scene {scene.name} has not".strip())
    columns = {}
    for name, values in vary.items():
        entry = fields(package)[name]
        if entry.choices:
            columns[name] = checked_choices(name, values, entry)
            continue
        measured = bool(entry.or_unit) and carries_unit(values, name)
        column = columns[name] = checked_numbers(name, values, entry.measured if measured else entry, most)
        other_unit = entry.or_unit and scene.ways.volume != ("absolute" if measured else "relative")
        if column.size and (other_unit or (name in (*SPINS, *missing) and name not in scene.entries)):
            unit = f" {entry.or_unit}" if measured else ""
            texts_of = (f"{value!r}{unit}" if unit else value for value in column.ravel().tolist())
            # the first value that the scene accepts makes its entry of the same kind as the values
            scene = first_accepted(partial(scene.with_entries, {name: text}) for text in texts_of)
    return scene, columns


def first_accepted(attempts: Iterable[Callable[[], T]]) -> T:
    """The result of the first attempt that accepts its input; the InputError of the first where none does."""
    first: InputError | None = None
    for attempt in attempts:
        try:
            return attempt()
        except InputError as error:
            first = first or error
    assert first is not None  # there are attempts
    raise first


def check_varies(
    name: str, values: object, label: str = "vary", package: Package | None = None, texts: bool = False
) -> None:
    """Raise InputError unless the entry is a number (with `texts`, or a choice) and not the impact's speed or angle."""
    entries = fields(package)
    if name not in entries:
        raise unknown(name, values, package)
    if name in MEETING:
        problem = f"has an argument of its own, {name.removeprefix('impact.')}"
        raise InputError(label, name, "entries other than the impact's speed and angle", problem)
    if not (entries[name].numeric or (entries[name].choices and texts)):
        raise InputError(label, name, "entries that are numbers", "is a choice")


def checked_choices(name: str, values: Any, entry: Field) -> np.ndarray:
    """The values as an array of text of the same shape; InputError unless each is one of the entry's choices."""
    try:
        column = np.asarray(values, dtype=object)
    except Exception:  # noqa: BLE001 # whatever another library's conversion raises
        raise InputError(name, values, entry.accepts, "is not a list of names") from None
    names = column.ravel().tolist()
    # text is checked once for each distinct value; values of other types may not be hashable
    for value in dict.fromkeys(names) if all(isinstance(name, str) for name in names) else names:
        entry.read(value)
    return column.astype(str)


def checked_numbers(name: str, values: Any, entry: Field | None = None, most: int | None = 1) -> np.ndarray:
    """An array of SI numbers within the field's range; text carries its unit.

    Arguments:
        most: dimensions that it may have; None for any number.

    Raises:
        InputError: as `values.array`, and numbers outside the field's range.
    """
    entry = FIELDS[name] if entry is None else entry
    column = array(values, entry, name)
    if most is not None and column.ndim > most:
        raise InputError(name, f"{column.ndim} dimensions", "one dimension, or a single number", "is not accepted")
    # every range is an interval: if it holds the smallest and the largest value, it holds all
    ends = (float(column.min()), float(column.max())) if column.size else ()  # NaN if any value is
    if not all(math.isfinite(end) and entry.range.holds(end) for end in ends):
        for value in np.unique(column):
            entry.number(float(value))
    return column


def checked_span(name: str, values: Any) -> tuple[float, float]:
    """Two ascending SI numbers; InputError for anything else."""
    return ascending(name, checked_numbers(name, values))


def ascending(name: str, ends: np.ndarray) -> tuple[float, float]:
    """The ends of a range; InputError unless they are two that ascend."""
    if ends.shape != (2,) or not ends[0] < ends[1]:
        problem = "is not ascending" if ends.shape == (2,) else "is not a pair of numbers"
        raise InputError(name, ":".join(f"{end:g}" for end in ends.reshape(-1)), "LO:HI with LO below HI", problem)
    return float(ends[0]), float(ends[1])
