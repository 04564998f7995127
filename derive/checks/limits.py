"""Special cases and symmetries of the full equations: reduced, head-on and reflected."""

from dataclasses import replace
from operator import methodcaller

import sympy as sp

from ..equations.model import derive
from ..physics.law import filled
from ..physics.structure import Structure, structures
from ..vocabulary import quantities as q
from .base import MIDGAP, SIZES, Evidence, check, special_case


@check("reduced form", "full equations with xi = (L - m r^2 omega)/((32/5) m a^2) are the reduced ones")
def reduced_is_full() -> Evidence:
    """With the spin eliminated by conserved L, the full equations and the spin's rate are the reduced ones."""
    for structure in structures():
        if not structure.reduced:
            continue
        reduced, full = derive(structure), derive(Structure(True, structure.bridge, False))
        initial = (4 + q.aspect) ** 2 * q.initial_turning + sp.Rational(
            32, 5
        ) * q.initial_spin  # L/(m a^2 Omega) at first
        eliminated = {q.spin: (initial - q.orbital_momentum) * sp.Rational(5, 32)}
        rates, full_rates = (model.by_state("right_hand_side") for model in (reduced, full))

        yield from (filled(full_rates[s], MIDGAP).subs(eliminated) - rate for s, rate in rates.items())
        # the eliminated spin has the rate of the full equations
        turned = eliminated[q.spin].diff(q.orbital_momentum) * rates[q.orbital_momentum]
        yield turned - filled(full_rates[q.spin], MIDGAP).subs(eliminated)
        names = ("events", "energies", "outputs", "effective_potential", "inward_force", "turning_rate", "start")
        yield from special_case(reduced, names, full, methodcaller("subs", eliminated))


@check("head-on limit", "oblique equations at zero rotation are the head-on ones")
def head_on_is_oblique_at_rest() -> Evidence:
    """An oblique doublet without rotation follows the head-on equations, and does not start to rotate."""
    still = {q.orbital_momentum: 0, q.spin: 0, q.beta: 0}
    for head_on in structures():
        if head_on.oblique:
            continue
        narrow, wide = derive(head_on), derive(Structure(True, head_on.bridge, head_on.strings))
        rates = wide.by_state("right_hand_side")
        yield from (rates[s].subs(still) for s in wide.states if s not in narrow.states)
        names = ["right_hand_side", "events", "energies", "energy_rates", "inward_force", "outputs"]
        names += ["effective_potential"] if "effective_potential" in wide else []  # not for rotating strings
        yield from special_case(narrow, names, wide, methodcaller("subs", still))


_TURNING = (q.orbital_momentum, q.spin, q.partner_spin)
_EVEN = ("inward_force", "events", "energies", "energy_rates")
_ATTRACTED = Structure(oblique=True, bridge=True, strings=False, attraction=True)


@check("reflection", "J, xi -> -J, -xi reverses their rates and leaves all else")
def mirror() -> Evidence:
    """With every rotation reversed, rates of rotations are reversed, and gap, forces, energies and margins the same."""
    for structure in (_ATTRACTED, replace(_ATTRACTED, partner="pair")):
        model = derive(structure)
        reversed_ = {state: -state for state in model.states if state in _TURNING}
        names = {function.name for function in model.functions}
        for name in ("right_hand_side", *(quantity for quantity in _EVEN if quantity in names)):
            for key, value in model[name].outputs:
                result = model.expanded(value, SIZES)
                sign = -1 if name == "right_hand_side" and key in {state.name for state in reversed_} else 1
                yield result - sign * result.subs(reversed_, simultaneous=True)
