"""One emitted module by name, for what is derived when it is first needed."""

from __future__ import annotations

from pathlib import Path

from ..laws import LAWS
from ..model import derive
from ..modelfile import read
from ..structure import Structure, known
from .modules import law_module, structure_module
from .user import own_names


def named(name: str) -> Structure:
    """The structure whose module has this name; KeyError if there is none."""
    return {each.name: each for each in known()}[name]


def structure_text(name: str) -> str:
    """Text of a structure's module."""
    return structure_module(derive(named(name)))


def law_text(slot: str, name: str) -> str:
    """Text of a law's module."""
    return law_module(LAWS[slot][name])


def user_structure_text(source: str, model: str, name: str) -> str:
    """Text of a structure's module with the calls of a user's model, from the text of the model file."""
    found = read(Path(f"{model}.py"), source, model)
    return structure_module(found.extended(derive(named(name))), own_names(found))
