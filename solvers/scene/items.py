"""Items of results, declared once with meaning, unit and heading; docstrings, Datasets and tables are made of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..formatting.labelled import Column
from ..results import DEFINITIONS, FAILED, Definition, outcome_attributes

OUTCOME = "outcome"
"""Stands for the unit of outcomes, which are names in a result and codes in a Dataset."""

_ABSENT = {
    "sliding": "; None where the centres have no tangential velocity",
    "slipping": "; None where there is none before",
}


@dataclass(frozen=True)
class Item:
    """What `item` declares."""

    meaning: str
    unit: str
    head: str
    cell: Callable[[Any], str]


def item(meaning: str, unit: str = "", head: str = "", cell: Callable[[Any], str] = str, **options: Any) -> Any:
    """A field of a result.

    Arguments:
        meaning: what it is, for the docstring; a Dataset has what stands before a colon.
        unit: "1" of a number without, `OUTCOME` of an outcome; "" of anything that is no number.
        head: of its column in a table.
        cell: its value as text there.
        options: of `dataclasses.field`.
    """
    return field(metadata={"item": Item(meaning, unit, head, cell)}, **options)


def items(kind: type) -> dict[str, Item]:
    """The items that a class declares, by name."""
    return {entry.name: entry.metadata["item"] for entry in fields(kind) if "item" in entry.metadata}


def units(kind: type) -> dict[str, str]:
    """Units of the items that are numbers."""
    return {name: about.unit for name, about in items(kind).items() if about.unit not in ("", OUTCOME)}


def documented(kind: type, of: str = "") -> str | None:
    """The docstring of a class with the meanings of its own fields, declared as items or as results of a collision.

    Arguments:
        of: what stands before their names in `DEFINITIONS`.
    """
    about: dict[str, Item | Definition] = {**items(kind)}
    about |= {name: DEFINITIONS[of + name] for name in kind.__annotations__.keys() - about if of + name in DEFINITIONS}
    lines = [f"\n        {name}: {_sentence(about[name])}." for name in kind.__annotations__ if name in about]
    if not kind.__doc__ or not lines:
        return kind.__doc__
    text, example, code = kind.__doc__.partition("\n\n    Example:")
    head = "" if "Attributes:" in text else "\n\n    Attributes:"
    return "".join([text.rstrip(), head, *lines, example, code])


def _sentence(about: Item | Definition) -> str:
    unit = "" if about.unit in ("", "1", OUTCOME) else f", {about.unit}"
    return about.meaning + unit + (_ABSENT.get(about.exists, "") if isinstance(about, Definition) else "")


def cells(rows: Sequence[Any], names: Sequence[str] = ()) -> tuple[list[str], list[list[str]]]:
    """Head and rows of the table of these items, or of all that have a head; a column without any text is left out."""
    about = {name: declared for name, declared in items(type(rows[0])).items() if declared.head}
    columns = {name: [about[name].cell(getattr(row, name)) for row in rows] for name in names or about}
    columns = {about[name].head: texts for name, texts in columns.items() if any(texts)}
    return list(columns), [list(texts) for texts in zip(*columns.values(), strict=True)]


def csv(columns: Mapping[str, Any], units: Mapping[str, str], **options: Any) -> str:
    """Columns as the text of a CSV file, units in the header; a cell without a value is empty.

    Arguments:
        options: of `pandas.DataFrame.to_csv`.
    """
    from pandas import DataFrame

    frame = DataFrame(columns)
    heads = {name: f"{name} [{unit}]" for name, unit in units.items() if unit != "1"}
    return str(frame.rename(columns=heads).to_csv(index=False, lineterminator="\n", **options))


def columns(kind: type, rows: Sequence[Any], names: Sequence[str], *over: str) -> dict[str, Column]:
    """Items of results as columns of a Dataset; over two dimensions, of lists of results or values."""
    about = items(kind)
    return {name: (over, *_column(about[name], [_values(row, name) for row in rows], len(over) > 1)) for name in names}


def _values(row: Any, name: str) -> Any:
    return [getattr(member, name) for member in row] if isinstance(row, tuple) else getattr(row, name)


def _column(about: Item, values: Sequence[Any], is_list: bool) -> tuple[np.ndarray, Mapping[str, Any]]:
    """The array of a column, lists filled up to one length with NaN, "" or -1, and its attributes."""
    meaning = about.meaning.partition(": ")[0]
    attributes: Mapping[str, Any] = {"units": about.unit, "long_name": meaning}
    filler: Any = np.nan
    dtype: type = float
    if about.unit == OUTCOME:
        attributes, filler, dtype = outcome_attributes(meaning, "none"), FAILED, np.int8
        values = [list(map(OUTCOMES.index, row)) if is_list else OUTCOMES.index(row) for row in values]
    elif not about.unit:
        attributes, filler, dtype = {"long_name": meaning}, "", str
    if is_list:
        longest = max(map(len, values), default=0)
        values = [[*row, *[filler] * (longest - len(row))] for row in values]
        return np.array(values, dtype).reshape(len(values), longest), attributes
    return np.array(values, dtype), attributes
