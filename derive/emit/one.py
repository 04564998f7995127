"""Text of a single emitted module by name, for modules derived on first use."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import sympy as sp

from ..equations.model import derive
from ..physics.laws import LAWS
from ..physics.laws.base import Law
from ..physics.structure import Structure, known
from ..user_model.modelfile import read
from ..user_model.structures import UserModel
from ..vocabulary.quantities import normal_velocity
from .casadi import modules
from .casadi.automaton import provenance
from .casadi.printer import EmissionError
from .taylor.automaton import automaton_header, effects_header
from .taylor.header import Beside
from .taylor.law_slopes import UNUSED
from .user import own_names


def named(name: str) -> Structure:
    """The structure whose module has this name; KeyError if there is none."""
    return {each.name: each for each in known()}[name]


def structure_text(name: str) -> str:
    """Text of a structure's module."""
    return modules.structure_module(derive(named(name)))


def user_structure_text(source: str, model: str, name: str) -> str:
    """Text of a structure's module with the calls of a user's model, given as the text of the model file."""
    result = read(Path(f"{model}.py"), source, model)
    return modules.structure_module(result.extended(derive(named(name))), own_names(result))


def structure_header_text(name: str) -> str:
    """Text of a structure's C header for the kernel; `#error` and a sentence if it has none."""
    try:
        return modules.structure_kernel(derive(named(name)))
    except EmissionError as error:
        return _none(error)


def structure_tangent_text(name: str) -> str:
    """Text of the C header of a structure's tangent; `#error` and a sentence if it has none."""
    try:
        return modules.structure_tangent(derive(named(name)))
    except EmissionError as error:
        return _none(error)


def user_structure_header_text(source: str, model: str, name: str, tangent: bool = False) -> str:
    """Text of the C header of a structure, or of its tangent, with the calls and groups of a user's model."""
    result = read(Path(f"{model}.py"), source, model)
    own = own_names(result)
    meanings = {name: meaning for name, (_, meaning) in own.items()}
    beside = Beside({group.symbol: group.definition for group in result.groups}, meanings, result.extra, result.events)
    if tangent and result.events:
        return _none(EmissionError("declared events have no derivatives in C"))
    try:
        extended = result.extended(derive(named(name)))
        return (
            modules.structure_tangent(extended, beside) if tangent else modules.structure_kernel(extended, own, beside)
        )
    except EmissionError as error:
        return _none(error)


def user_law_header_text(source: str, model: str, slot: str, name: str, slopes: bool = False) -> str:
    """Text of a law's C header, or of that with its derivatives, as the structures of a user's model call it.

    The law may be one of the model or of the library.
    """
    result = read(Path(f"{model}.py"), source, model)
    groups = {group.symbol for group in result.groups}
    header = modules.law_slopes if slopes else modules.law_kernel
    try:
        for law in result.laws:
            if (law.slot, law.name) == (slot, name):
                return header(law, groups)
        law, beside = _wide(LAWS[slot][name], result)
        return header(law, groups | beside)
    except EmissionError as error:
        return _none(error, f"law {slot} {name}: ")


def user_automaton_texts(source: str, model: str) -> tuple[str, str]:
    """Texts of the C headers of the automaton with a user's events: enumerations, and the switch over effects."""
    own = [event.proposed.row for event in read(Path(f"{model}.py"), source, model).events]
    meanings = [event.proposed.meaning for event in read(Path(f"{model}.py"), source, model).events]
    return automaton_header(provenance(), own, meanings), effects_header(provenance(), own)


def _wide(law: Law, model: UserModel) -> tuple[Law, set[sp.Symbol]]:
    """A law of the library that ignores a model's additional arguments, and the constant ones among these."""
    still: set[sp.Symbol] = set()
    functions = []
    for each in law.functions:
        passed = model.extra.get(f"{law.slot}.{each.name}", ())
        marks = {event.mark for event in model.events}
        unused = tuple(sp.Symbol(f"{UNUSED}{symbol.name}", real=True) for symbol in passed)
        still |= {own for own, symbol in zip(unused, passed, strict=True) if symbol not in {normal_velocity, *marks}}
        functions.append(replace(each, arguments=(*each.arguments, *unused)))
    return replace(law, functions=tuple(functions)), still


def _none(error: EmissionError, where: str = "") -> str:
    return f"#error {where}{' '.join(str(error).split())}\n"
