"""Factors of Ce* when one quantity is doubled and all others are fixed, with the glass criterion disabled."""

import math
from pathlib import Path

import numpy as np

from ..formatting.document import Table
from ..formatting.style import LETTERS
from ..scene.scene import Scene
from ..sensitivity.boundaries import moving
from .boundary_cache import PRESSURE, BoundaryCache, Line, change_at, outcomes, printed_pressure
from .fig4a import centrifugal, near_printed
from .parts import Comparison, Part, degrees, number
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


def make(cache: BoundaryCache, folder: Path) -> Part:  # noqa: ARG001 # every part is made alike; this one has no picture
    """Compute the part: the S/SRS boundary of every scene with a doubled quantity."""
    cache.say("factors: Ce* with one quantity doubled")
    angles, place = cache.detail.critical, cache.detail.critical.index(_AT)
    bases = [variant(BRIDGED, {"model.arm": arm}) for arm in ARMS]
    bases = [base.with_entries({PRESSURE: _OUT_OF_REACH * printed_pressure(base)}) for base in bases]
    scenes = [[base, *(_doubled(base, entry) for entry in DOUBLED.values())] for base in bases]
    lines = iter(cache.many([near_printed(scene, angle) for of_arm in scenes for scene in of_arm for angle in angles]))
    traced = [[[next(lines)[0] for _ in angles] for _ in of_arm] for of_arm in scenes]
    critical = np.array([[[centrifugal(line) for line in row] for row in of_arm] for of_arm in traced])
    factors = critical[:, 1:] / critical[:, :1]  # by lever arm, quantity and angle
    [in_reach] = cache.lines(_doubled(variant(BRIDGED, {}), DOUBLED["factor_radius"]), (_AT,))
    through = ", ".join(LETTERS[outcome] for outcome in outcomes(in_reach))
    printed = np.array([PRINTED[key].value for key in DOUBLED])
    apart = ((factors - printed[:, None]) ** 2).sum(axis=1)
    arm, angle = np.unravel_index(int(np.argmin(apart)), apart.shape)
    rows = [
        Comparison(
            key,
            float(factors[0, k, place]),
            described(bases[0]) + ", p_gt out of reach",
            f"at {degrees(_AT)}. Over the angles and arms below: "
            f"{number(factors[:, k].min())} to {number(factors[:, k].max())}",
            beside=f"(surface arm: {number(factors[1, k, place])})",
        )
        for k, key in enumerate(DOUBLED)
    ]
    head = ["", "paper", *(f"at {degrees(angle)}" for angle in angles)]
    names = [[PRINTED[key].what, PRINTED[key].text] for key in DOUBLED]
    tables = [
        Table(
            f"Factors of Ce*, {arm} arm",
            head,
            [[*name, *(f"{value:.3f}" for value in row)] for name, row in zip(names, of_arm)],
        )
        for arm, of_arm in zip(ARMS, factors)
    ]
    return Part(
        "Ce* with one quantity doubled",
        "Each quantity alone is doubled; a doubled radius leaves m, x₀ and V/R³. The glass criterion is put out of "
        f"reach: with the preset's p_gt a doubled radius goes through {through} at {degrees(_AT)}. Ce* itself: "
        + "; ".join(f"{arm} arm {number(of_arm[0, place])}" for arm, of_arm in zip(ARMS, critical))
        + ". The paper does not say at which angle; nearest to its six numbers is the "
        f"{ARMS[arm]} arm at {degrees(angles[angle])}.",
        comparisons=rows,
        tables=[*tables, _predicted(bases, [of_arm[0][place] for of_arm in traced], factors[:, :, place], names)],
        scenes=(BRIDGED,),
    )


def _doubled(scene: Scene, entry: str) -> Scene:
    return scene.with_entries({entry: 2 * float(scene.entries[entry])})


def _predicted(bases: list[Scene], lines: list[Line], factors: np.ndarray, names: list[list[str]]) -> Table:
    """Table of factors predicted by the exact elasticities of Ce* at 45 degrees, and of computed factors."""
    rows, head = [[*name] for name in names], ["", "paper"]
    for arm, scene, line, doubled in zip(ARMS, bases, lines, factors):
        elasticities = moving(scene, _AT, change_at(line, "stick"), tuple(DOUBLED.values())).elasticity["centrifugal"]
        for row, entry, factor in zip(rows, DOUBLED.values(), doubled):
            elasticity = float(elasticities[entry] or 0.0)
            row += [f"{elasticity:+.4f}", f"{2**elasticity:.3f}", f"{factor:.3f}"]
        head += [f"d ln Ce*/d ln p, {arm}", "2^it", "doubled"]
    return Table(
        f"Exact elasticities of Ce* at {degrees(_AT)}, and the factors they predict beside those of the doubling: "
        "a doubling is a large step, along which the elasticity itself changes",
        head,
        rows,
    )
