"""Factors of Ce* when one quantity is doubled and all others are fixed, with the glass criterion disabled."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from ..formatting.style import LETTERS
from ..scene.scene import Scene
from ..sensitivity.boundaries import moving
from .desk import Desk, Line, outcomes, printed_pressure
from .fig4a import centrifugal, near_printed
from .parts import Comparison, Part, Table, degrees, number
from .printed import PRINTED
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
_OUT_OF_REACH = 1e9  # factor on the preset's glass-transition pressure


def make(desk: Desk, folder: Path) -> Part:  # noqa: ARG001 # every part is made alike; this one has no picture
    """Compute the part: the S/SRS boundary of every scene with a doubled quantity."""
    desk.say("factors: Ce* with one quantity doubled")
    angles = desk.detail.critical
    arms = {arm: _base(arm) for arm in ARMS}
    scenes = {(arm, key): _doubled(base, entry) for arm, base in arms.items() for key, entry in DOUBLED.items()}
    scenes |= {(arm, ""): base for arm, base in arms.items()}
    jobs = [near_printed(scene, angle) for scene in scenes.values() for angle in angles]
    followed = [line for [line] in desk.many(jobs)]
    traced = [centrifugal(line) for line in followed]
    lines = {name: followed[k * len(angles) : (k + 1) * len(angles)] for k, name in enumerate(scenes)}
    found = {name: traced[k * len(angles) : (k + 1) * len(angles)] for k, name in enumerate(scenes)}
    plain = {arm: found[arm, ""] for arm in arms}
    factors = {
        arm: {key: [new / old for new, old in zip(found[arm, key], plain[arm])] for key in DOUBLED} for arm in arms
    }
    over = {key: [value for ratios in factors.values() for value in ratios[key]] for key in DOUBLED}
    place = angles.index(_AT)
    [in_reach] = desk.lines(_doubled(variant(BRIDGED, {}), DOUBLED["factor_radius"]), (_AT,))
    through = ", ".join(LETTERS[outcome] for outcome in outcomes(in_reach))
    rows = [
        Comparison(
            key,
            factors["midgap"][key][place],
            described(arms["midgap"]) + ", p_gt out of reach",
            f"at {degrees(_AT)}. Over the angles and arms below: {number(min(over[key]))} to {number(max(over[key]))}",
            beside=f"(surface arm: {number(factors['surface'][key][place])})",
        )
        for key in DOUBLED
    ]
    return Part(
        "Ce* with one quantity doubled",
        "Each quantity alone is doubled; a doubled radius leaves m, x₀ and V/R³. The glass criterion is put out of "
        f"reach: with the preset's p_gt a doubled radius goes through {through} at {degrees(_AT)}. Ce* itself: "
        + "; ".join(f"{arm} arm {number(values[place])}" for arm, values in plain.items())
        + f". The paper does not say at which angle; nearest to its six numbers is the {_nearest(angles, factors)}.",
        comparisons=rows,
        tables=[
            *(_table(arm, angles, found) for arm, found in factors.items()),
            _predicted(arms, lines, factors, place),
        ],
        scenes=(BRIDGED,),
    )


def _base(arm: str) -> Scene:
    scene = variant(BRIDGED, {"model.arm": arm})
    pressure = _OUT_OF_REACH * printed_pressure(scene)
    return scene.with_entries({"liquid.glass_transition_pressure": pressure})


def _doubled(scene: Scene, entry: str) -> Scene:
    return scene.with_entries({entry: 2 * float(scene.entries[entry])})


def _nearest(angles: Sequence[float], factors: dict[str, dict[str, list[float]]]) -> str:
    """Lever arm and angle whose factors are nearest to the printed ones, by the sum of squared differences."""
    apart = {
        (arm, angle): sum((found[key][k] - PRINTED[key].value) ** 2 for key in DOUBLED)
        for arm, found in factors.items()
        for k, angle in enumerate(angles)
    }
    arm, angle = min(apart, key=lambda name: apart[name])
    return f"{arm} arm at {degrees(angle)}"


def _table(arm: str, angles: Sequence[float], found: dict[str, list[float]]) -> Table:
    rows = [
        [PRINTED[key].what, PRINTED[key].text, *(f"{value:.3f}" for value in values)] for key, values in found.items()
    ]
    return Table(f"Factors of Ce*, {arm} arm", ["", "paper", *(f"at {degrees(angle)}" for angle in angles)], rows)


def _predicted(
    arms: dict[str, Scene],
    lines: dict[tuple[str, str], list[Line]],
    factors: dict[str, dict[str, list[float]]],
    place: int,
) -> Table:
    """Table of factors predicted by the exact elasticities of Ce* at 45 degrees, and of computed factors."""
    columns = {}
    for arm, scene in arms.items():
        change = next(one for one in lines[arm, ""][place] if one.before == "stick")
        found = moving(scene, _AT, change, tuple(DOUBLED.values())).elasticity["centrifugal"]
        columns[arm] = [float(found[entry] or 0.0) for entry in DOUBLED.values()]
    rows = []
    for k, key in enumerate(DOUBLED):
        row = [PRINTED[key].what, PRINTED[key].text]
        for arm, elasticities in columns.items():
            row += [f"{elasticities[k]:+.4f}", f"{2 ** elasticities[k]:.3f}", f"{factors[arm][key][place]:.3f}"]
        rows.append(row)
    head = ["", "paper", *(text for arm in columns for text in (f"d ln Ce*/d ln p, {arm}", "2^it", "doubled"))]
    return Table(
        f"Exact elasticities of Ce* at {degrees(_AT)}, and the factors they predict beside those of the doubling: "
        "a doubling is a large step, along which the elasticity itself changes",
        head,
        rows,
    )
