"""`pair_gradients()`: derivatives of collisions with vectors, of two spheres in space or of a sphere and a wall.

Maps lead from quantities and vectors to the groups of a trajectory, and from its end to the motion after.
Vectors are in the laboratory's axes; the equations of two spheres are integrated in axes that are constant along all
derivatives. The scale of rates keeps its number, too: no result depends on it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np
from casadi import SX, Function, cross, densify, dot, jacobian, norm_2, vertcat, vertsplit

from ...generated import scaling
from ...generated.automaton import OUTCOMES, STICK
from ..boundaries.experiment import free_names
from ..collision.by_kernel import sequence_of, words_of
from ..collision.space.by_replay import groups_of, own_axes, sequence_in_space
from ..collision.space.collide_pair import NUMBERS, VECTORS, check_scene, refusals
from ..collision.space.pairs import AXES, Pairs, without_spins
from ..collision.space.pairs import checked as checked_pairs
from ..engines.casadi.sequence import EventSequence
from ..engines.settings import check_rtol
from ..engines.taylor.record import recorded_in_space
from ..errors import ComputationError, WetDoubletError
from ..host.arguments import check_names
from ..host.pictures import register
from ..host.thread_caches import own_cache
from ..model.dimensionless import Problem, nondimensionalise
from ..model.key import ModelKey
from ..model.model import Model, load, select_model
from ..model.validity import warn
from ..results import FAILED, outcome_attributes
from ..scene.origin import provenance
from ..scene.scene import Scene
from .boundary_distance import FINE, Course, Courses, checked, course, courses_of
from .by_casadi import Replayable
from .parameters import Kind, kind_of, parameter_map, references
from .problem import RECORDED, Query
from .trajectory import STATE

if TYPE_CHECKING:
    import xarray

_SLIDES = np.pi / 4  # any angle beside a wall
INPUTS: Mapping[str, tuple[int, ...]] = {"normal": (3,), "velocities": (2, 3), "spins": (2, 3)}
COMPONENTS = tuple(
    ".".join((name, *map(str, index[:-1]), AXES[index[-1]])) for name, shape in INPUTS.items()
    for index in np.ndindex(shape)
)  # fmt: skip
"""Names of all components of the inputs, which follow the entries among what is given to the maps."""
_STICK = "a stick: the rigid motion that it is given as is not differentiated"
SIZES = ("reduced_radius", "radius_ratio", "mass_ratio")
RESULTS: Mapping[str, tuple[int, ...]] = {
    "restitution": (), "time": (), "gap": (), "normal": (3,), "position": (3,), "velocities": (2, 3), "spins": (2, 3),
}  # fmt: skip
"""Shapes of the results, in the order of the maps' rows."""
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
    parameters = [name for name in names if name not in INPUTS]
    absent = "spins.1" if loaded.wall else "none"
    parameters += [name for name in COMPONENTS if name.partition(".")[0] in names and not name.startswith(absent)]
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
            outcome[k], value[k], slope[k] = _of_one_pair(pairs.subset(np.array([k])), parameters, rtol)
        except WetDoubletError as error:
            reason[k] = str(error)
    reason[outcome == OUTCOMES.index(STICK)] = _STICK
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
        by_parameter = slopes.reshape((*pairs.shape, *shape, len(parameters)))
        meaning = {"long_name": f"derivative of the {attrs['long_name']}"}
        data[f"d_{name}"] = (*dims, *more, "parameter"), by_parameter, meaning
    coordinates = {"axis": list(AXES), "parameter": parameters}
    return xr.Dataset(data, coordinates, provenance(loaded, rtol=rtol, engine="rosenbrock"))


