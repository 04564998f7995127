"""Comments of the exported C."""

import textwrap

_WIDTH = 94  # characters of a comment's text


def comment(text: str) -> list[str]:
    """The lines of a comment."""
    lines = textwrap.wrap(text, _WIDTH)
    if len(lines) == 1:
        return [f"/* {lines[0]} */"]
    return [f"/* {lines[0]}", *(f" * {line}" for line in lines[1:]), " */"]
