"""Checks of output files and folders, made before anything is computed."""

import os
from collections.abc import Sequence
from pathlib import Path

from ..errors import InputError
from . import bounded

PICTURES = (".png", ".pdf", ".svg")
_LONGEST = 200  # bytes of a name; file systems accept 255, and the temporary file has a longer name


def check_file(
    path: object, label: str, suffixes: Sequence[str] = (), *, replaced: bool = False, folder: bool = False
) -> Path:
    """Return the path of an output file; InputError naming `label` if it cannot be written or has a wrong suffix.

    Arguments:
        replaced: the file is moved into place, so that its folder must be writable too.
        folder: it is itself a folder, as a Zarr store is.
    """
    accepted = "a file name" + (f" ending in {', '.join(suffixes)}" if suffixes else "") + " in a folder that exists"
    text = _text(path, label, accepted)
    file = Path(text)
    if suffixes and file.suffix.lower() not in suffixes:
        raise InputError(label, text, accepted, "has an unsupported suffix")
    if len(os.fsencode(file.name)) > _LONGEST:
        raise InputError(label, text, f"{accepted}, of at most {_LONGEST} bytes", "is too long a name")
    meant = Path(os.path.realpath(file))  # a link may be broken
    if not (bounded.is_folder(file.parent) and bounded.is_folder(meant.parent)):
        raise InputError(label, text, accepted, "is in a folder that does not exist")
    if not folder and bounded.is_folder(file):
        raise InputError(label, text, accepted, "is a folder")
    exists = bounded.exists(file)
    if (exists and not os.access(file, os.W_OK)) or ((replaced or not exists) and not _takes_files(meant.parent)):
        raise InputError(label, text, accepted, "cannot be written")
    return file


def check_folder(path: object, label: str) -> Path:
    """Return the output folder, which need not exist; InputError naming `label` if it cannot be created."""
    accepted = "a folder that exists or can be made"
    text = _text(path, label, accepted)
    folder = Path(text)
    if any(len(os.fsencode(name)) > _LONGEST for name in folder.parts):
        raise InputError(label, text, accepted, "is too long a name")
    nearest = next(parent for parent in (folder, *folder.absolute().parents) if bounded.exists(parent))
    if not bounded.is_folder(nearest):
        problem = "is a file" if nearest == folder else f"cannot be made: {nearest} is a file"
        raise InputError(label, text, accepted, problem)
    if not _takes_files(nearest):
        problem = "cannot be written to" if nearest == folder else f"cannot be made: {nearest} cannot be written to"
        raise InputError(label, text, accepted, problem)
    return folder


def _text(path: object, label: str, accepted: str) -> str:
    text = os.fspath(path) if isinstance(path, (str, os.PathLike)) else None
    if not isinstance(text, str) or not text.strip() or "\0" in text:
        raise InputError(label, path, accepted, "is not a file name")
    try:
        os.fsencode(text)
    except UnicodeEncodeError:
        raise InputError(label, text, accepted, "is not a file name") from None
    return text


def _takes_files(folder: Path) -> bool:
    """True if a file can be created in a folder; tested by creating one, as permissions are not reliable in /proc."""
    import tempfile  # slow import

    try:
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
