"""The library's laws, declared as a user's are: one published law or family of laws a file.

`LAWS[slot][name]` has every selectable law. Equations call a law through its slot, so eight bridge laws are eight small
modules and not eight copies of the equations. Files in this folder are found; `modelfile` reads those of users.
"""

from importlib import import_module
from pkgutil import iter_modules
from types import ModuleType

from ..equations.store import stored
from ..physics.law import Law, LawFunction, fill, filled, is_slot_call, slot_call, slot_calls
from ..physics.slots import SLOTS
from ..user.declarations import collecting
from ..user.structures import express

_FIRST = ("mikami", "mikami_log10", "willett", "lambert", "soulie", "constant")
"""Files of laws in the order in which lists have them; any other follows by its name."""


def files() -> list[str]:
    """Names of the files of laws, in the order of lists."""
    names = sorted({module.name for module in iter_modules(__path__)} - {"modelfile"})
    return sorted(names, key=lambda name: _FIRST.index(name) if name in _FIRST else len(_FIRST))


def _library() -> dict[str, dict[str, Law]]:
    result: dict[str, dict[str, Law]] = {slot: {} for slot in SLOTS}
    for name in files():
        with collecting(library=True) as declared:
            import_module(f".{name}", __package__)
        for law in express(name, "", declared).laws:
            result[law.slot][law.name] = law
    return result


LAWS = stored("laws", _library)
__all__ = ["LAWS", "Law", "LawFunction", "fill", "filled", "is_slot_call", "slot_call", "slot_calls"]


def __getattr__(name: str) -> ModuleType:
    """A file of laws, not imported so far where `LAWS` come from the store; what it declares are not a model file's."""
    if name not in files():
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    with collecting(library=True):
        return import_module(f".{name}", __package__)
