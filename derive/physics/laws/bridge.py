"""Liquid-bridge laws: capillary attraction over pi R sigma as a function of the gap h = x/R, V = volume/R^3 and phi.

All are published fits at constant volume (nothing to derive); natural logarithms unless the name says otherwise. A
doublet separates at the rupture distance of the bridge (common, or a law's own), or without one at the film's edge.
"""

from __future__ import annotations

import sympy as sp

from ...vocabulary.quantities import R, contact_angle, volume, x0
from ...vocabulary.quantities import contact_angle as phi
from ...vocabulary.quantities import volume as V
from .base import Definition, Law, LawFunction, Validity
from .references import DERJAGUIN, LAMBERT, LIAN, MIKAMI, RABINOVICH, SOULIE, WILLETT, Reference

_THIRD = sp.Rational(1, 3)
_LIAN = volume**_THIRD * (1 + contact_angle / 2)


def rupture_distance(bridge: bool) -> sp.Expr:
    """x_f = R V^(1/3) (1 + phi/2) with a bridge (Lian, Thornton & Adams 1993), x0 without one."""
    return R * _LIAN if bridge else x0


COMMON = (LIAN,)  # publication of the rupture distance, unless a law has its own

# Rupture distances over R published with a force law: distance, publication and a remark, by author
_OWN: dict[str, tuple[sp.Expr, Reference, str]] = {
    "willett": (
        (1 + contact_angle / 2) * (volume**_THIRD + volume ** (2 * _THIRD) / 10),
        WILLETT,
        "",
    ),
    "mikami": (
        (sp.Rational("0.62") * contact_angle + sp.Rational("0.99")) * volume ** sp.Rational("0.34"),
        MIKAMI,
        "",
    ),
    "lian": (_LIAN, LIAN, ", which Soulie et al. (2006) use"),
}


def own_rupture(author: str) -> LawFunction:
    """The rupture distance over R published with `author`'s force law."""
    distance, published, remark = _OWN[author]
    doc = f"Rupture distance over R that goes with this law.\n\nSource: {published.short}{remark}."
    return LawFunction("rupture_distance", (volume, contact_angle), distance, doc, references=(published,))


h = sp.Symbol("gap_over_radius", positive=True)
_D = "Capillary attraction over pi R sigma."


def _n(text: str) -> sp.Rational:
    """The exact rational of a printed decimal."""
    return sp.Rational(text)


def _law(
    name: str,
    meaning: str,
    published: Reference,
    result: sp.Expr,
    definitions: tuple[Definition, ...] = (),
    rupture: str | None = None,
    validity: Validity | None = None,
    falls: bool = False,
    remark: str = "",
) -> Law:
    functions = [LawFunction("force", (h, V, phi), result, _D, definitions, falls=falls)]
    functions += [own_rupture(rupture)] if rupture else []
    return Law("bridge", name, meaning, published.short + remark, tuple(functions), validity, (published,))


def _exponential(
    name: str,
    meaning: str,
    published: Reference,
    slope: str,
    offset: str,
    tail: str,
    logarithm: sp.Expr,
    rupture: str,
    remark: str = "",
) -> Law:
    """Mikami's form exp(A h + B) + C; B and C are linear in ln V with the given coefficients."""
    log_volume, A, B, C = sp.symbols("log_volume decay offset tail", real=True)
    definitions = (
        (log_volume, logarithm),
        (A, _n("-1.1") * V ** _n("-0.53")),
        (B, (_n(slope) * log_volume - _n("0.96")) * phi**2 + _n(offset) * log_volume + _n("0.48")),
        (C, _n(tail) * log_volume + _n("0.078")),
    )
    return _law(name, meaning, published, sp.exp(A * h + B) + C, definitions, rupture, falls=True, remark=remark)


