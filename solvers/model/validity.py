"""Where a collision leaves the model's range: each limit once, with its number, as sentences and as flags.

The numbers are computed by formulas that take floats, arrays or CasADi expressions, so that one table serves a
collision, a map, and C that computes them elsewhere.
"""

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache, reduce
from types import SimpleNamespace
from typing import Any

import numpy as np

from ...generated.automaton import BOUNCE, OUTCOMES
from ..errors import ModelWarning
from ..host.emitted import LAWS
from ..scene.groups import GAPS, NEVER_MET, formulas, law_module, si_values
from ..scene.liquids import is_named, liquid
from ..scene.scene import Scene
from ..scene.schema import LIQUIDS, NEWTONIAN

Values = Mapping[str, Any]  # quantities under the vocabulary's names and results, SI: floats, arrays, expressions
_ROUNDING = 1e-12  # 50 deg is inside of 50 deg
_SRS = 1


@dataclass(frozen=True)
class Limit:
    """A number that says how far the model may be trusted, and between which values it may.

    Arguments:
        flag: its word in a Dataset.
        number: of a scene, its quantities and results; NaN where the question does not arise.
        says: the sentence for a number outside.
    """

    flag: str
    number: Callable[[Scene, Values], Any]
    says: Callable[[float], str]
    least: float = -math.inf
    most: float = math.inf

    @property
    def bounds(self) -> tuple[float, float]:
        """The least and most number that count as inside."""
        least = self.least - abs(self.least) * _ROUNDING if math.isfinite(self.least) else self.least
        return least, self.most + abs(self.most) * _ROUNDING if math.isfinite(self.most) else self.most

    def exceeded(self, number: Any) -> Any:
        """Where the number lies outside."""
        least, most = self.bounds
        return np.greater(number, most) | np.less(number, least)


def _library(values: Values) -> Any:
    """The functions used here, under numpy's names: of arrays, or of CasADi expressions."""
    return _of_expressions() if hasattr(values["angle"], "is_symbolic") else np


@lru_cache(maxsize=1)
def _of_expressions() -> Any:
    import casadi

    return SimpleNamespace(
        tan=casadi.tan, sin=casadi.sin, arctan=casadi.atan, arctan2=casadi.atan2, abs=casadi.fabs, log=casadi.log,
        maximum=casadi.fmax, where=casadi.if_else, logical_and=casadi.logic_and, logical_or=casadi.logic_or,
    )  # fmt: skip


# Re: lubrication theory leaves the inertia of the liquid out, and takes none of its terms to be of order Re.
_REYNOLDS = 1.0
# x0/a: lubrication theory is the first term of an expansion in the gap over the radius (O'Neill & Stewartson 1967;
# Jeffrey & Onishi 1984); what it leaves out of the film's force is of order x0/a.
_FILM_GAP = 0.2
# x_f/a: from x = a on the logarithm ln(2a/x) is below ln 2, less than the constant of order one that it leaves out.
_RUPTURE_GAP = 1.0
# A path that is bent by less is one past the other sphere.
_BENT = math.radians(10)
# Torque on a sphere that slides along a wall, over 8 pi mu R^2 U: ln(R/x)/10 - 0.1895 (Goldman, Cox & Brenner 1967);
# the model has ln(h_outer/x)/10. The ratio of the two may differ from 1 by a quarter.
_WALL_CONSTANT = 1.895
_WALL_RATIO = 1.25


def _rupture_gap(scene: Scene, values: Values) -> Any:
    """x_f/a of a bridge; without one the film's x0/a says it."""
    if scene.bridge is None:
        return math.nan
    return _group(scene, values, "rupture_gap") * values["film_thickness"] / values["reduced_radius"]


def _group(scene: Scene, values: Values, name: str) -> Any:
    formula, arguments = formulas(scene)[name]
    return formula(*(values[argument] for argument in arguments))


def _radii(values: Values) -> tuple[Any, Any]:
    """R_1 and R_2 of two spheres."""
    ratio = values["radius_ratio"]
    return values["reduced_radius"] * (1 + ratio) / ratio, values["reduced_radius"] * (1 + ratio)


def _liquid(scene: Scene, values: Values) -> Any:
    """Volume of the bridge over that of a coating x0/2 on each sphere; a wall has any amount of liquid."""
    if scene.bridge is None or scene.wall:
        return math.nan
    coating = values["film_thickness"] / 2
    shells = [4 / 3 * math.pi * ((radius + coating) ** 3 - radius**3) for radius in _radii(values)]
    return values["volume"] * (2 * values["reduced_radius"]) ** 3 / (shells[0] + shells[1])


