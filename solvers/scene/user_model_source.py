"""A user's model: opened, from an emitted folder (a stale one is refused) or a model file, and derived.

A model file is derived on first use; only the functions that derive import sympy.
"""

import ast
import hashlib
import json
import os
import re
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from ..errors import CheckFailed, InputError
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
        return _derived_once(key_of(bounded.read(path, bounded.LARGEST, label, ACCEPTED)), files_of, path)
    raise InputError(label, str(source), ACCEPTED, "is neither a folder nor a model file")


@lru_cache(maxsize=8)
def liquid_package(law: str) -> Package:
    """The library's laws for a law of liquids, as a model; derived on first use, then cached."""
    return _derived_once(f"liquid-{law}-{derivation()[:16]}-{library_digest()[:16]}.json", files_of_liquid, law)


def _derived_once(key: str, derive: Callable[[Any], Mapping[str, str]], source: Path | str) -> Package:
    """The model that a function derives of a source, with a key from the cache of the user if it is there."""
    from ..host.user_cache import fetch

    def derived() -> bytes:
        with deriving():
            return json.dumps(dict(derive(source))).encode()

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


def _of_folder(folder: Path, label: str) -> Package:
    try:
        package = Package(bounded.text(folder / "manifest.json"), folder)
        current = (
            package.manifest["kind"] == "wetdoublet model" and package.manifest["format"] == 1 and _is_whole(package)
        )
    except (OSError, ValueError, LookupError, AttributeError, TypeError):
        current = False
    if not current:
        raise InputError(label, str(folder), ACCEPTED, "holds no emitted model")
    if package.manifest["library"] != library_digest():
        problem = "was emitted for other equations of the library than these"
        raise InputError(label, str(folder), package.remedy.removeprefix("run "), problem)
    source = package.original
    if source and bounded.is_file(source):
        content = bounded.read(source, bounded.LARGEST, label, ACCEPTED)
        if hashlib.sha256(content).hexdigest() != package.manifest["files"]["model.py"]:
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


# ---- derivation


@dataclass(frozen=True)
class Derived:
    """A derived model file: the report, its files (none if a check fails), the failed checks and the first's figure."""

    report: str
    files: Mapping[str, str]
    failed: str
    reason: str = ""


def derived_package(path: Path, folder: Path | None) -> Derived:
    """Derive, check and emit a model file (imports sympy); `folder` is the destination of its files, if any.

    With a folder, the report says what has changed against the model there, or else the library.

    Raises:
        InputError: not a valid model file; names the line, and what is accepted.
    """
    from ...derive.checks.regenerated import changed, earlier
    from ...derive.checks.user import model_checks
    from ...derive.checks.words import conserved, in_words
    from ...derive.emit.user import package
    from ...derive.user.declarations import ModelFileError

    try:
        model, checks = model_checks(path)
    except ModelFileError as error:
        raise InputError(error.field, error.value, error.accepted, error.problem) from None
    width = max(len(check.name) for check in checks)
    marks = {True: "ok  ", False: "FAIL", None: "note"}
    lines = [f"{marks[check.ok]} {check.name:<{width}}  {check.figure}" for check in checks]
    failing = [check for check in checks if check.ok is False]
    if model is None or failing:
        failed = f"fails {', '.join(check.name for check in failing)}; nothing is emitted"
        return Derived("\n".join(lines), {}, failed, failing[0].figure)
    source, words = path.read_text(encoding="utf-8"), in_words(model)
    files = package(model, source, library_digest(), conserved(model), words, origin_of(path, folder))
    emitted = Package(files["manifest.json"], path, files)
    for name, value in emitted.defaults.items():
        try:
            emitted.fields[name].read(value)
        except InputError as error:
            accepted = error.accepted.partition(", such as")[0]  # the example is this default
            accepted += f", which is {unit}" if (unit := emitted.fields[name].unit) else ""
            raise InputError(f"{path}: {name}, default", value, accepted, error.problem) from None
    for law in model.laws:  # in the cache for the kernels: the first collisions then need no sympy
        emitted.law_header(law.slot, law.name)
        emitted.law_header(law.slot, law.name, slopes=True)
    meanings = [f"{model.name}: {model.meaning}."]
    meanings += [f"  {law.slot} law {law.name}: {law.meaning}" for law in model.laws]
    meanings += [f"  event {event.proposed.word}: {event.proposed.meaning}" for event in model.events]
    lines = [*meanings, "", *lines, "", *words]
    if folder is not None:
        lines += ["", *changed(earlier(folder / "model.py"), model)]
    return Derived("\n".join(lines), files, "")


def files_of(path: Path) -> Mapping[str, str]:
    """What a model file is derived to (imports sympy); CheckFailed if one of its checks fails."""
    package = derived_package(path, None)
    if not package.files:
        raise CheckFailed(f"{path}: {package.failed}: {package.reason}")
    return package.files


def files_of_liquid(law: str) -> Mapping[str, str]:
    """What the laws of the library for a liquid are derived to; they are checked where they are developed."""
    from ...derive.emit.user import package
    from ...derive.laws.liquids import file_of
    from ...derive.laws.modelfile import read

    path = file_of(law)
    source = path.read_text(encoding="utf-8")
    return package(read(path, source, path.stem), source, library_digest(), (), (), table="liquid")


def origin_of(path: Path, folder: Path | None) -> str:
    """Path of the model file relative to the folder."""
    if folder is None:
        return ""
    try:
        return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
    except ValueError:  # on another drive
        return ""
