"""Kernels that come compiled with the package: those of the library's usual laws, for several instruction sets.

Each is a file STEM-SOURCE.CONTENT.so: digests of the text and flags that it was compiled from, and of its bytes. So one
that is damaged, or of other equations than the package's, is never loaded. As a program this module compiles them; the
package's build runs it.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

from ...host.compiler import CannotCompile, library, more_flags
from ...host.cores import usable_cores
from ...host.remarks import say_once
from ...host.user_cache import digest_of
from ...model.key import ModelKey
from ..machine import SETS, InstructionSet, here, lanes
from .orders import ORDERS, order_for
from .source import Variant, emitted_headers, flags, source, stem

FOLDER = Path(__file__).resolve().with_name("kernels")
_LAWS = {
    "film": "finite", "glass": "literal", "shear": "immersed", "arm": "midgap", "bridge": "mikami", "strings": "exact",
}  # fmt: skip
_RTOL = 1e-9  # whose orders are shipped
_WITH_LEDGER = ({"ledger": True}, {"ledger": True, "trajectory": True})
_WITHOUT: tuple[dict[str, bool], ...] = ({}, {"trajectory": True}, {"gradients": True})
_BACKWARD = {"gradients": True, "backward": True}
_ORDERS_BACKWARD = [order for _, order in ORDERS]  # fits have a looser default tolerance
_STRUCTURES = {
    ("oblique", "oblique_bridge"): tuple(each | {"rotation": True} for each in _WITH_LEDGER),
    ("oblique_reduced", "oblique_bridge_reduced"): (
        *(each | {"rotation": True} for each in _WITHOUT), {}, {"gradients": True}, _BACKWARD
    ),
    ("head_on", "head_on_bridge", "head_on_strings", "oblique_strings"): (*_WITH_LEDGER, *_WITHOUT, _BACKWARD),
}  # fmt: skip


def variants() -> Iterator[Variant]:
    """The variants that are shipped, for the lanes of this machine."""
    for structure, options in ((name, options) for names, options in _STRUCTURES.items() for name in names):
        slots = ["film", "glass"]
        slots += ["shear"] if structure.startswith("oblique") else []
        slots += ["arm"] if structure.startswith("oblique") and "reduced" not in structure else []
        slots += [slot for slot in ("bridge", "strings") if slot in structure]
        choice = ModelKey(structure, tuple((slot, _LAWS[slot]) for slot in slots))
        for each in options:
            for order in _ORDERS_BACKWARD if "backward" in each else (order_for(_RTOL),):
                yield Variant(choice, order, **each)


def shipped(variant: Variant) -> bytes | None:
    """The library of a variant for the widest instruction set of this machine that it was shipped for; None if none."""
    if more_flags() or not any(name.startswith(f"{stem(variant)}-") for name in _names()):
        return None
    for each in here():
        name = _name(variant, each)
        path = next((FOLDER / file for file in _names() if file.startswith(f"{name}.")), None)
        if path is not None:
            content = path.read_bytes()
            if path.name == f"{name}.{digest_of(content)}.so":
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
    return tuple(sorted(path.name for path in FOLDER.glob("*.so")))


@cache
def _name(variant: Variant, instructions: InstructionSet) -> str:
    """Name of a variant's library without the digest of its content."""
    text, flagged = _compilation(variant, instructions)
    return f"{stem(variant)}-{digest_of(chr(0).join((text, *flagged)).encode())}"


def _compilation(variant: Variant, instructions: InstructionSet) -> tuple[str, tuple[str, ...]]:
    """Text and flags of a variant for an instruction set, whose lanes replace those of this machine."""
    of_machine = replace(variant, lanes=lanes()) == variant
    fitting = replace(variant, lanes=instructions.lanes) if of_machine else variant
    emitted = emitted_headers(fitting)
    assert emitted is not None  # of the library's laws
    return source(fitting, emitted), flags(fitting, instructions)


def _compile(folder: Path, sets: list[InstructionSet], structure: str | None, only_values: bool) -> None:
    """Compile the shipped kernels, all or some of them, into a folder, and remove others from it."""
    from concurrent.futures import ThreadPoolExecutor  # slow import

    folder.mkdir(parents=True, exist_ok=True)
    chosen = [each for each in variants() if structure in (None, each.choice.structure)]
    chosen = [each for each in chosen if not (only_values and each.gradients)]
    wanted = {_name(each, instructions): (each, instructions) for each in chosen for instructions in sets}
    for path in folder.iterdir():
        if wanted.pop(path.name.split(".")[0], None) is None:
            path.unlink()

    def write(name: str) -> None:
        content = library(*_compilation(*wanted[name]))
        (folder / f"{name}.{digest_of(content)}.so").write_bytes(content)

    with ThreadPoolExecutor(usable_cores()) as pool:
        list(pool.map(write, wanted))


if __name__ == "__main__":
    import argparse  # slow import

    known = {each.name: each for family in SETS.values() for each in family}
    parser = argparse.ArgumentParser(description="Compile the kernels that come with the package.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("sets", nargs="*", help=f"instruction sets [this machine's]: {', '.join(known)}")
    parser.add_argument("--structure", help="of this structure only")
    parser.add_argument("--only-values", action="store_true", help="none with derivatives, which take twice as long")
    arguments = parser.parse_args()
    if unknown := set(arguments.sets) - set(known):
        parser.error(f"no such instruction set: {', '.join(sorted(unknown))}; accepted: {', '.join(known)}")
    try:
        sets = [known[name] for name in arguments.sets] or [here()[0]]
        _compile(arguments.folder, sets, arguments.structure, arguments.only_values)
    except CannotCompile as error:
        parser.exit(1, f"the kernels cannot be compiled: {error}\n")
