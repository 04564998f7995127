"""The kernels that come compiled with the package: those that the questions on its presets ask for.

As a program this module compiles those that `shipped.json` lists; the package's build runs it, and so without CasADi.
`python -m wetdoublet.solvers.engines.ship --list` writes the list anew.
"""

import json
from collections.abc import Callable, Collection
from dataclasses import asdict
from pathlib import Path

from ..host.compiler import CannotCompile, compiler, library
from ..host.user_cache import digest_of
from ..host.workers import usable_cores
from ..model.key import ModelKey
from .machine import SETS, InstructionSet, own_sets
from .taylor.shipped import SUFFIX, compilation, name_of
from .taylor.source import Variant

LIST = Path(__file__).with_name("shipped.json")
FIRST = "oblique_bridge"
"""Beginning of the structures of which the README's first commands ask, and four of the presets."""


def needed_by_questions() -> tuple[Variant, ...]:
    """The variants that questions on the presets ask for, for the lanes of this machine."""
    from ..scene.scene import Scene
    from ..scene.scenefile import PRESETS
    from .kernels import needed
    from .settings import RTOL

    every = (need for name in PRESETS for need in needed(Scene.load(name), [RTOL], derivatives=True))
    return tuple(dict.fromkeys(variant for _, _, variant in every))


def variants() -> tuple[Variant, ...]:
    """The variants that the list has, for the lanes of this machine."""
    rows = json.loads(LIST.read_text(encoding="utf-8"))
    return tuple(Variant(ModelKey(row.pop("structure"), tuple(row.pop("laws").items())), **row) for row in rows)


def write_list() -> None:
    """Write `shipped.json` from the questions."""
    rows = []
    for variant in needed_by_questions():
        options = asdict(variant)
        del options["choice"], options["lanes"]
        options = {name: value for name, value in options.items() if value}
        rows.append({"structure": variant.choice.structure, "laws": dict(variant.choice.laws), **options})
    text = ",\n".join(f"  {json.dumps(row)}" for row in rows)
    LIST.write_text(f"[\n{text}\n]\n", encoding="utf-8")


def pack(folder: Path, suffix: str, wanted: Collection[str], content: Callable[[str], bytes]) -> None:
    """Write the files NAME.DIGEST and suffix of a folder that are missing, and remove those that are not wanted."""
    from concurrent.futures import ThreadPoolExecutor  # slow import

    folder.mkdir(parents=True, exist_ok=True)
    files = {path.name.partition(".")[0]: path for path in folder.glob(f"*{suffix}")}
    for name in files.keys() - wanted:
        files[name].unlink()

    def write(name: str) -> None:
        written = content(name)
        (folder / f"{name}.{digest_of(written)}{suffix}").write_bytes(written)

    with ThreadPoolExecutor(usable_cores()) as pool:
        list(pool.map(write, (name for name in wanted if name not in files)))


def values_for_here() -> list[Variant]:
    """The variants without derivatives; beside a compiler, which makes the others when asked, those asked for first."""
    values = [variant for variant in variants() if not variant.gradients]
    own = compiler()
    if own is None or "ziglang" in own.command:  # of the build's environment only
        return values
    return [variant for variant in values if variant.choice.structure.startswith(FIRST)]


def _compile(folder: Path, sets: list[InstructionSet], chosen: Collection[Variant]) -> None:
    """Compile kernels for instruction sets into a folder, and remove others from it."""
    wanted = {name_of(variant, instructions): (variant, instructions) for variant in chosen for instructions in sets}
    pack(folder, SUFFIX, wanted, lambda name: library(*compilation(*wanted[name])))


if __name__ == "__main__":
    import argparse  # slow import

    by_name = {instructions.name: instructions for family in SETS.values() for instructions in family}
    parser = argparse.ArgumentParser(description="Compile the kernels that come with the package.")
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("sets", nargs="*", help=f"instruction sets [this machine's]: {', '.join(by_name)}")
    parser.add_argument("--structure", help="values of this structure only")
    parser.add_argument("--for-here", action="store_true", help="values only; beside a compiler, those asked for first")
    parser.add_argument("--list", action="store_true", help="write the list of kernels instead")
    arguments = parser.parse_args()
    if arguments.list:
        write_list()
        parser.exit()
    if arguments.folder is None:
        parser.error("a folder is missing")
    if unknown := set(arguments.sets) - set(by_name):
        parser.error(f"no such instruction set: {', '.join(sorted(unknown))}; accepted: {', '.join(by_name)}")
    try:
        sets = [by_name[name] for name in arguments.sets] or [own_sets()[0]]
        chosen = values_for_here() if arguments.for_here else variants()
        if arguments.structure:
            chosen = [item for item in chosen if item.choice.structure == arguments.structure and not item.gradients]
        _compile(arguments.folder, sets, chosen)
    except CannotCompile as error:
        parser.exit(1, f"the kernels cannot be compiled: {error}\n")