def _of_one_pair(pair: Pairs, parameters: Sequence[str], rtol: float) -> tuple[int, Any, Any]:
    """Outcome of one pair; its results and their derivatives (results, parameters), NaN if it sticks.

    Raises:
        ComputationError: near a boundary, or the trajectory could not be differentiated.
    """
    scene = pair.scene
    model, kind = load(select_model(scene, True, space=not scene.wall)), kind_of(scene, "speed")
    in_groups, in_results = pair_maps(kind, model.choice)
    v0 = -float(pair.opening[0])
    reference = references(scene, kind.entries, v0, 0.0)
    inputs = np.concatenate([pair.normal[0], pair.velocities[0].ravel(), pair.spins[0].ravel()])
    typical = np.concatenate([np.ones(3), np.full(6, v0), np.full(6, v0 / float(scene.material["reduced_radius"]))])
    places = [*map((*kind.entries, *COMPONENTS).index, parameters)]
    units = np.append(np.where(reference == 0, 1.0, reference), typical)[places]
    n, axes = _scaled(pair)
    given = np.append(reference, inputs), axes, n.groups["obliquity"]
    p, dp = (matrix.full() for matrix in in_groups(*given))
    n = replace(n, groups={**n.groups, **dict(zip(model.groups, p.ravel().tolist(), strict=True))})
    followed, courses = _followed(pair, n)
    try:
        path = followed(RECORDED)
        if not path.separated:
            return OUTCOMES.index(path.outcome), np.nan, np.nan
        near = checked(courses, True, rtol)
        last = tuple(STATE + name for name in model.state)
        query = Query((*last, "contact_time"), "forward", rtol, near)
        collision = Replayable(followed, model.choice, "rosenbrock", path.parting, p.ravel(), dp[:, places] * units)
        end, slopes = collision.differentiated(query)
    except ComputationError as error:
        raise n.in_si(error) from None
    value, by_end, direct = (matrix.full() for matrix in in_results(end, *given))
    return OUTCOMES.index(path.outcome), value.ravel(), by_end @ slopes / units + direct[:, places]


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


# ---- maps


@dataclass(frozen=True)
class _Inputs:
    normal: SX
    velocities: tuple[SX, SX]
    spins: tuple[SX, SX]
    relative: SX

    @classmethod
    def of(cls, x: SX) -> _Inputs:
        normal, first, second, spin, partner = (x[k : k + 3] for k in range(0, len(COMPONENTS), 3))
        return cls(normal / norm_2(normal), (first, second), (spin, partner), second - first)


@own_cache(32)
def pair_maps(kind: Kind, choice: ModelKey) -> tuple[Function, Function]:
    """The maps of a model of two spheres in space, or of a sphere beside a wall, as CasADi functions.

    Both take what is given, the reference values of the entries and the inputs, and the axes and scale of the groups.

    Returns:
        The groups and their derivatives by what is given; and, with the end of the trajectory as the first argument,
        the results and their derivatives by the end and by what is given.
    """
    model, count = load(choice), len(kind.entries)
    given, axes, scale = SX.sym("given", count + len(COMPONENTS)), SX.sym("axes", 3, 3), SX.sym("s")
    end = SX.sym("end", len(model.state) + 1)
    values, inputs = SX(given[:count]), _Inputs.of(given[count:])
    speed = -dot(inputs.normal, inputs.relative)
    values[kind.entries.index(kind.held)] = speed
    groups = [name for name in model.groups if not name.startswith(("obliquity", "initial_"))]  # no vector's
    names = tuple(dict.fromkeys((*groups, *(SIZES if model.space else SIZES[:1]))))
    numbers = parameter_map(kind, (), names).values(values)
    quantities = {name: numbers[k] for k, name in enumerate((*names, "film_thickness"))} | {"speed": speed}
    if model.space:
        first = _first(quantities, inputs, axes, scale) | {"obliquity": scale}
    else:
        first = {"initial_turning": SX(1), "initial_spin": SX(0), "obliquity": SX(1)}
    p = densify(vertcat(*(first[name] if name in first else quantities[name] for name in model.groups)))
    if model.space:
        results = densify(_of_spheres(model, end, p, quantities, inputs, axes, scale))
    else:
        results = densify(_beside_wall(model, end, p, quantities, inputs))
    slopes = [densify(jacobian(column, by)) for column, by in ((p, given), (results, end), (results, given))]
    return (
        Function("groups", [given, axes, scale], [p, slopes[0]]),
        Function("results", [end, given, axes, scale], [results, *slopes[1:]]),
    )


