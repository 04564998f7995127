"""What must hold of the derivation: dimensions, conservation laws, limits between structures, and the groups.

Every check works on the expressions that are emitted (or on the SI equations they come from), symbolically: a check
that holds, holds for all values. `symbolic_checks` runs them all.
"""

from __future__ import annotations

from .attractions import law_checks
from .base import Check
from .certificate import least_energy
from .conservation import angular_momentum, energy
from .dimensions import dimension_checks
from .groups import centrifugal_number, normalisation_of_the_paper, number_of_groups
from .limits import head_on_is_oblique_at_rest, reduced_is_full
from .mechanics import inertia_is_rigid_rotation, strings_are_conservative
from .partners import partner_checks

__all__ = ["Check", "symbolic_checks"]


def symbolic_checks() -> tuple[Check, ...]:
    """Every check, in the order of the derivation."""
    return (
        *dimension_checks(),
        inertia_is_rigid_rotation(),
        *strings_are_conservative(),
        *angular_momentum(),
        *energy(),
        reduced_is_full(),
        head_on_is_oblique_at_rest(),
        least_energy(),
        centrifugal_number(),
        normalisation_of_the_paper(),
        number_of_groups(),
        *law_checks(),
        *partner_checks(),
    )
