"""Liquid-bridge laws: capillary attraction over pi R sigma as a function of the gap h = x/R, V = volume/R^3 and phi.

All are published fits at constant volume (nothing to derive); natural logarithms unless the name says otherwise. A
doublet separates at the rupture distance of the bridge (common, or a law's own), or without one at the film's edge.
"""

from typing import Any

import sympy as sp

from ...vocabulary.quantities import R, x0
from ...vocabulary.quantities import contact_angle as phi
from ...vocabulary.quantities import volume as V
from .base import Definition, Law, LawFunction, Validity
from .references import DERJAGUIN, LAMBERT, LIAN, MIKAMI, RABINOVICH, SOULIE, WILLETT, Reference

h = sp.Symbol("gap_over_radius", positive=True)
_n = sp.Rational  # of text: the exact rational of a printed decimal
_THIRD = _n(1, 3)
_LIAN = V**_THIRD * (1 + phi / 2)
COMMON = (LIAN,)  # publication of the rupture distance, unless a law has its own

# Rupture distances over R published with a force law: distance, publication and a remark, by author
_OWN: dict[str, tuple[sp.Expr, Reference, str]] = {
    "willett": ((1 + phi / 2) * (V**_THIRD + V ** (2 * _THIRD) / 10), WILLETT, ""),
    "mikami": ((_n("0.62") * phi + _n("0.99")) * V ** _n("0.34"), MIKAMI, ""),
    "lian": (_LIAN, LIAN, ", which Soulie et al. (2006) use"),
}


def rupture_distance(bridge: bool) -> sp.Expr:
    """x_f = R V^(1/3) (1 + phi/2) with a bridge (Lian, Thornton & Adams 1993), x0 without one."""
    return R * _LIAN if bridge else x0


def _law(
    name: str,
    meaning: str,
    published: Reference,
    result: sp.Expr,
    definitions: tuple[Definition, ...] = (),
    rupture: str = "",
    remark: str = "",
    falls: bool = True,
    **known: Any,
) -> Law:
    """A law; `rupture` is the author of its own rupture distance, `known` what is known of its validity."""
    doc = "Capillary attraction over pi R sigma."
    functions = [LawFunction("force", (h, V, phi), result, doc, definitions, falls=falls)]
    if rupture:
        distance, source, beside = _OWN[rupture]
        doc = f"Rupture distance over R that goes with this law.\n\nSource: {source.short}{beside}."
        functions.append(LawFunction("rupture_distance", (V, phi), distance, doc, references=(source,)))
    return Law("bridge", name, meaning, published.short + remark, tuple(functions), references=(published,), **known)


def _exponential(
    name: str,
    meaning: str,
    published: Reference,
    fit: tuple[str, str, str],
    log: sp.Expr,
    rupture: str,
    remark: str = "",
) -> Law:
    """Mikami's form exp(A h + B) + C; B and C are linear in ln V with the fitted slope, offset and tail."""
    log_volume, A, B, C = sp.symbols("log_volume decay offset tail", real=True)
    slope, offset, tail = map(_n, fit)
    definitions = (
        (log_volume, log),
        (A, _n("-1.1") * V ** _n("-0.53")),
        (B, (slope * log_volume - _n("0.96")) * phi**2 + offset * log_volume + _n("0.48")),
        (C, tail * log_volume + _n("0.078")),
    )
    return _law(name, meaning, published, sp.exp(A * h + B) + C, definitions, rupture, remark)


# Coefficients of phi^0, phi^1, phi^2 in each coefficient of the polynomials f1..f4 of Willett et al. in ln V
_WILLETT = {
    "f1": "-0.44507 0.050832 -1.1466, -0.1119 -0.000411 -0.1490, -0.012101 -0.0036456 -0.01255, "
    "-0.0005 -0.0003505 -0.00029076",
    "f2": "1.9222 -0.57473 -1.2918, -0.0668 -0.1201 -0.22574, -0.0013375 -0.0068988 -0.01137",
    "f3": "1.268 -0.01396 -0.23566, 0.198 0.092 -0.06418, 0.02232 0.02238 -0.009853, 0.0008585 0.001318 -0.00053",
    "f4": "-0.010703 0.073776 -0.34742, 0.03345 0.04543 -0.09056, 0.0018574 0.004456 -0.006257",
}


