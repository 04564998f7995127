"""Where a user's model comes from: an emitted folder, or a model file, derived on first use; refused if stale."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from .custom import ACCEPTED, Package
from .emitted import DERIVING, derivation, library_digest
from .errors import CheckFailed, InputError


def open_package(source: str | Path | Package, label: str = "--model") -> Package:
    """The model of a folder that `generate` made, or of a model file (derived on first use, then cached).

    Raises:
        InputError: no such model, or one that is stale: says what to run.
    """
    if isinstance(source, Package):
        return source
    path = Path(source)
    if path.is_dir():
        return _of_folder(path, label)
    if path.suffix == ".py" and path.is_file():
        return _of_file(path)
    raise InputError(label, str(source), ACCEPTED, "is neither a folder nor a model file")


def _of_folder(folder: Path, label: str) -> Package:
    try:
        text = (folder / "manifest.json").read_text(encoding="utf-8")
        package = Package(text, folder)
        known = package.manifest["kind"] == "wetdoublet model" and package.manifest["format"] == 1
    except (OSError, ValueError, KeyError, TypeError):
        known = False
    if not known:
        raise InputError(label, str(folder), ACCEPTED, "holds no emitted model")
    if package.manifest["library"] != library_digest():
        problem = "was emitted for other equations of the library than these"
        raise InputError(label, str(folder), package.remedy.removeprefix("run "), problem)
    source = package.original
    if source is not None and source.is_file() and _sha256(source) != package.manifest["files"]["model.py"]:
        problem = f"is stale: {source} has changed since"
        raise InputError(label, str(folder), f"a model emitted from it: {package.remedy}", problem)
    for path in package.manifest["files"]:
        package.text_of(path)
    return package


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _of_file(path: Path) -> Package:
    from .cache import kept

    key = hashlib.sha256(b"\0".join([path.read_bytes(), derivation().encode(), library_digest().encode()])).hexdigest()

    def derived() -> bytes:
        from .derived import derived_package  # imports sympy when it is called

        with DERIVING:
            made = derived_package(path, None)
        if not made.files:
            raise CheckFailed(f"{path}: {made.failed}")
        return json.dumps(dict(made.files)).encode()

    files = json.loads(kept(f"model-{key[:32]}.json", derived))
    return Package(files["manifest.json"], path, files)
