"""The accessor `.wetdoublet` of this package's Datasets: it draws one by the function for its variables.

The functions that draw are found by name on first use: they lie above this in the import order, and import matplotlib.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from ..errors import InputError
from .files import PICTURES, check_file, save

if TYPE_CHECKING:
    import xarray

_HOMES = {  # a variable that only one kind of result has -> what draws it
    "first_order": "sensitivity.plots.draw_band",
    "engine": "sensitivity.plots.draw_gradients",
    "outcome": "many.plot_map.draw",
}
_ROOT = __package__.rpartition(".")[0]


def plot(data: Any, path: str | Path | None = None) -> Any:
    """Draw a result, or a Dataset that this package has made, read back from a file or not.

    Arguments:
        data: a result that has a picture, or a Dataset of `collide_many`, `regime_map`, `band` or `gradients_many`.
        path: file to write (.png, .pdf or .svg); None only draws.

    Returns:
        The matplotlib Figure.

    Raises:
        InputError: another Dataset, or a file of another kind.

    Example:
        >>> from wetdoublet.solvers import plot, regime_map
        >>> figure = plot(regime_map("granulation", stokes=[0.01, 0.1, 0.3], angle=["10 deg", "40 deg", "70 deg"]))
    """
    variables = getattr(data, "data_vars", ())
    home = getattr(data, "_picture", None) or next((_HOMES[name] for name in _HOMES if name in variables), None)
    if home is None:
        accepted = "a result or a Dataset that this package has made"
        raise InputError("data", type(data).__name__, accepted, "has no picture")
    return saved(lambda: _drawing(home)(data), path)


def _drawing(home: str) -> Callable[[Any], Any]:
    module, _, function = home.rpartition(".")
    drawing: Callable[[Any], Any] = getattr(import_module(f"{_ROOT}.{module}"), function)
    return drawing


def saved(draw: Callable[[], Any], path: str | Path | None) -> Any:
    """The figure that is drawn, written to a file if one is named; the name is checked before anything is drawn."""
    file = None if path is None else check_file(path, "path", PICTURES)
    figure = draw()
    if file is not None:
        save(figure, file, dpi=150)
    return figure


class Drawn:
    """A result with a picture."""

    _picture: ClassVar[str]  # what draws it, by name as above

    def plot(self, path: str | Path | None = None) -> Any:
        """Draw it; returns the matplotlib Figure.

        Arguments:
            path: file to write (.png, .pdf or .svg); None only draws.
        """
        return saved(lambda: _drawing(self._picture)(self), path)


class Pictures:
    """The accessor: `data.wetdoublet.plot("picture.png")`."""

    def __init__(self, data: xarray.Dataset) -> None:
        self._data = data

    def plot(self, path: str | Path | None = None) -> Any:
        return plot(self._data, path)


@cache
def register() -> None:
    """Make the accessor known to xarray; called where a Dataset is made."""
    import xarray

    xarray.register_dataset_accessor("wetdoublet")(Pictures)
