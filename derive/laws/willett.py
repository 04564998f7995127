"""Bridge laws of Willett et al.: the full fit to solutions of the Young-Laplace equation, and their closed form."""

import sympy as sp

from ..user import Formula, Rational, Reference, V, cos, exp, h, law, let, log, phi, pi, sqrt

WILLETT = Reference(
    "willett2000capillary", ("Willett, C. D.", "Adams, M. J.", "Johnson, S. A.", "Seville, J. P. K."),
    "Capillary bridges between two spherical bodies",
    "Langmuir", "Langmuir", "16", "9396–9405", 2000, "10.1021/la000657y",
)  # fmt: skip
_RUPTURE = Formula((1 + phi / 2) * (V ** Rational(1, 3) + V ** Rational(2, 3) / 10), source=WILLETT)
_ANGLES = (None, 5 * pi / 18)

# Coefficients of phi^0, phi^1, phi^2 in each coefficient of the polynomials f1..f4 in ln V
_FIT = {
    "f1": "-0.44507 0.050832 -1.1466, -0.1119 -0.000411 -0.1490, -0.012101 -0.0036456 -0.01255, "
    "-0.0005 -0.0003505 -0.00029076",
    "f2": "1.9222 -0.57473 -1.2918, -0.0668 -0.1201 -0.22574, -0.0013375 -0.0068988 -0.01137",
    "f3": "1.268 -0.01396 -0.23566, 0.198 0.092 -0.06418, 0.02232 0.02238 -0.009853, 0.0008585 0.001318 -0.00053",
    "f4": "-0.010703 0.073776 -0.34742, 0.03345 0.04543 -0.09056, 0.0018574 0.004456 -0.006257",
}
log_volume = let("log_volume", log(V))
log_scaled = let("log_scaled_gap", log(h / (2 * sqrt(V))))


def _polynomial(rows: str) -> sp.Expr:
    fits = [[Rational(number) for number in row.split()] for row in rows.split(",")]
    return sp.Add(*((p + q * phi + r * phi**2) * log_volume**k for k, (p, q, r) in enumerate(fits)))


f1, f2, f3, f4 = (let(name, _polynomial(rows)) for name, rows in _FIT.items())
law(
    "bridge", "willett", source=WILLETT, validity={"volume": (None, Rational("0.1")), "contact_angle": _ANGLES},
    meaning="fit to Young-Laplace solutions over h/(2 sqrt V), full form",
    force=2 * exp(f1 - f2 * exp(f3 * log_scaled + f4 * log_scaled**2)), rupture_distance=_RUPTURE,
)  # fmt: skip

scaled = let("scaled_gap", h / sqrt(V))
law(
    "bridge", "willett-simple", source=WILLETT, falls=True,
    validity={"volume": (None, Rational("0.001")), "contact_angle": _ANGLES},
    meaning="closed-form approximation of the full fit, for small bridges",
    force=2 * cos(phi) / (1 + 1.05 * scaled + 2.5 * scaled**2), rupture_distance=_RUPTURE,
)  # fmt: skip