def _sizes(quantities: Mapping[str, SX]) -> tuple[SX, SX]:
    """Sum of the radii, and the part of the mass that is the first sphere's."""
    a, ratio = quantities["reduced_radius"], quantities["radius_ratio"]
    return a * (1 + ratio) ** 2 / ratio, 1 / (1 + quantities["mass_ratio"])


def _rate(quantities: Mapping[str, SX], scale: SX) -> SX:
    """The scale of rates, rad/s."""
    values = {**quantities, "obliquity": scale}
    return SX(scaling.rate_scale_pair(*(values[name] for name in scaling.ARGUMENTS["rate_scale_pair"])))


def _first(quantities: Mapping[str, SX], inputs: _Inputs, axes: SX, scale: SX) -> dict[str, SX]:
    """The groups that are components of vectors."""
    distance, rate = _sizes(quantities)[0] + quantities["film_thickness"], _rate(quantities, scale)
    vectors = {
        "initial_normal": inputs.normal,
        "initial_turning": cross(inputs.normal, inputs.relative) / distance / rate,
        "initial_spin": inputs.spins[0] / rate,
        "initial_partner_spin": inputs.spins[1] / rate,
    }
    return {f"{name}_{axis}": (axes @ v)[k] for name, v in vectors.items() for k, axis in enumerate(AXES)}


def _of_spheres(
    model: Model, end: SX, groups: SX, quantities: Mapping[str, SX], inputs: _Inputs, axes: SX, scale: SX
) -> SX:
    """Results of two spheres, as `collision.space.ends.after` has them."""
    y, rate, speed = end[:-1], _rate(quantities, scale), quantities["speed"]
    values = dict(zip(model.names("outputs"), vertsplit(model.function("outputs")(y, groups)), strict=True))

    def vector(name: str) -> SX:
        return axes.T @ vertcat(*(values[f"{name}_{axis}"] for axis in AXES))

    contact, share = _sizes(quantities)
    gap, normal = y[0] * quantities["film_thickness"], vector("final_normal")
    turning = vector("final_rotation_rate") * rate
    relative = (contact + gap) * cross(turning, normal) + values["restitution"] * speed * normal
    centre = share * inputs.velocities[0] + (1 - share) * inputs.velocities[1]
    return vertcat(
        values["restitution"],
        end[-1] * quantities["film_thickness"] / speed,
        gap,
        normal,
        (contact + gap) * normal,
        centre - (1 - share) * relative,
        centre + share * relative,
        vector("final_spin") * rate,
        vector("final_spin_partner") * rate,
    )


def _beside_wall(model: Model, end: SX, groups: SX, quantities: Mapping[str, SX], inputs: _Inputs) -> SX:
    """Results beside a wall, as `collision.space.beside_wall` has them: one linear map of sliding and rolling."""
    y, speed, radius, normal = end[:-1], quantities["speed"], quantities["reduced_radius"], inputs.normal
    spinning = SX(groups)
    spinning[list(model.groups).index("initial_spin")] = 1
    places = [model.names("outputs").index(name) for name in ("tangential_restitution", "final_spin")]
    slides, both = (model.function("outputs")(y, p) for p in (groups, spinning))
    restitution = slides[model.names("outputs").index("restitution")]
    sliding = dot(normal, inputs.relative) * normal - inputs.relative
    rolling = radius * cross(normal, inputs.spins[0])
    later_slide, later_roll = (slides[k] * sliding + (both[k] - slides[k]) * rolling for k in places)
    gap = y[0] * quantities["film_thickness"]
    wall, nothing = inputs.velocities[1], SX.zeros(3)
    return vertcat(
        restitution,
        end[-1] * quantities["film_thickness"] / speed,
        gap,
        normal,
        (radius + gap) * normal,
        wall + later_slide - restitution * speed * normal,
        wall,
        cross(later_roll, normal) / radius + dot(inputs.spins[0], normal) * normal,
        nothing,
    )
