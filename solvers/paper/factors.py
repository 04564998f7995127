"""Factors of Ce* when one quantity is doubled and all others are fixed, with the glass criterion disabled."""

import math
from pathlib import Path

import numpy as np

from ..formatting.document import Table
from ..formatting.style import LETTERS
from ..scene.scene import Scene
from ..sensitivity.boundaries import moving
from .lines import BRIDGED, PRESSURE, Line, PaperLines, centrifugal, described, ends, outcomes, printed_pressure
from .printed import PRINTED
from .report import Comparison, Part, degrees, number

DOUBLED = {
    "factor_volume": "bridge.volume",
    "factor_film": "liquid.film_thickness",
    "factor_viscosity": "liquid.viscosity",
    "factor_tension": "bridge.surface_tension",
    "factor_mass": "particles.reduced_mass",
    "factor_radius": "particles.reduced_radius",
}
_AT = math.radians(45)
_OUT_OF_REACH = 1e9  # factor on the preset's glass-transition pressure


def make(lines: PaperLines, folder: Path) -> Part:  # noqa: ARG001 # every part is made alike; this one has no picture
    """Compute the part: the S/SRS boundary of every scene with a doubled quantity."""
    lines.say("factors: Ce* with one quantity doubled")
    angles, place = lines.critical, lines.critical.index(_AT)
    preset = Scene.load(BRIDGED)
    base = preset.with_entries({PRESSURE: _OUT_OF_REACH * printed_pressure(preset)})
    scenes = [base, *(_doubled(base, entry) for entry in DOUBLED.values())]
    traced = [lines.along(scene, angles, near=True) for scene in scenes]
    critical = np.array([[centrifugal(line) for line in row] for row in traced])
    factors = critical[1:] / critical[0]  # by quantity and angle
    [in_reach] = lines.along(_doubled(preset, DOUBLED["factor_radius"]), (_AT,))
    through = ", ".join(LETTERS[outcome] for outcome in outcomes(in_reach))
    printed = np.array([PRINTED[key].value for key in DOUBLED])
    angle = int(np.argmin(((factors - printed[:, None]) ** 2).sum(axis=0)))
    rows = [
        Comparison(
            key,
            float(factors[k, place]),
            described(base) + ", p_gt out of reach",
            f"at {degrees(_AT)}. Over the angles below: {number(factors[k].min())} to {number(factors[k].max())}",
        )
        for k, key in enumerate(DOUBLED)
    ]
    names = [[PRINTED[key].what, PRINTED[key].text] for key in DOUBLED]
    head = ["", "paper", *(f"at {degrees(angle)}" for angle in angles)]
    table = Table("Factors of Ce*", head, [[*name, *(f"{x:.3f}" for x in row)] for name, row in zip(names, factors)])
    return Part(
        "Ce* with one quantity doubled",
        "Each quantity alone is doubled; a doubled radius leaves m, x₀ and V/R³. The glass criterion is put out of "
        f"reach: with the preset's p_gt a doubled radius goes through {through} at {degrees(_AT)}. Ce* itself: "
        f"{number(critical[0, place])}. The paper does not say at which angle; nearest to its six numbers is "
        f"{degrees(angles[angle])}.",
        comparisons=rows,
        tables=[table, _predicted(base, traced[0][place], factors[:, place], names)],
        scenes=(BRIDGED,),
    )


def _doubled(scene: Scene, entry: str) -> Scene:
    return scene.with_entries({entry: 2 * float(scene.entries[entry])})


def _predicted(base: Scene, line: Line, factors: np.ndarray, names: list[list[str]]) -> Table:
    """Table of factors predicted by the exact elasticities of Ce* at 45 degrees, and of computed factors."""
    elasticities = moving(base, _AT, ends(line), tuple(DOUBLED.values())).elasticity["centrifugal"]
    rows = []
    for name, entry, factor in zip(names, DOUBLED.values(), factors):
        elasticity = float(elasticities[entry] or 0.0)
        rows.append([*name, f"{elasticity:+.4f}", f"{2**elasticity:.3f}", f"{factor:.3f}"])
    return Table(
        f"Exact elasticities of Ce* at {degrees(_AT)}, and the factors they predict beside those of the doubling: "
        "a doubling is a large step, along which the elasticity itself changes",
        ["", "paper", "d ln Ce*/d ln p", "2^it", "doubled"],
        rows,
    )
