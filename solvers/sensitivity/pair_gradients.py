"""`pair_gradients()`: derivatives of collisions with vectors, of two spheres in space or of a sphere and a wall."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np

from ...generated.automaton import OUTCOMES
from ..changes.experiment import free_names
from ..collision.by_kernel import sequence_of, words_of
from ..engines.casadi.sequence import EventSequence
from ..engines.settings import check_rtol
from ..engines.taylor.record import recorded_in_space
from ..errors import ComputationError, WetDoubletError
from ..host.arguments import check_names
from ..host.pictures import register
from ..model.dimensionless import Problem, nondimensionalise
from ..model.model import load, select_model
from ..model.validity import warn
from ..results import FAILED, outcome_attributes
from ..scene.origin import provenance
from ..scene.scene import Scene
from ..space.by_replay import groups_of, own_axes, sequence_in_space
from ..space.collide_pair import NUMBERS, VECTORS, check_scene, refusals
from ..space.pairs import AXES, Pairs, without_spins
from ..space.pairs import checked as checked_pairs
from .boundary_distance import FINE, Course, Courses, checked, course, courses_of
from .by_casadi import Replayable
from .pair_maps import RESULTS, pair_maps
from .parameters import kind_of, parameter_map, references
from .problem import RECORDED, Query
from .trajectory import STATE

if TYPE_CHECKING:
    import xarray

_SLIDES = np.pi / 4  # any angle beside a wall
INPUTS = ("normal", "velocities", "spins")
_SHAPES = {"normal": (3,), "velocities": (2, 3), "spins": (2, 3)}
_STICK = "a stick: the rigid motion that it is given as is not differentiated"
_ROWS = sum(map(math.prod, RESULTS.values()))


def pair_gradients(
    scene: Scene | str | FilePath,
    normal: Any,
    velocities: Any,
    spins: Any,
    *,
    wrt: Sequence[str] | str | None = None,
    rtol: float = 1e-9,
) -> xarray.Dataset:
    """Exact derivatives of collisions with vectors, through their events; one pair after another, by Rosenbrock.

    Arguments:
        scene, normal, velocities, spins: as for `collide_pair`.
        wrt: numeric entries of the scene by dotted name (but not its impact), and "normal", "velocities", "spins" for
            all their components; None for all of these.
        rtol: relative tolerance, 1e-13..1e-3.

    Returns:
        Dataset over dim_0, dim_1, ...: outcome, restitution, time, gap, normal, position, velocities and spins as
        `collide_pair` has them, each but the outcome with its derivatives `d_NAME` over `parameter` too, SI.
        Components of inputs are called "normal.x", "velocities.1.x", "spins.0.z". Only the direction of the normal
        matters: its derivatives are those across it. Where no derivative exists, as of sticks and near boundaries,
        there is NaN, and `reason` says why.

    Raises:
        InputError: as for `collide_pair`, or an unknown name.

    Example:
        >>> from wetdoublet.solvers import pair_gradients
        >>> velocities, spins = [[0.1, 0, 3.0], [0, 0, 0]], [[0, 0, 0], [0, 1000, 200]]  # m/s, rad/s
        >>> found = pair_gradients("granulation", [0, 0, 1], velocities, spins, wrt=["liquid.viscosity", "spins"])
        >>> found.d_velocities.sel(parameter="spins.1.y").dims, bool(found.d_restitution.notnull().all())
        (('particle', 'axis'), True)
    """
    import xarray as xr

    register()
    loaded, rtol = Scene.load(scene), check_rtol(rtol)
    check_scene(loaded)
    everything = (*free_names(loaded), *INPUTS)
    names = everything if wrt is None else check_names(wrt, everything, "wrt")
    pairs = checked_pairs(loaded, normal, velocities, spins)
    entries, vectors = tuple(name for name in names if name not in INPUTS), _components(loaded, names)
    parameters = [*entries, *vectors.values()]
    size = pairs.size
    outcome, reason = np.full(size, FAILED, np.int8), np.full(size, "", object)
    value, slope = np.full((size, _ROWS), np.nan), np.full((size, _ROWS, len(parameters)), np.nan)
    refused = refusals(pairs)
    if len(refused) < size:
        warn(loaded)
    for k in range(size):
        if k in refused:
            reason[k] = refused[k]
            continue
        try:
            outcome[k], results = _of_one_pair(pairs.subset(np.array([k])), entries, [*vectors], rtol)
        except WetDoubletError as error:
            reason[k] = str(error)
            continue
        if results is None:
            reason[k] = _STICK
        else:
            value[k], slope[k] = results
    if loaded.wall:
        value[:, -3:] = slope[:, -3:] = np.nan
    dims = tuple(f"dim_{k}" for k in range(len(pairs.shape)))
    data: dict[str, Any] = {
        "outcome": (dims, outcome.reshape(pairs.shape), outcome_attributes()),
        "reason": (dims, reason.astype(str).reshape(pairs.shape), {"long_name": "why there is no derivative"}),
    }
    ends = np.cumsum([math.prod(shape) for shape in RESULTS.values()])[:-1]
    columns = zip(RESULTS.items(), np.split(value, ends, axis=1), np.split(slope, ends, axis=1), strict=True)
    for (name, shape), values, slopes in columns:
        more, attrs = ((), NUMBERS[name]) if name in NUMBERS else VECTORS[name]
        data[name] = (*dims, *more), values.reshape((*pairs.shape, *shape)), attrs
        meaning = {"long_name": f"derivative of the {attrs['long_name']}"}
        data[f"d_{name}"] = (
            (*dims, *more, "parameter"),
            slopes.reshape((*pairs.shape, *shape, len(parameters))),
            meaning,
        )
    coordinates = {"axis": list(AXES), "parameter": parameters}
    return xr.Dataset(data, coordinates, provenance(loaded, rtol=rtol, engine="rosenbrock"))


def _components(scene: Scene, names: Sequence[str]) -> dict[int, str]:
    """Place among all inputs, and name, of each component of the vectors among these names."""
    every = [(name, index) for name, shape in _SHAPES.items() for index in np.ndindex(shape)]
    return {
        place: ".".join((name, *map(str, index[:-1]), AXES[index[-1]]))
        for place, (name, index) in enumerate(every)
        if name in names and not (scene.wall and name == "spins" and index[0] == 1)
    }


def _of_one_pair(
    pair: Pairs, entries: tuple[str, ...], components: list[int], rtol: float
) -> tuple[int, tuple[np.ndarray, np.ndarray] | None]:
    """Outcome of one pair; its results and their derivatives (results, parameters), None if it sticks.

    Arguments:
        entries, components: the parameters, of which the second are places among all inputs.

    Raises:
        ComputationError: near a boundary, or the trajectory could not be differentiated.
    """
    scene = pair.scene
    model, kind = load(select_model(scene, True, space=not scene.wall)), kind_of(scene, "speed")
    in_groups, in_results = pair_maps(kind, model.choice, entries, tuple(components))
    v0 = -float(pair.opening[0])
    reference = references(scene, kind.entries, v0, 0.0)
    x = np.concatenate([pair.normal[0], pair.velocities[0].ravel(), pair.spins[0].ravel()])
    typical = np.concatenate([np.ones(3), np.full(6, v0), np.full(6, v0 / float(scene.material["reduced_radius"]))])
    units = np.append(parameter_map(kind, entries, ()).at(reference)[2], typical[components])
    n, axes = _scaled(pair)
    given = reference, x, axes, n.groups["obliquity"], units
    p, dp = (matrix.full() for matrix in in_groups(*given))
    n = replace(n, groups={**n.groups, **dict(zip(model.groups, p.ravel().tolist(), strict=True))})
    followed, courses = _followed(pair, n)
    try:
        path = followed(RECORDED)
        if not path.separated:
            return OUTCOMES.index(path.outcome), None
        near = checked(courses, True, rtol)
        last = tuple(STATE + name for name in model.state)
        query = Query((*last, "contact_time"), "forward", rtol, near)
        collision = Replayable(followed, model.choice, "rosenbrock", path.parting, p.ravel(), dp)
        end, by_p, dp = collision.differentiated(query)
    except ComputationError as error:
        raise n.in_si(error) from None
    value, by_end, by_theta = (matrix.full() for matrix in in_results(end, *given))
    return OUTCOMES.index(path.outcome), (value.ravel(), (by_end @ (by_p @ dp) + by_theta) / units)


def _scaled(pair: Pairs) -> tuple[Problem, np.ndarray]:
    """The groups of a pair, and the axes of its vectors; where nothing moves sideways rates have a scale of 1."""
    if pair.scene.wall:
        return nondimensionalise(pair.scene, -float(pair.opening[0]), 0.0), np.eye(3)
    axes = own_axes(pair)
    n = groups_of(pair, axes)
    return replace(n, groups={**n.groups, "obliquity": n.groups["obliquity"] or 1.0}), axes


def _followed(pair: Pairs, n: Problem) -> tuple[Callable[[float], EventSequence], Courses]:
    """The events of one pair at a tolerance, and what happens at other speeds."""
    if pair.scene.wall:  # the normal motion does not depend on the tangential one
        scene = without_spins(pair.scene)
        aside = nondimensionalise(scene, n.speed, _SLIDES)
        return lambda rtol: replace(sequence_of(aside, rtol), groups=n.groups), partial(courses_of, scene, aside)
    restitution = load(select_model(pair.scene, True, space=True)).names("outputs").index("restitution")

    def courses(factors: np.ndarray) -> list[Course]:
        rows = []
        for factor in factors.tolist():
            faster = replace(pair, velocities=factor * pair.velocities, spins=factor * pair.spins)
            answer, log = recorded_in_space(faster.impacts, FINE)
            rows.append(course(answer, log, words_of(pair.scene), float(answer["shown"][restitution])))
        return rows

    return partial(sequence_in_space, pair, n), courses
