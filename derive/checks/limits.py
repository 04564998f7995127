"""Limits: reduced and head-on equations as special cases of the full oblique equations."""

from __future__ import annotations

from operator import methodcaller

import sympy as sp

from ..equations.model import derive
from ..physics.laws import LAWS
from ..physics.laws.base import filled
from ..physics.structure import Structure, structures
from ..vocabulary.quantities import aspect, beta, initial_spin, initial_turning, orbital_momentum, spin
from .base import Evidence, check
from .closed import special_case


@check("reduced form", "full equations with xi = (L - m r^2 omega)/((32/5) m a^2) are the reduced ones")
def reduced_is_full() -> Evidence:
    """With the spin eliminated by conserved L, the full equations and the spin's rate are the reduced ones."""
    midgap = {"arm": LAWS["arm"]["midgap"]}
    for structure in structures():
        if not structure.reduced:
            continue
        reduced, full = derive(structure), derive(Structure(True, structure.bridge, False))
        initial = (4 + aspect) ** 2 * initial_turning + sp.Rational(32, 5) * initial_spin  # L/(m a^2 Omega) at first
        eliminated = {spin: (initial - orbital_momentum) * sp.Rational(5, 32)}
        rates, full_rates = (each.by_state("right_hand_side") for each in (reduced, full))

        yield from (filled(full_rates[s], midgap).subs(eliminated) - rate for s, rate in rates.items())
        # the eliminated spin has the rate of the full equations
        turned = eliminated[spin].diff(orbital_momentum) * rates[orbital_momentum]
        yield turned - filled(full_rates[spin], midgap).subs(eliminated)
        names = ("events", "energies", "outputs", "effective_potential", "inward_force", "turning_rate", "start")
        yield from special_case(reduced, names, full, methodcaller("subs", eliminated))


@check("head-on limit", "oblique equations at zero rotation are the head-on ones")
def head_on_is_oblique_at_rest() -> Evidence:
    """An oblique doublet without rotation follows the head-on equations, and does not start to rotate."""
    still = {orbital_momentum: 0, spin: 0, beta: 0}
    for head_on in structures():
        if head_on.oblique:
            continue
        narrow, wide = derive(head_on), derive(Structure(True, head_on.bridge, head_on.strings))
        rates = wide.by_state("right_hand_side")
        yield from (rates[s].subs(still) for s in wide.states if s not in narrow.states)
        names = ["right_hand_side", "events", "energies", "energy_rates", "inward_force", "outputs"]
        names += ["effective_potential"] if "effective_potential" in wide else []  # not for rotating strings
        yield from special_case(narrow, names, wide, methodcaller("subs", still))
