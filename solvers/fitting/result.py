"""The result of `fit`: estimates, rows and remarks, and how they are shown and written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputError
from ..formatting.tables import aligned
from ..host import files
from ..host.files import check_file
from ..host.pictures import Drawn
from ..host.progress import Estimated, Progress
from ..scene.items import item
from ..scene.origin import Record, Result, origin, plain
from ..scene.scene import Scene
from .free_entries import IDENTIFIED, FreeEntries, interval, unit_shown
from .joint import Part, home, worded
from .likelihood import KNEE
from .measurements import Measurements
from .optimise import Objective

_WIDE = 2.0  # ratio of the ends of an interval from which it is told as a factor
_TRIED, _PROFILE, _PER_POINT = 33, 20, 4  # evaluations of a picture; points of a profile, and evaluations of one

CONTRADICTED = (
    "At least half of the impacts contradict the model: no entry is identified, and no intervals are computed. The "
    "estimates are the least bad within a factor of 1000 of the scene's. `wetdoublet check` looks at the data."
)
"""The first remark where `RowDiagnostics.contradicted`."""


class Estimate(Record):
    """An entry: the most likely value, its 95 % interval (None: an open end), SI, and the verdict."""

    value: float
    low: float | None
    high: float | None
    verdict: str

    @property
    def precision(self) -> str:
        """How well it is known, as text: half the width of the interval relative to the value, or a factor if wide."""
        if self.verdict != IDENTIFIED or self.low is None or self.high is None or not self.value:
            return ""
        if self.low > 0 and self.high > _WIDE * self.low:
            return f"within a factor of {(self.high / self.low) ** 0.5:.2g}"
        return f"to {50 * (self.high - self.low) / abs(self.value):.2g} %"


class RowDiagnostics(Record):
    """The rows of the data under the estimates; arrays of one length, NaN where a row has no such number."""

    probability: np.ndarray = item("of the observed outcome")
    expected: Mapping[str, np.ndarray] = item(
        "result -> its mean over the scatter, where the outcome is the observed one"
    )
    residual: Mapping[str, np.ndarray] = item(
        "result -> what was measured less that, over the standard deviation of both"
    )
    log_likelihood: np.ndarray = item("of the row, relative to a perfect observation")
    pull: np.ndarray = item("how far the estimates would move without the row, in standard errors, to first order")

    @property
    def contradicting(self) -> np.ndarray:
        """Indices of the rows that lie beyond what the scatter allows."""
        return np.flatnonzero(self.log_likelihood < -KNEE)

    @property
    def contradicted(self) -> bool:
        """Whether at least half of the rows contradict the model."""
        return 2 * self.contradicting.size >= self.log_likelihood.size


class Fit(Result, Drawn):
    """The result of `fit`: what was estimated, and how that is shown and written.

    Example:
        >>> from wetdoublet.solvers import fit
        >>> impacts = {"stokes": [0.08, 0.1, 0.13, 0.16], "angle": [0.0] * 4, "outcome": ["S", "S", "B", "B"]}
        >>> fitted = fit("granulation", impacts, "liquid.glass_transition_pressure")
        >>> sorted(fitted.to_dict()["estimates"]["liquid.glass_transition_pressure"])
        ['high', 'low', 'value', 'verdict']
    """

    _picture = "fitting.plot.draw"

    parts: tuple[Part, ...] = item("the scenes with their first guesses, and their impacts")
    data: Measurements = item("the impacts of all parts")
    estimates: Mapping[str, Estimate] = item("by dotted name, NAME@LABEL of an entry that is not shared by the scenes")
    log_likelihood: float = item("maximum, with all constants of the densities; priors are not part of it")
    correlation: np.ndarray = item("of the estimates in the variables of the search, (entries, entries)")
    combinations: tuple[str, ...] = item("sentences on products of powers that the data tell")
    remarks: tuple[str, ...] = item("sentences on defaults, contradictions, and what the data lack")
    rows: RowDiagnostics
    quadrature: float = item("change of the log-likelihood with twice as fine integrals")
    others: tuple[tuple[Mapping[str, float], float], ...] = item(
        "values of less likely separate maxima, with their log-likelihoods"
    )
    objective: Objective = field(repr=False, compare=False)
    ends: tuple[tuple[np.ndarray, np.ndarray], ...] = item(
        "of each entry's interval below and above, all entries in the variables of the search",
        repr=False,
        compare=False,
    )

    @property
    def first(self) -> Scene:
        """The scene that was fitted; the first of several."""
        return self.parts[0].scene

    @cached_property
    def scenes(self) -> tuple[Scene, ...]:
        """The scenes with the most likely values."""
        return tuple(
            member.scene.with_si({name: self.estimates[member.entries[name]].value for name in member.names})
            for member in self.parts
        )

    @property
    def scene(self) -> Scene:
        """The scene with the most likely values; the first of several."""
        return self.scenes[0]

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
        return np.array([entry.inner(self.estimates[entry.name].value) for entry in self.free.entries])

    def table(self) -> tuple[list[str], list[list[str]]]:
        """Head and rows of the table of estimates."""
        rows = [
            [name, worded(self.parts, name, entry.value), interval(*home(self.parts, name), entry.low, entry.high),
             f"{entry.verdict} {entry.precision}".rstrip()]
            for name, entry in self.estimates.items()
        ]  # fmt: skip
        return ["entry", "estimate", "95 % interval", "verdict"], rows

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
        return {
            "estimates": plain(self.estimates),
            "log_likelihood": self.log_likelihood,
            "points": self.points,
            "correlation": {name: dict(zip(names, row)) for name, row in zip(names, self.correlation.tolist())},
            "combinations": list(self.combinations),
            "remarks": list(self.remarks),
            "residuals": {
                "probability": self.rows.probability.tolist(),
                **plain(self.rows.residual, gaps=True),
                "pull": self.rows.pull.tolist(),
            },
            "quadrature": self.quadrature,
            "others": [{"values": dict(values), "log_likelihood": height} for values, height in self.others],
            **origin(self.first),
            **({"scenes": [origin(member.scene)["scene"] for member in self.parts]} if len(self.parts) > 1 else {}),
            "units": {
                name: scene.fields[entry].unit or "1" if entry in scene.fields else "1"
                for name in names
                for scene, entry in (home(self.parts, name),)
            },
        }

    def __str__(self) -> str:
        head, rows = self.table()
        count = "1 impact" if self.points == 1 else f"{self.points} impacts"
        first = [CONTRADICTED, ""] if self.rows.contradicted else []
        lines = [f"{count}, log-likelihood {self.log_likelihood:.3f}", "", *first, *aligned([head, *rows])]
        for sentences in (self.combinations, [remark for remark in self.remarks if remark not in first]):
            if sentences:
                lines += ["", *sentences]
        return "\n".join(lines)

    __repr__ = __str__  # at the prompt

    def plot(self, path: str | Path | None = None, progress: Progress | None = None) -> Any:
        """Draw data over the regime map, e_n with its band, profiles and residuals; returns the matplotlib Figure.

        Arguments:
            path: file to write (.png, .pdf or .svg); None only draws.
            progress: called with (evaluations done, evaluations in all), as by `fit`.
        """
        size = self.free.size
        work = Estimated(progress, _TRIED + size * _PROFILE * (_PER_POINT if size > 1 else 1))
        work.start()
        self.objective.likelihood.tell = work.add
        try:
            return super().plot(path)
        finally:
            del self.objective.likelihood.tell
            work.finish()

    def write(self, path: str | Path) -> None:
        """Write the fitted scene as TOML, with the intervals as comments; of several NAME-1.toml, NAME-2.toml, ..."""
        file = check_file(path, "path", (".toml",))
        for k in range(len(self.parts)):
            numbered = file.with_stem(f"{file.stem}-{k + 1}") if len(self.parts) > 1 else file
            files.write(numbered, self.to_toml(k))

    def to_toml(self, part: int = 0) -> str:
        """The fitted scene as TOML, with intervals and verdicts as comments.

        Arguments:
            part: index of the scene, if there are several.
        """
        member = self.parts[part]
        try:
            scene = self._rounded(member, 6)
        except InputError:  # at the edge of what is possible
            scene = self._rounded(member, 17)
        rows = {name: f"fitted: 95 % {ends}, {verdict}" for name, _, ends, verdict in self.table()[1]}
        comments = dict(scene.comments) | {name: rows[member.entries[name]] for name in member.names}
        return Scene(scene.name, scene.given, tuple(comments.items()), scene.package).to_toml()

    def _rounded(self, member: Part, digits: int) -> Scene:
        changes: dict[str, float | str] = {}
        for name in member.names:
            value, (unit, size) = self.estimates[member.entries[name]].value, unit_shown(member.scene, name)
            changes[name] = f"{value / size:.{digits}g} {unit}" if unit else float(f"{value:.{digits}g}")
        return member.scene.with_entries(changes)
