"""Derivation of a user's model file: checks, emitted files and a report."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ..errors import CheckFailed, InputError
from ..host.emitted import library_digest
from .user_model import Package


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
