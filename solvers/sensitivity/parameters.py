"""Parameters of a collision: numeric entries of its scene by dotted name, and the map to groups and scales.

Derivatives are in theta, p = p_ref (1 + theta), or p = scale theta where p_ref is 0, so that each is of order one.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from casadi import SX, Function, densify, jacobian, substitute, vec, vertcat

from ...generated import scaling
from ..errors import InputError, excerpt
from ..host.arguments import check_names
from ..host.casadi_calls import Buffered
from ..host.thread_caches import own_cache
from ..scene.groups import GAPS, Formula, formulas
from ..scene.quantities import Ways, initial_gap, normal_speed, quantities
from ..scene.scene import Scene
from ..scene.schema import FIELDS, MEETING, SPEEDS, SPINS, acting_defaults

SIDEWAYS = ("impact.angle", *SPINS)
IMPACT = ("impact.speed", "impact.stokes", "impact.angle")
Row = Mapping[str, float | None]
"""A number for each parameter; None where it is not defined."""
SCALES = ("length", "time", "rate", "energy")
RELATIVE = "impact.relative_speed"
_AT_ONCE = 32  # impacts in a call of a parameter map, which takes 5 us for itself


def elasticities(value: np.ndarray, gradient: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Values d ln y/d ln p of y (results, ...) and dy/dp (results, ..., parameters); NaN where y or p is zero."""
    with np.errstate(divide="ignore", invalid="ignore"):
        ratios: np.ndarray = gradient * reference / value[..., None] + 0.0
    ratios[~np.isfinite(ratios) | (reference == 0)] = np.nan
    return ratios


def numbers(names: Sequence[str], values: np.ndarray) -> Row:
    """Values by name, None for NaN."""
    return {name: None if value != value else value for name, value in zip(names, values.tolist(), strict=True)}


def cell(elasticity: float | None, gradient: float | None, none: str = "none") -> str:
    """An elasticity in a table, `none` for zero; or, marked by a star, the derivative where there is none."""
    if elasticity is None:
        return "-" if gradient is None else f"* {gradient:.4g}"
    return f"{elasticity:.5g}" if elasticity else none


def parameters_of(scene: Scene) -> tuple[str, ...]:
    """The parameters of a scene: its numeric entries in the file's order, then speed, Stokes number and angle."""
    numeric = [name for name, value in scene.si if not (isinstance(value, str) or name in MEETING)]
    return (*numeric, *((RELATIVE,) if RELATIVE in scene.entries else ()), *IMPACT)


def check_wrt(scene: Scene, wrt: Sequence[str] | str | None, label: str = "wrt") -> tuple[str, ...]:
    """The requested parameters; InputError with the nearest known name for one that the scene does not have."""
    everything = parameters_of(scene)
    if wrt is None:
        return everything
    # parameters even if the scene takes their defaults or gives another speed
    more = (*_defaults(scene), RELATIVE)
    refuse_texts(scene, wrt, everything, label)
    requested = check_names(wrt, (*everything, *(name for name in more if name not in everything)), label)
    if not requested:
        raise InputError(label, "", ", ".join(everything), "names no parameter")
    return requested


def refuse_texts(scene: Scene, names: object, accepted: Sequence[str], label: str) -> None:
    """InputError for a choice, or an entry that this scene has as text (a volume "from coating"): neither can vary."""
    for name in (names,) if isinstance(names, str) else names if isinstance(names, Collection) else ():
        entry, value = scene.fields.get(str(name)), scene.entries.get(str(name))
        if entry is None or name in accepted:
            continue
        if not entry.numeric:
            raise InputError(label, name, ", ".join(accepted), "is a choice, not a number")
        if isinstance(value, str):
            raise InputError(label, name, ", ".join(accepted), f"is {excerpt(value)} in this scene, not a number")


def _defaults(scene: Scene) -> dict[str, float]:
    """Numeric entries that take their defaults."""
    barred = () if scene.pendulum is None else SPINS
    return {name: value for name, value in acting_defaults(scene.entries).items() if name not in barred}


@dataclass(frozen=True)
class Kind:
    """Key of a parameter map: the entries that a scene has, and the held quantity of the impact."""

    entries: tuple[str, ...]  # names of the reference values, in order
    hold: str
    ways: Ways
    shape: tuple[object, ...]  # further choices that select the formulas
    formulas: Mapping[str, Formula] = field(compare=False, repr=False)

    @property
    def held(self) -> str:
        return f"impact.{self.hold}"


def kind_of(scene: Scene, hold: str) -> Kind:
    """The kind (key of the parameter map) of a scene's collision."""
    entries = dict.fromkeys(name for name in (*parameters_of(scene), *_defaults(scene)) if name not in MEETING)
    own_rupture = scene.bridge.law if scene.bridge is not None and scene.bridge.rupture == "own" else None
    names, choices = (*entries, f"impact.{hold}", "impact.angle"), (scene.pair, own_rupture, scene.package)
    return Kind(names, hold, scene.ways, choices, formulas(scene))


