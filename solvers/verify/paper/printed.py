"""Numbers and findings printed in the paper, with quotes. Nothing here is computed."""

import math
from dataclasses import dataclass

CITATION = "Donahue, Davis, Kantak and Hrenya, Phys. Rev. E 86, 021303 (2012), DOI 10.1103/PhysRevE.86.021303"


@dataclass(frozen=True)
class Printed:
    """A number, or a short form of a finding, of the paper: what it is of, its place, and the sentence quoted."""

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
CURVES = tuple(math.radians(degrees) for degrees in (0, 15, 30, 45, 60, 75))
"""Impact angles of Fig. 4b, bottom to top (caption of Fig. 4)."""
DOUBLED = {
    "V": ("bridge.volume", "1.0"), "x₀": ("liquid.film_thickness", "0.79"), "μ": ("liquid.viscosity", "0.99"),
    "σ": ("bridge.surface_tension", "1.01"), "m": ("particles.reduced_mass", "1.01"),
    "a": ("particles.reduced_radius", "1.13"),
}  # fmt: skip
"""Symbol -> entry that is doubled, and the factor of Ce*."""

_CAPTION_1, _CAPTION_4 = (f"caption of Fig. {number}" for number in (1, 4))
_ON_3, _ON_4B, _ON_CE = (f"text on {what}" for what in ("Fig. 3", "Fig. 4b", "Ce*"))
_SHOTS = "Top-view of collisions that (a) stick (S), (b) stick-rotate-separate (SRS), and (c) bounce (B)"
_SMALL = "demarcates the transition between agglomeration and de-agglomeration for small impact angles (θ₀ ~< 50°)"
_CRITICAL = "Ce* = 4.2 and St* = 0.11"
_DRY = "predictions without capillary forces, where only normal collisions agglomerate"
_FACTORS = "doubling the values of V, x0, mu, sigma, m and a leads to a change in Ce* by factors of ..."

PRINTED = {
    f"fig1{shot.panel}": Printed(f"Fig. 1{shot.panel}, St {shot.stokes} at 45°", shot.outcome, _CAPTION_1, _SHOTS)
    for shot in SHOTS
}
PRINTED |= {
    "diameter": Printed("diameter of the steel spheres, mm", "25.4", _CAPTION_1, "25.4 mm diameter"),
    "stokes_3": Printed("St* at θ₀ = 0, Fig. 3", "1.4", _ON_3, "transition from stick to bounce (St*) is equal to 1.4"),
    "angle_3": Printed("θ₀ up to which St* separates sticking from not, Fig. 3 (°)", "50", _ON_3, _SMALL),
    "stokes_4": Printed("St* at θ₀ = 0, Fig. 4", "0.11", _CAPTION_4, _CRITICAL),
    "centrifugal": Printed("Ce* on the S/SRS boundary, Fig. 4", "4.2", _CAPTION_4, _CRITICAL),
    "dry": Printed("outcomes that stick without F_c, inset of Fig. 4a", "θ₀ = 0 only", _CAPTION_4, _DRY),
    "two_at_15": Printed("outcomes at 15°, Fig. 4b", "stick, bounce", _ON_4B, "only stick and bounce are observed"),
    "same_at_15": Printed(
        "e_n at 15° against 0°, Fig. 4b", "almost the same", _ON_4B, "almost indistinguishable from normal collisions"
    ),
    "above_one": Printed("largest e_n, Fig. 4b", "> 1 in some regions", _ON_4B, "e_w,n > 1 in some regions"),
}
PRINTED |= {
    entry: Printed(f"Ce* when {symbol} is doubled", factor, _ON_CE, _FACTORS)
    for symbol, (entry, factor) in DOUBLED.items()
}

NOT_COMPARED = (
    ("Re < 0.04 in the experiments", "needs the oil's density, printed nowhere"),
    ("Ca > 1500 in the experiments", "needs the oil's surface tension, printed nowhere"),
    ("the symbols of Fig. 3", "measured points are in the picture alone; only the theory's lines are drawn here"),
)
