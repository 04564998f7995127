"""One C file of several kernels: what they share once, the rest with prefixes, and nothing that is not called."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...engines.taylor.source import RUNTIME, included
from .conditions import Conditions
from .items import Item, items, own_names

OWN = Path(__file__).resolve().parent / "c"
"""Hand-written C that only the exported law has."""
_LINE = 100  # characters of the rule above a section
_EMITTED = re.compile(r"(/\*)? ?\*? ?Emitted by wetdoublet.*?\n.*?sha256 ([0-9a-f]{64})", re.DOTALL)
_TOKENS = re.compile(r'/\*.*?\*/|"(?:[^"\\]|\\.)*"|(?:\.|->)\s*[A-Za-z_]\w*|[A-Za-z_]\w*', re.DOTALL)


@dataclass(frozen=True)
class Source:
    """A kernel before it is merged: its prefix, its files by name, and the files that begin its text.

    Arguments:
        prefix: of what depends on its structure, such as "plane".
        generated_files: texts of the generated files, by name; the others are in the runtime's folder.
        roots: files whose functions are called from elsewhere; the rest is included by them.
    """

    prefix: str
    generated_files: Mapping[str, str]
    roots: tuple[str, ...]


@dataclass
class _Kernel:
    prefix: str
    items: list[Item]
    heads: dict[str, str]  # comment at the head of each file

    @property
    def names(self) -> dict[str, list[Item]]:
        by_name: dict[str, list[Item]] = {}
        for item in self.items:
            for name in item.defines:
                by_name.setdefault(name, []).append(item)
        return by_name


def merged(sources: Sequence[Source], callers: Sequence[Item]) -> tuple[str, list[str], list[str]]:
    """The text of all kernels, the headers that they always include, and those under a condition.

    Arguments:
        callers: what stands behind the kernels, and calls their functions with the prefix.
    """
    kernels = [_parsed(source) for source in sources]
    wanted = set().union(*(item.uses for item in callers)) if callers else set()
    for kernel in kernels:
        called = {name.removeprefix(f"{kernel.prefix}_") for name in wanted if name.startswith(f"{kernel.prefix}_")}
        kernel.items = _reached(kernel, called | wanted)
    shared = _shared(kernels)
    parts, done = [], set[tuple[str, str]]()
    for kernel in kernels:
        both = [item for item in kernel.items if _is(item, shared) and (item.file, item.text) not in done]
        done |= {(item.file, item.text) for item in both if item.kind != "condition"}
        parts += _sections(both, kernel.heads, lambda item: item.text)
    text = "".join(parts)
    for kernel in kernels:
        own_items = [item for item in kernel.items if item.kind == "condition" or not _is(item, shared)]
        renamed = _renamer(kernel, own_items)
        body = "".join(_sections(own_items, kernel.heads, renamed))
        text += f"{_rule(f'Kernel `{kernel.prefix}`')}\n{body}"
    includes = {include for kernel in kernels for include in _includes(kernel.items)}
    conditional = {include for include in includes if include.startswith("#if")}
    return text, sorted(includes - conditional), sorted(conditional)


def _includes(parts: Sequence[Item]) -> list[str]:
    """The includes of a kernel, each with the conditions that it stands under."""
    includes, above = list[str](), list[str]()
    for item in parts:
        if item.kind == "include":
            includes.append("\n".join([*above, item.code.strip(), *["#endif"] * len(above)]))
        elif item.code.startswith("#endif"):
            above.pop()
        elif item.code.startswith("#if"):
            above.append(item.code.strip())
        elif item.kind == "condition" and above:
            above[-1] = f"{above[-1]}\n{item.code.strip()}"
    return includes


def digests(sources: Iterable[Source]) -> list[str]:
    """The digests of the equations that the kernels' texts are emitted from."""
    texts = (text for source in sources for text in source.generated_files.values())
    return sorted({digest[2] for text in texts for digest in _EMITTED.finditer(text)})


def _parsed(source: Source) -> _Kernel:
    conditions, result, heads = Conditions(), list[Item](), dict[str, str]()
    seen: set[str] = set()

    def put(name: str) -> None:
        if name in seen:
            return
        seen.add(name)
        path = OWN / name if (OWN / name).exists() else RUNTIME / name
        text = source.generated_files[name] if name in source.generated_files else path.read_text()
        for other in included(text):
            put(other)
        text = re.sub(r'^#include "[^"]+"\n', "", text, flags=re.MULTILINE)
        heads[name], parts = items(name, conditions.resolved(_unmarked(text)))
        result.extend(parts)

    for root in source.roots:
        put(root)
    return _Kernel(source.prefix, result, heads)


