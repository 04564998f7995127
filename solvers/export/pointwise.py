"""Results of collisions and their derivatives, elementwise over arrays of SI numbers."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..engines.settings import check_rtol
from ..errors import ComputationError, InputError
from ..host.arguments import check_names
from ..many.collide_many import collide_many
from ..results import DIFFERENTIATED, FAILED
from ..scene.scene import Scene
from ..sensitivity.gradients_many import gradients_many
from ..sensitivity.parameters import check_wrt

OUTCOME = "outcome"
CHOICES = ("nan", "zero", "raise")
"""What stands in place of a derivative that does not exist."""
_IMPACT = ("impact.speed", "impact.angle")


@dataclass(frozen=True)
class Pointwise:
    """Results of a scene's collisions as functions of columns: normal speed, angle, then entries of the scene.

    Arguments:
        scene: what the columns leave out.
        of: results by name, and "outcome", whose derivative is 0.
        entries: dotted names of the other columns.
        rtol: relative tolerance of the integrations.
        undifferentiable: "nan", "zero" or "raise" where a result has no derivative.
    """

    scene: Scene
    of: tuple[str, ...]
    entries: tuple[str, ...]
    rtol: float
    undifferentiable: str

    def values(self, columns: np.ndarray) -> np.ndarray:
        """Results, (..., results), of columns (columns, ...); NaN where undefined or undecided, outcome then -1."""
        flat = self._flat(columns)
        if not flat.shape[1]:
            return np.zeros((*columns.shape[1:], len(self.of)))
        speed, angle, *entries = flat
        data = collide_many(
            self.scene, speed=speed, angle=angle, vary=dict(zip(self.entries, entries)), rtol=self.rtol,
            of=tuple(name for name in self.of if name != OUTCOME) or ("restitution",),
        )  # fmt: skip
        results = np.stack([data[name].values.astype(float) for name in self.of], axis=-1)
        if self.undifferentiable == "raise" and (data[OUTCOME].values == FAILED).any():
            self._refuse(flat, int(np.argmax(data[OUTCOME].values == FAILED)), str(data["reason"].values.max()))
        return results.reshape(*columns.shape[1:], len(self.of))

    def slopes(self, columns: np.ndarray, by: Sequence[int]) -> np.ndarray:
        """Derivatives, (..., results, by), of columns (columns, ...) by the columns of these indices."""
        flat = self._flat(columns)
        names = tuple(name for name in self.of if name != OUTCOME)
        wrt = [(*_IMPACT, *self.entries)[k] for k in by]
        slopes = np.zeros((flat.shape[1], len(self.of), len(by)))
        places = [k for k, name in enumerate(self.of) if name != OUTCOME]
        materials, which = np.unique(flat[2:].T, axis=0, return_inverse=True)
        for k, material in enumerate(materials) if names and wrt else ():
            rows = np.flatnonzero(which.ravel() == k)
            scene = self.scene.with_si(dict(zip(self.entries, material)), "speed") if self.entries else self.scene
            gradients = gradients_many(
                scene, speed=flat[0, rows], angle=flat[1, rows], wrt=wrt, of=names, rtol=self.rtol, hold="speed"
            )
            gradient = gradients["gradient"].transpose("collision", "quantity", "parameter").values
            missing = np.isnan(gradient)
            if self.undifferentiable == "raise" and missing.any():
                bad = int(np.argmax(missing.any(axis=(1, 2))))
                self._refuse(flat, int(rows[bad]), str(gradients["reason"].values[bad]) or "it is undefined")
            elif self.undifferentiable == "zero":
                gradient = np.where(missing, 0.0, gradient)
            slopes[rows[:, None], places] = gradient
        return slopes.reshape(*columns.shape[1:], len(self.of), len(by))

    @staticmethod
    def _flat(columns: np.ndarray) -> np.ndarray:
        return np.asarray(columns, dtype=float).reshape(len(columns), -1)

    def _refuse(self, flat: np.ndarray, k: int, reason: str) -> None:
        named = zip((*_IMPACT, *self.entries), flat[:, k].tolist())
        at = ", ".join(f"{name} = {value:.8g}" for name, value in named)
        raise ComputationError(f"no result or no derivative at {at}: {reason}")


def pointwise(
    scene: Scene | str | Path, of: Sequence[str] | str, entries: Sequence[str], rtol: float, undifferentiable: str
) -> Pointwise:
    """The checked request; InputError for an unknown name or choice."""
    if undifferentiable not in CHOICES:
        raise InputError("undifferentiable", undifferentiable, ", ".join(CHOICES))
    loaded, names = Scene.load(scene), check_names(of, (*DIFFERENTIATED, OUTCOME), "of", "names no result")
    for name in check_wrt(loaded, tuple(entries), "entries") if entries else ():
        if name.startswith("impact.") and not name.endswith("spin"):
            raise InputError("entries", name, "entries of the scene; speed and angle are arguments of their own")
    return Pointwise(loaded, names, tuple(entries), check_rtol(rtol), undifferentiable)
