"""`collide`: computes one collision of a scene."""

from __future__ import annotations

from pathlib import Path as FilePath

from ...generated.automaton import STICK
from ..engines.choice import single_engine
from ..host.arguments import check_flag
from ..model.dimensionless import DimensionlessGroups, nondimensionalise
from ..model.validity import warn
from ..scene.scene import Scene
from ..settings import UNTIL, check_engine, check_rtol
from .by_casadi import by_casadi
from .by_kernel import collision
from .result import Collision


def collide(
    scene: Scene | str | FilePath,
    *,
    stokes: float | str | None = None,
    speed: float | str | None = None,
    angle: float | str | None = None,
    relative_speed: float | str | None = None,
    rtol: float = 1e-9,
    engine: str | None = None,
    ledger: bool = True,
    trajectory: bool = False,
    until: float | str | None = None,
) -> Collision:
    """Collide two wet particles.

    Arguments:
        scene: a Scene, a path to a scene file, or a preset's name.
        stokes: Stokes number of the impact. At most one of stokes, speed and relative_speed is given; it replaces the
            speed or Stokes number of the scene.
        speed: normal component of the relative velocity, m/s or a string with its unit.
        relative_speed: magnitude of the relative velocity, m/s or a string with its unit.
        angle: impact angle, rad or a string with its unit.
        rtol: relative tolerance of the integrators, 1e-13..1e-3.
        engine: "cvodes", "rosenbrock" or "taylor" (compiled on first use; rosenbrock where unsupported); None
            chooses (cvodes for one collision).
        ledger: integrate the energy ledger and keep the spin as a state to see the drift of angular momentum.
        trajectory: keep the trajectory as an xarray Dataset.
        until: time after initial contact, s or a string with its unit. A stick is integrated up to this time, beyond
            its proof; its outcome stays, its events and energy run up to this time.

    Returns:
        The Collision.

    Raises:
        InputError: a field or option is not acceptable.
        ComputationError: the trajectory could not be completed; says in which phase, when and at what state.

    Warns:
        ModelWarning: the scene leaves the range of validity of a law.

    Example:
        >>> from wetdoublet.solvers import collide
        >>> collide("granulation", stokes=0.02, angle="75 deg").restitution > 1
        True
    """
    rtol, plugin = check_rtol(rtol), single_engine(check_engine(engine))
    ledger, trajectory = check_flag(ledger, "ledger"), check_flag(trajectory, "trajectory")
    last = None if until is None else UNTIL.number(until)
    loaded = Scene.load(scene).with_impact(stokes, speed, angle, relative_speed)
    v0, theta0 = loaded.need_impact()
    dimensionless = nondimensionalise(loaded, v0, theta0)
    warn(loaded)
    by = _by_kernel if plugin == "taylor" else by_casadi
    return by(loaded, dimensionless, rtol, plugin, ledger, trajectory, until=last)


def _by_kernel(
    scene: Scene, n: DimensionlessGroups, rtol: float, _plugin: str, ledger: bool, trajectory: bool, until: float | None
) -> Collision:
    """By the Taylor kernel; by Rosenbrock where it does not complete the collision, and for a stick followed on."""
    found = collision(scene, n, rtol, ledger, trajectory)
    if found is not None and (until is None or found.outcome != STICK):
        return found
    return by_casadi(scene, n, rtol, "rosenbrock", ledger, trajectory, until=until)
