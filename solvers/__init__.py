"""Scenes, event-driven integration and its results: `Scene`, `collide`.

Names are loaded on first use, so that a command pays only for what it needs.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .averages.averages import collision_averages
    from .boundaries.boundary import Atlas, Boundaries, atlas, boundary
    from .collision.collide import collide
    from .collision.result import Collision
    from .engines.kernels import compile_kernels
    from .errors import CheckFailed, ComputationError, InputError, ModelWarning, WetDoubletError
    from .fitting.compare import compare_models
    from .fitting.fit import fit, log_likelihood
    from .fitting.result import Fit
    from .host.pictures import plot
    from .many.collide_many import collide_many
    from .many.regime_map import regime_map
    from .planning.design import design
    from .planning.result import Design
    from .scene.scene import Scene
    from .sensitivity.boundaries import BoundarySensitivities, boundary_sensitivities
    from .sensitivity.gradients_many import gradients_many
    from .sensitivity.pair_gradients import pair_gradients
    from .sensitivity.result import Sensitivities
    from .sensitivity.sensitivities import sensitivities
    from .sensitivity.trajectory import trajectory_sensitivities
    from .sensitivity.uncertainty import band
    from .sensitivity.variance import sobol_indices
    from .space.collide_pair import collide_pair
    from .tables.table import Table, table

_HOMES = {
    "Atlas": "boundaries.boundary",
    "Boundaries": "boundaries.boundary",
    "BoundarySensitivities": "sensitivity.boundaries",
    "CheckFailed": "errors",
    "Collision": "collision.result",
    "ComputationError": "errors",
    "Design": "planning.result",
    "Fit": "fitting.result",
    "InputError": "errors",
    "ModelWarning": "errors",
    "Scene": "scene.scene",
    "Sensitivities": "sensitivity.result",
    "Table": "tables.table",
    "WetDoubletError": "errors",
    "atlas": "boundaries.boundary",
    "band": "sensitivity.uncertainty",
    "boundary": "boundaries.boundary",
    "boundary_sensitivities": "sensitivity.boundaries",
    "collide": "collision.collide",
    "collide_many": "many.collide_many",
    "collide_pair": "space.collide_pair",
    "collision_averages": "averages.averages",
    "compare_models": "fitting.compare",
    "compile_kernels": "engines.kernels",
    "design": "planning.design",
    "fit": "fitting.fit",
    "gradients_many": "sensitivity.gradients_many",
    "log_likelihood": "fitting.fit",
    "pair_gradients": "sensitivity.pair_gradients",
    "plot": "host.pictures",
    "regime_map": "many.regime_map",
    "sensitivities": "sensitivity.sensitivities",
    "sobol_indices": "sensitivity.variance",
    "table": "tables.table",
    "trajectory_sensitivities": "sensitivity.trajectory",
}

__all__ = [
    "Atlas",
    "Boundaries",
    "BoundarySensitivities",
    "CheckFailed",
    "Collision",
    "ComputationError",
    "Design",
    "Fit",
    "InputError",
    "ModelWarning",
    "Scene",
    "Sensitivities",
    "Table",
    "WetDoubletError",
    "atlas",
    "band",
    "boundary",
    "boundary_sensitivities",
    "collide",
    "collide_many",
    "collide_pair",
    "collision_averages",
    "compare_models",
    "compile_kernels",
    "design",
    "fit",
    "gradients_many",
    "log_likelihood",
    "pair_gradients",
    "plot",
    "regime_map",
    "sensitivities",
    "sobol_indices",
    "table",
    "trajectory_sensitivities",
]

if not TYPE_CHECKING:  # so that type checkers know the names above and no others

    def __getattr__(name: str) -> Any:
        if name not in _HOMES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
