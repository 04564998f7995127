"""The result of `fit`, shown and written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..errors import InputError
from ..formatting.markdown import aligned
from ..scene.origin import origin
from ..scene.scene import Scene
from .estimates import CONTRADICTED, Fitted
from .free_entries import interval, unit_shown

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Fit(Fitted):
    """The result of `fit`: what was found, and how that is shown and written. Its attributes are those of `Fitted`.

    Example:
        >>> from wetdoublet.solvers import fit
        >>> seen = {"stokes": [0.08, 0.1, 0.13, 0.16], "angle": [0.0] * 4, "outcome": ["S", "S", "B", "B"]}
        >>> found = fit("granulation", seen, "liquid.glass_transition_pressure")
        >>> sorted(found.to_dict()["estimates"]["liquid.glass_transition_pressure"])
        ['high', 'low', 'value', 'verdict']
    """

    def log_density(self, values: Mapping[str, float]) -> tuple[float, dict[str, float]]:
        """Logarithm of likelihood times prior density, and its gradient, for given values of the free entries.

        Arguments:
            values: of every free entry by dotted name, SI.

        Returns:
            the logarithm (-inf where the scene is impossible) and its derivatives by the values, SI.
        """
        return self.objective.log_density(values)

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet fit --json`."""
        names = list(self.estimates)
        residuals = {
            name: [float(value) if np.isfinite(value) else None for value in values]
            for name, values in self.rows.residual.items()
        }
        return {
            "estimates": {name: asdict(each) for name, each in self.estimates.items()},
            "log_likelihood": self.log_likelihood,
            "points": self.points,
            "correlation": {name: dict(zip(names, row)) for name, row in zip(names, self.correlation.tolist())},
            "combinations": list(self.combinations),
            "remarks": list(self.remarks),
            "residuals": {
                "probability": self.rows.probability.tolist(), **residuals, "pull": self.rows.pull.tolist()
            },
            "quadrature": self.quadrature,
            "others": [{"values": dict(values), "log_likelihood": height} for values, height in self.others],
            **origin(self.first),
            "units": {name: self.first.fields[name].unit or "1" for name in names},
        }  # fmt: skip

    def to_pandas(self) -> pd.DataFrame:
        """A row for each impact: what was observed, and what the fitted scene predicts of it."""
        from ..formatting.frames import frame

        data = self.data
        cells: dict[str, Any] = {
            "row": [data.label(k) for k in range(data.size)], data.speed_name: data.speed, "angle": data.angle,
            "outcome": [OUTCOMES[code] if code >= 0 else "" for code in data.outcome],
            "probability": self.rows.probability,
        }  # fmt: skip
        for name, expected in self.rows.expected.items():
            cells |= {name: data.observed[name][0], f"{name}_expected": expected}
            cells[f"{name}_residual"] = self.rows.residual[name]
        return frame(cells | {"log_likelihood": self.rows.log_likelihood, "pull": self.rows.pull})

    def __str__(self) -> str:
        head, rows = self.table()
        count = "1 impact" if self.points == 1 else f"{self.points} impacts"
        first = [CONTRADICTED, ""] if self.rows.contradicted else []
        lines = [f"{count}, log-likelihood {self.log_likelihood:.3f}", "", *first, *aligned([head, *rows])]
        for sentences in (self.combinations, [each for each in self.remarks if each not in first]):
            if sentences:
                lines += ["", *sentences]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        from ..formatting.notebook import view

        head, rows = self.table()
        return view(f"fit of {self.points} impacts", rows, head, [CONTRADICTED] if self.rows.contradicted else [])

    def plot(self, path: str | Path | None = None) -> Any:
        """Draw data over the regime map, e_n with its band, profiles and residuals; returns the matplotlib Figure.

        Arguments:
            path: file to write (.png, .pdf or .svg); None only draws.
        """
        from ..host.pictures import saved
        from .plot import draw

        return saved(lambda: draw(self), path)

    def write(self, path: str | Path) -> None:
        """Write the fitted scene as TOML, with the intervals as comments."""
        from ..host import files
        from ..host.outputs import check_file

        files.write(check_file(path, "path", (".toml",)), self.to_toml())

    def to_toml(self) -> str:
        """The fitted scene as TOML, with intervals and verdicts as comments."""
        try:
            scene = self._rounded(6)
        except InputError:  # at the edge of what is possible
            scene = self._rounded(17)
        comments = dict(scene.comments) | {
            name: f"fitted: 95 % {interval(self.first, name, each.low, each.high)}, {each.verdict}"
            for name, each in self.estimates.items()
        }
        return Scene(scene.name, scene.given, tuple(comments.items()), scene.package).to_toml()

    def _rounded(self, digits: int) -> Scene:
        changes: dict[str, float | str] = {}
        for name, each in self.estimates.items():
            unit, size = unit_shown(self.first, name)
            changes[name] = f"{each.value / size:.{digits}g} {unit}" if unit else float(f"{each.value:.{digits}g}")
        return self.first.with_entries(changes)

    def report(self, folder: str | Path) -> list[Path]:
        """Write report.md, report.html and their picture into a folder; returns the files."""
        from .report import write_report

        return write_report(self, folder)
