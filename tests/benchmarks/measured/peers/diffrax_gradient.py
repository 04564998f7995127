"""Derivatives of e_n by diffrax: forward mode through its solver and through the root that ends each phase.

What a user of jax would write: `jacfwd` of the trajectory of `peer_diffrax`. An event's time is the solution of a root
find of optimistix, which differentiates it implicitly; with it the state at the event carries the saltation. Jitted,
all parameters and all collisions vectorised.
"""

from collections.abc import Callable, Sequence
from importlib.util import find_spec

import numpy as np
from wetdoublet.solvers.engines.casadi.locate import EventLocator
from wetdoublet.solvers.model.dimensionless import DimensionlessGroups
from wetdoublet.solvers.model.model import load, select_model
from wetdoublet.solvers.scene.scene import Scene

from ..gradient_task import Gradients
from .diffrax_engine import SEPARATED, trajectory
from .heyoka_engine import starts
from .translated import translated

MISSING = "" if find_spec("diffrax") else "diffrax is not installed (pip install wetdoublet[bench])"
TOLERANCES = (1e-6, 1e-9, 1e-12)


def of_task(asked: Gradients, copies: int, rtol: float) -> Callable[[], np.ndarray]:
    """The call that `gradient_work` times."""
    return prepare(asked.scene, asked.numbers * copies, np.tile(asked.slopes, (copies, 1, 1)), rtol)


def prepare(
    scene: Scene, numbers: Sequence[DimensionlessGroups], slopes: np.ndarray, rtol: float
) -> Callable[[], np.ndarray]:
    """A call that returns derivatives of e_n in theta, (collisions, parameters); NaN where nothing separates.

    Arguments:
        numbers: of collisions that separate, all oblique.
        slopes: derivatives of the groups in theta, (collisions, groups, parameters).
    """
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)
    choice = select_model(scene, True)
    names = tuple(load(choice).groups)
    begun = starts([EventLocator(load(choice), each.groups, min(rtol, 1e-6)) for each in numbers], numbers, names)
    parameters = np.array([each.parameters for each in begun])
    rebound = np.array([each.reversed for each in begun])
    structure, laws = translated(choice, lambda word: getattr(jnp, word))
    integrate = trajectory(choice, names, None, rtol)  # no stick is to be proved

    def restitution(theta: jax.Array, p: jax.Array, slope: jax.Array, met: jax.Array) -> tuple[jax.Array, jax.Array]:
        moved = p.at[: len(names)].add(slope @ theta)
        groups = dict(zip(names, moved))
        first = {name: jnp.asarray(value, float) for name, value in structure.start({}, groups, laws).items()}
        after = structure.rebound(first, groups, laws)
        y = jnp.stack([jnp.where(met, after[name], first[name]) for name in first])
        ended, e_n, _ = integrate(y, moved, met)
        return e_n, ended

    columns = jax.jit(jax.vmap(jax.jacfwd(restitution, has_aux=True), in_axes=(None, 0, 0, 0)))
    at = np.zeros(slopes.shape[2])

    def run() -> np.ndarray:
        found, ended = (np.asarray(each) for each in columns(at, parameters, slopes, rebound))
        return np.where(ended[:, None] == SEPARATED, found, np.nan)

    return run
