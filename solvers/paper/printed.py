"""Numbers and findings printed in the paper, with quotes. Nothing here is computed.

Donahue, Davis, Kantak and Hrenya, Phys. Rev. E 86, 021303 (2012), DOI 10.1103/PhysRevE.86.021303.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

CITATION = "Donahue, Davis, Kantak and Hrenya, Phys. Rev. E 86, 021303 (2012), DOI 10.1103/PhysRevE.86.021303"


@dataclass(frozen=True)
class Printed:
    """A number or a finding of the paper.

    Arguments:
        key: name in this package.
        what: description.
        text: the printed number, or a short form of the finding.
        place: place in the paper.
        quote: the quoted sentence.
    """

    key: str
    what: str
    text: str
    place: str
    quote: str

    @property
    def value(self) -> float:
        """The number; ValueError for a finding in words."""
        return float(self.text)

    @property
    def digits(self) -> int:
        """Number of digits printed after the decimal point."""
        return len(self.text.partition(".")[2])


@dataclass(frozen=True)
class Shot:
    """A collision of Fig. 1: its panel, Stokes number, ms between frames and outcome."""

    panel: str
    stokes: float
    interval: float
    outcome: str


_FACTORS = "doubling the values of V, x0, mu, sigma, m and a leads to a change in Ce* by factors of ..."
_FIGURE_1 = "Top-view of collisions that (a) stick (S), (b) stick-rotate-separate (SRS), and (c) bounce (B)"

_TABLE = (
    Printed("fig1a", "Fig. 1a, St 1.0 at 45°", "stick", "caption of Fig. 1", _FIGURE_1),
    Printed("fig1b", "Fig. 1b, St 1.3 at 45°", "stick-rotate-separate", "caption of Fig. 1", _FIGURE_1),
    Printed("fig1c", "Fig. 1c, St 1.5 at 45°", "bounce", "caption of Fig. 1", _FIGURE_1),
    Printed("diameter", "diameter of the steel spheres, mm", "25.4", "caption of Fig. 1", "25.4 mm diameter"),
    Printed(
        "stokes_3",
        "St* at θ₀ = 0, Fig. 3",
        "1.4",
        "text on Fig. 3",
        "transition from stick to bounce (St*) is equal to 1.4",
    ),
    Printed(
        "angle_3",
        "θ₀ up to which St* separates sticking from not, Fig. 3 (°)",
        "50",
        "text on Fig. 3",
        "demarcates the transition between agglomeration and de-agglomeration for small impact angles (θ₀ ~< 50°)",
    ),
    Printed("stokes_4", "St* at θ₀ = 0, Fig. 4", "0.11", "caption of Fig. 4", "Ce* = 4.2 and St* = 0.11"),
    Printed("centrifugal", "Ce* on the S/SRS boundary, Fig. 4", "4.2", "caption of Fig. 4", "Ce* = 4.2 and St* = 0.11"),
    Printed(
        "dry",
        "outcomes that stick without F_c, inset of Fig. 4a",
        "θ₀ = 0 only",
        "caption of Fig. 4",
        "predictions without capillary forces, where only normal collisions agglomerate",
    ),
    Printed(
        "two_at_15",
        "outcomes at 15°, Fig. 4b",
        "stick, bounce",
        "text on Fig. 4b",
        "only stick and bounce are observed",
    ),
    Printed(
        "same_at_15",
        "e_n at 15° against 0°, Fig. 4b",
        "almost the same",
        "text on Fig. 4b",
        "almost indistinguishable from normal collisions",
    ),
    Printed("above_one", "largest e_n, Fig. 4b", "> 1 in some regions", "text on Fig. 4b", "e_w,n > 1 in some regions"),
    Printed("factor_volume", "Ce* when V is doubled", "1.0", "text on Ce*", _FACTORS),
    Printed("factor_film", "Ce* when x₀ is doubled", "0.79", "text on Ce*", _FACTORS),
    Printed("factor_viscosity", "Ce* when μ is doubled", "0.99", "text on Ce*", _FACTORS),
    Printed("factor_tension", "Ce* when σ is doubled", "1.01", "text on Ce*", _FACTORS),
    Printed("factor_mass", "Ce* when m is doubled", "1.01", "text on Ce*", _FACTORS),
    Printed("factor_radius", "Ce* when a is doubled", "1.13", "text on Ce*", _FACTORS),
)

PRINTED: dict[str, Printed] = {entry.key: entry for entry in _TABLE}

SHOTS = (
    Shot("a", 1.0, 79.0, PRINTED["fig1a"].text),
    Shot("b", 1.3, 61.0, PRINTED["fig1b"].text),
    Shot("c", 1.5, 49.0, PRINTED["fig1c"].text),
)
SHOT_ANGLE = math.radians(45)  # caption of Fig. 1

CURVES = tuple(math.radians(degrees) for degrees in (0, 15, 30, 45, 60, 75))
"""Impact angles of Fig. 4b, bottom to top (caption of Fig. 4)."""

NOT_COMPARED = (
    ("Re < 0.04 in the experiments", "needs the oil's density, printed nowhere"),
    ("Ca > 1500 in the experiments", "needs the oil's surface tension, printed nowhere"),
    ("the symbols of Fig. 3", "measured points are in the picture alone; only the theory's lines are drawn here"),
)
