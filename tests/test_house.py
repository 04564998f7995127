"""The rules of the house, read from the imports: arrows go one way, and there are no circles.

`python tests/test_house.py` prints the rooms by floors, the foundations at the bottom: what each is for, and the rooms
that it stands on directly.
"""

import ast
import re
import sys
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

from wetdoublet.solvers.host.emitted import LAWS

ROOT = Path(__file__).resolve().parents[1]
Graph = dict[str, set[str]]
# From what stands on nothing to what nothing stands on. A room imports from rooms above it in this list, never below.
ORDER = (
    "derive.vocabulary", "derive.physics", "derive.equations", "derive.user", "derive.laws", "derive.emit",
    "derive.checks",
    "generated", "solvers.errors", "solvers.host", "solvers.results", "solvers.formatting", "solvers.scene",
    "solvers.model", "solvers.engines", "solvers.collision", "solvers.many",
    "solvers.boundaries", "solvers.sensitivity", "solvers.averages", "solvers.fitting", "solvers.verify",
    "solvers.export", "solvers.explorer", "solvers.commands", "solvers", "solvers.package", "solvers.__main__",
)  # fmt: skip


MADE = (
    "mine.py example.py law.h MODEL.py NAME.py model.py model.h settings.h layout.h granulation.h"  # by users, builds
)


@cache
def modules() -> dict[str, Path]:
    """Dotted name below the root -> file; `generated` is one."""
    files = {}
    for top in ("derive", "solvers"):
        for path in sorted((ROOT / top).rglob("*.py")):
            parts = path.relative_to(ROOT).with_suffix("").parts
            files[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return files


@cache
def parsed(path: Path) -> ast.Module:
    """The syntax of a file."""
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def imports() -> Graph:
    """File -> files that it imports: types, and imports within functions, included."""
    return {name: {file for file in _imported(name, path) if file != name} for name, path in modules().items()}


def _imported(name: str, path: Path) -> set[str]:
    targets = set()
    for node in ast.walk(parsed(path)):
        if isinstance(node, ast.ImportFrom):
            base = name.split(".") if path.name == "__init__.py" else name.split(".")[:-1]
            base = base[: len(base) - node.level + 1] if node.level else []
            source = ".".join([*base, *(node.module or "").split(".")]).strip(".")
            source = source.removeprefix("wetdoublet.")
            for alias in node.names:
                whole = f"{source}.{alias.name}"
                targets.add(whole if whole in modules() else source)
    files = {"generated" if target.startswith("generated") else target for target in targets}
    return files & {*modules(), "generated"}


def room(name: str) -> str:
    """The folder directly in derive/ or solvers/ that a file lies in, or the file that is left there."""
    return ".".join(name.split(".")[:2])


def apart(name: str) -> str:
    """The room, with each of the two engines, and what lies beside them, as a room of its own."""
    return ".".join(name.split(".")[:3]) if room(name) == "solvers.engines" else room(name)


def between(of: Callable[[str], str]) -> Graph:
    """Room -> rooms that it imports from, with the rooms that `of` gives."""
    graph: Graph = defaultdict(set)
    for name, files in imports().items():
        graph[of(name)] |= {of(file) for file in files} - {of(name)}
        for file in files:
            graph.setdefault(of(file), set())
    return dict(graph)


@cache
def rooms() -> Graph:
    """Room -> rooms that it imports from."""
    return between(room)


def direct(graph: Graph) -> Graph:
    """The graph without the arrows that follow from others."""

    @cache
    def below(name: str) -> frozenset[str]:
        return frozenset(graph[name]).union(*(below(target) for target in graph[name]))

    return {
        name: {target for target in targets if not any(target in below(other) for other in targets - {target})}
        for name, targets in graph.items()
    }


def purpose(name: str) -> str:
    """The first line of a room's docstring."""
    text = ast.get_docstring(parsed(modules()[name])) if name in modules() else "Emitted text."
    return (text or "").partition("\n")[0]


def floors(graph: Graph) -> list[tuple[str, ...]]:
    """Rooms by floors: each stands on those below; CycleError, which names a circle, where there is one."""
    sorter, levels = TopologicalSorter(graph), []
    sorter.prepare()
    while sorter.is_active():
        levels.append(sorter.get_ready())
        sorter.done(*levels[-1])
    return levels


def test_there_is_no_circle_of_files() -> None:
    """Imports for types and imports within functions count."""
    assert floors(imports())


def test_rooms_stand_on_rooms_above_them_in_the_list() -> None:
    """No arrow against the order, no circle, at most 35 rooms on at most 19 floors."""
    everything = {*rooms(), *set().union(*rooms().values())}
    wrong = [(name, target) for name, targets in rooms().items() for target in targets if _rank(name) <= _rank(target)]
    assert everything - {"derive"} <= set(ORDER)
    assert wrong == []
    assert len(everything) <= 35
    assert len(floors(rooms())) <= 19


def _rank(name: str) -> int:
    return -1 if name == "derive" else ORDER.index(name)


def test_the_engines_do_not_know_of_each_other() -> None:
    """Neither imports from the other's folder."""
    for engine, other in (("casadi", "taylor"), ("taylor", "casadi")):
        own = [name for name in imports() if name.startswith(f"solvers.engines.{engine}")]
        assert len(own) > 3
        assert not [
            (name, file) for name in own for file in imports()[name] if file.startswith(f"solvers.engines.{other}")
        ]


def test_one_place_chooses_the_engine() -> None:
    """Only the engines look at whether the kernel can answer; every question asks `engines.kernels`."""
    asking = re.compile(r"\b(kernel_supports|is_compiled)\(")
    above = {name: path for name, path in modules().items() if _rank(room(name)) > _rank("solvers.engines")}
    assert len(above) > 100
    assert not [name for name, path in above.items() if asking.search(path.read_text())]


def test_no_law_is_known_by_its_name() -> None:
    """Above `scene`, a law is named only where a scene is written down, as the value of one of its entries.

    `film` is a slot and a flag as well, `exact` a word of xarray: no laws where nothing is compared with them.
    """
    names = {name for laws in LAWS.values() for name in laws}
    rooms = [name for name in modules() if name.startswith("solvers.") and room(name) != "solvers.scene"]
    assert len(rooms) > 150
    assert not {name: words for name in rooms if (words := _named(parsed(modules()[name]), names))}


def _named(tree: ast.AST, names: set[str]) -> set[str]:
    """Names among the texts of a file, without the entries of scenes."""
    words = set()
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.Dict):
            pairs = zip(node.keys, node.values, strict=True)
            entries = [value for key, value in pairs if isinstance(key, ast.Constant) and "." in str(key.value)]
            node = ast.Dict(node.keys, [value for value in node.values if value not in entries])
        if isinstance(node, ast.Constant) and node.value in names - {"film", "exact"}:
            words.add(str(node.value))
        if isinstance(node, ast.Compare):
            sides = [side.value for side in (node.left, *node.comparators) if isinstance(side, ast.Constant)]
            words |= {"film", "exact"} & {*map(str, sides)}
        words |= _named(node, names)
    return words


