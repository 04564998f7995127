"""Check of the theorem on floating doublets (solvers/certificates/floating.py)."""

from __future__ import annotations

from dataclasses import replace

from ..equations.model import derive
from ..physics.forces import FILM, SHEAR
from ..physics.structure import Structure
from ..vocabulary.quantities import gap, normal_velocity, orbital_momentum, stokes
from .base import Evidence, check
from .closed import SIZES

_EQUAL = Structure(oblique=True, bridge=True, strings=False)
_COVERED = tuple(
    replace(_EQUAL, bridge=not attraction, attraction=attraction, partner=partner)
    for attraction in (False, True)
    for partner in (_EQUAL.partner, "pair")
)


@check("floating", "beyond the shear: dJ/dt = 0, du/dt = -inward(x, J) - drag(x) u/St")
def floating_doublets() -> Evidence:
    """Without shear J is constant, and what remains of the motion is a fixed potential and a drag proportional to u.

    So u^2/2 and the work against the inward force, of gap and J alone, only decrease.
    """
    laws_of_gap = True
    for structure in _COVERED:
        model = derive(structure)
        rates = {state: rate.subs(SHEAR, 0) for state, rate in model.by_state("right_hand_side", SIZES).items()}
        inward = model.expanded(model["inward_force"]["inward_force"], SIZES)
        drag = -(rates[normal_velocity] + inward)
        yield from (rates[gap] - normal_velocity, rates[orbital_momentum], drag.subs(FILM, 0))
        yield from ((drag / (FILM * normal_velocity)).diff(normal_velocity), drag.diff(stokes) * stokes + drag)
        laws_of_gap &= not inward.free_symbols & (set(model.states) - {gap, orbital_momentum})
    yield laws_of_gap, "inward depends on another state"