def _unmarked(text: str) -> str:
    """The text without the comments that say that it is emitted; the exported file says so at its head."""
    text = re.sub(r"/\* Emitted by wetdoublet[^*]*\n \* \w+ sha256 [0-9a-f]{64} ?\*/\n*", "", text)
    return re.sub(r"/\* Emitted by wetdoublet[^*]*\n \* \w+ sha256 [0-9a-f]{64}\n \*\n", "/*\n", text)


def _reached(kernel: _Kernel, roots: Iterable[str]) -> list[Item]:
    """The items that the roots need, directly or not."""
    names, reached, waiting = kernel.names, set[int](), list(roots)
    closure: set[str] = set()
    while waiting:
        name = waiting.pop()
        if name in closure:
            continue
        closure.add(name)
        for item in names.get(name, ()):
            if id(item) not in reached:
                reached.add(id(item))
                waiting += item.uses | {*item.defines}
    kinds = ("condition", "include")
    return _without_empty([item for item in kernel.items if item.kind in kinds or id(item) in reached])


def _without_empty(parts: list[Item]) -> list[Item]:
    """The items without conditionals that have no others in them."""
    again = True
    while again:
        again = False
        for k, item in enumerate(parts):
            if not item.code.startswith("#if"):
                continue
            end = k + 1
            while parts[end].kind == "condition" and not parts[end].code.startswith(("#endif", "#if")):
                end += 1
            if parts[end].code.startswith("#endif"):
                del parts[k : end + 1]
                again = True
                break
    return parts


def _shared(kernels: Sequence[_Kernel]) -> set[str]:
    """Names whose definitions are the same in all kernels that have them, with all that these need."""
    tables = [kernel.names for kernel in kernels]
    shared = set().union(*tables)
    texts: dict[str, set[str]] = {}
    for table in tables:
        for name, defined in table.items():
            texts.setdefault(name, set()).add("\n".join(item.text for item in defined))
    shared = {name for name, definitions in texts.items() if len(definitions) == 1}
    everywhere = set(texts)
    while True:
        lost = {
            name
            for table in tables
            for name in shared & set(table)
            for item in table[name]
            if (item.uses & everywhere) - shared or not shared >= {*item.defines}
        }
        if not lost:
            return shared
        shared -= lost


def _is(item: Item, shared: set[str]) -> bool:
    return item.kind == "condition" or (bool(item.defines) and shared >= {*item.defines})


def _renamer(kernel: _Kernel, parts: Sequence[Item]) -> Callable[[Item], str]:
    """Writes items with the kernel's prefix in front of the names that they define."""
    functions = {name for item in parts if item.kind == "function" for name in item.defines}
    defined = {name for item in parts for name in item.defines}

    def name_of(name: str) -> str:
        return f"{kernel.prefix.upper()}_{name}" if name.isupper() else f"{kernel.prefix}_{name}"

    def renamed(item: Item) -> str:
        """The text of an item; names that it declares for itself stay, unless they are called as functions."""
        hidden = own_names(item) & defined
        text = item.code

        def replacement(match: re.Match[str]) -> str:
            token = match[0]
            if token not in defined:
                return token
            if token in hidden:
                called = token in functions and text[match.end() :].lstrip().startswith("(")
                if not called:
                    return token
            return name_of(token)

        return item.comment + _TOKENS.sub(replacement, text)

    return renamed


def _sections(items: Sequence[Item], heads: Mapping[str, str], written: Callable[[Item], str]) -> list[str]:
    """Items in their order, each file under its head comment."""
    items = _without_empty([item for item in items if item.kind != "include"])
    parts, file, last = list[str](), "", None
    for item in items:
        if item.file != file and item.kind != "condition":
            file, last = item.file, None
            parts.append(f"{_rule(file.removesuffix('.h'))}\n" + (f"{heads[file]}\n\n" if heads.get(file) else ""))
        text = written(item)
        if last is not None and not (_short(last) and _short(item)):
            parts.append("\n")
        parts.append(text)
        last = item
        if item.kind == "condition":
            continue
    return [*parts, "\n"] if parts else []


def _short(item: Item) -> bool:
    return item.code.count("\n") == 1 and not item.comment


def _rule(title: str) -> str:
    return f"\n/* {'-' * 8} {title} {'-' * max(_LINE - len(title) - 16, 4)} */\n"
