"""Energy certificate: its energy is the least one at fixed angular momentum, and its slope that of the energy."""

import sympy as sp

from ..equations.invariants import conserved_momentum
from ..vocabulary import quantities as q
from .base import MIDGAP, Evidence, check, models, slope_along


@check("stick certificate", "slope = d/dx [L^2/(2 I(x)) + U_s(x) + W_c(x)] at fixed L")
def least_energy() -> Evidence:
    """The certificate's energy is L^2/(2 I) (+ U_s), its slope the derivative at fixed L plus the bridge force."""
    for model in models():
        if "effective_potential" not in model:
            continue
        structure = model.structure
        value, slope = model.results("effective_potential").values()
        momentum = sp.Symbol("L", real=True)  # over m a^2 Omega
        inertia = (4 + q.aspect * q.gap) ** 2 + sp.Rational(32, 5)
        expected = change = sp.Integer(0)
        if structure.oblique:
            turning, spun = (q.initial_turning, q.initial_spin) if structure.reduced else (q.orbital_momentum, q.spin)
            kinetic = ((4 + q.aspect) ** 2 if structure.reduced else 1) * turning + sp.Rational(32, 5) * spun
            fixed = momentum**2 * q.obliquity**2 / (32 * inertia)  # Omega = v0 T/(4a)
            expected += fixed.subs(momentum, kinetic)
            change += fixed.diff(q.gap).subs(momentum, kinetic)
        if structure.strings:
            stored = model.expanded(model["energies"]["strings"])
            expected += stored
            change += slope_along(stored, q.gap)
        if structure.bridge:
            work = model["energy_rates"]["capillary"]
            change += model.expanded(work) / q.normal_velocity
        yield from (value - expected, slope - change)


@check(
    "least energy at fixed L",
    "min over (u, omega, xi) of T at fixed L and x is L^2/(2 I(x)), in rigid rotation: stationary and convex",
)
def least_energy_is_a_minimum() -> Evidence:
    """At fixed gap and L the energy T + W_c (+ U_s) is least in rigid rotation: stationary, convex, and of that value.

    Only T depends on the velocities; its gradient over (u, orbit), with the spin given by L, vanishes at
    `rigid_rotation`, its Hessian is positive definite there and everywhere, and its value is the emitted energy's.
    """
    convex = True
    tangent, momentum = sp.Symbol("tangent", positive=True), sp.Symbol("L", real=True)
    # the strings' energy does not depend on velocities; `reduced form` covers the reduced equations
    for model in models(lambda s: not s.reduced and not s.strings):
        kinetic = model.expanded(model["energies"]["kinetic"]).subs(q.obliquity, tangent)
        least = model.expanded(model["effective_potential"]["energy"]).subs(q.obliquity, tangent)
        at_least = model.by_state("rigid_rotation")
        velocities = [q.normal_velocity]
        if model.structure.oblique:
            velocities.append(q.orbital_momentum)
            left_over = {q.spin: conserved_momentum(model, MIDGAP).solved(q.spin, momentum)}
            kinetic, least = kinetic.subs(left_over), sp.factor(least.subs(left_over))
            at_least = {s: sp.factor(value.subs(left_over)) for s, value in at_least.items() if s != q.spin}
        gradient = [kinetic.diff(velocity).subs(at_least) for velocity in velocities]
        yield from (*gradient, kinetic.subs(at_least) - least)
        hessian = sp.hessian(kinetic, velocities)
        minors = [sp.factor(hessian[:k, :k].det()) for k in range(1, len(velocities) + 1)]
        convex &= all(minor.is_positive for minor in minors)
    yield convex, "the Hessian is not positive definite"
    yield "gradient zero, Hessian positive definite, value as emitted"
