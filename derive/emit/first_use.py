"""Text of a single emitted module by name, for modules derived on first use."""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import sympy as sp

from ..equations.model import derive
from ..laws import LAWS, Law
from ..laws.modelfile import read
from ..physics.structure import Structure, all_structures
from ..user.structures import UserModel
from ..vocabulary.quantities import normal_velocity
from .casadi import modules
from .casadi.automaton import provenance
from .casadi.printer import EmissionError
from .interval import header as interval
from .taylor.automaton import automaton_header, effects_header
from .taylor.header import Beside, structure_header
from .taylor.law_header import law_header
from .taylor.law_slopes import UNUSED, slopes_header
from .taylor.tangent import tangent_header
from .user import own_names


def named(name: str) -> Structure:
    """The structure whose module has this name; KeyError if there is none."""
    return {structure.name: structure for structure in all_structures()}[name]


@lru_cache(maxsize=2)  # the headers of a model follow each other
def _model(source: str, name: str) -> UserModel:
    return read(Path(f"{name}.py"), source, name)


def structure_text(name: str) -> str:
    """Text of a structure's module."""
    return modules.structure_module(derive(named(name)))


def user_structure_text(source: str, model: str, name: str) -> str:
    """Text of a structure's module with the calls of a user's model, given as the text of the model file."""
    user_model = _model(source, model)
    return modules.structure_module(user_model.derived(named(name)), own_names(user_model))


def header_text(kind: str, name: str) -> str:
    """Text of a C header; `#error` and a sentence if there is none.

    Arguments:
        kind: its folder below `generated`: "taylor", "taylor/tangent" or "interval" of structures, "interval/laws".
        name: of the structure's module or the law's.
    """
    if kind == "interval/laws":
        (law,) = (law for laws in LAWS.values() for law in laws.values() if law.module == name)
        return _or_error(lambda: interval.law_header(law))
    emit = {"taylor": structure_header, "taylor/tangent": tangent_header, "interval": interval.structure_header}[kind]
    return _or_error(lambda: emit(derive(named(name))))


def user_structure_header_text(source: str, model: str, name: str, tangent: bool = False) -> str:
    """Text of the C header of a structure, or of its tangent, with the calls and groups of a user's model."""
    user_model = _model(source, model)
    groups = {group.symbol: group.definition for group in user_model.groups} | user_model.gaps
    beside = Beside(groups, own_names(user_model), user_model.extra, user_model.events)

    def text() -> str:
        if tangent and user_model.events:
            raise EmissionError("declared events have no derivatives in C")
        extended = user_model.derived(named(name))
        return tangent_header(extended, beside) if tangent else structure_header(extended, beside)

    return _or_error(text)


def user_law_header_text(source: str, model: str, slot: str, name: str, slopes: bool = False) -> str:
    """Text of a law's C header, or of that with its derivatives, as the structures of a user's model call it.

    The law may be one of the model or of the library.
    """
    user_model, header = _model(source, model), slopes_header if slopes else law_header
    groups = {group.symbol for group in user_model.groups}
    law = next((candidate for candidate in user_model.laws if (candidate.slot, candidate.name) == (slot, name)), None)
    if law is None:
        law, beside = _with_ignored_arguments(LAWS[slot][name], user_model)
        groups |= beside
    return _or_error(lambda: header(law, groups), f"law {slot} {name}: ")


def user_automaton_text(source: str, model: str, effects: bool) -> str:
    """Text of a C header of the automaton with a user's events: its enumerations, or the switch over `effects`."""
    events = [event.proposed for event in _model(source, model).events]
    rows, meanings = [event.row for event in events], [event.meaning for event in events]
    return effects_header(provenance(), rows) if effects else automaton_header(provenance(), rows, meanings)


def _with_ignored_arguments(law: Law, model: UserModel) -> tuple[Law, set[sp.Symbol]]:
    """A library law that takes and ignores a model's additional arguments; those of them that stay constant."""
    constant_extras: set[sp.Symbol] = set()
    varying = {normal_velocity, *(event.mark for event in model.events)}
    functions = []
    for function in law.functions:
        extra = model.extra.get(f"{law.slot}.{function.name}", ())
        unused = tuple(sp.Symbol(f"{UNUSED}{symbol.name}", real=True) for symbol in extra)
        constant_extras |= {dummy for dummy, symbol in zip(unused, extra, strict=True) if symbol not in varying}
        functions.append(replace(function, arguments=(*function.arguments, *unused)))
    return replace(law, functions=tuple(functions)), constant_extras


def _or_error(text: Callable[[], str], where: str = "") -> str:
    try:
        return text()
    except EmissionError as error:
        return f"#error {where}{' '.join(str(error).split())}\n"
