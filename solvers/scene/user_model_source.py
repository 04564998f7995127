"""Opening of a user's model: an emitted folder, or a model file, derived on first use. A stale one is refused."""

import ast
import hashlib
import json
import os
import re
import sys
from functools import lru_cache
from pathlib import Path

from ..errors import InputError
from ..host import bounded
from ..host.emitted import derivation, deriving, library_digest
from .user_model import ACCEPTED, Package

_OTHERS = re.compile(rb"\b(open|exec|eval|__import__|read_text|read_bytes)\(|\bimportlib\b")
_STEADY = {"wetdoublet", "sympy", *sys.stdlib_module_names}


def open_package(source: str | Path | Package, label: str = "--model") -> Package:
    """The model of a folder written by `generate`, or of a model file (derived on first use, then from the cache).

    Raises:
        InputError: no such model, or a stale one; names the command to run.
    """
    if isinstance(source, Package):
        return source
    if not isinstance(source, (str, os.PathLike)):
        raise InputError(label, source, ACCEPTED, "is not the name of a file")
    path = Path(source)
    if bounded.is_folder(path):
        return _of_folder(path, label)
    if path.suffix == ".py" and bounded.is_file(path):
        return _derived_once(key_of(_read(path, label)), "files_of", path)
    raise InputError(label, str(source), ACCEPTED, "is neither a folder nor a model file")


@lru_cache(maxsize=8)
def liquid_package(law: str) -> Package:
    """The library's laws for a law of liquids, as a model; derived on first use, then cached."""
    return _derived_once(f"liquid-{law}-{derivation()[:16]}-{library_digest()[:16]}.json", "files_of_liquid", law)


def _derived_once(key: str, function: str, source: Path | str) -> Package:
    """The model that a function of `user_model_derived` gives, with a key from the cache of the user if it is there."""
    from ..host.user_cache import fetch

    def derived() -> bytes:
        from . import user_model_derived  # imports sympy

        with deriving():
            return json.dumps(dict(getattr(user_model_derived, function)(source))).encode()

    files = json.loads(fetch(key, derived) if key else derived())
    return Package(files["manifest.json"], Path(source), files)


def _is_whole(package: Package) -> bool:
    """True if a manifest's parts have the expected types; KeyError or similar if parts are missing."""
    listed = package.manifest
    texts = [package.name, listed["library"], listed["files"]["model.py"], *listed["files"].values()]
    texts += [package.law_file(law["slot"], law["name"]) for law in listed["laws"]]
    texts += [*listed["files"], *listed["structures"], *package.fields, *package.defaults, *package.plain]
    tables = (listed["files"], listed["structures"], listed["extra"])
    return (
        bool(package.remedy)
        and all(isinstance(text, str) for text in texts)
        and all(isinstance(t, dict) for t in tables)
    )


def _read(path: Path, label: str) -> bytes:
    """Content of a model's file; InputError if it cannot be read or exceeds `bounded.LARGEST`."""
    try:
        return bounded.read(path, bounded.LARGEST)
    except FileNotFoundError:
        raise InputError(label, str(path), ACCEPTED, "is not there") from None
    except bounded.NotRead as reason:
        raise InputError(label, str(path), ACCEPTED, str(reason)) from None


def _of_folder(folder: Path, label: str) -> Package:
    try:
        package = Package(bounded.text(folder / "manifest.json"), folder)
        current = (
            package.manifest["kind"] == "wetdoublet model" and package.manifest["format"] == 1 and _is_whole(package)
        )
    except (OSError, ValueError, LookupError, AttributeError, TypeError, bounded.NotRead):
        current = False
    if not current:
        raise InputError(label, str(folder), ACCEPTED, "holds no emitted model")
    if package.manifest["library"] != library_digest():
        problem = "was emitted for other equations of the library than these"
        raise InputError(label, str(folder), package.remedy.removeprefix("run "), problem)
    source = package.original
    digest = package.manifest["files"]["model.py"]
    if source and bounded.is_file(source) and hashlib.sha256(_read(source, label)).hexdigest() != digest:
        problem = f"is stale: {source} has changed since"
        raise InputError(label, str(folder), f"a model emitted from it: {package.remedy}", problem)
    for path in package.manifest["files"]:
        package.text_of(path)
    return package


def key_of(content: bytes, origin: str = "") -> str:
    """Name of the cache's entry for the files that a model file of this content gives; "" if others may change them."""
    if _depends_on_others(content):
        return ""
    parts = [content, derivation().encode(), library_digest().encode(), *([origin.encode()] if origin else [])]
    return f"model-{hashlib.sha256(bytes([0]).join(parts)).hexdigest()[:32]}.json"


def _depends_on_others(content: bytes) -> bool:
    """Whether a model file imports or opens files besides the package's, sympy's and Python's."""
    try:
        nodes = [*ast.walk(ast.parse(content))]
    except (SyntaxError, ValueError):
        return True
    names = [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
    names += [node.module or "" for node in nodes if isinstance(node, ast.ImportFrom) and not node.level]
    return bool(_OTHERS.search(content)) or any(name.partition(".")[0] not in _STEADY for name in names)
