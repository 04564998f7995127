"""Limits of the laws: where each force vanishes, and limits that relate the string laws."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp
from sympy.core.function import AppliedUndef

from ..equations.intermediates import SHEAR_FORCE
from ..equations.model import derive
from ..physics.forces import force_laws
from ..physics.laws import LAWS, Law
from ..physics.laws.base import filled
from ..physics.laws.strings import offset_squared
from ..physics.mechanics import F_n, F_t, S_n, S_t
from ..physics.scaling import DISTANCE
from ..physics.structure import structures
from ..vocabulary.quantities import aspect, gap, l_s, omega, orbital_momentum, spin, string_ratio, x, x0, xi
from .base import Check, Evidence, check, vanishing


@check("rigid rotation", "omega = xi: no tangential force, for every tangential law")
def rigid_rotation_is_free() -> Evidence:
    """The tangential force vanishes in rigid rotation, in SI and as emitted, for any tangential law."""
    yield force_laws()[F_t].subs(xi, omega)
    for structure in structures():
        if structure.oblique and not structure.reduced:
            model = derive(structure)
            rigid = {orbital_momentum: spin * model.expanded(DISTANCE) ** 2}
            yield model.expanded(SHEAR_FORCE).subs(rigid)


def film_ends(films: Iterable[Law], shears: Iterable[Law]) -> tuple[Check, ...]:
    """The film force vanishes at the rim x = x0, the tangential force at its own edge."""
    checks = []
    for law in films:
        left = filled(force_laws()[F_n], {"film": law}).subs(x, x0)
        name, statement = f"film's rim: {law.name}", "x -> x0: no film force"
        if law.name == "infinite":  # by definition this law has no rim in the pressure
            checks.append(Check(name, statement, None, f"ends at {left}: known, the film has no rim"))
        else:
            checks.append(vanishing(name, statement, [left]))
    for law in shears:
        left = [law["log_factor"](law["edge"](aspect), aspect)]
        checks.append(vanishing(f"shear's edge: {law.name}", "no tangential force at its edge", left))
    return tuple(checks)


def long_strings_vanish(laws: Iterable[Law]) -> tuple[Check, ...]:
    """Strings of infinite length exert no force, at fixed weight and swing."""
    swing = sp.Symbol("swing", positive=True)  # (d/a)^2
    checks = []
    for law in laws:
        left = []
        for force in (S_n, S_t):
            whole = force_laws()[force]
            calls = {
                node: node.func(node.args[0], swing)
                for node in whole.atoms(AppliedUndef)
                if node.func.__name__.startswith("strings.")
            }
            left.append(sp.limit(filled(whole.xreplace(calls), {"strings": law}), l_s, sp.oo))
        left.append(sp.limit(law["rise"](string_ratio, swing), string_ratio, sp.oo))
        checks.append(
            vanishing(f"infinite strings: {law.name}", "l -> oo: S_n, S_t, U_s -> 0 at fixed weight and swing", left)
        )
    return tuple(checks)


@check("small-angle strings", "forces and energy are the exact ones to leading order in the swing")
def small_angle_is_linear() -> Evidence:
    """Small-angle strings are the exact ones to leading order in the swing: forces linear, energy quadratic."""
    exact, small = LAWS["strings"]["exact"], LAWS["strings"]["small-angle"]
    size = sp.Symbol("size", positive=True)  # of the swing d
    for function, order in (("stiffness", 0), ("rise", 2)):
        swung = exact[function](string_ratio, size**2 * offset_squared)
        leading = sp.limit(swung / size**order, size, 0)
        yield leading - small[function](string_ratio, offset_squared)


def head_on_closed_form(laws: Iterable[Law]) -> tuple[Check, ...]:
    """Head-on with a film only, u = -v0 (1 - Lf(s)/St) solves the emitted equations, Lf the integral of resistance."""
    head_on = next(s for s in structures() if not (s.oblique or s.bridge or s.strings))
    model = derive(head_on)
    closing, film_flag, stokes = model.states[1], sp.Symbol("film", nonnegative=True), model.groups[0]
    checks = []
    for law in laws:
        integral, integrated = film_integral(law)
        speed = -(1 - integral / stokes)
        rate = filled(model.expanded(model["right_hand_side"]["normal_velocity"]), {"film": law})
        left = [speed * speed.diff(gap) - rate.subs({closing: speed, film_flag: 1}), speed.subs(gap, 1) + 1]
        left += [integral - each(gap) for each in law.functions if each.name == "stopping"]
        figure = f"Lf(s) = {integral}".replace("gap", "s")
        if law.name == "finite" and integrated:
            left.append(sp.expand_log(integral - (sp.log(1 / gap) - sp.Rational(3, 2) + 2 * gap - gap**2 / 2)))
        checks.append(vanishing(f"head-on closed form: {law.name}", "-u/v0 = 1 - Lf(s)/St solves it", left, figure))
    return tuple(checks)


def film_integral(law: Law) -> tuple[sp.Expr, bool]:
    """Lf(s), the film's resistance integrated from the gap s to its rim, and whether it has a closed form."""
    inner = sp.Symbol("inner_gap", positive=True)
    resistance = sp.expand(law["resistance"](inner))
    integral = sp.integrate(resistance, (inner, gap, 1))
    if integral.has(sp.Integral):
        return sp.Integral(resistance, (inner, gap, 1)), False
    return sp.expand(integral), True
