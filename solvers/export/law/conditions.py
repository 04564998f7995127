"""Conditional parts of C text: those decided when a law is exported are resolved, those of the compiler are kept.

By hand, since `pcpp` also replaces macros in the code that it keeps, which an exported law leaves to its reader.
"""

import re
from collections.abc import Iterator

from ...errors import CheckFailed

OPEN = ("LANES", "__GNUC__", "__AVX2__", "__AVX512DQ__", "__has_builtin", "__cplusplus")
"""Macros that are known when the exported file is compiled."""
_DIRECTIVE = re.compile(r"^\s*#\s*(if|ifdef|ifndef|elif|else|endif|define|undef|pragma)\b\s*(.*)$")


class Conditions:
    r"""A partial preprocessor: resolves `#if` as far as macros that the text has defined decide it.

    Texts are passed in the order in which they are included; a definition holds for all texts after it.

    Examples:
        >>> Conditions().resolved("#define WALL 0\n#if WALL\nint a;\n#else\nint b;\n#endif\n")
        '#define WALL 0\nint b;\n'
    """

    def __init__(self) -> None:
        self._macros: dict[str, str] = {}

    def resolved(self, text: str) -> str:
        """The text without the parts that are left out, and without the conditions that are decided."""
        return "".join(self._lines(text))

    def value(self, expression: str) -> int | None:
        """The value of an integer constant expression of C; None if only a compiler knows it."""
        if self._is_open(expression):
            return None
        return _integer(self._plain(expression, 0))

    def _lines(self, text: str) -> Iterator[str]:
        stack: list[_Part] = []  # of nested conditions
        for line in _logical(text):
            directive = _DIRECTIVE.match(line)
            word, rest = (directive[1], _without_comment(directive[2])) if directive else ("", "")
            enclosing_kept = all(condition.kept for condition in stack[:-1])
            if word in ("if", "ifdef", "ifndef"):
                test = rest if word == "if" else f"{'' if word == 'ifdef' else '!'}defined({rest})"
                reached = all(condition.kept for condition in stack)
                stack.append(_Part(self.value(test) if reached else 0))
                if reached and stack[-1].open:
                    yield line
            elif word in ("elif", "else", "endif"):
                branch = stack[-1]
                if branch.open and enclosing_kept:
                    yield line
                elif word == "elif":
                    branch.follow(self.value(rest) if enclosing_kept and not branch.done else 0)
                elif word == "else":
                    branch.follow(1)
                if word == "endif":
                    stack.pop()
            elif all(condition.kept for condition in stack):
                if word == "pragma":
                    continue
                self._note(word, rest)
                yield line

    def _note(self, word: str, rest: str) -> None:
        name = re.match(r"\w+", rest)
        if word == "undef" and name:
            self._macros.pop(name[0], None)
        elif word == "define" and name:
            self._macros[name[0]] = rest[name.end() :].strip()

    def _is_open(self, expression: str, depth: int = 0) -> bool:
        words = set(re.findall(r"[A-Za-z_]\w*", expression))
        if depth > 20:
            raise CheckFailed(f"a macro refers to itself: {expression}")
        return any(word in OPEN or self._is_open(self._macros.get(word, ""), depth + 1) for word in words)

    def _plain(self, expression: str, depth: int) -> str:
        """The expression without names: `defined` is answered, macros are replaced."""

        def answered(match: re.Match[str]) -> str:
            return str(int((match[1] or match[2]) in self._macros))

        def replaced(match: re.Match[str]) -> str:
            name = match[0]
            return f"({self._plain(self._macros[name], depth + 1)})" if self._macros.get(name) else "0"

        expression = re.sub(r"\bdefined\s*(?:\(\s*(\w+)\s*\)|(\w+))", answered, expression)
        return re.sub(r"\b[A-Za-z_]\w*\b", replaced, expression)


class _Part:
    """A part of a conditional: whether its lines are kept, an earlier part was, or the compiler decides."""

    def __init__(self, value: int | None) -> None:
        self.open = value is None
        self.kept = value is None or bool(value)
        self.done = self.kept

    def follow(self, value: int | None) -> None:
        if value is None:
            raise CheckFailed("a condition that the compiler decides follows one that is decided")
        self.kept = bool(value) and not self.done
        self.done = self.done or self.kept


def _integer(text: str) -> int:
    """The value of an integer constant expression of C without names; between brackets its operators are Python's."""
    while inner := re.search(r"\(([^()]*)\)", text):
        text = f"{text[: inner.start()]}{_integer(inner[1])}{text[inner.end() :]}"
    test, conditional, choices = text.partition("?")
    if conditional:
        yes, _, no = choices.partition(":")
        return _integer(yes if _integer(test) else no)
    translated = re.sub(r"!(?!=)", " not ", text.replace("&&", " and ").replace("||", " or ")).replace("/", "//")
    if not re.fullmatch(r"(?:\d+|and|or|not|[=!<>]=|[<>+*/%-]|\s)+", translated):
        raise CheckFailed(f"a condition that is not understood: {text}")
    try:
        return int(eval(translated.strip(), {"__builtins__": {}}))
    except SyntaxError:
        raise CheckFailed(f"a condition that is not understood: {text}") from None


def _logical(text: str) -> Iterator[str]:
    """Lines, those that end with a backslash joined with the next."""
    held = ""
    for line in text.splitlines(keepends=True):
        held += line
        if not line.endswith("\\\n"):
            yield held
            held = ""
    if held:
        yield held


def _without_comment(text: str) -> str:
    return re.sub(r"/\*.*?\*/", "", text.replace("\\\n", " "), flags=re.DOTALL).strip()
