"""Experiments: impacts on rows of scenes that share their choices and differ in numbers, and their results.

All impacts of a call go through the kernel together. Quantities in which rows differ from each other or from the scene
are passed as columns, so that no scene is built anew. With free entries the results have derivatives by their values.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from casadi import SX, Function, densify, jacobian, vertcat

from ...generated.automaton import LAST_ANSWER
from ..engines.settings import KERNEL_STEPS
from ..engines.taylor.call import KernelImpacts, run_kernel
from ..engines.taylor.layout import result
from ..engines.taylor.tangent import run_tangent
from ..many.by_kernel import admissible
from ..results import DEFINITIONS
from ..scene.quantities import quantities
from ..scene.scene import Scene
from ..scene.schema import MEETING

UNDECIDED = -1
STEEPEST = np.arccos(4e-5)
"""Largest impact angle that is computed, rad; a steeper impact counts as one at this angle."""

LENGTHS = ("solids", "touch", "apart")
"""Distances of the centres (m) of touching solids and at both ends of contact, of rows that need them."""

_HEAD_ON = 1e-12  # angle (rad) below which an impact is head-on: rounding on a line along the speeds


def free_names(scene: Scene) -> tuple[str, ...]:
    """The entries of a scene that may be free: its numbers, without those of the impact."""
    return tuple(name for name, value in scene.si if not isinstance(value, str) and not name.startswith("impact."))


class Rows:
    """The quantities of rows as a function of the values of free entries.

    Arguments:
        scene: what the rows share.
        names: the free entries, dotted.
        columns: other entries that differ from row to row, by dotted name.
        size: number of rows, 1 if all are alike.
        rtol: relative tolerance of the integrations.
    """

    def __init__(
        self, scene: Scene, names: tuple[str, ...], columns: Mapping[str, np.ndarray], size: int, rtol: float
    ) -> None:
        self.scene, self.names, self.columns, self.rtol = scene, names, columns, rtol
        self.size = size
        entries = [*names, *columns]
        column = SX.sym("entries", len(entries))
        shared: dict[str, Any] = {name: value for name, value in scene.si if name not in MEETING}
        by_quantity = quantities(shared | {name: column[k] for k, name in enumerate(entries)}, scene.ways)
        by_quantity |= self.lengths(by_quantity)
        self._quantities = tuple(name for name in by_quantity if name != "density")
        stacked = vertcat(*(SX(by_quantity[name]) for name in self._quantities))
        slopes = jacobian(stacked, column[: len(names)]) if names else SX(stacked.numel(), 0)
        self._map = Function("quantities", [column], [densify(stacked), densify(slopes)])

    def lengths(self, by_quantity: Mapping[str, Any]) -> dict[str, Any]:
        """LENGTHS from quantities, where they are needed."""
        return {}

    def at(self, values: np.ndarray) -> Experiment | None:
        """The experiment with these values of the free entries; None where they make the scene of a row impossible."""
        experiment = self.unchecked(values)
        return experiment if experiment.possible.all() else None

    def unchecked(self, values: np.ndarray) -> Experiment:
        """The experiment with these values, which may make the scene of a row impossible."""
        entries = np.broadcast_to(values[:, None], (len(self.names), self.size))
        mapped, slopes = self._map.map(self.size)(np.vstack([entries, *self.columns.values()]))
        by_quantity = np.asarray(slopes.full()).reshape(len(self._quantities), self.size, len(self.names))
        columns = dict(zip(self._quantities, np.asarray(mapped.full()), strict=True))
        return Experiment(self, values, columns, dict(zip(self._quantities, by_quantity, strict=True)), self.rtol)


@dataclass(frozen=True)
class Results:
    """Results of impacts and their derivatives, SI; NaN where the kernel has none.

    Attributes:
        outcome: (impacts,).
        value: (results, impacts).
        free: (results, impacts, free entries), by the values of the free entries.
        speed, angle: (results, impacts), by normal speed and angle.
    """

    outcome: np.ndarray
    value: np.ndarray
    free: np.ndarray
    speed: np.ndarray
    angle: np.ndarray

    @classmethod
    def empty(cls, shape: tuple[int, ...], entries: int) -> Results:
        """No result yet, derivatives 0; the shape is (results, impacts)."""
        zeros = np.zeros((*shape, entries)), np.zeros(shape), np.zeros(shape)
        return cls(np.zeros(shape[1], np.int8), np.full(shape, np.nan), *zeros)


@dataclass(frozen=True)
class Experiment:
    """Scenes by row, and collisions of them at any normal speeds (m/s) and angles (rad), each on one of the rows.

    The angle may be negative: the mirror image of the positive one.

    Attributes:
        rows: the quantities as a function of the free entries.
        values: of the free entries.
        columns: name of a quantity -> (rows,), or (1,) where all rows are alike, SI.
        slopes: the same, with the derivatives by the free entries along the last axis.
        rtol: relative tolerance of the integrations.
    """

    rows: Rows
    values: np.ndarray
    columns: Mapping[str, np.ndarray]
    slopes: Mapping[str, np.ndarray]
    rtol: float

    @property
    def scene(self) -> Scene:
        return self.rows.scene

    @property
    def possible(self) -> np.ndarray:
        """Mask of the rows whose quantities make a scene; of one element where all rows are alike."""
        finite = np.isfinite(list(self.columns.values())).all(axis=0)
        return finite & admissible(self.scene, self.columns)

    def _share(self, row: np.ndarray) -> np.ndarray:
        """Index of the quantities of each row."""
        return row if next(iter(self.columns.values())).size > 1 else np.zeros(row.size, int)

    def joined(self, others: Sequence[Experiment], row: np.ndarray) -> tuple[Experiment, np.ndarray]:
        """These experiments, one after the other, as one, and its rows: `row` of the first, of the second, and on."""
        every = [self, *others]
        columns = {name: np.concatenate([experiment.columns[name] for experiment in every]) for name in self.columns}
        size = next(iter(self.columns.values())).size
        return replace(self, columns=columns), np.concatenate([self._share(row) + k * size for k in range(len(every))])

    def impacts(self, row: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> KernelImpacts:
        """Impacts on these rows, as the kernel takes them."""
        share, material = self._share(row), self.scene.material
        others = {
            name: values[share]
            for name, values in self.columns.items()
            if name not in LENGTHS and (values.size > 1 or float(values[0]) != material.get(name))
        }
        for name in ("impact_spin", "impact_partner_spin"):
            spin = self.columns.get(name)
            if spin is not None and spin.any() and (angle < 0).any():
                others[name] = spin[share] * np.where(angle < 0, -1.0, 1.0)
        size = np.abs(angle)
        return KernelImpacts(self.scene, speed, np.where(size < _HEAD_ON, 0.0, np.minimum(size, STEEPEST)), others)

    def answers(
        self, row: np.ndarray, speed: np.ndarray, angle: np.ndarray, rotation: bool = False, **options: Any
    ) -> np.ndarray:
        """What `run_kernel` answers, with its options."""
        return run_kernel(self.impacts(row, speed, angle), self.rtol, rotation, **options)

    def outcomes(self, row: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> np.ndarray:
        """Outcomes of impacts, UNDECIDED where the kernel does not decide one."""
        answers = self.answers(row, speed, angle, jumps=2)
        return np.where(answers["status"] > LAST_ANSWER, UNDECIDED, answers["outcome"]).astype(np.int8)

    def plain(self, names: tuple[str, ...], row: np.ndarray, speed: np.ndarray, angle: np.ndarray) -> np.ndarray:
        """The results alone, (results, impacts): of long trajectories in a fraction of the time."""
        answers = self.answers(
            row, speed, angle, "rotation" in names, jumps=min(DEFINITIONS[name].jumps for name in names)
        )
        done = (answers["status"] <= LAST_ANSWER) & (answers["outcome"] > 0)
        results = np.stack([np.where(done, result(answers, name), np.nan) for name in names])
        for k, name in enumerate(names):
            if name == "contact_time":
                results[k] *= self.columns["film_thickness"][self._share(row)] / speed
            if name == "rotation":
                results[k, angle < 0] *= -1
        return results

    def results(
        self, names: tuple[str, ...], row: np.ndarray, speed: np.ndarray, angle: np.ndarray, forward: bool = False,
        budget: int = KERNEL_STEPS,
    ) -> Results:  # fmt: skip
        """Results of impacts, with derivatives.

        Arguments:
            forward: carry all derivatives forward, also where the adjoint would give the restitution's.
            budget: steps of a trajectory, where longer ones may be left out.
        """
        impacts = self.impacts(row, speed, angle)
        results = Results.empty((len(names), row.size), len(self.rows.names))
        for oblique, which in impacts.by_kind():
            self._fill(results, names, row[which], impacts.subset(which), which, oblique, forward, budget)
        mirrored = np.where(angle < 0, -1.0, 1.0)
        results.angle[:] *= mirrored
        if "rotation" in names:
            k = names.index("rotation")
            for values in (results.value, results.speed, results.angle):
                values[k] *= mirrored
            results.free[k] *= mirrored[:, None]
        return results

    def _fill(
        self, results: Results, names: tuple[str, ...], row: np.ndarray, impacts: KernelImpacts, which: np.ndarray,
        oblique: bool, forward: bool, budget: int,
    ) -> None:  # fmt: skip
        """Fill in the results of impacts `which`, that are all oblique or all head-on."""
        rtol, rotation, share = self.rtol, "rotation" in names, self._share(row)
        moved = (*(name for name, slope in self.slopes.items() if slope.any()), "speed", "angle")
        back = not forward and names == ("restitution",)
        run = run_tangent(impacts, oblique, rtol, rotation, None if back else moved, None, budget, back, False)
        answers, slopes = run.answers, run.slopes
        failures = np.flatnonzero(answers["status"] > LAST_ANSWER)
        if back and failures.size:
            again = run_tangent(impacts.subset(failures), oblique, rtol, rotation, moved, None, budget, False, False)
            answers[failures], slopes[failures] = again.answers, again.slopes[:, :, :1]
        done, count = answers["status"] <= LAST_ANSWER, len(self.rows.names)
        results.outcome[which] = np.where(done, answers["outcome"], UNDECIDED)
        axes = np.eye(count + 2)  # of the free entries, speed and angle
        by = {entry: self.slopes[entry][share] @ axes[:count] for entry in moved[:-2]}
        by |= {"speed": np.tile(axes[-2], (which.size, 1)), "angle": np.tile(axes[-1], (which.size, 1))}
        film = self.columns["film_thickness"][share]
        time = film / impacts.speed, -by["speed"] / impacts.speed[:, None]
        if "film_thickness" in by:
            time[1][:] += by["film_thickness"] / film[:, None]
        for k, name in enumerate(names):
            value, slope = run.along(name, by, {"time": time})
            results.value[k, which] = np.where(done & (answers["outcome"] > 0), value, np.nan)
            results.free[k, which] = slope[:, :count]
            results.speed[k, which], results.angle[k, which] = slope[:, -2:].T

    @property
    def scales(self) -> np.ndarray:
        """What steps of differences are parts of, as `values`: 1 for fractions and angles, which may be 0."""
        bounded = [bool(np.isfinite(self.scene.fields[name].range.high)) for name in self.rows.names]
        size = np.abs(self.values)
        return np.where(np.array(bounded, bool) | (size == 0), 1.0, size)

    def displaced(self, k: int, step: float) -> Experiment | None:
        """The experiment with free entry k changed by a step; None where that is impossible."""
        values = self.values.copy()
        values[k] += step
        return self.rows.at(values)