def test_every_room_says_what_it_is_for() -> None:
    """The `__init__.py` of each folder begins with a docstring."""
    folders = {path.parent for path in modules().values()}
    assert not [folder for folder in folders if not ast.get_docstring(parsed(folder / "__init__.py"))]


def test_files_that_are_named_exist() -> None:
    """Every `name.py` and `name.h` in back-quotes in documentation, docstrings and comments is a file of the tree."""
    texts = [*(ROOT / "docs").rglob("*.md"), *(ROOT / "derive").rglob("*.py"), *(ROOT / "solvers").rglob("*.py")]
    texts += [*(ROOT / "solvers").rglob("*.h"), ROOT / "README.md"]
    files = {
        path.name
        for top in ("derive", "docs", "examples", "generated", "solvers", "tests")
        for path in (ROOT / top).rglob("*.*")
    }
    mentions = {
        (path.name, file.rpartition("/")[2])
        for path in texts
        for file in re.findall(r"`([\w/]+\.(?:py|h))`", path.read_text())
    }
    assert len(mentions) > 30
    assert not {(page, name) for page, name in mentions if name not in files | {*MADE.split()}}


_NO_NOUNS = {
    "left": 10, "part": 2, "kept": 1,  # beside right or as a side; a public keyword; a key of the JSON
    "each": 0, "one": 0, "known": 0, "found": 0, "shown": 0, "there": 0, "made": 0, "late": 0, "said": 0, "spoken": 0,
}  # fmt: skip
"""Pronouns, particles and participles, and how often each names something in derive/ and solvers/: never more often."""


def _names_bound(tree: ast.AST) -> Iterator[str]:
    """Every name that a file binds: variables, arguments, functions, classes, and imports under another name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id
        elif isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef, ast.ExceptHandler, ast.MatchAs)) and node.name:
            yield node.name
        elif isinstance(node, ast.alias) and node.asname:
            yield node.asname


def test_names_are_nouns() -> None:
    """A name says what it is: no pronoun or participle is bound more often than it was; lower a number with a count."""
    counts: Counter[str] = Counter()
    for room in ("derive", "solvers"):
        for path in (file for file in (ROOT / room).rglob("*.py") if "node_modules" not in file.parts):
            counts.update([path.stem, *_names_bound(parsed(path))])
    more = {word: (counts[word], most) for word, most in _NO_NOUNS.items() if counts[word] > most}
    assert not more, f"bound more often than allowed (count, most): {more}"


if __name__ == "__main__":
    drawn = direct(between(apart))
    for floor, names in reversed([*enumerate(floors(drawn))]):
        for entry in sorted(names):
            sys.stdout.write(
                f"{floor:2}  {entry:24} {purpose(entry)}\n{'':30}on {', '.join(sorted(drawn[entry])) or '-'}\n"
            )
