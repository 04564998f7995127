"""The result of `design`, shown and written."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ..fitting.free_entries import in_unit, interval
from ..formatting.markdown import aligned
from ..scene.held import NAMES
from ..scene.origin import origin
from .planned import Planned

_NOTABLE = 0.5  # least bound on the efficiency that is worth a sentence


@dataclass(frozen=True)
class Design(Planned):
    """The result of `design`: planned impacts, what they will tell, and how that is shown and written.

    `impacts` are the planned ones, `expected` and `before` the intervals of the entries with and without them,
    `against_grid` their lengths beside those of an even grid. The attributes are listed at `Planned`.

    Example:
        >>> from wetdoublet.solvers import design
        >>> found = design("granulation", "liquid.viscosity", {"stokes": (0.05, 0.3), "angle": 0.0}, 3)
        >>> sum(each.count for each in found.impacts)
        3
    """

    def to_dict(self) -> dict[str, Any]:
        """The JSON object of `wetdoublet design --json`."""
        scatter = self.window.scatter
        return {
            "impacts": [
                {
                    "count": each.count, "stokes": each.stokes, "speed": each.speed,
                    "relative_speed": each.relative_speed, "angle": each.angle,
                    "probability": dict(zip(("stick", "stick-rotate-separate", "bounce"), each.probability)),
                }
                for each in self.impacts
            ],
            "expected": {name: asdict(each) for name, each in self.expected.items()},
            "before": {name: asdict(each) for name, each in self.before.items()},
            "against_grid": dict(self.against_grid),
            "grid": list(self.grid),
            "combinations": list(self.combinations),
            "efficiency": self.efficiency,
            "for": self.target,
            "draws": self.draws,
            "candidates": self.candidates,
            "scatter": {self._speed: scatter.speed, "angle": scatter.angle, "restitution": scatter.restitution},
        } | origin(self.window.scene)  # fmt: skip

    def to_csv(self) -> str:
        """A row for each impact in the form that `fit` reads, its observations empty."""
        scatter, name = self.window.scatter, self._speed
        file = io.StringIO()
        writer = csv.writer(file, lineterminator="\n")
        head = [f"{name} [m/s]", f"{name}_sd [m/s]", "angle [deg]", "angle_sd [deg]", "outcome"]
        measured = scatter.restitution is not None
        writer.writerow(head + (["restitution", "restitution_sd"] if measured else []))
        for each in self.impacts:
            speed = getattr(each, name)
            row = [f"{speed:.6g}", f"{scatter.speed * speed:.3g}", f"{math.degrees(each.angle):.4f}"]
            row += [f"{math.degrees(scatter.angle):.4g}", ""]
            writer.writerows([row + (["", f"{scatter.restitution:.4g}"] if measured else [])] * each.count)
        return file.getvalue()

    def __str__(self) -> str:
        scene, scatter = self.given, self.window.scatter
        names = self.free.names if self.target is None else (self.target,)
        title = f"{self.size} impact{'s' * (self.size > 1)} for {', '.join(names)}"
        rows = [(*self._head(), "S / SRS / B (%)")]
        for row, each in zip(self._rows(), self.impacts, strict=True):
            rows.append((*row, " / ".join(f"{100 * share:.0f}" for share in each.probability)))
        speeds, angles = self.grid
        entries = [("entry", "expected 95 % interval", "before", f"beside a {speeds} x {angles} grid")]
        for name, expected in self.expected.items():
            before = self.before[name]
            entries.append((
                name, interval(scene, name, expected.low, expected.high),
                interval(scene, name, before.low, before.high),
                "-" if expected.low is expected.high else f"{self.against_grid[name]:.2g} of its interval",
            ))  # fmt: skip
        noise = "outcomes only" if scatter.restitution is None else f"restitution to {scatter.restitution:.3g}"
        values = zip(self.free.names, self.values.tolist(), strict=True)
        now = ", ".join(f"{name} = {in_unit(scene, name, value)}" for name, value in values)
        averaged = f", averaged over {self.draws} draws" if self.draws > 1 else ""
        share_of_speed = f"{100 * scatter.speed:.3g} % of the {NAMES[self._speed]}"
        scattered = f"scatter {share_of_speed}, {math.degrees(scatter.angle):.3g} deg; {noise}"
        sentences = [f"Planned for {now}{averaged}; {scattered}."]
        combined = [name for name, each in self.expected.items() if each.low is each.high]
        if self.combinations and combined:
            sentences.append(
                "Entries open at both ends are told in combination only; a prior on one may close the others."
            )
        sentences += self.combinations
        if (self.efficiency or 0) > _NOTABLE and self.candidates > 1:
            share = math.floor(100 * (self.efficiency or 0))
            least = f"At least {share} % as good" if share < 100 else "As good"
            sentences.append(f"{least} as any other {self.size} of {self.candidates} candidates.")
        return "\n".join([title, "", *aligned(rows), "", *aligned(entries), "", *sentences])

    def _repr_html_(self) -> str:
        from ..formatting.notebook import view

        return view(f"design of {self.size} impacts", self._rows(), self._head())

    @property
    def _speed(self) -> str:
        """Which speed is shown."""
        return self.window.key if self.window.key != "stokes" else "speed"

    def _head(self) -> tuple[str, ...]:
        return "times", "St", NAMES[self._speed], "angle"

    def _rows(self) -> list[tuple[str, ...]]:
        return [
            (str(each.count), f"{each.stokes:.4g}", f"{getattr(each, self._speed):.4g} m/s",
             f"{math.degrees(each.angle):.1f} deg")
            for each in self.impacts
        ]  # fmt: skip

    def plot(self, path: str | Path | None = None) -> Any:
        """Draw what single impacts tell over the window, and the planned ones; returns the matplotlib Figure.

        Arguments:
            path: file to write (.png, .pdf or .svg); None only draws.
        """
        from ..host.pictures import saved
        from .plot import draw

        return saved(lambda: draw(self), path)
