"""The gradients that everything is measured on: which collisions, which parameters, and what they should be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from wetdoublet.solvers.errors import ComputationError
from wetdoublet.solvers.many.collide_many import collide_many
from wetdoublet.solvers.model.dimensionless import Problem
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.scene.scene import Scene
from wetdoublet.solvers.sensitivity.parameters import Kind, kind_of, parameter_map, parameters_of, references
from wetdoublet.solvers.sensitivity.sensitivities import sensitivities

from .tasks import Impact, Task, columns, dimensionless

COUNT = 12  # parameters
SEPARATING = 25  # collisions
RTOL = 1e-12  # of the derivatives that errors are measured against
_HOLD = "speed"


@dataclass(frozen=True)
class Gradients:
    """Collisions of a scene that separate, oblique, and the parameters in which e_n is differentiated.

    Derivatives are in theta, p = p_ref (1 + theta): of the same unit for all parameters.
    """

    scene: Scene
    impacts: tuple[Impact, ...]
    names: tuple[str, ...]

    @classmethod
    def of(cls, task: Task, count: int = SEPARATING) -> Gradients:
        """The first `count` collisions that separate, drawn on until there are so many; the last of its parameters."""
        scene, kept = task.scene, list[Impact]()
        for impacts in task.drawn():
            stokes, angle = columns(impacts)
            outcome = collide_many(scene, stokes=stokes, angle=angle)["outcome"].values
            kept += [each for each, found in zip(impacts, outcome, strict=True) if found > 0 and each.angle > 0]
            if len(kept) >= count:
                break
        names = [name for name in parameters_of(scene) if name != "impact.stokes"]
        return cls(scene, tuple(kept[:count]), tuple(names[-COUNT:]))

    @cached_property
    def kind(self) -> Kind:
        return kind_of(self.scene, _HOLD)

    @cached_property
    def numbers(self) -> list[Problem]:
        """The collisions without dimensions."""
        return [dimensionless(self.scene, each) for each in self.impacts]

    @cached_property
    def groups(self) -> tuple[str, ...]:
        """The groups of the structure."""
        return tuple(load(select_model(self.scene, True)).groups)

    def _ways(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Of each collision, derivatives of groups and scales, and dp/dtheta."""
        via = parameter_map(self.kind, self.names, self.groups)
        found = []
        for each in self.numbers:
            slopes, units = via.slopes(references(self.scene, self.kind.entries, each.speed, each.angle))
            found.append((np.array(slopes.full()), np.array(units.full()).ravel()))
        return found

    @cached_property
    def slopes(self) -> np.ndarray:
        """Derivatives of the groups in theta, (collisions, groups, parameters)."""
        return np.array([slopes[: len(self.groups)] for slopes, _ in self._ways()])

    @cached_property
    def units(self) -> np.ndarray:
        """dp/dtheta, SI: (collisions, parameters)."""
        return np.array([units for _, units in self._ways()])

    def by_casadi(self, method: str, engine: str, rtol: float, names: Sequence[str] | None = None) -> np.ndarray:
        """`sensitivities` of one collision after the other: derivatives in theta, (collisions, parameters).

        NaN where they are refused: at a loose tolerance a boundary is too near.
        """
        wrt = list(self.names if names is None else names)
        found: list[list[float | None]] = []
        for each in self.impacts:
            try:
                one = sensitivities(
                    self.scene, ["restitution"], wrt, stokes=each.stokes, angle=each.angle,
                    method=method, engine=engine, rtol=rtol,
                )  # fmt: skip
            except ComputationError:
                found.append([math.nan] * len(wrt))
                continue
            row = one.gradient["restitution"]
            assert row is not None  # it separates
            found.append([row[name] for name in wrt])
        rows: np.ndarray = np.array(found, dtype=float) * self.units[:, [self.names.index(name) for name in wrt]]
        return rows

    @cached_property
    def truth(self) -> np.ndarray:
        """By forward derivatives of Rosenbrock at 1e-12, (collisions, parameters)."""
        return self.by_casadi("forward", "rosenbrock", RTOL)

    def errors(self, found: np.ndarray) -> np.ndarray:
        """Of each collision the largest error, over its largest derivative."""
        apart: np.ndarray = np.abs(found - self.truth).max(axis=1) / np.abs(self.truth).max(axis=1)
        return apart
