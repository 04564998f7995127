"""Conservation: energy along the emitted equations for all laws, and the rate of angular momentum for a given arm."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache

import sympy as sp

from ..equations.model import derive
from ..physics.laws import Law, strings
from ..physics.laws.base import filled
from ..physics.structure import Structure, structures
from ..vocabulary.quantities import orbital_momentum, spin
from .base import Check, checks, vanishing
from .closed import slope_along

_FULL = tuple(structure for structure in structures() if not structure.reduced)


def momentum_rate(structure: Structure, laws: Mapping[str, Law]) -> sp.Expr:
    """d/dtau of orbital_momentum + (32/5) spin, L over m a^2 omega0, along the emitted right-hand side."""
    rates = derive(structure).by_state("right_hand_side")
    return sp.factor(sp.expand(filled(rates[orbital_momentum] + sp.Rational(32, 5) * rates[spin], laws)))


@cache
def energy_balance(structure: Structure) -> sp.Expr:
    """d/dtau of the emitted energies plus the emitted energy_rates, for any laws (and either arm)."""
    model = derive(structure)
    rates, stored = model.by_state("right_hand_side"), sp.Add(*model.results("energies").values())
    total = sp.Add(*(slope_along(stored, state) * rate for state, rate in rates.items()))
    lost = sp.Add(*model.results("energy_rates").values())
    return sp.factor(sp.expand(strings.half_angles(total + lost)))


@checks
def energy(among: Iterable[Structure] = _FULL) -> tuple[Check, ...]:
    """Film, shear and bridge are the only forces that change the mechanical energy; strings are conservative."""
    return tuple(
        vanishing(
            f"energy: {structure.name}",
            "d(kinetic + strings)/dt = -(film + shear + bridge power), for all laws and both arms",
            [energy_balance(structure)],
        )
        for structure in among
    )
