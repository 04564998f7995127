"""Kernels that come compiled with the package (`engines/ship.py`), for several instruction sets.

Each is a file STEM-SOURCE.CONTENT.so: digests of the text and flags that it was compiled from, and of its bytes. So one
that is damaged, or of other equations than the package's, is never loaded.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

from ...host.compiler import more_flags
from ...host.remarks import say_once
from ...host.user_cache import digest_of
from ..machine import InstructionSet, lanes, own_sets
from .source import Variant, emitted_headers, flags, source, stem

FOLDER, SUFFIX = Path(__file__).resolve().with_name("kernels"), ".so"


def shipped(variant: Variant) -> bytes | None:
    """The library of a variant for the widest instruction set of this machine that it was shipped for; None if none."""
    if more_flags() or not any(name.startswith(f"{stem(variant)}-") for name in _names()):
        return None
    for instructions in own_sets():
        if (content := content_of(FOLDER, name_of(variant, instructions), SUFFIX)) is not None:
            return content
    return None


def content_of(folder: Path, name: str, suffix: str) -> bytes | None:
    """The content of the file NAME.DIGEST and suffix; None if there is none, or none that has this digest."""
    for path in folder.glob(f"{name}.*{suffix}"):
        content = path.read_bytes()
        if path.name == f"{name}.{digest_of(content)}{suffix}":
            return content
        say_once(f"{path} is damaged: it is not used; install wetdoublet anew")
    return None


def is_shipped(variant: Variant) -> bool:
    """True if the library of a variant came with the package and is whole; its file is read once a process."""
    return not more_flags() and _is_whole(variant)


@cache
def _is_whole(variant: Variant) -> bool:
    return shipped(variant) is not None


def shipped_digest() -> str:
    """Digest of all shipped libraries; "" if there are none."""
    return digest_of("".join(_names()).encode()) if _names() else ""


@cache
def _names() -> tuple[str, ...]:
    return tuple(sorted(path.name for path in FOLDER.glob(f"*{SUFFIX}")))


@cache
def name_of(variant: Variant, instructions: InstructionSet) -> str:
    """Name of a variant's library without the digest of its content."""
    text, flagged = compilation(variant, instructions)
    return f"{stem(variant)}-{digest_of(chr(0).join((text, *flagged)).encode())}"


def compilation(variant: Variant, instructions: InstructionSet) -> tuple[str, tuple[str, ...]]:
    """Text and flags of a variant for an instruction set, whose lanes replace those of this machine."""
    of_machine = replace(variant, lanes=lanes()) == variant
    fitting = replace(variant, lanes=instructions.lanes) if of_machine else variant
    emitted = emitted_headers(fitting)
    assert emitted is not None  # of the library's laws
    return source(fitting, emitted), flags(fitting, instructions)
