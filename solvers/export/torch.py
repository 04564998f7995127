"""The collision law as a function of torch tensors that has derivatives: an autograd function."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..engines.settings import RTOL
from ..scene.scene import Scene
from .extras import required
from .pointwise import OUTCOME, Pointwise, pointwise

required("torch", "torch")
import torch  # noqa: E402 # after the check that it is there

__all__ = ["collide_many", "law"]


def collide_many(
    scene: Scene | str | Path, *, speed: Any, angle: Any, vary: Mapping[str, Any] | None = None,
    of: Sequence[str] | str = "restitution", rtol: float = RTOL, undifferentiable: str = "nan",
) -> Any:  # fmt: skip
    """Results of many collisions, differentiable by speeds, angles and the entries that vary.

    Each call makes a `law`; where it is called again and again, as in training, take the function of `law` itself.

    Arguments:
        scene, of, rtol, undifferentiable: as for `law`.
        speed, angle, vary: normal speeds (m/s), angles (rad) and entries of the scene by dotted name (SI), tensors that
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
    """A collision law as a function of tensors (speed, angle, entries).

    Arguments:
        scene, of, rtol, undifferentiable: as for `wetdoublet.jax.law`.

    Returns:
        A function of normal speed (m/s), angle (rad) and a mapping of entries of the scene by dotted name (SI), numbers
        or tensors that broadcast against each other. It returns a tensor of their shape, or a dict of such tensors if
        `of` is a list; "outcome" is int32. Computed on the CPU in double precision and returned in the arguments'
        precision and on their device. Forward and reverse mode, first order.

    Raises:
        InputError: an unknown name or a bad value.
        ComputationError: "raise" is chosen and a collision has no result or no derivative.

    Example:
        >>> import torch
        >>> viscosity = torch.tensor(2.0, dtype=torch.float64, requires_grad=True)
        >>> law("granulation")(3.0, 0.2, {"liquid.viscosity": viscosity}).backward()
        >>> bool(viscosity.grad > 0)
        True
    """
    loaded = Scene.load(scene)
    names = pointwise(loaded, of, (), rtol, undifferentiable).of

    def function(speed: Any, angle: Any, entries: Mapping[str, Any] | None = None) -> Any:
        ordered = dict(entries or {})
        points = pointwise(loaded, names, tuple(ordered), rtol, undifferentiable)
        columns = (speed, angle, *ordered.values())
        tensors = [column for column in columns if isinstance(column, torch.Tensor)]
        floating = [tensor for tensor in tensors if tensor.dtype.is_floating_point]
        dtype = torch.float64
        for k, tensor in enumerate(floating):
            dtype = tensor.dtype if k == 0 else torch.promote_types(dtype, tensor.dtype)
        device = tensors[0].device if tensors else None
        inputs = [torch.as_tensor(column, dtype=dtype, device=device) for column in columns]
        outputs = _Values.apply(points, None, *torch.broadcast_tensors(*inputs))
        results = {name: outputs[..., k] for k, name in enumerate(names)}
        if OUTCOME in results:
            results[OUTCOME] = results[OUTCOME].detach().to(torch.int32)
        return results[names[0]] if isinstance(of, str) else results

    return function


class _OfColumns(torch.autograd.Function):  # type: ignore[misc] # torch is Any
    """Elementwise function (points, how, columns of one shape) -> (..., more axes), computed by numpy."""

    @staticmethod
    def forward(points: Pointwise, by: tuple[int, ...], *columns: Any) -> Any:
        raise NotImplementedError("values and slopes are computed by classes of their own")

    @classmethod
    def vmap(cls, info: Any, places: tuple[int | None, ...], points: Pointwise, by: Any, *columns: Any) -> Any:
        batched = [
            column.expand(info.batch_size, *column.shape) if place is None else column.movedim(place, 0)
            for column, place in zip(columns, places[2:], strict=True)
        ]
        return cls.apply(points, by, *batched), 0


class _Slopes(_OfColumns):
    """Derivatives (..., results, by); these have none of their own."""

    @staticmethod
    def forward(points: Pointwise, by: tuple[int, ...], *columns: Any) -> Any:
        return torch.from_numpy(points.slopes(_stacked(columns), by)).to(columns[0])

    @staticmethod
    def setup_context(ctx: Any, inputs: tuple[Any, ...], output: Any) -> None:
        pass

    @staticmethod
    def backward(ctx: Any, *_: Any) -> Any:  # torch's own signature
        raise NotImplementedError("a collision law has first derivatives only")


class _Values(_OfColumns):
    """Results (..., results)."""

    @staticmethod
    def forward(points: Pointwise, by: tuple[int, ...], *columns: Any) -> Any:  # as its base
        return torch.from_numpy(points.values(_stacked(columns))).to(columns[0])

    @staticmethod
    def setup_context(ctx: Any, inputs: tuple[Any, ...], output: Any) -> None:  # torch's own signature
        ctx.points = inputs[0]
        ctx.save_for_backward(*inputs[2:])
        ctx.save_for_forward(*inputs[2:])

    @staticmethod
    def backward(ctx: Any, gradient: Any) -> tuple[Any, ...]:
        by = tuple(k for k, needed in enumerate(ctx.needs_input_grad[2:]) if needed)
        slopes = _Slopes.apply(ctx.points, by, *ctx.saved_tensors)
        gradients: list[Any] = [None] * len(ctx.needs_input_grad)
        for place, k in enumerate(by):  # a result that the loss does not depend on may be without a derivative
            gradients[k + 2] = torch.where(gradient == 0, 0.0, gradient * slopes[..., place]).sum(-1)
        return tuple(gradients)

    @staticmethod
    def jvp(ctx: Any, _: Any, __: Any, *tangents: Any) -> Any:
        by = tuple(k for k, tangent in enumerate(tangents) if tangent is not None)
        slopes = _Slopes.apply(ctx.points, by, *ctx.saved_tensors)
        return sum(slopes[..., place] * tangents[k][..., None] for place, k in enumerate(by))


def _stacked(columns: Sequence[Any]) -> np.ndarray:
    return np.stack([column.detach().cpu().double().numpy() for column in columns])
