"""Output files and folders: checked before anything is computed, and written atomically.

Content is built in memory, written to a temporary file beside the target and moved into place. A full disk thus loses
the new file, never the old one, and every failed write is detected.
"""

from __future__ import annotations

import io
import os
import stat
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError
from . import bounded

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURES = (".png", ".pdf", ".svg")
_LONGEST = 200  # bytes of a name; file systems accept 255, and the temporary file has a longer name


# ---- checking


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


# ---- writing


def write(path: str | Path, content: bytes | memoryview | str) -> None:
    """Write a file, text as UTF-8; OSError with its path if that fails: an existing file is then unchanged."""
    target = Path(os.path.realpath(path))  # write to the target of a symbolic link and keep the link
    data = content.encode() if isinstance(content, str) else content
    try:
        if _replaceable(target):
            _replace(target, data)
        else:
            with target.open("wb") as file:
                file.write(data)
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(path)) from error


def write_all_in(folder: Path, files: Mapping[str, str]) -> list[Path]:
    """Write texts by relative path below a folder, creating it; returns the paths. OSError as in `write`."""
    written = []
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        write(path, text)
        written.append(path)
    return written


def differing(folder: Path, files: Mapping[str, str]) -> dict[str, str]:
    """Those of the texts by relative path that are not what is below the folder."""
    old = {name: folder / name for name in files}
    return {
        name: text for name, text in files.items() if not old[name].is_file() or old[name].read_bytes() != text.encode()
    }


def save(figure: Figure, path: str | Path, dpi: int) -> None:
    """Write a figure in the format of the file's suffix. OSError as in `write`."""
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=dpi, format=Path(path).suffix.lstrip(".").lower() or None)
    write(path, drawn.getbuffer())


def _replaceable(target: Path) -> bool:
    """True if a new file may be moved here: the path is free, or a regular file in a writable folder."""
    try:
        status = target.lstat()
    except FileNotFoundError:
        return True
    return stat.S_ISREG(status.st_mode) and status.st_nlink == 1 and os.access(target.parent, os.W_OK)


def _replace(target: Path, data: bytes | memoryview) -> None:
    beside = target.with_name(f".{target.name[:100]}.{os.getpid()}.{os.urandom(4).hex()}.writing")
    try:
        with beside.open("xb") as file:
            with suppress(OSError, AttributeError):
                os.fchmod(file.fileno(), stat.S_IMODE(target.stat().st_mode))
            file.write(data)
        beside.replace(target)
    finally:
        beside.unlink(missing_ok=True)
