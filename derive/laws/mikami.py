"""Bridge law of Mikami, Kamiya & Horio: the capillary attraction decays exponentially with the gap."""

import sympy as sp

from ..user import Formula, Reference, V, exp, h, law, let, log, phi

MIKAMI = Reference(
    "mikami1998numerical", ("Mikami, T.", "Kamiya, H.", "Horio, M."),
    "Numerical simulation of cohesive powder behavior in a fluidized bed",
    "Chemical Engineering Science", "Chem. Eng. Sci.", "53", "1927–1940", 1998, "10.1016/S0009-2509(97)00325-4",
)  # fmt: skip
RUPTURE = Formula((0.62 * phi + 0.99) * V**0.34, source=MIKAMI)


def exponential(logarithm: sp.Expr, slope: float, offset: float, tail: float) -> sp.Expr:
    """exp(A h + B) + C; B and C are linear in ln V with the fitted slope, offset and tail."""
    log_volume = let("log_volume", logarithm)
    decay = let("decay", -1.1 * V**-0.53)
    at_contact = let("offset", (slope * log_volume - 0.96) * phi**2 + offset * log_volume + 0.48)
    return exp(decay * h + at_contact) + let("tail", tail * log_volume + 0.078)


def fit(logarithm: sp.Expr) -> sp.Expr:
    """The published coefficients."""
    return exponential(logarithm, -0.34, -0.019, 0.0042)


law(
    "bridge", "mikami", source=MIKAMI, falls=True,
    meaning="regression of Young-Laplace solutions",
    force=fit(log(V)), rupture_distance=RUPTURE,
)  # fmt: skip
