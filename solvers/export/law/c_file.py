"""One C file of several kernels: what they share once, then each with its prefix before its names.

The C is the runtime's and the emitted, which is laid out alike: what stands at file scope begins a line. The runtime's
conditions stay, of the options that stand at the head of each kernel: the C compiler decides them.
"""

import re
from collections.abc import Iterator, Mapping, Sequence

from ...engines.taylor.source import resolved
from .kernels import SPACE, Kernel

_ROOTS, _SPACE_ROOTS = ("run_block.h", "follow.h"), ("space_rows.h", "held.h")
"""Files of a kernel whose functions the law calls; the others are included by them."""
_SHARED, _SHARED_IN_SPACE = ("vector.h", "automaton.h", "block.h"), ("vector3.h", "pairs.h", "ends.h")
"""Files whose types kernels and their callers exchange, with all that they include."""
_EMITTED = re.compile(r"/\* Emitted by wetdoublet[^*]*\n \* [\w ]+ sha256 ([0-9a-f]{64})(?: ?\*/\n+|\n \*(\n))")
_NO_CODE = r'/\*.*?\*/|"(?:[^"\\\n]|\\.)*"'
_DEFINITION = re.compile(
    r"""
    ^\#define\ (\w+)
    | ^(?!typedef)[A-Za-z_][\w\ *]*[\ *](\w+)\(                        # function
    | ^\}\ (\w+);                                                       # end of a structure
    | ^typedef\ struct\ \{.*?\}\ (\w+);
    | ^typedef\ [^{;]*?\b(\w+)(?:\[\w+\])?(?:\ __attribute__[^;]*)?;
    | ^(?:typedef\ )?struct\ (\w+)
    """,
    re.MULTILINE | re.VERBOSE,
)
_ENUMERATION = re.compile(r"\benum \{(.*?)\}", re.DOTALL)
_ENUMERATOR = re.compile(r"(?:\A|,)\s*(\w+)")
_DATA = re.compile(r"^static const (?:struct \{[^}]*\})?([^;(]*;)", re.MULTILINE)  # without a structure's members
_VARIABLE = re.compile(r"\b(\w+)(?:\[[^\]]*\])*(?=\s*(?:=[^=]|;))")
_TOKEN = re.compile(
    rf"{_NO_CODE}|(?P<structure>\bstruct[^;{{}}()]*\{{[^{{}}]*\}})|(?:\.|->)\s*\w+|\b[A-Za-z_]\w*", re.DOTALL
)
_TYPE_OR_SIZE = re.compile(rf"{_NO_CODE}|\b[A-Za-z_]\w*\b(?!\s*[\[,;])", re.DOTALL)  # in a structure; no member


def kernels_text(law_kernels: Sequence[Kernel]) -> str:
    """The C of a law's kernels."""
    first = law_kernels[0].files
    in_space = any(kernel.prefix == SPACE for kernel in law_kernels) or law_kernels[0].scene.wall
    shared = _SHARED + (_SHARED_IN_SPACE if in_space else ())
    parts = [_included(shared, {**first, "settings.h": ""})]
    for kernel in law_kernels:
        again = {name: "" for name in shared if kernel.files.get(name) == first.get(name)}
        roots = _SPACE_ROOTS if kernel.prefix == SPACE else _ROOTS if kernel.variant.limit else _ROOTS[:1]
        text = _included(("settings.h", *roots), {**kernel.files, **again})
        parts.append(f"\n/* {f' Kernel `{kernel.prefix}` ':-^94} */\n{_prefixed(kernel.prefix, text)}")
    return "".join(parts)


def digests(law_kernels: Sequence[Kernel]) -> list[str]:
    """The digests of the equations that the kernels' texts are emitted from."""
    texts = (text for kernel in law_kernels for text in kernel.files.values())
    return sorted({digest[1] for text in texts for digest in _EMITTED.finditer(text)})


def _included(names: Sequence[str], texts: Mapping[str, str]) -> str:
    """The text of files and all that they include, without the marks of what is emitted."""
    text = resolved("".join(f'#include "{name}"\n' for name in names), texts)
    return _EMITTED.sub(lambda mark: f"/*{mark[2]}" if mark[2] else "", text)


def _prefixed(prefix: str, text: str) -> str:
    r"""The text with `prefix_`, of macros and enumerators `PREFIX_`, before names that it defines; members stay.

    Examples:
        >>> _prefixed("plane", "static double gap(const state *s)\n{\n    return s->gap; /* gap */\n}\n")
        'static double plane_gap(const state *s)\n{\n    return s->gap; /* gap */\n}\n'
    """
    defined = {*_defined(re.sub(_NO_CODE, " ", text, flags=re.DOTALL))}

    def replaced(token: re.Match[str]) -> str:
        name = token[0]
        if token.lastgroup == "structure":
            return _TYPE_OR_SIZE.sub(replaced, name)
        if name not in defined:
            return name
        return f"{prefix.upper()}_{name}" if name.isupper() else f"{prefix}_{name}"

    return _TOKEN.sub(replaced, text)


def _defined(code: str) -> Iterator[str]:
    """The names that C without comments and texts defines at file scope."""
    for definition in _DEFINITION.finditer(code):
        yield definition[definition.lastindex or 0]
    for enumeration in _ENUMERATION.finditer(code):
        yield from _ENUMERATOR.findall(enumeration[1])
    for data in _DATA.finditer(code):
        yield from _VARIABLE.findall(data[1])
