"""Times and tables of records, as text."""

from collections.abc import Mapping, Sequence


def us(seconds: float) -> str:
    """Microseconds with three digits."""
    return f"{seconds * 1e6:.3g}" if seconds < 1e-3 else f"{seconds * 1e6:.0f}"


def of_rows(rows: Sequence[Mapping[str, object]]) -> str:
    """Rows of a record as a Markdown table, numbers with two digits."""
    cells = [[f"{value:.2g}" if isinstance(value, float) else str(value) for value in row.values()] for row in rows]
    lines = [list(rows[0]), ["---"] * len(rows[0]), *cells]
    return "\n".join("| " + " | ".join(cell.replace("|", r"\|") for cell in line) + " |" for line in lines)
