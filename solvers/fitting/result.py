"""What a fit has found: estimates with intervals and verdicts, and what each row says of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..errors import InputError
from ..scene.origin import origin
from ..scene.scene import Scene
from .estimates import CONTRADICTED, Estimate, Rows
from .free_entries import FreeEntries
from .likelihood import Evaluation
from .measurements import Measurements
from .objective import Objective
from .shown import in_unit, interval, unit_shown

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Fit:
    """The result of `fit`.

    Attributes:
        scene: with the most likely values.
        first: the scene that was given.
        estimates: by dotted name.
        log_likelihood: maximum, with all constants of the densities; priors are not part of it.
        correlation: of the estimates in the variables of the search, (entries, entries).
        combinations: sentences on products of powers that the data tell.
        remarks: sentences on defaults, contradictions, and what the data lack.
        quadrature: change of the log-likelihood with twice as fine integrals.
        others: values of less likely separate maxima, with their log-likelihoods.
        ends: of each entry's interval below and above, all entries in the variables of the search.

    Example:
        >>> from wetdoublet.solvers import fit
        >>> seen = {"stokes": [0.08, 0.1, 0.13, 0.16], "angle": [0.0] * 4, "outcome": ["S", "S", "B", "B"]}
        >>> found = fit("granulation", seen, "liquid.glass_transition_pressure")
        >>> sorted(found.to_dict()["estimates"]["liquid.glass_transition_pressure"])
        ['high', 'low', 'value', 'verdict']
    """

    scene: Scene
    first: Scene
    data: Measurements
    estimates: Mapping[str, Estimate]
    log_likelihood: float
    correlation: np.ndarray
    combinations: tuple[str, ...]
    remarks: tuple[str, ...]
    rows: Rows
    quadrature: float
    others: tuple[tuple[Mapping[str, float], float], ...]
    objective: Objective = field(repr=False, compare=False)
    ends: tuple[tuple[np.ndarray, np.ndarray], ...] = field(repr=False, compare=False)

    @property
    def points(self) -> int:
        """Number of impacts."""
        return self.data.size

    @property
    def free(self) -> FreeEntries:
        return self.objective.free

    @cached_property
    def best(self) -> np.ndarray:
        """The estimates in the variables of the search."""
        return np.array([each.inner(self.estimates[each.name].value) for each in self.free.entries])

    @property
    def evaluation(self) -> Evaluation:
        """The likelihoods of the rows at the estimates."""
        found = self.objective.at(self.best)
        assert found is not None  # the estimates are possible
        return found

    def log_density(self, values: Mapping[str, float]) -> tuple[float, dict[str, float]]:
        """Logarithm of likelihood times prior density, and its gradient, for given values of the free entries.

        Arguments:
            values: of every free entry by dotted name, SI.

        Returns:
            the logarithm (-inf where the scene is impossible) and its derivatives by the values, SI.
        """
        return log_density(self.objective, values)

    # ---- shown and written

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet fit --json`."""
        names = list(self.estimates)
        residuals = {name: [_number(value) for value in values] for name, values in self.rows.residual.items()}
        return (
            {
                "estimates": {name: each.to_dict() for name, each in self.estimates.items()},
                "log_likelihood": self.log_likelihood,
                "points": self.points,
                "correlation": {name: dict(zip(names, row)) for name, row in zip(names, self.correlation.tolist())},
                "combinations": list(self.combinations),
                "remarks": list(self.remarks),
                "residuals": {
                    "probability": self.rows.probability.tolist(),
                    **residuals,
                    "pull": self.rows.pull.tolist(),
                },
                "quadrature": self.quadrature,
                "others": [{"values": dict(values), "log_likelihood": height} for values, height in self.others],
            }
            | origin(self.first)
            | {"units": {name: self.first.fields[name].unit or "1" for name in names}}
        )

    def to_pandas(self) -> pd.DataFrame:
        """A row for each impact: what was observed, and what the fitted scene says of it."""
        from ..formatting.frames import frame

        data = self.data
        columns: dict[str, Any] = {
            "row": [data.label(k) for k in range(data.size)], data.speed_name: data.speed, "angle": data.angle,
            "outcome": [OUTCOMES[code] if code >= 0 else "" for code in data.outcome],
            "probability": self.rows.probability,
        }  # fmt: skip
        for name, expected in self.rows.expected.items():
            columns |= {name: data.observed[name][0], f"{name}_expected": expected}
            columns[f"{name}_residual"] = self.rows.residual[name]
        return frame(columns | {"log_likelihood": self.rows.log_likelihood, "pull": self.rows.pull})

    def __str__(self) -> str:
        width = max(len(name) for name in self.estimates)
        rows = [
            (name, in_unit(self.first, name, each.value), interval(self.first, name, each.low, each.high), each.verdict)
            for name, each in self.estimates.items()
        ]
        widths = [
            max(len(row[k]) for row in (*rows, ("entry", "estimate", "95 % interval", "verdict"))) for k in range(4)
        ]
        widths[0] = max(width, widths[0])
        head = ("entry", "estimate", "95 % interval", "verdict")
        count = "1 impact" if self.points == 1 else f"{self.points} impacts"
        first = [CONTRADICTED, ""] if self.rows.contradicted else []
        lines = [f"{count}, log-likelihood {self.log_likelihood:.3f}", "", *first]
        lines += ["  ".join(cell.ljust(size) for cell, size in zip(row, widths)).rstrip() for row in (head, *rows)]
        remarks = [each for each in self.remarks if each not in first]
        for said in (self.combinations, remarks):
            if said:
                lines += ["", *said]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        from ..formatting.notebook import view

        rows = [
            [name, in_unit(self.first, name, each.value), interval(self.first, name, each.low, each.high), each.verdict]
            for name, each in self.estimates.items()
        ]
        notes = [CONTRADICTED] if self.rows.contradicted else []
        return view(f"fit of {self.points} impacts", rows, ["entry", "estimate", "95 % interval", "verdict"], notes)

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
            made = self._rounded(6)
        except InputError:  # at the edge of what is possible
            made = self._rounded(17)
        comments = dict(made.comments) | {
            name: f"fitted: 95 % {interval(self.first, name, each.low, each.high)}, {each.verdict}"
            for name, each in self.estimates.items()
        }
        return Scene(made.name, made.given, tuple(comments.items()), made.package).to_toml()

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


def log_density(objective: Objective, values: Mapping[str, float]) -> tuple[float, dict[str, float]]:
    """Logarithm of likelihood times prior density, and its gradient by the values, SI."""
    free = objective.free
    inner = np.array([each.inner(float(values[each.name])) for each in free.entries])
    height = objective.value(inner)
    if not np.isfinite(height):
        return -np.inf, dict.fromkeys(free.names, 0.0)
    slope = objective.gradient(inner) / free.rates(free.values(inner))
    return height, dict(zip(free.names, slope.tolist(), strict=True))


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
