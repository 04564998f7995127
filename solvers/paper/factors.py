"""Ce* when one quantity is doubled, all others as they are, with the glass criterion out of reach."""

from __future__ import annotations

import math
from pathlib import Path

from ..scene import Scene
from .desk import Desk
from .fig4a import centrifugal
from .parts import Comparison, Part, Table, degrees, number
from .printed import CURVES, PRINTED
from .variants import BRIDGED, described, variant

DOUBLED = {
    "factor_volume": "bridge.volume",
    "factor_film": "liquid.film_thickness",
    "factor_viscosity": "liquid.viscosity",
    "factor_tension": "bridge.surface_tension",
    "factor_mass": "particles.reduced_mass",
    "factor_radius": "particles.reduced_radius",
}
ARMS = ("midgap", "surface")
_AT = math.radians(45)
_ANGLES = CURVES[2:]
_OUT_OF_REACH = 1e9  # times the preset's glass-transition pressure


def make(desk: Desk, folder: Path) -> Part:  # noqa: ARG001 # every part is made alike; this one has no picture
    """Trace the S/SRS boundary of every doubled scene."""
    desk.say("factors: Ce* with one quantity doubled")
    arms = {arm: _base(arm) for arm in ARMS}
    jobs = [
        (scene, _ANGLES)
        for base in arms.values()
        for scene in (base, *(_doubled(base, entry) for entry in DOUBLED.values()))
    ]
    traced = iter([[centrifugal(line) for line in lines] for lines in desk.many(jobs)])
    plain: dict[str, list[float]] = {}
    factors: dict[str, dict[str, list[float]]] = {}
    for arm in arms:
        plain[arm] = next(traced)
        factors[arm] = {key: [new / old for new, old in zip(next(traced), plain[arm])] for key in DOUBLED}
    place = _ANGLES.index(_AT)
    rows = [
        Comparison(
            key,
            factors["midgap"][key][place],
            described(arms["midgap"]) + ", p_gt out of reach",
            f"at {degrees(_AT)}; the paper does not say at which angle. " + _range(key, factors),
            beside=f"(surface arm: {number(factors['surface'][key][place])})",
        )
        for key in DOUBLED
    ]
    return Part(
        "Ce* with one quantity doubled",
        "Each quantity alone is doubled; a doubled radius leaves m, x₀ and V/R³. The glass criterion is put out of "
        f"reach, since with the preset's p_gt a doubled radius turns S directly into B at {degrees(_AT)}. Ce* itself: "
        + "; ".join(f"{arm} arm {number(values[place])}" for arm, values in plain.items())
        + ".",
        comparisons=rows,
        tables=[_table(arm, found) for arm, found in factors.items()],
        scenes=(BRIDGED,),
    )


def _base(arm: str) -> Scene:
    scene = variant(BRIDGED, {"model.arm": arm})
    pressure = _OUT_OF_REACH * scene.liquid.glass_transition_pressure
    return scene.with_entries({"liquid.glass_transition_pressure": pressure})


def _doubled(scene: Scene, entry: str) -> Scene:
    return scene.with_entries({entry: 2 * float(scene.entries[entry])})


def _range(key: str, factors: dict[str, dict[str, list[float]]]) -> str:
    everything = [value for found in factors.values() for value in found[key]]
    return f"Over the angles and arms below: {number(min(everything))} to {number(max(everything))}"


def _table(arm: str, found: dict[str, list[float]]) -> Table:
    rows = [
        [PRINTED[key].what, PRINTED[key].text, *(f"{value:.3f}" for value in values)] for key, values in found.items()
    ]
    return Table(f"Factors of Ce*, {arm} arm", ["", "paper", *(f"at {degrees(angle)}" for angle in _ANGLES)], rows)