def _bent(scene: Scene, values: Values) -> Any:
    """Angle by which the relative velocity has turned, of spheres that would have missed each other; else NaN."""
    if scene.wall:
        return math.nan
    on = _library(values)
    touching = sum(_radii(values))
    apart = touching + values["film_thickness"]
    sliding = on.tan(values["angle"]) * apart / touching  # per normal speed: omega is v0 tan(theta0)/touching
    misses = apart * on.sin(on.arctan(sliding)) > touching
    along = on.arctan2(values["tangential_restitution"] * sliding, values["restitution"])
    bent = on.abs(values["rotation"] + along - (math.pi - on.arctan(sliding)))
    return on.where(on.logical_and(misses, values["outcome"] == _SRS), bent, math.nan)


def _wall_coupling(scene: Scene, values: Values) -> Any:
    """Torque of sliding along a wall by the leading logarithm over the published one, at the smallest gap."""
    if not scene.wall or scene.law_of("shear") not in LAWS["shear"]:
        return math.nan
    edge = law_module(scene.package, "shear", scene.model.tangential).edge
    outer = edge(values["film_thickness"] / values["reduced_radius"]) * values["film_thickness"]
    gap = values["smallest_gap"]  # NaN for a stick, whose spin is not defined
    on = _library(values)
    with np.errstate(all="ignore"):
        published = on.log(values["reduced_radius"] / gap) - _WALL_CONSTANT
        none = on.where(published <= 0, math.inf, math.nan)
        ratio = on.where(published > 0, on.log(outer / gap) / published, none)
    return on.where(values["angle"] > 0, ratio, math.nan)


def _unlike(scene: Scene, values: Values) -> Any:
    """The larger radius over the smaller; infinite for a wall."""
    if scene.wall:
        return math.inf
    return _library(values).maximum(values["radius_ratio"], 1 / values["radius_ratio"])


def _cavitating(scene: Scene, values: Values) -> Any:
    if not scene.law_has("film", "suction"):
        return math.nan
    return _library(values).where(values["angle"] > 0, _unlike(scene, values), math.nan)


def _idle_friction(scene: Scene, values: Values) -> Any:
    """Smallest gap of a bounce over that of solid contact, where only solids have friction; else NaN."""
    if scene.particles.friction is None or scene.model.contact_friction != "solid":
        return math.nan
    values = {"poisson_ratio": 0.0, **NEVER_MET, **values}  # entries that may be left out
    on = _library(values)
    contact = values["film_thickness"] * reduce(on.maximum, (_group(scene, values, name) for name in GAPS.values()))
    bounced = values["outcome"] == OUTCOMES.index(BOUNCE)
    oblique = on.logical_or(values["angle"] > 0, scene.turns(0.0))
    with np.errstate(all="ignore"):
        return on.where(on.logical_and(bounced, oblique), values["smallest_gap"] / contact, math.nan)


_PLACES = 40  # gaps between the film's edge and the smallest at which the rate is looked for


def shear_rate(scene: Scene, values: Values) -> Any:
    """About the largest shear rate in the film, 1/s, that the squeeze makes at a wall.

    It is 3 |u| s/h^2, on the ring where h = 4x/3 the largest; u falls from v0 to nothing at the smallest gap as in a
    Newtonian film, and is v0 up to a rebound. A stick's smallest gap is where a film of this viscosity would stop it.
    """
    on, bounced = _library(values), values["outcome"] == OUTCOMES.index(BOUNCE)
    thickness, radius, speed = (values[name] for name in ("film_thickness", "reduced_radius", "speed"))
    stokes, gap = _group(scene, values, "stokes"), values["smallest_gap"] / thickness
    largest = 0.0
    for k in range(1, _PLACES + 1):
        here = on.where(gap == gap, gap, 1e-3) ** (k / _PLACES)  # a stick has none
        stopped = on.where(gap == gap, _taken(gap, on), stokes)
        share = on.where(bounced, 1.0, on.maximum(1 - _taken(here, on) / stopped, 0.0))
        largest = on.maximum(largest, share * ((1 - here) > 0.25) / here**1.5)
    return 9 * math.sqrt(6) / 16 * largest * speed / (thickness * radius) ** 0.5


def _taken(gap: Any, on: Any) -> Any:
    """The Stokes number that a film takes from an approach to this gap, over x0."""
    return on.log(1 / gap) - 1.5 + 2 * gap - gap**2 / 2


def _sheared(scene: Scene, values: Values) -> Any:
    """The largest shear rate over that up to which the liquid was measured; NaN where that is not said."""
    measured = scene.entries.get("liquid.measured_to")
    return math.nan if measured is None else shear_rate(scene, values) / measured


def _has_plateau(scene: Scene) -> bool:
    return "plateau_rate" in LIQUIDS.get(scene.liquid.law or NEWTONIAN, ())


def _creeping(scene: Scene, values: Values) -> Any:
    """Time of contact over that of the rate below which the liquid is Newtonian; NaN of a liquid without one."""
    if not _has_plateau(scene):
        return math.nan
    return values["contact_time"] * values["plateau_rate"]  # NaN for a stick


