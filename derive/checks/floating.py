"""Check of the theorem on floating doublets (solvers/certificates/floating.py)."""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from ..equations.model import derive
from ..physics.forces import FILM, SHEAR
from ..physics.structure import Structure
from ..vocabulary.quantities import gap, normal_velocity, orbital_momentum, stokes
from .base import Check, vanishing
from .closed import opened, opened_rates

_EQUAL = Structure(oblique=True, bridge=True, strings=False)
_COVERED = tuple(
    replace(_EQUAL, bridge=not attraction, attraction=attraction, partner=partner)
    for attraction in (False, True)
    for partner in (_EQUAL.partner, "pair")
)


def floating_doublets() -> Check:
    """Without shear J is constant, and what remains of the motion is a fixed potential and a drag proportional to u.

    So u^2/2 and the work against the inward force, of gap and J alone, only decrease.
    """
    left: list[sp.Expr] = []
    laws_of_gap = True
    for structure in _COVERED:
        model = derive(structure)
        rates = {state: rate.subs(SHEAR, 0) for state, rate in opened_rates(model).items()}
        inward = opened(model, model["inward_force"]["inward_force"])
        drag = -(rates[normal_velocity] + inward)
        left += [rates[gap] - normal_velocity, rates[orbital_momentum], drag.subs(FILM, 0)]
        left += [(drag / (FILM * normal_velocity)).diff(normal_velocity), drag.diff(stokes) * stokes + drag]
        laws_of_gap &= not inward.free_symbols & (set(model.states) - {gap, orbital_momentum})
    found = vanishing("floating", "beyond the shear: dJ/dt = 0, du/dt = -inward(x, J) - drag(x) u/St", left)
    return found if laws_of_gap else replace(found, ok=False, figure="inward depends on another state")
