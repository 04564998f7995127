"""Entries, tables and quantities of a scene, and its dimensionless groups by the emitted formulas."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache, partial
from typing import Any

import numpy as np

from ...generated import scaling
from ...generated.automaton import CRITERIA
from ..errors import InputError
from ..host import emitted
from ..host.emitted import LAWS
from .fields import Field, Raw
from .quantities import Ways, normal_speed, quantities
from .schema import FIELDS, MEETING, SPEEDS, Attraction, Bridge, Impact, Liquid, Model, Particles, Partner, Pendulum
from .user_model import ENTRIES, Package, features, fields

Formula = tuple[Callable[..., Any], tuple[str, ...]]
_VARIANTS = (
    "initial_rate_pair", "centrifugal_pair", "generalised_centrifugal", "obliquity_pair", "obliquity_wall",
    "obliquity_space", "rate_scale_pair", "rate_scale_wall",
)  # fmt: skip

GAPS = {word: row.limit for word, row in CRITERIA.items() if row.contact}
"""Word of a rebound criterion with a fixed gap -> name of that gap's group."""
NEVER_MET = dict(row.removed_by for row in CRITERIA.values() if row.removed_by is not None)
"""Quantities that disable the rebound criteria, SI."""
REMOVERS = {
    word: next(name for name, field in FIELDS.items() if field.quantity == row.removed_by[0])
    for word, row in CRITERIA.items()
    if row.removed_by is not None
}
"""Word of such a criterion -> entry of a scene that removes it."""
AT_ANY_SPEED = tuple(word for word, group in GAPS.items() if "speed" not in scaling.ARGUMENTS[group])
"""Criteria whose gap is that of the scene, however fast the impact."""
TIE = "tie of " + " and ".join(CRITERIA[word].name for word in reversed(GAPS))
"""Boundary at which two criteria are met at the same gap."""


