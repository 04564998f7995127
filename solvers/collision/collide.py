"""`collide`: computes one collision of a scene."""

from pathlib import Path as FilePath

from ..engines.settings import UNTIL, check_engine, check_rtol
from ..errors import ComputationError
from ..host.arguments import check_flag
from ..model.dimensionless import Problem
from ..model.validity import warn
from ..scene.scene import Scene
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
        engine: "taylor" (default), or "cvodes" or "rosenbrock", which integrate the phases that taylor has found and
            check its events.
        ledger: integrate the energy ledger and keep the spin as a state to see the drift of angular momentum.
        trajectory: keep the trajectory as an xarray Dataset.
        until: time after initial contact, s or a string with its unit. A stick is integrated up to this time, beyond
            its proof or not so far; its outcome stays, its events and energy run up to this time.

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
    rtol, requested = check_rtol(rtol), check_engine(engine)
    ledger, trajectory = check_flag(ledger, "ledger"), check_flag(trajectory, "trajectory")
    last = None if until is None else UNTIL.number(until)
    problem = Problem.read(scene, stokes, speed, angle, relative_speed)
    warn(problem.scene)
    return integrated(problem, rtol, requested, ledger, trajectory, last)


def integrated(
    problem: Problem, rtol: float, engine: str | None, ledger: bool, trajectory: bool, until: float | None = None
) -> Collision:
    """The collision by the kernel, or as an engine of CasADi replays it; `until` in s."""
    if engine in (None, "taylor"):
        try:
            return collision(problem, rtol, ledger, trajectory, until)
        except ComputationError:  # implicit steps, which creeping motion needs, are not recorded
            if engine == "taylor" or not trajectory:
                raise
            engine = "rosenbrock"
    from .by_replay import by_replay

    return by_replay(problem, rtol, engine, ledger, trajectory, until)
