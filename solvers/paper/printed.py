"""Numbers and findings printed in the paper, with quotes. Nothing here is computed.

Donahue, Davis, Kantak and Hrenya, Phys. Rev. E 86, 021303 (2012), DOI 10.1103/PhysRevE.86.021303.
"""

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
        return len(self.text.partition(".")[2])


@dataclass(frozen=True)
class Shot:
    """A collision of Fig. 1: its panel, Stokes number, ms between frames and outcome."""

    panel: str
    stokes: float
    interval: float
    outcome: str


SHOTS = (Shot("a", 1.0, 79.0, "stick"), Shot("b", 1.3, 61.0, "stick-rotate-separate"), Shot("c", 1.5, 49.0, "bounce"))
SHOT_ANGLE = math.radians(45)  # caption of Fig. 1

_FACTORS = "doubling the values of V, x0, mu, sigma, m and a leads to a change in Ce* by factors of ..."
_FACTORS_OF = {
    "volume": ("V", "1.0"),
    "film": ("x₀", "0.79"),
    "viscosity": ("μ", "0.99"),
    "tension": ("σ", "1.01"),
    "mass": ("m", "1.01"),
    "radius": ("a", "1.13"),
}
_FIGURE_1 = "Top-view of collisions that (a) stick (S), (b) stick-rotate-separate (SRS), and (c) bounce (B)"
_STOKES_3 = "transition from stick to bounce (St*) is equal to 1.4"
_ANGLE_3 = "demarcates the transition between agglomeration and de-agglomeration for small impact angles (θ₀ ~< 50°)"
_CRITICAL_4 = "Ce* = 4.2 and St* = 0.11"
_DRY = "predictions without capillary forces, where only normal collisions agglomerate"
_AT_15 = "only stick and bounce are observed"
_SAME = "almost indistinguishable from normal collisions"
_CAPTIONS = tuple(f"caption of Fig. {number}" for number in (1, 4))
_TEXTS = tuple(f"text on {what}" for what in ("Fig. 3", "Fig. 4b", "Ce*"))

_TABLE = (
    *(
        Printed(
            f"fig1{shot.panel}", f"Fig. 1{shot.panel}, St {shot.stokes} at 45°", shot.outcome, _CAPTIONS[0], _FIGURE_1
        )
        for shot in SHOTS
    ),
    Printed("diameter", "diameter of the steel spheres, mm", "25.4", _CAPTIONS[0], "25.4 mm diameter"),
    Printed("stokes_3", "St* at θ₀ = 0, Fig. 3", "1.4", _TEXTS[0], _STOKES_3),
    Printed("angle_3", "θ₀ up to which St* separates sticking from not, Fig. 3 (°)", "50", _TEXTS[0], _ANGLE_3),
    Printed("stokes_4", "St* at θ₀ = 0, Fig. 4", "0.11", _CAPTIONS[1], _CRITICAL_4),
    Printed("centrifugal", "Ce* on the S/SRS boundary, Fig. 4", "4.2", _CAPTIONS[1], _CRITICAL_4),
    Printed("dry", "outcomes that stick without F_c, inset of Fig. 4a", "θ₀ = 0 only", _CAPTIONS[1], _DRY),
    Printed("two_at_15", "outcomes at 15°, Fig. 4b", "stick, bounce", _TEXTS[1], _AT_15),
    Printed("same_at_15", "e_n at 15° against 0°, Fig. 4b", "almost the same", _TEXTS[1], _SAME),
    Printed("above_one", "largest e_n, Fig. 4b", "> 1 in some regions", _TEXTS[1], "e_w,n > 1 in some regions"),
    *(
        Printed(f"factor_{name}", f"Ce* when {symbol} is doubled", factor, _TEXTS[2], _FACTORS)
        for name, (symbol, factor) in _FACTORS_OF.items()
    ),
)

PRINTED: dict[str, Printed] = {entry.key: entry for entry in _TABLE}

CURVES = tuple(math.radians(degrees) for degrees in (0, 15, 30, 45, 60, 75))
"""Impact angles of Fig. 4b, bottom to top (caption of Fig. 4)."""

NOT_COMPARED = (
    ("Re < 0.04 in the experiments", "needs the oil's density, printed nowhere"),
    ("Ca > 1500 in the experiments", "needs the oil's surface tension, printed nowhere"),
    ("the symbols of Fig. 3", "measured points are in the picture alone; only the theory's lines are drawn here"),
)
