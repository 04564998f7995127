"""Oblique collisions of two liquid-coated particles: whether they stick, bounce, or stick, rotate and separate.

Plain numbers are SI and radians; a string carries its unit. A scene is a `Scene`, a path to a scene file, or a preset's
name. Names are loaded on first use, so that importing the package costs a few milliseconds.

Example:
    >>> import wetdoublet as wd
    >>> one = wd.collide("granulation", stokes=0.02, angle="75 deg")
    >>> one.outcome, one.restitution > 1
    ('stick-rotate-separate', True)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from wetdoublet.solvers import __all__ as __all__  # absolute: this folder is mapped to the top of the package

if TYPE_CHECKING:
    from wetdoublet.solvers import Atlas as Atlas
    from wetdoublet.solvers import Boundaries as Boundaries
    from wetdoublet.solvers import BoundarySensitivities as BoundarySensitivities
    from wetdoublet.solvers import CheckFailed as CheckFailed
    from wetdoublet.solvers import Collision as Collision
    from wetdoublet.solvers import ComputationError as ComputationError
    from wetdoublet.solvers import Design as Design
    from wetdoublet.solvers import Fit as Fit
    from wetdoublet.solvers import InputError as InputError
    from wetdoublet.solvers import ModelWarning as ModelWarning
    from wetdoublet.solvers import Scene as Scene
    from wetdoublet.solvers import Sensitivities as Sensitivities
    from wetdoublet.solvers import Table as Table
    from wetdoublet.solvers import WetDoubletError as WetDoubletError
    from wetdoublet.solvers import atlas as atlas
    from wetdoublet.solvers import band as band
    from wetdoublet.solvers import boundary as boundary
    from wetdoublet.solvers import boundary_sensitivities as boundary_sensitivities
    from wetdoublet.solvers import collide as collide
    from wetdoublet.solvers import collide_many as collide_many
    from wetdoublet.solvers import collide_pair as collide_pair
    from wetdoublet.solvers import collision_averages as collision_averages
    from wetdoublet.solvers import compare_models as compare_models
    from wetdoublet.solvers import compile_kernels as compile_kernels
    from wetdoublet.solvers import design as design
    from wetdoublet.solvers import fit as fit
    from wetdoublet.solvers import gradients_many as gradients_many
    from wetdoublet.solvers import log_likelihood as log_likelihood
    from wetdoublet.solvers import pair_gradients as pair_gradients
    from wetdoublet.solvers import plot as plot
    from wetdoublet.solvers import regime_map as regime_map
    from wetdoublet.solvers import sensitivities as sensitivities
    from wetdoublet.solvers import sobol_indices as sobol_indices
    from wetdoublet.solvers import table as table
    from wetdoublet.solvers import trajectory_sensitivities as trajectory_sensitivities

    __version__: str

if not TYPE_CHECKING:  # so that type checkers know the names above and no others

    def __getattr__(name: str) -> Any:
        if name == "__version__":
            from importlib.metadata import version

            value: Any = version("wetdoublet")
        elif name in __all__:
            from wetdoublet import solvers

            value = getattr(solvers, name)
        else:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
