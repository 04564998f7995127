"""Films and attractions: dimensions and limits of the laws added to the paper's, and the generalised number Ce_F."""

from __future__ import annotations

import sympy as sp

from ..equations.model import Model, derive
from ..physics.forces import force_laws
from ..physics.laws import LAWS, attraction, fill, film
from ..physics.laws.start import initial_rate
from ..physics.mechanics import F_c
from ..physics.scaling import generalised_centrifugal, group_definitions
from ..physics.structure import Structure
from ..vocabulary.dimensions import ENERGY, FORCE, LENGTH, PRESSURE, demand_dimension
from ..vocabulary.quantities import DIMENSIONS, centrifugal, contact_angle, gap, normal_velocity, omega0, x, x0
from .base import Check, Evidence, check, checks, vanishing
from .closed import SIZES, slope_along

_H = sp.Symbol("h", positive=True)
_ATTRACTED = (
    Structure(False, True, True, attraction=True),
    Structure(True, False, False, reduced=True, attraction=True),
    Structure(True, True, False, attraction=True),
    Structure(True, True, False, attraction=True, partner="pair"),
    Structure(True, True, False, attraction=True, partner="wall"),
)


@checks
def films() -> tuple[Check, ...]:
    """Each film law is a force and tends to the force of an unlimited film as the rim goes to infinity."""
    rim = sp.Symbol("rim", positive=True)
    lengths = {**DIMENSIONS, rim: LENGTH}
    forces = (film.normal_force(), film.unbounded_force(), film.sustained_force(), film.constant_volume_force())
    for force in forces:
        demand_dimension("film force", force, FORCE, lengths)
    demand_dimension("rim of constant volume", film.rim_of_constant_volume(), LENGTH, DIMENSIONS)
    demand_dimension("attraction of half-spaces", attraction.flat_pressure(), PRESSURE, {**DIMENSIONS, _H: LENGTH})
    demand_dimension("van der Waals force", attraction.van_der_waals_force(), FORCE, DIMENSIONS)
    demand_dimension("van der Waals potential", attraction.van_der_waals_potential(), ENERGY, DIMENSIONS)
    unbounded = film.unbounded_force()
    far = [
        sp.limit(film.normal_force() / unbounded, x0, sp.oo) - 1,
        sp.limit(film.constant_volume_force() / unbounded, rim, sp.oo) - 1,
        film.constant_volume_force().subs(rim, x0) - film.normal_force(),
        film.sustained_force(),
    ]
    potential = attraction.van_der_waals_potential().diff(x) - attraction.van_der_waals_force()
    return (
        vanishing("films", "all tend to 6 pi mu a^2 u/x as the rim goes far; without suction no force opposes", far),
        vanishing("van der Waals", "F_w = dW_w/dx = A a/(6 x^2)", [potential]),
    )


@checks
def resistances() -> Check:
    """The resistance of every film is nowhere negative, so that lubrication only dissipates."""
    wrong = []
    for law in LAWS["film"].values():
        for function in (each for each in law.functions if not each.for_proof):
            value = function(*function.arguments).subs(gap, sp.Symbol("s", positive=True))
            if not (sp.factor(value) * sp.Symbol("s", positive=True)).is_nonnegative:
                wrong.append(f"{law.name} {function.name}")
    return Check("films dissipate", "resistance >= 0 at every gap", not wrong, ", ".join(wrong) or "4 films")


@check("generalised centrifugal number", "m omega0^2 a/F = Ce/(4 pi cos(phi)) for the constant bridge")
def generalised_number() -> Evidence:
    """Ce_F is a constant times Ce for the constant bridge: Ce/(4 pi cos(phi))."""
    force = fill(force_laws()[F_c], {"bridge": LAWS["bridge"]["constant"]})
    own = sp.simplify(generalised_centrifugal(force) / _centrifugal())
    yield own - 1 / (4 * sp.pi * sp.cos(contact_angle))
    yield f"Ce_F/Ce = {own}"


def _centrifugal() -> sp.Expr:
    return sp.simplify(group_definitions()[centrifugal] / initial_rate() ** 2) * omega0**2


@check("stick certificate, attractions", "slope = d/dx [L^2/(2 I) + U_s + W_c + W_w] at fixed L")
def slopes() -> Evidence:
    """The certificate's slope is that of its energy plus the work against every attraction."""
    for structure in _ATTRACTED:
        model = derive(structure)
        least, taken = (model.results(name, SIZES) for name in ("effective_potential", "energy_rates"))
        work = sp.Add(*(taken[name] / normal_velocity for name in ("capillary", "attraction") if name in taken))
        yield least["slope"] - _slope(model, least["energy"]) - work


def _slope(model: Model, energy: sp.Expr) -> sp.Expr:
    """Slope of the least energy along the gap at a fixed angular momentum."""
    if not model.structure.oblique or model.structure.partner == "wall":
        return slope_along(energy, gap)
    by_name = {symbol.name: symbol for symbol, _ in model.definitions}
    own, inertia = (model.expanded(by_name[name], SIZES) for name in ("momentum", "inertia_ratio"))
    momentum, scale = sp.Symbol("L", positive=True), sp.simplify(energy * inertia / own**2)
    return (scale * momentum**2 / inertia).diff(gap).subs(momentum, own)
