"""What a model file changes in the equations, against the library or the file as it was."""

import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from ..emit.casadi.modules import groups_module, law_module, structure_module
from ..emit.compare import compare, count, equations, in_lines
from ..emit.document.document import EFFECTS, watched
from ..emit.document.theory import DEFAULTS
from ..emit.user import own_names
from ..laws import LAWS, Law
from ..laws.modelfile import read
from ..physics.scaling import ScalingError
from ..physics.structure import BRIDGED, Structure
from ..user.declarations import Declarations, ModelFileError
from ..user.structures import UserModel
from ..vocabulary.dimensions import DimensionError
from .words import conserved

LIBRARY = UserModel("the library", "", Declarations(), (), (), (), {})


def earlier(file: Path) -> UserModel:
    """The model of a file that was emitted before; the library's if there is none, or it is none any more."""
    try:
        return replace(read(file, name="before"), name=f"{file.parent}{os.sep}")
    except (ModelFileError, DimensionError, ScalingError):
        return LIBRARY


def changed(before: UserModel, after: UserModel) -> list[str]:
    """Lines on the terms of the equations that differ, and on what is declared that came or went."""
    models = (before, after)
    laws = tuple(dict.fromkeys((law.slot, law.name) for model in reversed(models) for law in model.laws))
    slots, spread = {slot for slot, _ in laws}, any(law.spread for model in models for law in model.laws)
    shape = replace(BRIDGED, strings="strings" in slots, attraction="attraction" in slots, spread=spread)
    changes = compare(*(equations(_texts(model, shape, laws)) for model in models))
    lines = [f"Against {before.name}, {count(changes)}" + (":" if changes else "."), *in_lines(changes), ""]
    old, new = (list(_listed(model)) for model in models)
    for kind in ("law", "quantity", "term", "group", "event", "criterion", "conserved"):
        rows = [("removed", text) for heading, text in old if heading == kind and (heading, text) not in new]
        rows += [("added", text) for heading, text in new if heading == kind and (heading, text) not in old]
        lines += [f"{kind:<10} {word:<8} {text}".rstrip() for word, text in rows or [("as before", "")]]
    return lines


def _texts(model: UserModel, shape: Structure, laws: tuple[tuple[str, str], ...]) -> dict[str, str]:
    """Emitted modules of a structure, of the laws of these names or what acts in their place, and of groups."""
    texts = {"": structure_module(model.derived(shape), own_names(model))}
    slots = [slot for slot, _ in laws]
    for slot, name in laws:
        if law := _law(model, slot, name):
            texts[slot if slots.count(slot) == 1 else f"{slot} {name}"] = law_module(law)
    definitions = {group.symbol: group.definition for group in model.groups if group.definition != group.symbol}
    return texts | ({"scaling": groups_module(definitions, own_names(model), "", "")} if definitions else {})


def _law(model: UserModel, slot: str, name: str) -> Law | None:
    its = {law.name: law for law in model.laws if law.slot == slot}
    library = LAWS[slot].get(name) or LAWS[slot].get(DEFAULTS.get(slot, ""))
    return its.get(name) or next(iter(its.values()), library)


def _listed(model: UserModel) -> Iterator[tuple[str, str]]:
    yield from (("law", f"{law.slot} {law.name}") for law in model.laws)
    for item in model.declarations.quantities.values():
        default = "" if item.default is None else f", default {item.default}"
        yield "quantity", f"{item.symbol} [{item.unit}] {item.bounds.text}{default}"
    yield from (("term", f"energy {energy}") for energy in model.declarations.energies)
    yield from (("term", f"force on the {on}: {force}") for on, force in model.declarations.forces)
    yield from (("criterion", f"{criterion.word}: at a gap of {criterion.gap}") for criterion in model.criteria)
    for group in model.groups:
        yield "group", f"{group.symbol}" + (f" = {group.definition}" if group.definition != group.symbol else "")
    for event in model.events:
        row = event.proposed.row
        yield "event", f"{event.proposed.word}: watched {watched(row)}; {EFFECTS[event.proposed.ends]}"
    yield from (("conserved", text) for text in conserved(model))
