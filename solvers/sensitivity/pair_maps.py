"""Maps around a trajectory of a pair: from quantities and vectors to its groups, and from its end to the motion after.

Vectors are in the laboratory's axes; the equations of two spheres are integrated in axes that are constant along all
derivatives. The scale of rates keeps its number, too: no result depends on it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from casadi import SX, Function, cross, densify, dot, jacobian, norm_2, substitute, vertcat, vertsplit

from ...generated import scaling
from ..host.thread_caches import own_cache
from ..model.key import ModelKey
from ..model.model import Model, load
from .parameters import Kind, parameter_map

AXES = "xyz"
INPUTS = 15  # normal, two velocities, two spins
SIZES = ("reduced_radius", "radius_ratio", "mass_ratio")
RESULTS: Mapping[str, tuple[int, ...]] = {
    "restitution": (), "time": (), "gap": (), "normal": (3,), "position": (3,), "velocities": (2, 3), "spins": (2, 3),
}  # fmt: skip
"""Shapes of the results, in the order of the maps' rows."""


def quantities_of(model: Model) -> tuple[str, ...]:
    """Names of the quantities `g` of a pair's maps: groups that no vector changes, and sizes."""
    groups = (name for name in model.groups if not name.startswith(("obliquity", "initial_")))
    return tuple(dict.fromkeys((*groups, *(SIZES if model.space else SIZES[:1]))))


@dataclass(frozen=True)
class _Inputs:
    normal: SX
    velocities: tuple[SX, SX]
    spins: tuple[SX, SX]

    @classmethod
    def of(cls, x: SX) -> _Inputs:
        normal, first, second, spin, partner = (x[k : k + 3] for k in range(0, INPUTS, 3))
        return cls(normal / norm_2(normal), (first, second), (spin, partner))

    @property
    def relative(self) -> SX:
        return self.velocities[1] - self.velocities[0]


@own_cache(32)
def pair_maps(
    kind: Kind, choice: ModelKey, entries: tuple[str, ...], components: tuple[int, ...]
) -> tuple[Function, Function]:
    """The maps of a model of two spheres in space, or of a sphere beside a wall, as CasADi functions.

    Both take the reference values of the entries, the inputs x, the axes and scale of the groups, and dp/dtheta of the
    parameters, which are these entries and components of x.

    Returns:
        The groups and their derivatives in theta; and, with the end of the trajectory as the first argument, the
        results and their derivatives by the end and in theta.
    """
    model, size = load(choice), len(entries) + len(components)
    reference, x, axes, scale = SX.sym("ref", len(kind.entries)), SX.sym("x", INPUTS), SX.sym("axes", 3, 3), SX.sym("s")
    units, theta, end = SX.sym("units", size), SX.sym("theta", size), SX.sym("end", len(model.state) + 1)
    values, vectors = SX(reference), SX(x)
    for k, name in enumerate(entries):
        values[kind.entries.index(name)] += units[k] * theta[k]
    for k, place in enumerate(components, len(entries)):
        vectors[place] += units[k] * theta[k]
    inputs = _Inputs.of(vectors)
    speed = -dot(inputs.normal, inputs.relative)
    values[kind.entries.index(kind.held)] = speed
    names = quantities_of(model)
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

    def function(name: str, arguments: list[SX], *outputs: SX) -> Function:
        here = substitute(list(outputs), [theta], [SX.zeros(size)])
        return Function(name, [*arguments, reference, x, axes, scale, units], [densify(output) for output in here])

    return (
        function("groups", [], p, jacobian(p, theta)),
        function("results", [end], results, jacobian(results, end), jacobian(results, theta)),
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
    """Results of two spheres, as `space.ends.after` has them."""
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
    """Results beside a wall, as `space.beside_wall` has them: one linear map of sliding and rolling."""
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
