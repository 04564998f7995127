"""Atomic writing of output files.

Content is built in memory, written to a temporary file beside the target and moved into place. A full disk thus loses
the new file, never the old one, and every failed write is detected.
"""

from __future__ import annotations

import io
import os
import stat
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def write(path: str | Path, content: bytes | memoryview | str) -> None:
    """Write a file, text as UTF-8; OSError with its path if that fails: an existing file is then unchanged."""
    target = Path(os.path.realpath(path))  # write to the target of a symbolic link and keep the link
    data = content.encode() if isinstance(content, str) else content
    try:
        if _replaceable(target):
            _replace(target, data)
        else:
            _fill(os.open(target, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666), data)
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


def write_all(descriptor: int, data: bytes | memoryview) -> None:
    """Write all bytes to a descriptor. OSError if the system refuses."""
    rest = memoryview(data)
    while rest:
        rest = rest[os.write(descriptor, rest) :]


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
        descriptor = os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
        with suppress(OSError, AttributeError):
            os.fchmod(descriptor, stat.S_IMODE(target.stat().st_mode))
        _fill(descriptor, data)
        beside.replace(target)
    finally:
        beside.unlink(missing_ok=True)


def _fill(descriptor: int, data: bytes | memoryview) -> None:
    try:
        write_all(descriptor, data)
    except BaseException:
        with suppress(OSError):
            os.close(descriptor)
        raise
    os.close(descriptor)  # a full disk may be reported only here
