"""What a model file declares of a law, judged on the spot."""

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import sympy as sp

from ..physics.law import RANGES, Law, Range
from ..physics.references import Reference
from ..physics.slots import SLOTS, places
from .declarations import Formula, ModelFileError, Proposed, Source, check_texts, declarations, read_expression

_LAW_NAME = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
_BIBTEX = re.compile(r"\s*@\w+\s*\{[^{},]+,.*\}\s*", re.S)
_PUBLICATION = 'authors as ("Family, Initials", ...), the year as a whole number, all else as text'


def published(source: Source, remark: str = "") -> tuple[Any, tuple[Reference, ...]]:
    """A source in words, and its publications."""
    named = source if isinstance(source, tuple) else (source,)
    publications = tuple(item for item in named if isinstance(item, Reference))
    if publications != named:
        return source + remark if isinstance(source, str) else source, ()  # what is no text is refused as one
    for work in publications:
        texts = [work.key, work.title, work.journal, work.abbreviated, work.volume, work.pages, work.doi]
        authors = work.authors if isinstance(work.authors, tuple) and work.authors else (None,)
        if not all(isinstance(text, str) for text in (*texts, *authors)) or not isinstance(work.year, int):
            raise ModelFileError("source", work, _PUBLICATION, "has a part of another kind")
    return "; ".join(item.short for item in publications) + remark, publications


def law(
    slot: str,
    name: str,
    *,
    source: Source = "",
    remark: str = "",
    bibtex: str = "",
    meaning: str = "",
    accept: tuple[str, ...] = (),
    validity: Mapping[str, Range] | None = None,
    falls: bool = False,
    spread: bool = False,
    **functions: object,
) -> None:
    """Declare a law.

    Arguments:
        slot: the slot that it fills.
        name: its name in scenes.
        source: its origin, text or publications.
        remark: what is said after them.
        bibtex: the publication as a BibTeX entry, for `wetdoublet cite`.
        meaning: a description in one line.
        accept: names of checks that it is known to fail.
        validity: (least, largest) of `volume`, `contact_angle` (rad) and `separation` (gap over R) for which its source
            gives it, None for no bound; outside of it a warning is given.
        falls: the slot's first function never increases with its first argument, as some certificates require; checked.
        spread: of a film, its rim follows the bridge's volume: its functions take `aspect` and `V` beside the gap.
        functions: the slot's functions as expressions or `Formula`: of the slot's dimension in SI, or dimensionless.

    Raises:
        ModelFileError: names the wrong argument and what is accepted.
    """
    model, label = declarations(), f"law {slot} {name}"
    if slot not in SLOTS:
        raise ModelFileError("law", slot, "a slot: " + ", ".join(SLOTS), "is not a slot")
    if not isinstance(name, str) or not _LAW_NAME.fullmatch(name):
        raise ModelFileError(f"law {slot}", name, "a name of small letters, digits and single dashes")
    if name in model.taken.get(slot, ()):
        raise ModelFileError(f"law {slot}", name, "a name of your own", "is a law of the library")
    if (slot, name) in model.laws:
        raise ModelFileError(f"law {slot}", name, "each name once", "is declared twice")
    if slot == "attraction" and not model.library and any(other == slot for other, _ in model.laws):
        raise ModelFileError(f"law {slot}", name, "one law in a file", "is a second one, which no entry chooses")
    by_name = {place.function: place for place in places().values() if place.slot == slot}
    for foreign in functions.keys() - by_name.keys():
        raise ModelFileError(label, foreign, "the functions " + ", ".join(by_name), "is no function of this slot")
    for missing in (function for function, place in by_name.items() if place.required and function not in functions):
        raise ModelFileError(f"{label}.{missing}", None, f"{missing} = an expression", "is missing")
    for option, value in (("falls", falls), ("spread", spread)):
        if not isinstance(value, bool):
            raise ModelFileError(f"{label}.{option}", value, "True, False")
    if not isinstance(accept, tuple | list) or not all(isinstance(check, str) for check in accept):
        raise ModelFileError(
            f"{label}.accept", accept, 'names of checks, as ("angular momentum",)', "is no list of them"
        )
    if spread and slot != "film":
        raise ModelFileError(f"{label}.spread", spread, "no such argument", "is of a film")
    formulas = {f: _formula(f"{label}.{f}", functions[f]) for f in by_name if f in functions}
    if "suction" in formulas and formulas["suction"].expression != 0:
        suction = str(formulas["suction"].expression)
        raise ModelFileError(f"{label}.suction", suction, "0, or no suction", "is not what cavitation leaves")
    origin, references = published(source, str(remark))
    check_texts(label, source=origin, remark=remark, bibtex=bibtex, meaning=meaning)
    if bibtex and not _BIBTEX.fullmatch(bibtex):
        raise ModelFileError(f"{label}.bibtex", bibtex, "an entry such as @article{key, author = {...}, ...}")
    meaning, origin = meaning or f"{name}, a user's law", origin or "no source given"
    if not isinstance(validity, Mapping | None):
        raise ModelFileError(f"{label}.validity", validity, "ranges by name: " + ", ".join(RANGES), "is no mapping")
    for quantity, ends in (validity or {}).items():
        if quantity not in RANGES:
            raise ModelFileError(f"{label}.validity", quantity, ", ".join(RANGES), "has no range")
        if not _is_range(ends):
            raise ModelFileError(f"{label}.validity", ends, "(least, largest), a number each, or None")
    valid = tuple((name, validity[name]) for name in RANGES if validity and name in validity)
    declared = Law(slot, name, meaning, origin, (), valid, references, spread)
    model.laws[slot, name] = Proposed(declared, formulas, tuple(accept), bibtex, falls)


def _is_range(ends: object) -> bool:
    """Whether these are two ends, finite numbers or None, of which the first is below the second."""
    if not isinstance(ends, tuple | list) or len(ends) != 2:
        return False
    bounds = [sp.sympify(end) for end in ends if end is not None]
    return all(end.is_number and end.is_finite for end in bounds) and (len(bounds) < 2 or bool(bounds[0] < bounds[1]))


def _formula(label: str, value: object) -> Formula:
    """A function of a law as it is declared, its expression and its texts judged."""
    formula = value if isinstance(value, Formula) else Formula(value)
    check_texts(label, doc=formula.doc, source=published(formula.source, formula.remark)[0])
    return replace(formula, expression=read_expression(label, formula.expression))
