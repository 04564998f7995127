"""The emitted modules for another library's expressions: copies whose elementary functions are that library's."""

from collections.abc import Callable
from importlib.util import find_spec, module_from_spec
from types import ModuleType, SimpleNamespace
from typing import Any

from wetdoublet.solvers.model.key import ModelKey

_GENERATED = "wetdoublet.generated"
_FUNCTIONS = ("exp", "log", "sqrt", "sin", "cos", "tan", "atan", "fmax", "fmin")


def translated(choice: ModelKey, function: Callable[[str], Callable[..., Any]]) -> tuple[ModuleType, Any]:
    """The structure module of a choice, and its laws as attributes by slot.

    Arguments:
        function: gives the elementary function of a name.
    """
    laws = {slot: _copy(f"laws.{slot}_{law.replace('-', '_')}", function) for slot, law in choice.laws}
    return _copy(choice.structure, function), SimpleNamespace(**laws)


def _copy(name: str, function: Callable[[str], Callable[..., Any]]) -> ModuleType:
    spec = find_spec(f"{_GENERATED}.{name}")
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    for word in _FUNCTIONS:
        if hasattr(module, word):
            setattr(module, word, function(word))
    return module