@dataclass(frozen=True)
class System:
    """A `Scene` without the ways to read, write and change it: its entries, tables and quantities, SI."""

    name: str
    given: tuple[tuple[str, Raw], ...] = field(compare=False, repr=False)
    comments: tuple[tuple[str, str], ...] = field(default=(), compare=False, repr=False)
    package: Package | None = field(default=None, repr=False)
    held: str = field(default="", compare=False, repr=False)

    particles: Particles = field(init=False, compare=False)
    partner: Partner | None = field(init=False, compare=False)
    liquid: Liquid = field(init=False, compare=False)
    bridge: Bridge | None = field(init=False, compare=False)
    attraction: Attraction | None = field(init=False, compare=False)
    pendulum: Pendulum | None = field(init=False, compare=False)
    model: Model = field(init=False, compare=False)
    impact: Impact = field(init=False, compare=False)
    si: tuple[tuple[str, float | str], ...] = field(init=False, repr=False)
    ways: Ways = field(init=False, repr=False)

    @property
    def fields(self) -> Mapping[str, Field]:
        """The entries that this scene may have: dotted name -> `Field`, with the unit of the value in `si`."""
        entries = fields(self.package)
        if self.ways.volume != "absolute":
            return entries
        return {**entries, "bridge.volume": entries["bridge.volume"].measured}

    @property
    def entries(self) -> Mapping[str, float | str]:
        """The given entries: dotted name -> SI number or choice, in the order of the file."""
        return dict(self.si)

    # ---- laws

    def law_of(self, slot: str) -> str:
        """The name of the law in a slot; "" if the scene lacks the table that says it."""
        table, _, key = ENTRIES[slot].partition(".")
        if self.package is not None:
            own = f"{self.entries.get('liquid.law')}-{getattr(self.model, key, '')}"
            if own in self.package.laws(slot):  # of the liquid
                return own
        if ENTRIES[slot] not in fields(self.package):  # no entry of a scene says it
            return next(iter((*(self.package.laws(slot) if self.package else ()), *LAWS[slot])))
        return str(getattr(getattr(self, table), key, ""))

    def law_has(self, slot: str, feature: str) -> bool:
        """Whether the law in a slot has a feature: a function that others lack, or a property."""
        return feature in features(self.package, slot, self.law_of(slot))

    def laws_with(self, slot: str, feature: str, has: bool = True) -> list[str]:
        """The laws that the scene may choose in a slot and that have a feature, or have it not."""
        choices = self.fields[ENTRIES[slot]].choices
        return [name for name in choices if (feature in features(self.package, slot, name)) == has]

    # ---- quantities of the pair

    @cached_property
    def material(self) -> Mapping[str, float]:
        """The quantities by vocabulary name, SI, without speed and angle of the impact. Read only."""
        return quantities({name: value for name, value in self.si if name not in MEETING}, self.ways)

    @property
    def wall(self) -> bool:
        """True if the partner is a wall."""
        return self.ways.wall

    @property
    def pair(self) -> bool:
        """True if each of two spheres has its own spin: unequal ones, or equal ones with a spin each."""
        return not self.wall and (self.partner is not None or self.impact.partner_spin is not None)

    @property
    def radius_ratio(self) -> float | None:
        """R_2/R_1: 1 without a partner, None for a wall."""
        return self.material.get("radius_ratio")

    @property
    def mass_ratio(self) -> float | None:
        """M_2/M_1: 1 without a partner, None for a wall."""
        return self.material.get("mass_ratio")

    @property
    def reduced_radius(self) -> float:
        """The pair's a = R_1 R_2/(R_1 + R_2) in m; R_1 with a wall."""
        return float(self.material["reduced_radius"])

    @property
    def reduced_mass(self) -> float:
        """The pair's m = M_1 M_2/(M_1 + M_2) in kg; M_1 with a wall."""
        return float(self.material["reduced_mass"])

    # ---- lengths, and the impact as Stokes number and as speed

    @cached_property
    def rupture_gap(self) -> float:
        """x_f in m: rupture gap of the bridge, or without one the film thickness."""
        if self.bridge is None:
            return self.liquid.film_thickness
        return scaled("rupture_gap", self) * self.liquid.film_thickness

    @cached_property
    def stokes_per_speed(self) -> float:
        """m/(6 pi mu a^2) in s/m: ratio of the Stokes number to the normal speed."""
        return scaled("stokes", self, speed=1.0)

    def stokes_of(self, speed: float) -> float:
        """Return the Stokes number of a normal speed (m/s)."""
        return speed * self.stokes_per_speed

    def speed_of(self, stokes: float) -> float:
        """Return the normal speed (m/s) of a Stokes number."""
        return stokes / self.stokes_per_speed

    @property
    def stokes(self) -> float | None:
        """Normal Stokes number of the impact, None if it has none."""
        if self.impact.stokes is not None:
            return self.impact.stokes
        return None if self.speed is None else self.stokes_of(self.speed)

    @property
    def speed(self) -> float | None:
        """Normal approach speed v0 of the impact in m/s, None if it has none."""
        if self.impact.stokes is not None:
            return self.speed_of(self.impact.stokes)
        if self.impact.relative_speed is None or self.impact.angle is None:
            return self.impact.speed
        return float(normal_speed(self.impact.relative_speed, self.impact.angle))

    @property
    def angle(self) -> float | None:
        """Impact angle in rad, None if the impact has none."""
        return self.impact.angle

    def turns(self, angle: float) -> bool:
        """True if something moves sideways at this angle (rad): the impact has one, or a sphere spins."""
        return angle > 0 or bool(self.impact.spin) or bool(self.impact.partner_spin)


def formulas(scene: System) -> Mapping[str, Formula]:
    """Emitted formulas by group or scale, each with the names of its arguments, for the scene's partner and laws.

    A formula takes floats or CasADi expressions. Its arguments are quantities, or groups and scales before it.
    """
    own_law = scene.bridge.law if scene.bridge is not None and scene.bridge.rupture == "own" else None
    return _formulas(scene.wall, scene.pair, own_law, scene.package)


@lru_cache(maxsize=64)
def _formulas(wall: bool, pair: bool, law: str | None, package: Package | None) -> Mapping[str, Formula]:
    """The formulas; `law` is that of a bridge which ruptures at its law's own distance."""
    result: dict[str, Formula] = {
        name: (getattr(scaling, name), arguments)
        for name, arguments in scaling.ARGUMENTS.items()
        if name not in _VARIANTS
    }
    if wall:
        del result["initial_rate"], result["initial_partner_spin"]
        # no line of centres rotates
        result["centrifugal"] = (lambda surface_tension: 0 * surface_tension), ("surface_tension",)
    kind, more = ("wall", ()) if wall else ("pair", ("initial_rate", "centrifugal")) if pair else ("", ())
    for name in (*more, "obliquity", "rate_scale") if kind else ():
        result[name] = getattr(scaling, f"{name}_{kind}"), scaling.ARGUMENTS[f"{name}_{kind}"]
    formula, arguments = result["obliquity"]
    # 1 where it vanishes: nothing moves sideways then, and rates that are zero need some scale
    result["obliquity"] = (lambda *values: (scale := formula(*values)) + (scale == 0)), arguments
    if law is not None:
        result["rupture_gap"] = partial(_own_rupture_gap, package, law), scaling.ARGUMENTS["rupture_gap"]
    if package is not None:
        result |= {name: (function, arguments) for name, (arguments, function) in package.groups.items()}
    return result


