"""What stands at the head of an emitted file: its origin, the digest of its equations, and what it describes."""

import hashlib
from collections.abc import Mapping
from functools import cache

import sympy as sp

from ..equations.model import Model
from ..physics.law import Law
from ..vocabulary.quantities import VOCABULARY

PROVENANCE = "Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`."


def digest(*parts: object) -> str:
    """SHA-256 of the mathematics of a module (srepr, not source text)."""
    text = "\n".join(sp.srepr(item) if isinstance(item, sp.Basic) else str(item) for item in parts)
    return hashlib.sha256(text.encode()).hexdigest()


def header(source: str) -> str:
    """The first lines of an emitted file, with the digest of its equations."""
    return f"{PROVENANCE}\nEquations sha256 {source}"


def law_digest(law: Law) -> str:
    """Digest of a law's mathematics."""
    parts: list[object] = [law.slot, law.name]
    for function in law.functions:
        parts += [function.name, *function.arguments, function.result]
        parts += [term for pair in function.definitions for term in pair]
    return digest(*parts)


@cache
def model_digest(model: Model) -> str:
    """Digest of a structure's mathematics."""
    parts: list[object] = [model.structure.name, *model.states, *model.groups, *model.slots]
    parts += [term for pair in model.definitions for term in pair]
    for function in model.functions:
        parts += [function.name, *(term for pair in function.outputs for term in pair)]
    return digest(*parts)


Own = Mapping[str, tuple[str, str]]
"""Unit and meaning, by name, of groups that are not the vocabulary's."""


def describe(model: Model, additions: Own) -> str:
    """The structure, its states, groups and slots, in words."""
    shape = model.structure
    what = {
        "": "Oblique" if shape.oblique else "Head-on",
        "pair": "Oblique unequal",
        "wall": "Oblique sphere-wall",
        "space": "Spatial",
    }
    words = {"a liquid bridge": shape.bridge, "pendulum strings": shape.strings, "another attraction": shape.attraction}
    extras = [word for word, present in words.items() if present]
    title = f"{what[shape.partner]} doublet" + (f" with {' and '.join(extras)}" if extras else " with a film only")
    if shape.spread:
        title += ", a film whose rim follows the bridge's volume"
    if shape.reduced:
        title += ", spin eliminated through the conserved angular momentum"
    meanings = {name: (quantity.unit, quantity.meaning) for name, quantity in VOCABULARY.items()} | dict(additions)
    states, groups = (
        [f"- {symbol.name} [{meanings[symbol.name][0]}]: {meanings[symbol.name][1]}" for symbol in symbols]
        for symbols in (model.states, model.groups)
    )
    slots = f"Law slots: {', '.join(model.slots)}."
    return "\n".join([f"{title}.", "", "Time in x0/v0. States (per unit):", *states, "", "Groups:", *groups, "", slots])
