"""Times and tables of records, as text."""

from collections.abc import Mapping, Sequence

from wetdoublet.solvers.formatting.markdown import unpadded


def us(seconds: float) -> str:
    """Microseconds with three digits."""
    return f"{seconds * 1e6:.3g}" if seconds < 1e-3 else f"{seconds * 1e6:.0f}"


def of_rows(rows: Sequence[Mapping[str, object]]) -> str:
    """Rows of a record as a Markdown table, numbers with two digits."""
    cells = [[f"{value:.2g}" if isinstance(value, float) else str(value) for value in row.values()] for row in rows]
    return "\n".join(unpadded(list(rows[0]), cells))
