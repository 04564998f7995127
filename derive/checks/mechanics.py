"""Mechanics: the inertia is that of the kinetic energy, the string forces are those of their potential."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache

import sympy as sp

from ..physics.forces import force_laws
from ..physics.laws import LAWS, Law, strings
from ..physics.laws.base import filled
from ..physics.mechanics import S_n, S_t, doublet_inertia, equations_of_motion, string_forces
from ..vocabulary.quantities import a, beta, g, l_s, m, omega, r, u, x, xi
from .base import Check, Evidence, check, vanishing


@check("inertia", "I(x) = 2 T(u = 0, xi = omega)/omega^2 = m a^2 [(4 + x/a)^2 + 32/5]")
def inertia_is_rigid_rotation() -> Evidence:
    """I(x) from the parallel-axis theorem gives the kinetic energy of a doublet in rigid rotation."""
    rigid = equations_of_motion().kinetic_energy.subs({u: 0, xi: omega})
    left = sp.expand(2 * rigid / omega**2 - doublet_inertia())
    left_paper = sp.expand(doublet_inertia() - m * a**2 * ((4 + x / a) ** 2 + sp.Rational(32, 5)))
    yield from (left, left_paper)


def strings_are_conservative(laws: Iterable[Law]) -> tuple[Check, ...]:
    """The string forces are minus the gradient of their potential, and `stiffness` is twice the slope of `rise`."""
    return tuple(map(_conservative, laws))


@cache
def _conservative(law: Law) -> Check:
    """The potential is 4 m g a `rise` for both spheres; for the library's laws also the one they were derived from."""
    swing = strings.swing_squared() / a**2
    rise, stiffness = law["rise"], law["stiffness"]
    potentials = [4 * m * g * a * rise(l_s / a, swing)]
    if LAWS["strings"].get(law.name) is law:
        potentials.append(strings.potential(law.name == "small-angle"))
    left = []
    for potential in potentials:
        normal, sideways = string_forces(potential, strings.r, beta)
        left += [
            sp.simplify(filled(force_laws()[force], {"strings": law}) - expected.subs(strings.r, r))
            for force, expected in ((S_n, normal), (S_t, sideways))
        ]
    arguments = rise.arguments
    left.append(sp.simplify(2 * rise(*arguments).diff(arguments[1]) - stiffness(*arguments)))
    return vanishing(f"strings: {law.name}", "S_n = dU/dr, S_t = (1/r) dU/dbeta", left)
