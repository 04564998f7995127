"""Tables as pandas DataFrames; pandas is optional."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ..errors import ComputationError

if TYPE_CHECKING:
    import pandas as pd


def frame(columns: Mapping[str, Sequence[Any]]) -> pd.DataFrame:
    """A DataFrame of named columns; ComputationError if pandas is not installed."""
    try:
        import pandas as pd
    except ImportError:
        raise ComputationError("a DataFrame needs pandas", advice="pip install pandas") from None
    return pd.DataFrame({name: list(values) for name, values in columns.items()})