def _willett() -> Law:
    """The full fit of Willett et al. (2000): f1..f4 are polynomials in ln V with coefficients quadratic in phi."""
    table = {
        "f1": (
            ("-0.44507", "0.050832", "-1.1466"),
            ("-0.1119", "-0.000411", "-0.1490"),
            ("-0.012101", "-0.0036456", "-0.01255"),
            ("-0.0005", "-0.0003505", "-0.00029076"),
        ),
        "f2": (
            ("1.9222", "-0.57473", "-1.2918"),
            ("-0.0668", "-0.1201", "-0.22574"),
            ("-0.0013375", "-0.0068988", "-0.01137"),
        ),
        "f3": (
            ("1.268", "-0.01396", "-0.23566"),
            ("0.198", "0.092", "-0.06418"),
            ("0.02232", "0.02238", "-0.009853"),
            ("0.0008585", "0.001318", "-0.00053"),
        ),
        "f4": (
            ("-0.010703", "0.073776", "-0.34742"),
            ("0.03345", "0.04543", "-0.09056"),
            ("0.0018574", "0.004456", "-0.006257"),
        ),
    }
    log_volume, log_scaled = sp.symbols("log_volume log_scaled_gap", real=True)
    definitions: list[Definition] = [(log_volume, sp.log(V)), (log_scaled, sp.log(h / (2 * sp.sqrt(V))))]
    f = {}
    for name, rows in table.items():
        f[name] = sp.Symbol(name, real=True)
        in_phi = [_n(p) + _n(q) * phi + _n(r) * phi**2 for p, q, r in rows]
        definitions.append((f[name], sp.Add(*(c * log_volume**k for k, c in enumerate(in_phi)))))
    result = 2 * sp.exp(f["f1"] - f["f2"] * sp.exp(f["f3"] * log_scaled + f["f4"] * log_scaled**2))
    return _law(
        "willett",
        "fit to Young-Laplace solutions over h/(2 sqrt V), full form",
        WILLETT,
        result,
        tuple(definitions),
        rupture="willett",
        validity=_fitted_up_to("0.1"),
    )


def _fitted_up_to(largest: str) -> Validity:
    """The fitted range of Willett et al.: bridge volume up to a bound, contact angles up to 50 deg."""
    return Validity(
        source=WILLETT.short,
        volume=(None, _n(largest)),
        contact_angle=(None, 5 * sp.pi / 18),
    )


def _lambert_parts() -> tuple[sp.Symbol, Definition, sp.Expr]:
    s = sp.Symbol("cylinder_reach", positive=True)
    return s, (s, sp.sqrt(h**2 + 2 * V / sp.pi)), 2 * sp.cos(phi) * (1 - h / s)


def _rabinovich() -> Law:
    s, reach, gorge = _lambert_parts()
    half_filling = sp.Symbol("half_filling_angle", positive=True)
    tension = 2 * sp.sin(half_filling) * sp.sin(half_filling + phi)
    return _law(
        "rabinovich",
        "lambert's pressure term and the surface tension along the contact line at the half-filling angle",
        RABINOVICH,
        gorge + tension,
        (reach, (half_filling, sp.sqrt(s - h))),
    )


def _lambert() -> Law:
    _, reach, gorge = _lambert_parts()
    return _law(
        "lambert",
        "energy approach with a cylindrical bridge, exact at constant volume",
        LAMBERT,
        gorge,
        (reach,),
        falls=True,
    )


def _willett_simple() -> Law:
    scaled = sp.Symbol("scaled_gap", positive=True)
    return _law(
        "willett-simple",
        "closed-form approximation of the full fit, for small bridges",
        WILLETT,
        2 * sp.cos(phi) / (1 + _n("1.05") * scaled + _n("2.5") * scaled**2),
        ((scaled, h / sp.sqrt(V)),),
        rupture="willett",
        validity=_fitted_up_to("0.001"),
        falls=True,
    )


BRIDGES = (
    _exponential(
        "mikami", "regression of Young-Laplace solutions", MIKAMI, "-0.34", "-0.019", "0.0042", sp.log(V), "mikami"
    ),
    _exponential(
        "mikami-log10",
        "mikami with decimal logarithms in B and C (closer to Young-Laplace for phi > 0)",
        MIKAMI,
        "-0.34",
        "-0.019",
        "0.0042",
        sp.log(V) / sp.log(10),
        "mikami",
        ", read with log10",
    ),
    _willett(),
    _willett_simple(),
    _rabinovich(),
    _lambert(),
    _exponential(
        "soulie",
        "mikami's form refitted for polydisperse spheres",
        SOULIE,
        "-0.148",
        "-0.0082",
        "0.0018",
        sp.log(V),
        "lian",
    ),
    _law(
        "constant",
        "gap-independent upper bound, the force at contact",
        DERJAGUIN,
        2 * sp.cos(phi),
        remark=": 2 cos(phi), the limit at h = 0",
        falls=True,
    ),
)
