"""Energy certificate: its energy is the least one at fixed angular momentum, and its slope that of the energy."""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from ..equations.invariants import conserved_momentum
from ..equations.model import derive
from ..physics.laws import LAWS
from ..physics.structure import structures
from ..vocabulary.quantities import (
    aspect,
    gap,
    initial_spin,
    initial_turning,
    normal_velocity,
    obliquity,
    orbital_momentum,
    spin,
)
from .base import Check, vanishing
from .closed import slope_along


def least_energy() -> Check:
    """The certificate's energy is L^2/(2 I) (+ U_s), its slope the derivative at fixed L plus the bridge force."""
    left = []
    for structure in structures():
        model = derive(structure)
        if "effective_potential" not in model:
            continue
        outputs = model["effective_potential"].by_name
        value, slope = model.expanded(outputs["energy"]), model.expanded(outputs["slope"])
        momentum = sp.Symbol("L", real=True)  # over m a^2 Omega
        inertia = (4 + aspect * gap) ** 2 + sp.Rational(32, 5)
        expected: sp.Expr = sp.Integer(0)
        change: sp.Expr = sp.Integer(0)
        if structure.oblique:
            turning, spun = (initial_turning, initial_spin) if structure.reduced else (orbital_momentum, spin)
            own = ((4 + aspect) ** 2 if structure.reduced else 1) * turning + sp.Rational(32, 5) * spun
            fixed = momentum**2 * obliquity**2 / (32 * inertia)  # Omega = v0 T/(4a)
            expected += fixed.subs(momentum, own)
            change += fixed.diff(gap).subs(momentum, own)
        if structure.strings:
            stored = model.expanded(model["energies"]["strings"])
            expected += stored
            change += slope_along(stored, gap)
        if structure.bridge:
            work = model["energy_rates"]["capillary"]
            change += model.expanded(work) / normal_velocity
        left += [value - expected, slope - change]
    return vanishing("stick certificate", "slope = d/dx [L^2/(2 I(x)) + U_s(x) + W_c(x)] at fixed L", left)


def least_energy_is_a_minimum() -> Check:
    """At fixed gap and L the energy T + W_c (+ U_s) is least in rigid rotation: stationary, convex, and of that value.

    Only T depends on the velocities; its gradient over (u, orbit), with the spin given by L, vanishes at
    `rigid_rotation`, its Hessian is positive definite there and everywhere, and its value is the emitted energy's.
    """
    left: list[sp.Expr] = []
    convex = True
    tangent, momentum = sp.Symbol("tangent", positive=True), sp.Symbol("L", real=True)
    for structure in structures():
        if structure.reduced or structure.strings:
            continue  # the strings' energy does not depend on velocities; `reduced form` covers the reduced equations
        model = derive(structure)
        kinetic = model.expanded(model["energies"]["kinetic"]).subs(obliquity, tangent)
        least = model.expanded(model["effective_potential"]["energy"]).subs(obliquity, tangent)
        at_least = {s: model.expanded(model["rigid_rotation"][s.name]) for s in model.states}
        velocities = [normal_velocity]
        if structure.oblique:
            velocities.append(orbital_momentum)
            left_over = {spin: conserved_momentum(model, {"arm": LAWS["arm"]["midgap"]}).solved(spin, momentum)}
            kinetic, least = kinetic.subs(left_over), sp.factor(least.subs(left_over))
            at_least = {s: sp.factor(value.subs(left_over)) for s, value in at_least.items() if s != spin}
        gradient = [kinetic.diff(velocity).subs(at_least) for velocity in velocities]
        left += [*gradient, kinetic.subs(at_least) - least]
        hessian = sp.hessian(kinetic, velocities)
        minors = [sp.factor(hessian[:k, :k].det()) for k in range(1, len(velocities) + 1)]
        convex &= all(minor.is_positive for minor in minors)
    found = vanishing(
        "least energy at fixed L",
        "min over (u, omega, xi) of T at fixed L and x is L^2/(2 I(x)), in rigid rotation: stationary and convex",
        left,
        "gradient zero, Hessian positive definite, value as emitted",
    )
    return found if convex else replace(found, ok=False, figure="the Hessian is not positive definite")
