"""Limits of the laws: where each force vanishes, films and attractions, the generalised number Ce_F."""

from collections.abc import Iterable
from dataclasses import replace

import sympy as sp

from ..equations.intermediates import SHEAR_FORCE
from ..equations.model import Model, derive
from ..laws import LAWS, Law, fill, filled, film, slot_calls
from ..physics import attraction
from ..physics.forces import force_laws
from ..physics.mechanics import F_c, F_n, F_t, S_n, S_t
from ..physics.pendulum import offset_squared
from ..physics.scaling import DISTANCE, generalised_centrifugal, group_definitions, initial_rate
from ..physics.structure import Structure
from ..vocabulary import quantities as q
from ..vocabulary.dimensions import ENERGY, FORCE, LENGTH, PRESSURE, demand_dimension
from .base import SIZES, Check, Evidence, check, checks, models, slope_along, vanishing


@check("rigid rotation", "omega = xi: no tangential force, for every tangential law")
def rigid_rotation_is_free() -> Evidence:
    """The tangential force vanishes in rigid rotation, in SI and as emitted, for any tangential law."""
    yield force_laws()[F_t].subs(q.xi, q.omega)
    for model in models(lambda s: s.oblique and not s.reduced):
        yield model.expanded(SHEAR_FORCE).subs(q.orbital_momentum, q.spin * model.expanded(DISTANCE) ** 2)


def film_ends(films: Iterable[Law], shears: Iterable[Law]) -> tuple[Check, ...]:
    """The film force vanishes at the rim x = x0, the tangential force at its own edge."""
    checks = []
    for law in films:
        residual = filled(force_laws()[F_n], {"film": law}).subs(q.x, q.x0)
        check = vanishing(f"film's rim: {law.name}", "x -> x0: no film force", [residual])
        if law.name == "infinite":  # by definition this law has no rim in the pressure
            check = replace(check, ok=None, figure=f"ends at {residual}: known, the film has no rim")
        checks.append(check)
    for law in shears:
        residual = [law["log_factor"](law["edge"](q.aspect), q.aspect)]
        checks.append(vanishing(f"shear's edge: {law.name}", "no tangential force at its edge", residual))
    return tuple(checks)


def long_strings_vanish(laws: Iterable[Law]) -> Iterable[Check]:
    """Strings of infinite length exert no force, at fixed weight and swing."""
    return map(_vanish, laws)


@check("infinite strings: {0.name}", "l -> oo: S_n, S_t, U_s -> 0 at fixed weight and swing")
def _vanish(law: Law) -> Evidence:
    swing = sp.Symbol("swing", positive=True)  # (d/a)^2
    for force in (S_n, S_t):
        whole = force_laws()[force]
        calls = {node: node.func(node.args[0], swing) for node in slot_calls(whole)}
        yield sp.limit(filled(whole.xreplace(calls), {"strings": law}), q.l_s, sp.oo)
    yield sp.limit(law["rise"](q.string_ratio, swing), q.string_ratio, sp.oo)


@check("small-angle strings", "forces and energy are the exact ones to leading order in the swing")
def small_angle_is_linear() -> Evidence:
    """Small-angle strings are the exact ones to leading order in the swing: forces linear, energy quadratic."""
    exact, small = LAWS["strings"]["exact"], LAWS["strings"]["small-angle"]
    size = sp.Symbol("size", positive=True)  # of the swing d
    for function, order in (("stiffness", 0), ("rise", 2)):
        swung = exact[function](q.string_ratio, size**2 * offset_squared)
        leading = sp.limit(swung / size**order, size, 0)
        yield leading - small[function](q.string_ratio, offset_squared)


def head_on_closed_form(laws: Iterable[Law]) -> tuple[Check, ...]:
    """Head-on with a film only, u = -v0 (1 - Lf(s)/St) solves the emitted equations, Lf the integral of resistance."""
    return tuple(map(_closed_form, laws))


@check("head-on closed form: {0.name}", "-u/v0 = 1 - Lf(s)/St solves it")
def _closed_form(law: Law) -> Evidence:
    model = derive(Structure(oblique=False, bridge=False, strings=False))
    closing, film_flag, stokes = model.states[1], sp.Symbol("film", nonnegative=True), model.groups[0]
    integral = film_integral(law)
    speed = -(1 - integral / stokes)
    rate = filled(model.expanded(model["right_hand_side"]["normal_velocity"]), {"film": law})
    yield from (speed * speed.diff(q.gap) - rate.subs({closing: speed, film_flag: 1}), speed.subs(q.gap, 1) + 1)
    yield from [integral - function(q.gap) for function in law.functions if function.name == "stopping"]
    if law.name == "finite" and not integral.has(sp.Integral):
        yield sp.expand_log(integral - (sp.log(1 / q.gap) - sp.Rational(3, 2) + 2 * q.gap - q.gap**2 / 2))
    yield f"Lf(s) = {integral}".replace("gap", "s")


