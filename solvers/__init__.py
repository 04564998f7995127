"""Scenes, event-driven integration and its results: `Scene`, `collide`.

Names are loaded on first use, so that a command pays only for what it needs.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import wraps
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .averages.averages import collision_averages
    from .boundaries.boundary import atlas, boundary
    from .boundaries.proved_boundary import ProvedBoundary, prove_boundary
    from .boundaries.proved_map import ProvedMap, prove_map
    from .boundaries.result import Atlas, Boundaries
    from .collision.collide import collide
    from .collision.result import Collision
    from .collision.space.collide_pair import collide_pair
    from .engines.interval.prove import Proof, prove
    from .engines.kernels import compile_kernels
    from .errors import CheckFailed, ComputationError, InputError, ModelWarning, WetDoubletError
    from .explorer.page_of_scene import Explorer, explore
    from .export.hybrid import Equations, equations
    from .fitting.design import design
    from .fitting.design_result import Design
    from .fitting.examine import check_data
    from .fitting.fit import fit, log_likelihood
    from .fitting.flow_curve import flow_curve
    from .fitting.result import Fit
    from .fitting.tracks import tracks
    from .host.pictures import plot
    from .many.collide_many import collide_many
    from .many.regime_map import regime_map
    from .scene.scene import Scene
    from .sensitivity.boundaries import BoundarySensitivities, boundary_sensitivities
    from .sensitivity.critical import Critical, critical
    from .sensitivity.gradients_many import gradients_many
    from .sensitivity.pair_gradients import pair_gradients
    from .sensitivity.sensitivities import Sensitivities, sensitivities
    from .sensitivity.solve import solve
    from .sensitivity.uncertainty import band

# Where each name is stands in the imports above, which are for type checkers alone: they are read here as text.
_IMPORTS = re.findall(r"^    from \.(\S+) import (.+)$", Path(__file__).read_text(encoding="utf-8"), re.MULTILINE)
_HOMES = {name: home for home, names in _IMPORTS for name in names.split(", ")}

__all__ = [
    "Atlas", "Boundaries", "BoundarySensitivities", "CheckFailed", "Collision", "ComputationError", "Critical",
    "Design", "Equations", "Explorer", "Fit", "InputError", "ModelWarning", "Proof", "ProvedBoundary", "ProvedMap",
    "Scene", "Sensitivities", "WetDoubletError", "atlas", "band", "boundary", "boundary_sensitivities", "check_data",
    "collide", "collide_many", "collide_pair", "collision_averages", "compile_kernels", "critical",
    "design", "equations", "explore", "fit", "flow_curve", "gradients_many", "log_likelihood", "pair_gradients", "plot",
    "prove", "prove_boundary", "prove_map", "regime_map", "sensitivities", "solve", "tracks",
]  # fmt: skip

if not TYPE_CHECKING:  # so that type checkers know the names above and no others

    def __getattr__(name: str) -> Any:
        if name not in _HOMES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
        globals()[name] = value = value if isinstance(value, type) else _by_its_names(value)
        return value

    def _by_its_names(function: Callable[..., Any]) -> Callable[..., Any]:
        """A public function that names the argument that a mistyped keyword is nearest to."""

        @wraps(function)
        def called(*given: Any, **options: Any) -> Any:
            try:
                return function(*given, **options)
            except TypeError:
                from inspect import signature

                from .errors import InputError, did_you_mean

                parameters = signature(function).parameters
                names = [name for name, parameter in parameters.items() if parameter.kind is not parameter.VAR_KEYWORD]
                for name in options.keys() - names if len(names) == len(parameters) else ():
                    problem = f"is no argument of {function.__name__}" + did_you_mean(name, names)
                    raise InputError(name, options[name], ", ".join(names), problem) from None
                raise

        called.__module__ = __name__  # where pickle finds it
        return called


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