def _partner(ratio: float) -> str:
    return "the partner is a wall" if math.isinf(ratio) else f"one radius is {ratio:.4g} times the other, above 1"


LIMITS: tuple[Limit, ...] = (
    Limit(
        "film_reynolds",
        lambda scene, values: _group(scene, values, "reynolds") if "density" in values else math.nan,
        lambda n: f"the film's Reynolds number Re = {n:.3g} is above {_REYNOLDS:g}: the liquid's inertia is left out",
        most=_REYNOLDS,
    ),
    Limit(
        "film_gap",
        lambda _, values: values["film_thickness"] / values["reduced_radius"],
        lambda n: f"x0/a = {n:.3g} is above {_FILM_GAP:g}: lubrication theory takes a film thin beside the radius",
        most=_FILM_GAP,
    ),
    Limit(
        "rupture_gap",
        _rupture_gap,
        lambda n: f"x_f/a = {n:.3g} is above {_RUPTURE_GAP:g}: before rupture the gap is not small beside the radius",
        most=_RUPTURE_GAP,
    ),
    Limit(
        "bridge_liquid",
        _liquid,
        lambda n: f"the bridge holds {n:.3g} times the liquid of a coating x0/2 on each sphere, more than 1 times",
        most=1.0,
    ),
    Limit(
        "fly_by",
        _bent,
        lambda n: (
            f"the path is bent by {math.degrees(n):.2g} deg, less than {math.degrees(_BENT):.0f} deg, and straight on "
            "the solids would have missed each other: a fly-by, counted as stick-rotate-separate"
        ),
        least=_BENT,
    ),
    Limit(
        "wall_coupling",
        _wall_coupling,
        lambda n: (
            f"beside the wall the coupling that sets the final spin is {n:.3g} times the published one at the smallest "
            f"gap, outside {1 / _WALL_RATIO:g} to {_WALL_RATIO:g}: the leading logarithm leaves a constant out "
            "(Goldman, Cox & Brenner 1967)"
        ),
        least=1 / _WALL_RATIO,
        most=_WALL_RATIO,
    ),
    Limit(
        "cavitating_film",
        _cavitating,
        lambda n: f"{_partner(n)}: the film cavitating ignores the pressure of rolling between unequal surfaces",
        most=1.0,
    ),
    Limit(
        "own_rupture",
        lambda scene, values: (
            _unlike(scene, values) if scene.bridge is not None and scene.bridge.rupture == "own" else math.nan
        ),
        lambda n: f"{_partner(n)}: the law's own rupture distance is that of equal spheres",
        most=1.0,
    ),
    Limit(
        "idle_friction",
        _idle_friction,
        lambda n: (
            "friction does nothing: the pair rebounds from glassy liquid, and its smallest gap is "
            f"{n:.3g} times that of solid contact (model.contact_friction = all lets it act)"
        ),
        most=1 + 1e-9,
    ),
    Limit(
        "shear_rate",
        _sheared,
        lambda n: (
            f"the film is sheared {n:.3g} times faster than liquid.measured_to: what its viscosity is there, "
            "nobody has measured"
        ),
        most=1.0,
    ),
    Limit(
        "slow_creep",
        _creeping,
        lambda n: (
            f"the contact lasts {n:.3g} times 1/liquid.plateau_rate: it ends in a creep at the viscosity of that rate; "
            "lower the rate: what then lasts longer in proportion, a yield stress would hold as a stick"
        ),
        most=1.0,
    ),
)
LAW_RANGE = "law_range"
FLAGS: tuple[str, ...] = (*(limit.flag for limit in LIMITS), LAW_RANGE)
"""Words of the flags, in the order of their bits."""
NEEDS = ("restitution", "tangential_restitution", "rotation", "contact_time", "smallest_gap")
"""Results that the limits ask for, beside the outcome."""


def needs(scene: Scene) -> tuple[str, ...]:
    """Those that the limits of a scene ask for."""
    return NEEDS if _has_plateau(scene) else tuple(name for name in NEEDS if name != "contact_time")


def sentences(scene: Scene, values: Values) -> list[str]:
    """What of any of some collisions lies outside the model's range, a sentence each with the number farthest outside.

    Arguments:
        values: as for `flags`.
    """
    result = []
    with np.errstate(all="ignore"):
        for limit in LIMITS:
            numbers = np.atleast_1d(np.asarray(limit.number(scene, values), float))
            outside = numbers[limit.exceeded(numbers)]
            if outside.size:
                result.append(limit.says(float(outside.max() if math.isfinite(limit.most) else outside.min())))
    return [*result, *remarks(scene)]


