"""The kernels that come compiled with the package: those that the questions on its presets ask for.

As a program this module compiles them; the package's build runs it.
"""

from pathlib import Path

from ..host.compiler import CannotCompile, library
from ..host.cores import usable_cores
from ..host.user_cache import digest_of
from ..scene.scene import Scene
from ..scene.scenefile import PRESETS
from .kernels import needed
from .machine import SETS, InstructionSet, here
from .settings import RTOL
from .taylor.shipped import compilation, name_of
from .taylor.source import Variant


def variants() -> tuple[Variant, ...]:
    """The variants that are shipped, for the lanes of this machine."""
    asked = (need for name in PRESETS for need in needed(Scene.load(name), [RTOL], derivatives=True))
    return tuple(dict.fromkeys(variant for _, _, variant in asked))


def _compile(folder: Path, sets: list[InstructionSet], structure: str | None, only_values: bool) -> None:
    """Compile the shipped kernels, all or some of them, into a folder, and remove others from it."""
    from concurrent.futures import ThreadPoolExecutor  # slow import

    folder.mkdir(parents=True, exist_ok=True)
    chosen = [each for each in variants() if structure in (None, each.choice.structure)]
    chosen = [each for each in chosen if not (only_values and each.gradients)]
    wanted = {name_of(each, instructions): (each, instructions) for each in chosen for instructions in sets}
    for path in folder.iterdir():
        if wanted.pop(path.name.split(".")[0], None) is None:
            path.unlink()

    def write(name: str) -> None:
        content = library(*compilation(*wanted[name]))
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
