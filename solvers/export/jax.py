"""The collision law as a function that jax transforms: `jit`, `vmap`, `jvp`, `grad`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ..engines.settings import RTOL
from ..scene.scene import Scene
from .extras import required
from .pointwise import OUTCOME, pointwise

required("jax", "jax")
import jax  # noqa: E402 # after the check that it is there
from jax import numpy as jnp  # noqa: E402 # as above
from jax.custom_derivatives import SymbolicZero  # noqa: E402 # as above

__all__ = ["collide_many", "law"]


def collide_many(
    scene: Scene | str | Path, *, speed: Any, angle: Any, vary: Mapping[str, Any] | None = None,
    of: Sequence[str] | str = "restitution", rtol: float = RTOL, undifferentiable: str = "nan",
) -> Any:  # fmt: skip
    """Results of many collisions, differentiable by speeds, angles and the entries that vary.

    Each call makes a `law`; where it is called again and again, as in training, take the function of `law` itself.

    Arguments:
        scene, of, rtol, undifferentiable: as for `law`.
        speed, angle, vary: normal speeds (m/s), angles (rad) and entries of the scene by dotted name (SI), arrays that
            broadcast against each other.

    Returns, Raises: as the function of `law`.

    Example:
        >>> bool(collide_many("granulation", speed=3.0, angle=0.2) > 0)
        True
    """
    return law(scene, of, rtol=rtol, undifferentiable=undifferentiable)(speed, angle, vary)


def law(
    scene: Scene | str | Path, of: Sequence[str] | str = "restitution", *, rtol: float = RTOL,
    undifferentiable: str = "nan",
) -> Callable[..., Any]:  # fmt: skip
    """A collision law as a jax function of (speed, angle, entries).

    Arguments:
        scene: a Scene, a path or a preset's name.
        of: results by name, as for `sensitivities`, and "outcome" (-1 undecided, 0 stick, 1 stick-rotate-separate,
            2 bounce; int32, derivative 0).
        rtol: relative tolerance, 1e-13..1e-3.
        undifferentiable: what stands in place of a derivative that does not exist: "nan", "zero", or "raise" for an
            error that names the collision. A stick has restitution 0 with derivative 0; its other results are NaN and
            have no derivative; nor has a collision so near a change of outcome that its derivative is not computed. In
            reverse mode a NaN spoils the gradient of a loss that masks the collision (0 NaN is NaN): take "zero" there.

    Returns:
        A function of normal speed (m/s), angle (rad) and a mapping of entries of the scene by dotted name (SI), numbers
        or arrays that broadcast against each other. It returns an array of their shape, or a dict of such arrays if
        `of` is a list. Speeds are held where entries vary. Computed in double precision; float32 unless
        `jax_enable_x64` is set. Forward and reverse mode, first order: derivatives of derivatives are refused by jax.
        All collisions of a call go through the kernel together, also under `vmap` and `jit`; their derivatives go
        together where they share their entries.

    Raises:
        InputError: an unknown name. A bad value is found when the function runs, and is then jax's error with our text.

    Example:
        >>> import jax
        >>> jax.config.update("jax_enable_x64", True)
        >>> restitution = law("granulation")
        >>> slope = jax.grad(lambda mu: restitution(3.0, 0.2, {"liquid.viscosity": mu}))(2.0)
        >>> bool(slope > 0)
        True
    """
    loaded = Scene.load(scene)
    names = pointwise(loaded, of, (), rtol, undifferentiable).of

    @lru_cache(maxsize=32)
    def of_columns(entries: tuple[str, ...]) -> Callable[..., Any]:
        points = pointwise(loaded, names, entries, rtol, undifferentiable)

        def on_host(function: Callable[[np.ndarray], np.ndarray], tail: tuple[int, ...], columns: Sequence[Any]) -> Any:
            dtype = columns[0].dtype
            result = jax.ShapeDtypeStruct((*columns[0].shape, *tail), dtype)
            return jax.pure_callback(
                lambda *arrays: function(np.stack([np.asarray(array, float) for array in arrays])).astype(dtype),
                result, *columns, vmap_method="broadcast_all",
            )  # fmt: skip

        @jax.custom_jvp  # type: ignore[untyped-decorator] # jax has no types here
        def collide(*columns: Any) -> Any:
            return on_host(points.values, (len(names),), columns)

        def rule(columns: Sequence[Any], tangents: Sequence[Any]) -> tuple[Any, Any]:
            by = [k for k, tangent in enumerate(tangents) if not isinstance(tangent, SymbolicZero)]
            slopes = on_host(lambda array: points.slopes(array, by), (len(names), len(by)), columns)
            moved = sum(slopes[..., place] * tangents[k][..., None] for place, k in enumerate(by))
            return collide(*columns), moved

        collide.defjvp(rule, symbolic_zeros=True)
        return collide  # type: ignore[no-any-return] # as above

    def function(speed: Any, angle: Any, entries: Mapping[str, Any] | None = None) -> Any:
        ordered = dict(sorted((entries or {}).items()))
        columns = jnp.broadcast_arrays(*(jnp.asarray(column, float) for column in (speed, angle, *ordered.values())))
        answers = of_columns(tuple(ordered))(*columns)
        results = {name: answers[..., k] for k, name in enumerate(names)}
        if OUTCOME in results:
            results[OUTCOME] = jax.lax.stop_gradient(results[OUTCOME]).astype("int32")
        return results[names[0]] if isinstance(of, str) else results

    return function
