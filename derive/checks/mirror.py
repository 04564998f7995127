"""Reflection: a doublet that turns the other way moves alike, so that proofs may take one rotation as positive."""

from __future__ import annotations

from dataclasses import replace

from ..equations.model import derive
from ..physics.structure import Structure
from ..vocabulary.quantities import orbital_momentum, partner_spin, spin
from .base import Evidence, check
from .closed import SIZES

_TURNING = (orbital_momentum, spin, partner_spin)
_EVEN = ("inward_force", "events", "energies", "energy_rates", "approach_force")
_FREE = Structure(oblique=True, bridge=True, strings=False, attraction=True)


@check("reflection", "J, xi -> -J, -xi reverses their rates and leaves all else")
def mirror() -> Evidence:
    """With every rotation reversed, rates of rotations are reversed, and gap, forces, energies and margins the same."""
    for structure in (_FREE, replace(_FREE, partner="pair")):
        model = derive(structure)
        reversed_ = {state: -state for state in model.states if state in _TURNING}
        names = {each.name for each in model.functions}
        for name in ("right_hand_side", *(each for each in _EVEN if each in names)):
            for key, value in model[name].outputs:
                result = model.expanded(value, SIZES)
                sign = -1 if name == "right_hand_side" and key in {state.name for state in reversed_} else 1
                yield result - sign * result.subs(reversed_, simultaneous=True)