def references(scene: Scene, names: Sequence[str], speed: Any, angle: Any) -> np.ndarray:
    """Values of parameters at a normal speed (m/s) and angle (rad), SI: (names,); at arrays of them (names, n)."""
    values: dict[str, Any] = _defaults(scene) | dict(scene.entries)
    values |= {"impact.speed": speed, "impact.stokes": scene.stokes_of(speed), "impact.angle": angle}
    values[RELATIVE] = speed / normal_speed(1.0, angle)
    return np.array(np.broadcast_arrays(speed, angle, *(values[name] for name in names))[2:], dtype=float)


def _scale_of_zero(name: str, values: Mapping[str, SX], ways: Ways) -> SX:
    """Scale of a parameter whose reference value is zero."""
    unit = FIELDS[name].unit if name in FIELDS else None
    if unit == "rad/s":  # of a surface that moves at 1 m/s
        return SX(1 / quantities(values, ways)["reduced_radius"])
    return initial_gap(values) if unit == "m" else SX(1)


@dataclass(frozen=True)
class ParameterMap:
    """Map from parameters to groups and scales, as CasADi functions of the reference values.

    Arguments:
        values: (ref,) -> groups, then the scales of length, time, rate and energy.
        whole: (ref,) -> these, their derivatives in theta parameter by parameter, and dp/dtheta, as one column.
    """

    values: Function
    whole: Function

    def at(self, reference: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Groups and scales (n,), their derivatives in theta (n, parameters), and dp/dtheta (parameters,).

        Of references (names, impacts) at once (n, impacts), (n, impacts, parameters) and (impacts, parameters).
        """
        impacts, size = reference.shape[1:], self.values.nnz_out(0)
        rows = np.atleast_2d(reference.T)
        count = min(len(rows), _AT_ONCE)
        whole = Buffered(self.whole.map(count), (0,))
        blocks = np.resize(rows, (-(-len(rows) // count), count * rows.shape[1]))  # the last one filled up
        columns = np.concatenate([whole(block) for block in blocks]).reshape(-1, self.whole.nnz_out(0))[: len(rows)]
        columns = columns.reshape(*impacts, -1)
        parameters = (self.whole.nnz_out(0) + 1) // (size + 1) - 1
        numbers, slopes, units = np.split(columns, (size, size * (1 + parameters)), axis=-1)
        slopes = slopes.reshape(*impacts, parameters, size)
        return np.moveaxis(numbers, -1, 0), np.moveaxis(slopes, -1, 0), units


@own_cache(128)
def parameter_map(kind: Kind, wrt: tuple[str, ...], groups: tuple[str, ...]) -> ParameterMap:
    """The map from a kind's parameters to the groups of a model.

    Speed and Stokes number are one variable: either changes the held one by the same relative amount.
    """
    reference = SX.sym("ref", len(kind.entries))
    theta = SX.sym("theta", len(wrt))
    base = {name: reference[k] for k, name in enumerate(kind.entries)}
    values, units = dict(base), []
    for k, name in enumerate(wrt):
        moved = kind.held if name in SPEEDS else name
        zero = base[moved] == 0
        unit = zero * _scale_of_zero(moved, base, kind.ways) + (1 - zero) * base[moved]
        values[moved] += theta[k] * unit
        units.append(_impact(base, kind.ways)[name] if name in SPEEDS else unit)
    known_values = dict(quantities(values, kind.ways))
    numbers: dict[str, Any] = dict.fromkeys(GAPS.values(), SX(0))
    numbers |= {name: known_values[name] for name in groups if name in known_values}
    for name, (formula, arguments) in kind.formulas.items():
        # a scale of which no result depends is that of the reference
        at = quantities(base, kind.ways) if name == "obliquity" else known_values
        if all(argument in at for argument in arguments):
            numbers[name] = known_values[name] = formula(*(at[argument] for argument in arguments))
    speed, length = known_values["speed"], known_values["film_thickness"]
    scales = [length, length / speed, numbers["rate_scale"], known_values["reduced_mass"] * speed**2]
    column = densify(vertcat(*(SX(numbers[name]) for name in groups), *scales))

    def function(name: str, output: SX) -> Function:
        (here,) = substitute([output], [theta], [SX.zeros(len(wrt))])
        return Function(name, [reference], [densify(here)])

    whole = vertcat(column, vec(densify(jacobian(column, theta))), *units)
    return ParameterMap(function("values", column), function("whole", whole))


def _impact(base: Mapping[str, SX], ways: Ways) -> dict[str, SX]:
    """Speeds and Stokes number as expressions of the reference values."""
    of = quantities(base, ways)
    stokes = scaling.stokes(of["reduced_radius"], of["reduced_mass"], of["viscosity"], of["speed"])
    relative = of["speed"] / normal_speed(1, base["impact.angle"])
    return {"impact.speed": of["speed"], "impact.stokes": stokes, RELATIVE: relative}