def film_integral(law: Law) -> sp.Expr:
    """Lf(s), the film's resistance integrated from the gap s to its rim; an Integral where it has no closed form."""
    inner = sp.Symbol("inner_gap", positive=True)
    resistance = sp.expand(law["resistance"](inner))
    integral = sp.integrate(resistance, (inner, q.gap, 1))
    return sp.Integral(resistance, (inner, q.gap, 1)) if integral.has(sp.Integral) else sp.expand(integral)


_THICKNESS = sp.Symbol("h", positive=True)
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
    lengths = {**q.DIMENSIONS, rim: LENGTH}
    forces = (film.normal_force(), film.unbounded_force(), film.sustained_force(), film.constant_volume_force())
    for force in forces:
        demand_dimension("film force", force, FORCE, lengths)
    demand_dimension("rim of constant volume", film.rim_of_constant_volume(), LENGTH, q.DIMENSIONS)
    demand_dimension(
        "attraction of half-spaces", attraction.flat_pressure(), PRESSURE, {**q.DIMENSIONS, _THICKNESS: LENGTH}
    )
    demand_dimension("van der Waals force", attraction.van_der_waals_force(), FORCE, q.DIMENSIONS)
    demand_dimension("van der Waals potential", attraction.van_der_waals_potential(), ENERGY, q.DIMENSIONS)
    unbounded = film.unbounded_force()
    far = [
        sp.limit(film.normal_force() / unbounded, q.x0, sp.oo) - 1,
        sp.limit(film.constant_volume_force() / unbounded, rim, sp.oo) - 1,
        film.constant_volume_force().subs(rim, q.x0) - film.normal_force(),
        film.sustained_force(),
    ]
    potential = attraction.van_der_waals_potential().diff(q.x) - attraction.van_der_waals_force()
    return (
        vanishing("films", "all tend to 6 pi mu a^2 u/x as the rim goes far; without suction no force opposes", far),
        vanishing("van der Waals", "F_w = dW_w/dx = A a/(6 x^2)", [potential]),
    )


@checks
def resistances() -> Check:
    """The resistance of every film is nowhere negative, so that lubrication only dissipates."""
    wrong = []
    for law in LAWS["film"].values():
        for function in (item for item in law.functions if not item.for_proof):
            value = function(*function.arguments).subs(q.gap, sp.Symbol("s", positive=True))
            if not (sp.factor(value) * sp.Symbol("s", positive=True)).is_nonnegative:
                wrong.append(f"{law.name} {function.name}")
    return Check("films dissipate", "resistance >= 0 at every gap", not wrong, ", ".join(wrong) or "4 films")


@check("generalised centrifugal number", "m omega0^2 a/F = Ce/(4 pi cos(phi)) for the constant bridge")
def generalised_number() -> Evidence:
    """Ce_F is a constant times Ce for the constant bridge: Ce/(4 pi cos(phi))."""
    force = fill(force_laws()[F_c], {"bridge": LAWS["bridge"]["constant"]})
    papers = sp.simplify(group_definitions()[q.centrifugal] / initial_rate() ** 2) * q.omega0**2
    derived = sp.simplify(generalised_centrifugal(force) / papers)
    yield derived - 1 / (4 * sp.pi * sp.cos(q.contact_angle))
    yield f"Ce_F/Ce = {derived}"


@check("stick certificate, attractions", "slope = d/dx [L^2/(2 I) + U_s + W_c + W_w] at fixed L")
def slopes() -> Evidence:
    """The certificate's slope is that of its energy plus the work against every attraction."""
    for structure in _ATTRACTED:
        model = derive(structure)
        least, taken = (model.results(name, SIZES) for name in ("effective_potential", "energy_rates"))
        work = sp.Add(*(taken[name] / q.normal_velocity for name in ("capillary", "attraction") if name in taken))
        yield least["slope"] - _slope(model, least["energy"]) - work


def _slope(model: Model, energy: sp.Expr) -> sp.Expr:
    """Slope of the least energy along the gap at a fixed angular momentum."""
    if not model.structure.oblique or model.structure.partner == "wall":
        return slope_along(energy, q.gap)
    by_name = {symbol.name: symbol for symbol, _ in model.definitions}
    momentum, inertia = (model.expanded(by_name[name], SIZES) for name in ("momentum", "inertia_ratio"))
    fixed, scale = sp.Symbol("L", positive=True), sp.simplify(energy * inertia / momentum**2)
    return (scale * fixed**2 / inertia).diff(q.gap).subs(fixed, momentum)
