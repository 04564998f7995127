"""A collision law as an estimator with `fit` and `predict`, in scikit-learn's protocol, which it does not need."""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Self

import numpy as np

from ..errors import ComputationError, InputError
from ..fitting.fit import RTOL, fit
from ..many.collide_many import collide_many
from ..many.results import FAILED
from ..scene.scene import Scene

__all__ = ["CollisionRegressor"]


class CollisionRegressor:
    """Restitution as a function of the impact, with entries of the scene that are fitted to data.

    Arguments:
        scene: a Scene, a path or a preset's name.
        free: entries to estimate, by dotted name.
        columns: what the columns of X are, SI: speed, relative_speed or stokes; angle; entries of the scene.
        restitution_sd: standard deviation of the measured restitution.
        prior, rtol, starts, seed: as of `fit`.

    Attributes:
        fit_: the `Fit`, with intervals, verdicts and remarks.
        scene_: the fitted scene.
        n_features_in_: number of columns.

    Example:
        >>> import numpy as np
        >>> X = np.array([[2.2, 0.0], [2.3, 0.1], [2.5, 0.2], [1.0, 0.0]])
        >>> truth = CollisionRegressor("granulation", "liquid.viscosity").predict(X)
        >>> guess = CollisionRegressor("granulation", "liquid.viscosity", starts=1).fit(X, truth)
        >>> guess.fit_.estimates["liquid.viscosity"].verdict
        'identified'
    """

    def __init__(
        self, scene: Scene | str | Path = "granulation", free: Sequence[str] | str = "liquid.viscosity", *,
        columns: Sequence[str] = ("speed", "angle"), restitution_sd: float = 0.02,
        prior: Mapping[str, str] | None = None, rtol: float = RTOL, starts: int = 16, seed: int = 0,
    ) -> None:  # fmt: skip
        self.scene, self.free, self.columns, self.restitution_sd = scene, free, columns, restitution_sd
        self.prior, self.rtol, self.starts, self.seed = prior, rtol, starts, seed

    def fit(self, X: Any, y: Any) -> Self:
        """Estimate the free entries.

        Arguments:
            X: (impacts, columns), SI.
            y: (impacts,), restitution; 0 is a stick.

        Raises:
            InputError: bad shapes, or a bad cell, named by row and column.
        """
        data, seen = self._named(X), np.asarray(y, dtype=float)
        if seen.shape != (len(np.asarray(X)),):
            raise InputError("y", f"shape {seen.shape}", "one restitution for each row of X")
        rows = data | {"restitution": seen, "restitution_sd": np.full(seen.size, self.restitution_sd)}
        self.fit_ = fit(
            self.scene, rows, self.free, prior=self.prior, rtol=self.rtol, starts=self.starts, seed=self.seed
        )
        self.scene_, self.n_features_in_ = self.fit_.scene, len(self.columns)
        return self

    def predict(self, X: Any) -> np.ndarray:
        """Restitution of impacts, 0 of sticks; by the scene as it is given where nothing was fitted yet.

        Raises:
            InputError: bad shapes or values.
            ComputationError: a collision that is not decided.
        """
        columns = self._named(X)
        impact: dict[str, Any] = {name: columns.pop(name) for name in list(columns) if "." not in name}
        found = collide_many(getattr(self, "scene_", self.scene), **impact, vary=columns, rtol=self.rtol)
        lost = np.flatnonzero(found["outcome"].values == FAILED)
        if lost.size:
            raise ComputationError(f"X, row {lost[0] + 1} is not decided: {found['reason'].values[lost[0]]}")
        return np.asarray(found["restitution"].values)

    def score(self, X: Any, y: Any) -> float:
        """Coefficient of determination R^2 of the prediction."""
        seen = np.asarray(y, dtype=float)
        return float(1 - ((seen - self.predict(X)) ** 2).sum() / ((seen - seen.mean()) ** 2).sum())

    def get_params(self, deep: bool = True) -> dict[str, Any]:  # scikit-learn's protocol
        """The arguments by name."""
        return {name: getattr(self, name) for name in inspect.signature(type(self)).parameters}

    def set_params(self, **parameters: Any) -> Self:
        """Replace arguments.

        Raises:
            ValueError: an argument that there is not.
        """
        known = self.get_params()
        for name, value in parameters.items():
            if name not in known:
                raise ValueError(f"{name} is no argument; there are {', '.join(known)}")
            setattr(self, name, value)
        return self

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self.get_params().items())})"

    def __sklearn_is_fitted__(self) -> bool:
        return hasattr(self, "fit_")

    def __sklearn_tags__(self) -> Any:
        from sklearn.utils import RegressorTags, Tags, TargetTags

        return Tags(estimator_type="regressor", target_tags=TargetTags(required=True), regressor_tags=RegressorTags())

    def _named(self, X: Any) -> dict[str, np.ndarray]:
        if hasattr(X, "toarray") or np.iscomplexobj(X):
            kind = "Sparse" if hasattr(X, "toarray") else "Complex"
            raise InputError(
                "X", type(X).__name__, "a dense array of real numbers", f"is refused: {kind} data not supported"
            )
        values = np.asarray(X, dtype=float)
        if values.ndim != 2 or values.shape[1] != len(self.columns):
            raise InputError("X", f"shape {values.shape}", f"(impacts, {len(self.columns)}): {', '.join(self.columns)}")
        return dict(zip(self.columns, values.T, strict=True))
