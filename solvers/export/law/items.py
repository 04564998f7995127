"""C text as items: the declarations, definitions and macros of a file, with the names they define and use."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from ...errors import CheckFailed

_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_STRING = re.compile(r'"(?:[^"\\]|\\.)*"')
_NAME = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
_MEMBER = re.compile(r"(?:\.|->)\s*[A-Za-z_]\w*")
_ATTRIBUTE = re.compile(r"__attribute__\s*\(\((?:[^()]|\([^()]*\))*\)\)")
_TYPES = r"(?:vec|mask|word|double|int|long|unsigned|int64_t|uint64_t|size_t|char)"


@dataclass
class Item:
    """A part of a C file at its top level, with the comment before it.

    Arguments:
        kind: "type", "data", "function", "macro" or "condition" (a directive that the compiler decides).
    """

    file: str
    kind: str
    comment: str
    code: str
    defines: tuple[str, ...] = ()
    uses: frozenset[str] = field(default_factory=frozenset)

    @property
    def text(self) -> str:
        return self.comment + self.code


def items(file: str, text: str) -> tuple[str, list[Item]]:
    """The comment at the head of a file, and its items in order; CheckFailed for a part that is not understood."""
    head, text = _head(text)
    return head, list(_items(file, text))


def own_names(item: Item) -> set[str]:
    """Names that an item declares for itself: parameters and variables of a function, members of a structure."""
    if item.kind == "function":
        return _locals(plain(item.code))
    body = re.match(r"[^{]*struct[^{]*\{(.*?)\}", plain(item.code), re.DOTALL)
    return set(re.findall(r"(\w+)\s*(?:\[[^;]*?\]\s*)*[,;]", body[1])) if body else set()


def _locals(code: str) -> set[str]:
    head, _, body = code.partition("{")
    names: set[str] = set()
    for parameter in _parts(head[head.index("(") + 1 : head.rindex(")")]):
        named = re.search(r"\(\s*\*\s*(\w+)", parameter) or re.search(r"(\w+)\s*(?:\[[^\]]*\]\s*)*$", parameter.strip())
        names |= {named[1]} if named else set()
    for declared in re.finditer(rf"(?<![\w)]){_TYPES}\s+([^;{{}}]*);", body):
        names |= {*_declared(declared[1])}
    return names


def plain(code: str) -> str:
    """Code without comments, texts and attributes."""
    return _ATTRIBUTE.sub("", _STRING.sub('""', _COMMENT.sub("", code)))


def _head(text: str) -> tuple[str, str]:
    """The first comment of a file, without what marks it as emitted, and the rest."""
    text = re.sub(r"\A\s*", "", text)
    comment = _COMMENT.match(text)
    if comment is None or not re.match(r"\s*\n\s*\n|\s*\Z|\s*\n#", text[comment.end() :]):
        return "", text
    return comment[0], text[comment.end() :]


def _items(file: str, text: str) -> Iterator[Item]:
    comment, at = "", 0
    while at < len(text):
        blank = re.compile(r"\s+").match(text, at)
        if blank:
            at = blank.end()
            continue
        remark = _COMMENT.match(text, at)
        if remark:
            comment += remark[0] + "\n"
            at = remark.end()
            continue
        end = _end(text, at)
        code = text[at:end].rstrip() + "\n"
        at = end
        if code.startswith("#include"):
            yield Item(file, "include", "", code)
        elif re.match(r"#\s*(if|elif|else|endif)", code):
            yield Item(file, "condition", "", code)
        elif not code.startswith("STATIC_ASSERT"):
            yield _item(file, comment, code)
        comment = ""


def _end(text: str, at: int) -> int:
    """The end of the item that starts here, with the comment behind it on its last line."""
    if text[at] == "#":
        match = re.compile(r"(?:[^\n\\]|\\\n|\\.)*\n?").match(text, at)
        assert match is not None
        return match.end()
    depth, place = 0, at
    for match in re.compile(r"/\*.*?\*/|\"(?:[^\"\\]|\\.)*\"|[{}()\[\];]", re.DOTALL).finditer(text, at):
        token, place = match[0], match.end()
        depth += (token in "{([") - (token in "})]") if len(token) == 1 else 0
        if depth == 0 and (token == ";" or (token == "}" and _is_function(text[at:place]))):
            behind = re.compile(r"[ \t]*/\*[^\n]*?\*/[ \t]*\n").match(text, place)
            return behind.end() if behind else place
    raise CheckFailed(f"C text that is not understood: {text[at : at + 200]}")


def _is_function(text: str) -> bool:
    head = plain(text).partition("{")[0]
    return "(" in head and "=" not in head and not head.lstrip().startswith(("typedef", "enum", "struct"))


def _item(file: str, comment: str, code: str) -> Item:
    bare = plain(code)
    if code.startswith("#"):
        match = re.match(r"#\s*(?:define|undef)\s+(\w+)", code)
        if not match:
            raise CheckFailed(f"a directive that is not understood: {code}")
        names, kind = [match[1]], "macro"
    elif bare.startswith("typedef"):
        match = re.search(r"(\w+)\s*(?:\[[^\]]*\])?\s*;\s*$", bare)
        names, kind = ([match[1]] if match else []), "type"
        names += re.findall(r"^typedef struct (\w+)", bare)
    elif re.match(r"(enum|struct)\b[^=(]*\{", bare):
        kind = "type"
        names = re.findall(r"struct (\w+)", bare)
        if not bare.startswith("struct"):
            inside = bare[bare.index("{") + 1 : bare.rindex("}")]
            names = [piece.split("=")[0].strip() for piece in _parts(inside) if piece.strip()]
    elif _is_function(bare):
        match = re.search(r"(\w+)\s*\(", bare)
        names, kind = ([match[1]] if match else []), "function"
    else:
        names, kind = _declared(bare.rstrip().rstrip(";")), "data"
    if not names:
        raise CheckFailed(f"C text that is not understood: {code}")
    item = Item(file, kind, comment, code, tuple(names))
    used = _MEMBER.sub(" ", bare)
    called = set(re.findall(r"\b([A-Za-z_]\w*)\s*\(", used))
    item.uses = frozenset(set(_NAME.findall(used)) - (own_names(item) - called) - {*names})
    return item


def _declared(text: str) -> list[str]:
    names = [re.search(r"(\w+)\s*(?:\[[^\]]*\]\s*)*$", piece.split("=")[0].strip()) for piece in _parts(text)]
    return [name[1] for name in names if name]


def _parts(text: str) -> list[str]:
    """The text between commas that no bracket encloses."""
    parts, depth = [""], 0
    for sign in text:
        depth += (sign in "([{") - (sign in ")]}")
        if sign == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += sign
    return parts