def _willett() -> Law:
    """The full fit of Willett et al. (2000): f1..f4 are polynomials in ln V with coefficients quadratic in phi."""
    log_volume, log_scaled = sp.symbols("log_volume log_scaled_gap", real=True)
    definitions: list[Definition] = [(log_volume, sp.log(V)), (log_scaled, sp.log(h / (2 * sp.sqrt(V))))]
    for name, rows in _WILLETT.items():
        fits = [[_n(number) for number in row.split()] for row in rows.split(",")]
        terms = ((p + q * phi + r * phi**2) * log_volume**k for k, (p, q, r) in enumerate(fits))
        definitions.append((sp.Symbol(name, real=True), sp.Add(*terms)))
    f1, f2, f3, f4 = (symbol for symbol, _ in definitions[2:])
    result = 2 * sp.exp(f1 - f2 * sp.exp(f3 * log_scaled + f4 * log_scaled**2))
    meaning = "fit to Young-Laplace solutions over h/(2 sqrt V), full form"
    return _law(
        "willett", meaning, WILLETT, result, tuple(definitions), "willett", falls=False, validity=_fitted_up_to("0.1")
    )


def _fitted_up_to(largest: str) -> Validity:
    """The fitted range of Willett et al.: bridge volume up to a bound, contact angles up to 50 deg."""
    return Validity(WILLETT.short, volume=(None, _n(largest)), contact_angle=(None, 5 * sp.pi / 18))


_reach, _half_filling = sp.symbols("cylinder_reach half_filling_angle", positive=True)
_REACH: Definition = (_reach, sp.sqrt(h**2 + 2 * V / sp.pi))
_GORGE = 2 * sp.cos(phi) * (1 - h / _reach)
_TENSION = 2 * sp.sin(_half_filling) * sp.sin(_half_filling + phi)
_scaled = sp.Symbol("scaled_gap", positive=True)
_YOUNG_LAPLACE = "regression of Young-Laplace solutions"
_FIT = ("-0.34", "-0.019", "0.0042")

BRIDGES = (
    _exponential("mikami", _YOUNG_LAPLACE, MIKAMI, _FIT, sp.log(V), "mikami"),
    _exponential(
        "mikami-log10", "mikami with decimal logarithms in B and C (closer to Young-Laplace for phi > 0)", MIKAMI, _FIT,
        sp.log(V) / sp.log(10), "mikami", ", read with log10",
    ),
    _willett(),
    _law(
        "willett-simple", "closed-form approximation of the full fit, for small bridges", WILLETT,
        2 * sp.cos(phi) / (1 + _n("1.05") * _scaled + _n("2.5") * _scaled**2), ((_scaled, h / sp.sqrt(V)),), "willett",
        validity=_fitted_up_to("0.001"),
    ),
    _law(
        "rabinovich",
        "lambert's pressure term and the surface tension along the contact line at the half-filling angle",
        RABINOVICH, _GORGE + _TENSION, (_REACH, (_half_filling, sp.sqrt(_reach - h))), falls=False,
    ),
    _law("lambert", "energy approach with a cylindrical bridge, exact at constant volume", LAMBERT, _GORGE, (_REACH,)),
    _exponential(
        "soulie", "mikami's form refitted for polydisperse spheres", SOULIE, ("-0.148", "-0.0082", "0.0018"), sp.log(V),
        "lian",
    ),
    _law(
        "constant", "gap-independent upper bound, the force at contact", DERJAGUIN, 2 * sp.cos(phi),
        remark=": 2 cos(phi), the limit at h = 0",
    ),
)  # fmt: skip
