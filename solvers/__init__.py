"""Scenes, event-driven integration and its results: `Scene`, `collide`.

Names are loaded on first use, so that a command pays only for what it needs.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .atlases import Atlas, atlas
    from .bounds import Boundaries, boundary
    from .errors import CheckFailed, ComputationError, InputError, ModelWarning, WetDoubletError
    from .many import collide_many
    from .regimes import regime_map
    from .result import Collision
    from .scene import Scene
    from .sensitivity.boundaries import BoundarySensitivities, boundary_sensitivities
    from .sensitivity.gradients import sensitivities
    from .sensitivity.many import gradients_many
    from .sensitivity.result import Sensitivities
    from .sensitivity.trajectory import trajectory_sensitivities
    from .sensitivity.uncertainty import band
    from .sensitivity.variance import sobol_indices
    from .simulate import collide

_HOMES = {
    "Atlas": "atlases",
    "Boundaries": "bounds",
    "BoundarySensitivities": "sensitivity.boundaries",
    "CheckFailed": "errors",
    "Collision": "result",
    "ComputationError": "errors",
    "InputError": "errors",
    "ModelWarning": "errors",
    "Scene": "scene",
    "Sensitivities": "sensitivity.result",
    "WetDoubletError": "errors",
    "atlas": "atlases",
    "band": "sensitivity.uncertainty",
    "boundary": "bounds",
    "boundary_sensitivities": "sensitivity.boundaries",
    "collide": "simulate",
    "collide_many": "many",
    "gradients_many": "sensitivity.many",
    "regime_map": "regimes",
    "sensitivities": "sensitivity.gradients",
    "sobol_indices": "sensitivity.variance",
    "trajectory_sensitivities": "sensitivity.trajectory",
}

__all__ = [
    "Atlas",
    "Boundaries",
    "BoundarySensitivities",
    "CheckFailed",
    "Collision",
    "ComputationError",
    "InputError",
    "ModelWarning",
    "Scene",
    "Sensitivities",
    "WetDoubletError",
    "atlas",
    "band",
    "boundary",
    "boundary_sensitivities",
    "collide",
    "collide_many",
    "gradients_many",
    "regime_map",
    "sensitivities",
    "sobol_indices",
    "trajectory_sensitivities",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
