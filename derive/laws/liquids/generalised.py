"""Squeeze flow, shear and axis pressure of a film whose viscosity depends on the shear rate.

On a ring of thickness h the squeeze flow has the apparent shear rate 3 |u| s/h^2 at the wall, s^2 = 2a (h - x): that of
a Newtonian liquid of the same flow, from continuity alone. The stress at the wall is that rate times a viscosity of
the ring, so that force and pressure are those of a Newtonian film with a mean of these viscosities,

    F_n = (6 pi a^2 u/x) (1 - x/x0)^2 <viscosity>,  mean over t = 1 - x/h with the weight 2t, 0 < t < 1 - x/x0.

Means are Gaussian sums whose weights add up to one: a constant viscosity comes out as it is, at any number of nodes.
The squeeze alone sets the rate, also of the tangential force: at equal speeds, sliding shears less by sqrt(x/a).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import sympy as sp

from ...physics.references import Reference
from ...physics.slots import approach
from ...user import aspect, gap, law, let, mu, normal_velocity, positive, quantity, v0, x0
from ..film import KANTAK
from ..glass import CRADLE
from ..shear import ONEILL

GIESEKUS = Reference(
    "giesekus1977bestimmung", ("Giesekus, H.", "Langer, G."),
    "Die Bestimmung der wahren Fließkurven nicht-newtonscher Flüssigkeiten und plastischer Stoffe mit der Methode der "
    "repräsentativen Viskosität",
    "Rheologica Acta", "Rheol. Acta", "16", "1–22", 1977,
)  # fmt: skip

Viscosity = Callable[[sp.Expr], sp.Expr]
"""A viscosity over `liquid.viscosity`, of a squared shear rate over (v0/x0)^2."""


@dataclass(frozen=True)
class Liquid:
    """A law of a liquid.

    Arguments:
        source, meaning: as of a law.
        in_shear: its viscosity.
        in_slit: the stress at the wall of a pressure-driven flow between plates over the apparent rate there.
        floor: squared rate, over (v0/x0)^2, below which the viscosity is constant.
    """

    name: str
    source: tuple[Reference, ...]
    meaning: str
    in_shear: Viscosity
    in_slit: Viscosity
    floor: sp.Expr = sp.S.Zero


@cache
def _nodes(count: int, power: int) -> tuple[tuple[sp.Expr, sp.Expr], ...]:
    """Places z and weights of Gauss and Legendre from 0 to 1 in 1 - (1 - z)^(1/power)."""
    y = sp.Symbol("y")
    polynomial = sp.Poly(sp.legendre(count, 2 * y - 1), y)
    weights = ((y, 1 / (y * (1 - y) * polynomial.diff().eval(y) ** 2)) for y in polynomial.nroots(n=25))
    return tuple((1 - (1 - y) ** power, power * (1 - y) ** (power - 1) * weight) for y, weight in weights)


def _mean(
    name: str, rate: Viscosity, viscosity: Viscosity, weight: Callable[[sp.Expr], sp.Expr], count: int, power: int = 3
) -> sp.Expr:
    """The mean of the viscosities of rings: of those at the places z from 0 to 1, with a weight.

    Arguments:
        rate: the squared rate of the ring at z.
        power: more than 1: nodes are closer to each other towards z = 1.
    """
    nodes = [(place, factor * weight(place)) for place, factor in _nodes(count, power)]
    total, terms = sp.Add(*(factor for _, factor in nodes)), []
    for number, (place, factor) in enumerate(nodes, 1):
        node = f"{name}_{number:02d}"
        ring = let(f"{node}_rate", positive(rate(sp.Rational(str(sp.N(place, 17))))))
        terms.append(sp.Rational(str(sp.N(factor / total, 17))) * let(node, viscosity(ring)))
    return let(f"{name}_mean", sp.Add(*terms))


def _resistance(liquid: Liquid) -> sp.Expr:
    inside = sp.sign(1 - gap)  # beyond the edge nothing acts, but numbers must be
    scale = let("film_scale", 18 * normal_velocity**2 * (1 - gap) * inside / (aspect * gap**3))

    def rate(place: sp.Expr) -> sp.Expr:
        return scale * place * (1 - place + place * gap) ** 3 + liquid.floor  # t = (1 - x/x0) place

    return (1 - gap) ** 2 / gap * _mean("film", rate, liquid.in_slit, lambda place: 2 * place, 10)


def _log_factor(liquid: Liquid, name: str, outer: sp.Expr) -> sp.Expr:
    """Couette shear integrated over the disc to a thickness: the mean over ln h."""
    scale = let(f"{name}_scale", 18 * normal_velocity**2 * sp.sign(outer - gap) / (aspect * gap**3))
    logarithm = let(f"{name}_log", sp.log(outer / gap))

    def rate(place: sp.Expr) -> sp.Expr:
        thinner = let(f"{name}_thinner_{len(rings) + 1}", sp.exp(-place * logarithm))  # x/h
        rings.append(thinner)
        return scale * (1 - thinner) * thinner**3 + liquid.floor

    rings: list[sp.Symbol] = []
    return logarithm * _mean(name, rate, liquid.in_shear, lambda place: sp.Integer(1), 6, 1)


def _pressure(liquid: Liquid, name: str, rim: sp.Expr) -> sp.Expr:
    """The pressure on the axis: the mean over (x/h)^2, which is 1 there and `rim` where the pressure is ambient."""
    scale = let(f"{name}_scale", 18 * approach**2 * sp.sign(1 - rim) / (aspect * gap**3))

    def rate(place: sp.Expr) -> sp.Expr:
        inverse = sp.sqrt(1 - place + rim * place)  # x/h
        if rim != 0:
            inverse = let(f"{name}_inverse_{len(rings) + 1}", inverse)
            rings.append(inverse)
        return scale * (1 - inverse) * inverse**3 + liquid.floor

    rings: list[sp.Symbol] = []
    mean = _mean(name, rate, liquid.in_slit, lambda place: sp.Integer(1), 8)
    return approach * (1 - rim) / gap**2 * mean


def film_laws(liquid: Liquid) -> None:
    """Declare the laws of its film in every slot, in the order in which scenes choose them."""
    source, remark = (*liquid.source, GIESEKUS), "; derived: a Newtonian film with the mean of its viscosities"
    common: dict[str, Any] = {"meaning": liquid.meaning, "remark": remark}
    resistance = _resistance(liquid)
    law("film", f"{liquid.name}-finite", source=(*source, KANTAK), resistance=resistance, **common)
    law("film", f"{liquid.name}-cavitating", source=(*source, KANTAK), resistance=resistance, suction=0, **common)
    for name, outer in (("immersed", 2 / aspect), ("film", sp.Integer(1))):
        factor = _log_factor(liquid, f"shear_{name}", outer)
        law("shear", f"{liquid.name}-{name}", source=(*source, ONEILL), log_factor=factor, edge=outer, **common)
    for name, rim in (("literal", sp.Integer(0)), ("film-corrected", gap**2)):
        pressure = _pressure(liquid, f"axis_{name[:4]}", rim)
        law("glass", f"{liquid.name}-{name}", source=(*source, CRADLE), pressure=pressure, **common)


@cache
def _of_power_law() -> tuple[sp.Symbol, sp.Expr]:
    """The index, and the rate at the wall over the apparent one of a power law between plates: (2n + 1)/(3n).

    The flow q = h^2/(2 T^2) int rate stress d(stress), up to the stress T at the wall, has the apparent rate 6 q/h^2.
    """
    index, stress, wall = sp.symbols("index stress wall", positive=True)
    flow = sp.integrate(sp.powsimp(stress * stress ** (1 / index)), (stress, 0, wall)) / (2 * wall**2)
    return index, sp.simplify(wall ** (1 / index) / (6 * flow))


def index_factor(index: sp.Expr) -> sp.Expr:
    """The rate at the wall over the apparent one, of a power law between plates."""
    symbol, factor = _of_power_law()
    return sp.sympify(factor.subs(symbol, index))


def representative_squared(index: sp.Expr) -> sp.Expr:
    """The squared ratio of the rate at which a viscosity acts between plates to the apparent one.

    ((2n + 1)/(3n))^(n/(n - 1)), with which a power law is exact, is exp(-ln(1 + w)/(3w)) with w = (1 - n)/(3n); here
    ln(1 + w)/w is its approximant of Padé, regular at n = 1, with which the viscosity is right to 0.3 % for n > 0.1.
    """
    return sp.exp(-6 * index * (5 * index + 1) / (37 * index**2 + 16 * index + 1))


def plateau_laws(
    name: str,
    source: Reference,
    begins: str,
    thinning: Callable[[sp.Expr, sp.Symbol], sp.Expr],
    floor: Callable[[sp.Symbol], sp.Expr] | None = None,
) -> None:
    """Declare the entries and laws of a liquid between two plateaus.

    Arguments:
        begins: what the inverse of its relaxation time is the rate of.
        thinning: from 1 at rest to 0, by the squared rate times the time and by the index.
        floor: as of `Liquid`, by the time.
    """
    index = quantity(
        "flow_index", "n", bounds="> 0 and <= 1", meaning="slope of the stress over the rate where it thins"
    )
    time = quantity("relaxation_time", r"\lambda", unit="s", over=x0 / v0, meaning=f"inverse rate where it {begins}")
    infinite = quantity("infinite_shear_viscosity", r"\mu_\infty", unit="Pa s", bounds=">= 0", over=mu)
    deborah, plateau = let("deborah", time * v0 / x0), let("plateau", infinite / mu)
    at_wall = let("at_wall", representative_squared(index))

    def viscosity(rate: sp.Expr) -> sp.Expr:
        return plateau + (1 - plateau) * thinning(deborah**2 * rate, index)

    def in_slit(rate: sp.Expr) -> sp.Expr:
        return viscosity(at_wall * rate)

    meaning = f"viscosity between two plateaus, by {name.title()}"
    rest = sp.S.Zero if floor is None else let("rest", floor(deborah))
    film_laws(Liquid(name, (source,), meaning, viscosity, in_slit, rest))