def _own_rupture_gap(
    package: Package | None, law: str, reduced_radius: Any, film_thickness: Any, volume: Any, contact_angle: Any
) -> Any:
    """The gap at which a bridge ruptures by its own law, whose module is read here, when numbers are at hand."""
    distance = law_module(package, "bridge", law).rupture_distance(volume, contact_angle)
    return 2 * reduced_radius * distance / film_thickness


def law_module(package: Package | None, slot: str, name: str) -> Any:
    """The emitted module of a law, from the library or the user's model."""
    if package is not None and name in package.laws(slot):
        return package.law(slot, name)
    return emitted.law(slot, name)


def si_values(scene: System, speed: float | None, angle: float | None) -> dict[str, float]:
    """The scene's quantities by vocabulary name, SI; speed and angle only if given."""
    impact = {"speed": speed, "angle": angle}
    return {**scene.material, **{name: value for name, value in impact.items() if value is not None}}


def sideways(scene: System, angle: np.ndarray, varied: Mapping[str, Any]) -> np.ndarray:
    """Mask of the collisions in which something moves sideways: the impact has an angle (rad), or a sphere spins.

    Arguments:
        varied: quantities by vocabulary name that replace the scene's, SI.
    """
    moves: np.ndarray = angle > 0
    for name in ("impact_spin", "impact_partner_spin"):
        spin = varied.get(name, scene.material.get(name, 0.0))
        if np.any(spin):
            moves = moves | (np.asarray(spin) != 0)
    return moves


def rate_scales(scene: System, quantities: Mapping[str, Any], space: bool = False) -> np.ndarray:
    """The scale of angular velocities of each collision, rad/s, from quantities by vocabulary name, SI."""
    values, planar = dict(quantities), formulas(scene)
    for name, in_space in (("obliquity", "obliquity_space"), ("rate_scale", "rate_scale_pair")):
        formula, arguments = (getattr(scaling, in_space), scaling.ARGUMENTS[in_space]) if space else planar[name]
        values[name] = np.asarray(formula(*(values[argument] for argument in arguments))).reshape(-1)  # of arrays a DM
    scales: np.ndarray = values["rate_scale"]
    return scales


def scaled(group: str, scene: System, speed: float | None = None) -> float:
    """Return a group by its emitted formula; inf where a double overflows."""
    return _value(formulas(scene)[group], si_values(scene, speed, None))


def natural(scene: System, name: str) -> float:
    """The value of a user's quantity, by its name, at which its dimensionless group is 1."""
    assert scene.package is not None
    if name in scene.package.plain:
        return 1.0
    speed = scene.speed or 1 / scaled("stokes", scene, 1.0)  # without an impact at a Stokes number of 1
    formula = formulas(scene)[scene.package.group(name)]
    return 1 / _value(formula, {**si_values(scene, speed, None), name: 1.0})


def _value(formula: Formula, values: Mapping[str, float]) -> float:
    function, arguments = formula
    try:
        return float(function(*map(values.__getitem__, arguments)))
    except (OverflowError, ZeroDivisionError):
        return math.inf


# Ranges of groups and scales in which products and quotients of several stay within a double's range. Divisors have a
# lower limit.
_RANGES = (
    dict.fromkeys(("adhesion", "weight", "obliquity"), (0.0, 1e100))
    | dict.fromkeys(("stokes", "aspect", "capillary", "string_ratio", "rupture_gap"), (1e-100, 1e100))
    | dict.fromkeys(("time", "energy"), (1e-300, 1e300))
)
_SCALES: dict[str, Formula] = {
    "time": (lambda film_thickness, speed: film_thickness / speed, ("film_thickness", "speed")),
    "energy": (lambda mass, speed: mass * speed * speed, ("reduced_mass", "speed")),
}


