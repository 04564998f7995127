"""Checks of the derivation: dimensions, conservation laws, signs of losses, limits, groups, and certificates.

Every check works symbolically on the expressions that are emitted, or on the SI equations they derive from: a check
that passes holds for all values. `symbolic_checks` runs them all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache

from ..physics.laws import LAWS, Law
from ..vocabulary.quantities import gap
from .admission import Admission, certificate, certificates
from .approach_certificate import approach_certificate
from .attraction_certificate import attraction_certificate
from .attractions import law_checks
from .base import Check
from .certificate import least_energy, least_energy_is_a_minimum
from .conservation import energy
from .dimensions import dimension_checks
from .dissipation import arms, bridge_does_work, film_dissipates, rebound_dissipates
from .emitted import emitted
from .floating import floating_doublets
from .friction import friction_checks
from .groups import (
    centrifugal_number,
    groups_are_the_papers,
    groups_span_the_nullspace,
    normalisation_of_the_paper,
    number_of_groups,
)
from .laws import (
    film_ends,
    head_on_closed_form,
    long_strings_vanish,
    rigid_rotation_is_free,
    small_angle_is_linear,
)
from .limits import head_on_is_oblique_at_rest, reduced_is_full
from .mechanics import inertia_is_rigid_rotation, strings_are_conservative
from .mirror import mirror
from .orbital_momentum_certificate import orbital_momentum_certificate
from .partners import partner_checks
from .pendulum_certificate import pendulum_certificate
from .restitution import ceiling_is_the_published, decomposition, rotation_can_be_released
from .slow_manifold import films_fall, slow_manifold
from .space import space_checks
from .spin_down_certificate import spin_down_certificate

__all__ = ["Admission", "Check", "certificate", "symbolic_checks"]


@cache
def _once(checks: Callable[[], Check | Iterable[Check]]) -> tuple[Check, ...]:
    """Checks that do not depend on laws: the same for every scene, computed once per process."""
    made = checks()
    return (made,) if isinstance(made, Check) else tuple(made)


def symbolic_checks(laws: Mapping[str, Law] | None = None) -> Iterator[Check]:
    """Every check, in the order of the derivation, computed lazily.

    Arguments:
        laws: slot -> law of the scene in question; checks that depend on a law are restricted to it, and for all of
            the library's laws in a slot that is left out.
    """
    own = dict(laws or {})

    def of(slot: str) -> list[Law]:
        return [own[slot]] if slot in own else list(LAWS[slot].values())

    # these structures do not have a rim that depends on the gap; `law_checks` covers it
    films = [law for law in of("film") if law["resistance"].arguments == (gap,)]
    yield from _once(dimension_checks)
    yield from _once(inertia_is_rigid_rotation)
    yield from strings_are_conservative(of("strings"))
    yield from _once(energy)
    yield from _once(emitted)
    yield from arms(of("arm"), of("shear"))
    yield from (film_dissipates(law) for law in films)
    yield from _once(bridge_does_work)
    yield from _once(rebound_dissipates)
    yield from _once(friction_checks)
    yield from _once(reduced_is_full)
    yield from _once(head_on_is_oblique_at_rest)
    yield from head_on_closed_form(films)
    yield from _once(rigid_rotation_is_free)
    yield from film_ends(films, of("shear"))
    yield from long_strings_vanish(of("strings"))
    yield from _once(small_angle_is_linear)
    yield from _once(decomposition)
    yield from _once(ceiling_is_the_published)
    yield from _once(rotation_can_be_released)
    yield from _once(mirror)
    yield from _once(least_energy)
    yield from _once(least_energy_is_a_minimum)
    yield from _once(pendulum_certificate)
    yield from _once(attraction_certificate)
    yield from _once(orbital_momentum_certificate)
    yield from _once(slow_manifold)
    yield from films_fall([*of("film"), *of("shear")])
    yield from _once(approach_certificate)
    yield from _once(spin_down_certificate)
    yield from _once(floating_doublets)
    yield from certificates(own)
    yield from _once(groups_span_the_nullspace)
    yield from _once(groups_are_the_papers)
    yield from _once(centrifugal_number)
    yield from _once(normalisation_of_the_paper)
    yield from _once(number_of_groups)
    yield from _once(law_checks)
    yield from _once(partner_checks)
    yield from _once(space_checks)
