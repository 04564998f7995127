"""Mechanics and conservation: inertia, potentials, energy along the emitted equations, the rate of angular momentum."""

from collections.abc import Iterable, Mapping
from functools import cache

import sympy as sp

from ..equations.model import Model, derive
from ..laws import LAWS, Law, filled
from ..physics import pendulum as strings
from ..physics.forces import force_laws
from ..physics.mechanics import S_n, S_t, doublet_inertia, equations_of_motion, string_forces
from ..physics.structure import Structure, structures
from ..vocabulary import quantities as q
from .base import Check, Evidence, check, checks, settled, slope_along, vanishing


@check("inertia", "I(x) = 2 T(u = 0, xi = omega)/omega^2 = m a^2 [(4 + x/a)^2 + 32/5]")
def inertia_is_rigid_rotation() -> Evidence:
    """I(x) from the parallel-axis theorem gives the kinetic energy of a doublet in rigid rotation."""
    rigid = equations_of_motion().kinetic_energy.subs({q.u: 0, q.xi: q.omega})
    residual = sp.expand(2 * rigid / q.omega**2 - doublet_inertia())
    left_paper = sp.expand(doublet_inertia() - q.m * q.a**2 * ((4 + q.x / q.a) ** 2 + sp.Rational(32, 5)))
    yield from (residual, left_paper)


def strings_are_conservative(laws: Iterable[Law]) -> tuple[Check, ...]:
    """The string forces are minus the gradient of their potential, and `stiffness` is twice the slope of `rise`."""
    return tuple(map(_conservative, laws))


@cache
@check("strings: {0.name}", "S_n = dU/dr, S_t = (1/r) dU/dbeta")
def _conservative(law: Law) -> Evidence:
    """The potential is 4 m g a `rise` for both spheres; for the library's laws also the one they were derived from."""
    swing = strings.swing_squared() / q.a**2
    rise, stiffness = law["rise"], law["stiffness"]
    potentials = [4 * q.m * q.g * q.a * rise(q.l_s / q.a, swing)]
    if LAWS["strings"].get(law.name) is law:
        potentials.append(strings.potential(law.name == "small-angle"))
    for potential in potentials:
        for force, expected in zip((S_n, S_t), string_forces(potential, strings.r, q.beta), strict=True):
            yield filled(force_laws()[force], {"strings": law}) - expected.subs(strings.r, q.r)
    yield 2 * rise(*rise.arguments).diff(rise.arguments[1]) - stiffness(*rise.arguments)


_FULL = tuple(structure for structure in structures() if not structure.reduced)


def momentum_rate(model: Model, laws: Mapping[str, Law]) -> sp.Expr:
    """d/dtau of orbital_momentum + (32/5) spin, L over m a^2 omega0, along the emitted right-hand side."""
    rates = model.by_state("right_hand_side")
    return sp.factor(sp.expand(filled(rates[q.orbital_momentum] + sp.Rational(32, 5) * rates[q.spin], laws)))


@cache
def energy_balance(structure: Structure) -> sp.Expr:
    """d/dtau of the emitted energies plus the emitted energy_rates, for any laws (and either arm)."""
    model = derive(structure)
    rates, stored = model.by_state("right_hand_side"), sp.Add(*model.results("energies").values())
    total = sp.Add(*(slope_along(stored, state) * rate for state, rate in rates.items()))
    lost = sp.Add(*model.results("energy_rates").values())
    return settled(strings.half_angles(total + lost))


@checks
def energy(among: Iterable[Structure] = _FULL) -> tuple[Check, ...]:
    """Film, shear and bridge are the only forces that change the mechanical energy; strings are conservative."""
    statement = "d(kinetic + strings)/dt = -(film + shear + bridge power), for all laws and both arms"
    return tuple(vanishing(f"energy: {structure.name}", statement, [energy_balance(structure)]) for structure in among)