def flags(scene: Scene, values: Values, size: int) -> np.ndarray:
    """A bit for each of `FLAGS` that a collision has exceeded, for arrays of quantities and results of one size.

    Arguments:
        scene: has the partner, the bridge and the laws; its numbers are those of `values`.
    """
    bits = np.zeros(size, dtype=np.int16)
    with np.errstate(all="ignore"):
        for bit, limit in enumerate(LIMITS):
            bits |= np.where(limit.exceeded(limit.number(scene, values)), 1 << bit, 0).astype(np.int16)
        for limit in law_limits(scene):
            outside = limit.exceeded(limit.number(scene, values))
            bits |= np.where(outside, 1 << FLAGS.index(LAW_RANGE), 0).astype(np.int16)
    return bits


def flag_attributes() -> dict[str, Any]:
    """CF attributes of a variable of flags."""
    return {
        "long_name": "where the collision leaves the model's range",
        "flag_masks": np.array([1 << bit for bit in range(len(FLAGS))], dtype=np.int16),
        "flag_meanings": " ".join(FLAGS),
    }


def flag_words(mask: int) -> str:
    """The names of the limits that are passed, as `film_reynolds fly_by`."""
    return " ".join(name for bit, name in enumerate(FLAGS) if mask >> bit & 1)


def counted(mask: np.ndarray) -> list[tuple[str, int]]:
    """How many collisions exceed each limit, in words: those that any has."""
    counts = [int(np.count_nonzero(mask & (1 << bit))) for bit in range(len(FLAGS))]
    return [(WORDS.get(flag, flag), count) for flag, count in zip(FLAGS, counts, strict=True) if count]


WORDS = {
    "film_reynolds": f"inertia of the liquid, Re > {_REYNOLDS:g}",
    "shear_rate": "faster shear than measured",
    "slow_creep": "creep below the plateau rate",
    "film_gap": f"thick film, x0/a > {_FILM_GAP:g}",
    "rupture_gap": f"wide gap at rupture, x_f/a > {_RUPTURE_GAP:g}",
    "bridge_liquid": "bridge larger than the coatings",
    "fly_by": "solids that pass each other",
    "wall_coupling": "spin beside the wall",
    "cavitating_film": "cavitating between unequal surfaces",
    "own_rupture": "own rupture of unequal spheres",
    "idle_friction": "friction without contact",
    LAW_RANGE: "range of the bridge law",
}
"""Flag -> the limit, or what lies beyond it, in a few words."""


# ---- the ranges of laws, which stand with the emitted laws (`VALIDITY`) as far as their sources give them


@lru_cache(maxsize=64)
def remarks(scene: Scene) -> tuple[str, ...]:
    """What of the scene lies outside the range its laws were made for, a sentence each."""
    values = si_values(scene, None, None)
    numbers = [(limit, float(limit.number(scene, values))) for limit in law_limits(scene)]
    named = dict(scene.given)["liquid.viscosity"]
    sources = liquid(str(named)).remarks if is_named(named) else ()
    return (*sources, *(limit.says(number) for limit, number in numbers if limit.exceeded(number)))


def law_limits(scene: Scene) -> list[Limit]:
    """The range of the scene's bridge law as limits; none where its source gives no range."""
    if scene.bridge is None:
        return []
    law = law_module(scene.package, "bridge", scene.bridge.law)
    ranges: dict[str, tuple[float | None, float | None]] = getattr(law, "VALIDITY", {})
    limits = []
    for name, (least, most) in ranges.items():
        low, high = -math.inf if least is None else least, math.inf if most is None else most

        def says(number: float, name: str = name, low: float = low, high: float = high) -> str:
            side, bound = ("below", low) if number < low else ("above", high)
            value, limit = (
                f"{math.degrees(quantity):.4g} deg" if name == "contact_angle" else f"{quantity:.4g}"
                for quantity in (number, bound)
            )
            bridge = scene.bridge.law if scene.bridge else ""
            where = f"outside the range of the law {bridge} ({law.VALIDITY_SOURCE})"
            return f"{_ENTRIES[name]} = {value} is {side} {limit}, {where}"

        limits.append(Limit(LAW_RANGE, _LAW_NUMBERS[name], says, low, high))
    return limits


_ENTRIES = {"volume": "bridge.volume", "contact_angle": "bridge.contact_angle", "separation": "x_f/R"}
_LAW_NUMBERS: dict[str, Callable[[Scene, Values], Any]] = {
    "volume": lambda _, values: values["volume"],
    "contact_angle": lambda _, values: values["contact_angle"],
    "separation": lambda scene, values: _rupture_gap(scene, values) / 2,
}


def warn(scene: Scene, stacklevel: int = 3) -> tuple[str, ...]:
    """Warn of every law used outside its range (ModelWarning), and return the sentences."""
    result = remarks(scene)
    for sentence in result:
        warnings.warn(sentence, ModelWarning, stacklevel=stacklevel)
    return result
