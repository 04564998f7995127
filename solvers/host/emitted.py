"""Emitted modules of the library by name, verified against the manifest; uncommitted ones are derived on first use.

Derived modules are cached for the user under a digest of the derivation's sources and versions, so that sympy is
needed only once. Modules are imported only from `generated/` and from the cache.
"""

import ast
import hashlib
import json
import re
import threading
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from ..errors import CheckFailed

_PACKAGE = f"{__package__.rsplit('.', 2)[0]}.generated"
_FOLDER = Path(__file__).resolve().parents[2] / "generated"
DERIVE = _FOLDER.with_name("derive")
_IMPORTED = re.compile(r"^from \.(\w+) import", re.MULTILINE)  # structures whose functions a structure has too
_INCLUDED = re.compile(r'^#include "(shared/\w+\.h)"\n', re.MULTILINE)
DERIVING = threading.RLock()  # sympy is not thread-safe


def _laws() -> Mapping[str, Mapping[str, Sequence[str]]]:
    """The laws of the library by slot and name, with their features: functions that others lack, and properties.

    There are none where this file is missing or broken, so that `generate` can write it; see `check_laws`.
    """
    try:
        return defaultdict(dict, json.loads((_FOLDER / "laws.json").read_bytes()))
    except (OSError, ValueError):
        return defaultdict(dict)


LAWS = _laws()


def check_laws() -> None:
    """Raise CheckFailed unless the table of laws is what was emitted."""
    _verified("laws.json")


@cache
def manifest() -> dict[str, Any]:
    """The library's manifest (digests of the emitted files)."""
    content: dict[str, Any] = json.loads((_FOLDER / "manifest.json").read_bytes())
    return content


@cache
def library_digest() -> str:
    """Digest of the manifest, and so of all laws and structures of the library."""
    return hashlib.sha256((_FOLDER / "manifest.json").read_bytes()).hexdigest()


def law(slot: str, name: str) -> ModuleType:
    """The module of a law of the library."""
    return module(f"laws.{slot}_{name.replace('-', '_')}")


@cache
def module(name: str) -> ModuleType:
    """An emitted module of the library; CheckFailed if its file was changed after it was emitted.

    Arguments:
        name: dotted name below `generated`; a structure that is not committed is derived.
    """
    path = name.replace(".", "/") + ".py"
    if not committed(path):
        return executed(f"{_PACKAGE}.{name}", text(name).encode())
    for file in (path, "assemble.py", "scaling.py", "automaton.py", "laws.json"):
        _verified(file)
    for home in _IMPORTED.findall((_FOLDER / path).read_text(encoding="utf-8")):
        _verified(f"{home}.py")
    return import_module(f"{_PACKAGE}.{name}")


def text(name: str) -> str:
    """Text of an emitted module of the library, not executed, with all its functions. Errors: see `module`."""
    path = name.replace(".", "/") + ".py"
    if committed(path):
        return with_imports(_read(path), lambda home: _read(f"{home}.py"))
    if "." in name:  # all laws are committed
        raise CheckFailed(f"generated/{path} is neither there nor can it be derived; run `wetdoublet generate`")
    return derived_once(f"{name}.py", "structure_text", name)


def with_imports(module: str, read: Callable[[str], str]) -> str:
    """Text of a structure's module with the functions that it imports from other structures.

    Arguments:
        module: the text.
        read: the text of another structure's module, by name.
    """
    for node in ast.parse(module).body:
        if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module:
            names, home = {alias.name for alias in node.names}, read(node.module)
            for statement in ast.parse(home).body:
                if isinstance(statement, ast.FunctionDef) and statement.name in names:
                    module += f"\n\n{ast.get_source_segment(home, statement)}\n"
    return module


def header(path: str) -> str:
    """Text of an emitted C header (path below `generated`) with its shared functions, verified.

    It is derived if it is not committed.
    """
    if committed(path):
        return _INCLUDED.sub(lambda shared: _read(f"taylor/{shared[1]}").partition("*/\n")[2], _read(path))
    kind, name = path.removesuffix(".h").rsplit("/", 1)
    return derived_once(f"{kind.replace('/', '-')}-{name}.h", "header_text", kind, name)


def committed(path: str) -> bool:
    """True if a file is among the package's committed emitted files."""
    return path in manifest()["files"]


def _read(path: str) -> str:
    _verified(path)
    return (_FOLDER / path).read_text(encoding="utf-8")


@cache
def _verified(path: str) -> None:
    file = _FOLDER / path
    if not file.is_file() or hashlib.sha256(file.read_bytes()).hexdigest() != manifest()["files"][path]:
        raise CheckFailed(
            f"{file} is not what was emitted (edited, or from another version); run `wetdoublet generate`"
        )


def executed(name: str, source: bytes) -> ModuleType:
    """A module executed from its verified source text, without reading the file again."""
    result = ModuleType(name)
    exec(compile(source, f"<{name}>", "exec", dont_inherit=True), result.__dict__)
    return result


@cache
def derivation() -> str:
    """Digest of the derivation's sources and of the versions of its dependencies."""
    from importlib.metadata import version

    digest = hashlib.sha256()
    for name in ("wetdoublet", "sympy", "casadi"):
        digest.update(f"{name} {version(name)}\n".encode())
    digest.update(sources_of_derivation().encode())
    return digest.hexdigest()


def sources_of_derivation() -> str:
    """Digest of the derivation's sources."""
    digest = hashlib.sha256()
    for path in sorted(DERIVE.rglob("*.py")):
        digest.update(path.relative_to(DERIVE).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()


@contextmanager
def deriving() -> Iterator[None]:
    """The right to derive, one thread at a time, laws and structures from the user's cache where it has them."""
    from .user_cache import fetch

    with DERIVING:  # its modules, too, are imported by one thread at a time
        from ...derive.equations.store import opened

        with opened(lambda name, make: fetch(f"derived-{derivation()[:32]}-{name}.pickle", make)):
            yield


def derived_once(name: str, function: str, *arguments: str | bool) -> str:
    """A text from the cache; `function` of `derive.emit.first_use` makes it if none has that name and derivation."""
    from .user_cache import fetch

    def alone() -> bytes:
        with deriving():
            from ...derive.emit import first_use  # imports sympy

            text: str = getattr(first_use, function)(*arguments)
            return text.encode()

    return fetch(f"emitted-{derivation()[:32]}-{name}", alone).decode()
