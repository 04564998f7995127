"""Reports: a sequence of blocks as Markdown."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby

from .markdown import unpadded


@dataclass(frozen=True)
class Table:
    """A table: a caption, which may be empty, a head, rows of text."""

    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True)
class Picture:
    """A picture: file name in the report's folder, and caption."""

    file: str
    caption: str

    @property
    def alternative(self) -> str:
        """The first sentence of the caption without markup, for readers who do not see the picture."""
        return re.sub(r"[\[\]*_]", "", self.caption.split(".", maxsplit=1)[0])


@dataclass(frozen=True)
class Formulas:
    """Equations: heading of the group, LaTeX and note of each."""

    lines: Sequence[tuple[str, str, str]]


Block = str | Sequence[str] | Table | Picture | Formulas
"""A paragraph, or a heading if the text begins with `## `; a list, a table, a picture, or equations."""


def markdown(title: str, blocks: Iterable[Block]) -> str:
    """The report in Markdown; formulas in LaTeX between dollars."""
    out = [f"# {title}"]
    for block in blocks:
        if isinstance(block, str):
            out.append(block)
        elif isinstance(block, Table):
            out += [f"**{block.caption}**"] if block.caption else []
            out.append("\n".join(unpadded(block.head, block.rows)))
        elif isinstance(block, Picture):
            out += [f"![{block.alternative}]({block.file})", f"*{block.caption}*"]
        elif isinstance(block, Formulas):
            for heading, lines in groupby(block.lines, key=lambda line: line[0]):
                out.append(f"### {heading}")
                out += [text for _, latex, note in lines for text in (f"$$ {latex} $$", note) if text]
        else:
            out.append("\n".join(f"* {line}" for line in block))
    return "\n\n".join(out) + "\n"