def _finite(scene: System, name: str, formula: Formula, values: Mapping[str, float]) -> float:
    """A group or scale by its formula; InputError outside its range in `_RANGES`, which names what the scene gives."""
    value, arguments = _value(formula, values), formula[1]
    least, most = _RANGES.get(name, (0.0, math.inf))
    if least <= abs(value) <= most and math.isfinite(value):
        return value
    numbers = {argument: values[argument] for argument in arguments}
    spins = [spin for spin in ("impact_spin", "impact_partner_spin") if numbers.get(spin)]
    quantity = spins[0] if spins else "speed" if "speed" in arguments else arguments[0]
    names = [key for key, item in FIELDS.items() if item.quantity == quantity] or [quantity]
    given: tuple[str, Raw] = names[0], numbers[quantity]
    if quantity != "speed" or numbers[quantity] == scene.speed:  # of the scene, not of an impact beside it
        names = [*SPEEDS] if quantity == "speed" else names
        given = next((pair for pair in scene.given if pair[0] in names), given)
    kind = "scale" if name in _SCALES else "number"
    span = "within a double's range" if most == math.inf else f"from {least:g} to {most:g}"
    raise InputError(*given, f"quantities whose {name.replace('_', ' ')} {kind} is {span}", "is too far off")


def check_criteria(scene: System, speed: float | None) -> None:
    """InputError for a criterion of a model whose gap is not within the film; a gap by the speed needs that."""
    if scene.package is None:
        return
    values = si_values(scene, speed, None)
    for criterion in scene.package.criteria:
        formula = formulas(scene)[criterion.group]
        gap = _value(formula, values) if all(map(values.__contains__, formula[1])) else 0.0
        if not 0 <= gap < 1:
            film = values["film_thickness"]
            accepted = f"a gap of 0, or more, but below the film thickness, {film:.4g} m"
            problem = "is negative" if gap < 0 else "is not below the film's surface, where an approach begins"
            raise InputError(f"criterion {criterion.word}", f"{gap * film:.4g} m", accepted, problem)


def groups_and_scales(scene: System, speed: float, angle: float) -> tuple[dict[str, float], dict[str, float]]:
    """The groups of a collision at a normal speed (m/s) and angle (rad), and the scales of time and energy, by name.

    Raises:
        InputError: one is outside its range in `_RANGES`, or a quantity of a user's model is missing.
    """
    check_criteria(scene, speed)
    values = dict(si_values(scene, speed, angle))
    plain = (
        "dry_restitution", "friction", "contact_tangential_restitution", "volume", "contact_angle", "radius_ratio",
        "mass_ratio",
    )  # fmt: skip
    groups: dict[str, float] = {name: values[name] for name in plain if name in values}
    if scene.package is not None:
        scene.package.demand(scene.entries)
        groups |= {name: values[name] for name in scene.package.plain}
    groups |= dict.fromkeys(GAPS.values(), 0.0)
    for name, formula in formulas(scene).items():
        if all(map(values.__contains__, formula[1])):
            groups[name] = values[name] = _finite(scene, name, formula, values)
    return groups, {name: _finite(scene, name, formula, values) for name, formula in _SCALES.items()}


# ---- the gap of solid contact: the largest of the gaps at which a rebound criterion is met


def never_touching(quantities: Mapping[str, Any]) -> Any:
    """Whether no criterion is met at a gap, by quantities (SI); elementwise for arrays."""
    never: Any = True
    for name, value in NEVER_MET.items():
        never = never & (quantities.get(name, value) == value)
    return never


def gap_at_any_speed(word: str, quantities: Mapping[str, Any]) -> Any:
    """Gap of a criterion of AT_ANY_SPEED over x0, from quantities (SI)."""
    group = GAPS[word]
    return getattr(scaling, group)(*(quantities[name] for name in scaling.ARGUMENTS[group]))


def contact_gap(groups: Mapping[str, float]) -> float:
    """Gap of solid contact, over x0."""
    return max(groups[name] for name in GAPS.values())


def contact_word(groups: Mapping[str, float]) -> str:
    """Word that reports a contact: the first criterion whose gap is the largest and positive, else the last."""
    *first, last = GAPS
    contact = contact_gap(groups)
    return next((word for word in first if groups[GAPS[word]] == contact > 0), last)
