"""Models of all structures, derived once a session; and derivations with one thing deliberately wrong."""

import ast
import sys
from collections.abc import Callable, Iterator
from functools import cache
from importlib.util import resolve_name
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from wetdoublet.derive.equations.certificates.table import CERTIFICATES
from wetdoublet.derive.equations.model import Model, derive
from wetdoublet.derive.physics.structure import FREE, Structure, structures
from wetdoublet.solvers.verify.report import Finding
from wetdoublet.solvers.verify.verdicts import findings

_ROOT = derive.__module__.rsplit(".", 2)[0]
# What is remembered of forces and models; mechanics, laws and scaling are functions of their arguments alone.
_DERIVED = ("physics.forces", "physics.slots", "equations", "checks")


@pytest.fixture(scope="session")
def models() -> dict[str, Model]:
    """The model of each structure by name."""
    return {structure.name: derive(structure) for structure in structures()}


@pytest.fixture(scope="session")
def healthy() -> dict[str, Finding]:
    """Every check of the library's derivation, by name: the package's verdicts, which a test of theirs proves again."""
    return {finding.name: finding for finding in findings({})}


def _modules() -> list[ModuleType]:
    return [module for name, module in sys.modules.items() if name.startswith(_ROOT)]


@cache
def _imports(name: str) -> set[str]:
    """Modules of the derivation that a module imports anywhere in its text."""
    module = sys.modules[name]
    found = set()
    for node in ast.walk(ast.parse(Path(str(module.__file__)).read_text())):
        if isinstance(node, ast.ImportFrom):
            source = resolve_name("." * node.level + (node.module or ""), str(module.__package__))
            found |= {source, *(f"{source}.{alias.name}" for alias in node.names)}
    return {each for each in found if each.startswith(_ROOT) and each in sys.modules}


def _users(name: str) -> set[str]:
    """A module and all that import it, directly or by others."""
    users, before = {name}, 0
    while len(users) > before:
        before = len(users)
        users |= {module.__name__ for module in _modules() if _imports(module.__name__) & users}
    return users


def _forget(users: set[str]) -> None:
    """Clear what these modules remember of forces and models."""
    for module in _modules():
        if module.__name__ in users and module.__name__.removeprefix(f"{_ROOT}.").startswith(_DERIVED):
            for value in list(vars(module).values()):
                if hasattr(value, "cache_clear") and value.__module__ == module.__name__:
                    value.cache_clear()


@pytest.fixture
def mutate(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[Any, Any], None]]:
    """Put a wrong function in place of a right one, in every module of the derivation that imported it, and in rows."""
    users: set[str] = set()

    def replace(right: Any, wrong: Any) -> None:
        holders = [vars(each) for each in (*_modules(), *CERTIFICATES)]
        places = [(holder, name) for holder in holders for name, value in holder.items() if value is right]
        assert places
        users.update(_users(right.__module__))
        _forget(users)
        for holder, name in places:
            monkeypatch.setitem(holder, name, wrong)

    yield replace
    monkeypatch.undo()
    _forget(users)


@pytest.fixture
def few_structures(mutate: Callable[[Any, Any], None]) -> None:
    """A wrong derivation is derived for three structures that have, together, every state, force and event."""
    few = (FREE, Structure(True, True, False, reduced=True), Structure(True, False, True))
    mutate(structures, lambda: few)
