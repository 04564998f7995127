"""Friction of the dry contact in the states of a structure: the impulse of a rebound, and the force while it rests."""

import sympy as sp

from ..physics.contact_friction import rubbing
from ..physics.law import Definition
from ..physics.partners import space, wall
from ..physics.partners.bodies import CENTRES
from ..physics.partners.pair import LEVER
from ..physics.partners.vectors import dot, named
from ..physics.scaling import DISTANCE
from ..physics.structure import Structure
from ..vocabulary import quantities as q
from . import terms
from .automaton import CREEP
from .intermediates import ORBITAL_RATE, rates

IMPULSE = sp.Symbol("impulse", real=True)
"""A tangential impulse, which an engine passes to the emitted functions: the smaller of the two of `at_rebound`."""
# Flags of resting contact, named as in emitted code: the sign of the slip (0: it does not slide), and whether it rolls
SLIDING, ROLLING = sp.symbols("sliding rolling", real=True)
DRY_SLIP, HOLDING_FORCE, DRY_FORCE = sp.symbols("dry_slip holding_force dry_force", real=True)
DRY_SLIPS = named("dry_slip")
LEAST_DIRECTION = sp.Float("1e-150")  # a smaller slip has no direction, so that there is no tangential impulse
COMPLIANCE, GRIP = sp.symbols("tangential_compliance grip", positive=True)


def definitions(structure: Structure, reaction: sp.Expr) -> tuple[Definition, ...]:
    """Named intermediates of a structure with friction, in order.

    Arguments:
        reaction: normal force of resting contact, over m v0^2/x0.
    """
    contact = rubbing(structure.partner)
    if structure.partner == "space":
        return (
            (LEVER, DISTANCE / CENTRES),  # at mid-gap
            (COMPLIANCE, contact.compliance),
            *zip(DRY_SLIPS, space.surface_slips(), strict=True),
            (DRY_SLIP, sp.sqrt(dot(DRY_SLIPS, DRY_SLIPS))),
            (GRIP, q.mu_f * contact.grip * reaction),
        )
    held = _smooth_rates(structure)
    slip = contact.slip.subs(ORBITAL_RATE, q.orbital_momentum / DISTANCE**2)
    slipping = sp.Add(*(slip.diff(state) * rate for state, rate in held.items()))  # the gap is held
    return (
        (COMPLIANCE, contact.compliance),
        (DRY_SLIP, contact.slip),
        (GRIP, q.mu_f * contact.grip * reaction),
        (HOLDING_FORCE, slipping / COMPLIANCE),
        (DRY_FORCE, SLIDING * GRIP + ROLLING * HOLDING_FORCE),
    )


_ZERO = sp.Integer(0)


def _smooth_rates(structure: Structure) -> dict[sp.Symbol, sp.Expr]:
    """Rates of the tangential states in resting contact without friction."""
    return wall.friction_rates()[1] if structure.partner == "wall" else rates(structure)


def at_rebound(structure: Structure) -> dict[str, sp.Expr]:
    """Slip before a rebound, the impulse that would make it stick, and Coulomb's limit of its magnitude.

    Where the doublet comes to rest instead (`rest_most`), the contact has stopped the approach only: the rebounds that
    are left out press as hard in the mean as resting contact, which begins at once.
    """
    stopping = q.mu_f * rubbing(structure.partner).grip * terms.mass(structure) * -q.normal_velocity
    return {
        "slip": DRY_SLIP,
        "sticking": (1 + q.beta_0) * DRY_SLIP / COMPLIANCE,
        "most": (1 + q.e_dry) * stopping,
        "rest_most": stopping,
    }


def rubbed(structure: Structure, states: tuple[sp.Symbol, ...]) -> dict[sp.Symbol, sp.Expr]:
    """State just after `IMPULSE`; the normal velocity is as before."""
    contact = rubbing(structure.partner)
    if structure.partner == "space":
        pushed = _along_the_slip(IMPULSE, LEAST_DIRECTION)
        return {state: state + pushed.get(state, _ZERO) for state in states}
    if structure.partner == "wall":
        begun = {q.last_slide: q.slide, q.last_roll: q.roll}
        moved = {last: state + contact.changes[state] * IMPULSE for last, state in begun.items()}
        return {**{state: state for state in states}, q.decay: _ZERO, **moved}
    return {state: state + contact.changes.get(state, _ZERO) * IMPULSE for state in states}


def _along_the_slip(size: sp.Expr, least: sp.Expr | float) -> dict[sp.Symbol, sp.Expr]:
    """Changes of the vectors in space by an impulse, or a force, of this size against the slip.

    Where the slip is less than `least`, they are smaller in the ratio of the two.
    """
    answer = rubbing("space").changes
    vectors = ((q.orbital_momentum, q.orbital_momenta), (q.spin, q.spins), (q.partner_spin, q.partner_spins))
    share = size / sp.sqrt(dot(DRY_SLIPS, DRY_SLIPS) + least**2)
    return {
        state: answer[planar] * share * slip
        for planar, vector in vectors
        for state, slip in zip(vector, DRY_SLIPS, strict=True)
    }


def loss(structure: Structure) -> sp.Expr:
    """Energy that `IMPULSE` takes from the tangential motion, over m v0^2: the impulse times the mean slip."""
    return rubbing(structure.partner).energy * IMPULSE * (DRY_SLIP - COMPLIANCE * IMPULSE / 2)


def resting_rates(structure: Structure) -> dict[sp.Symbol, sp.Expr]:
    """Rates of the states in resting contact, with friction."""
    contact, held = rubbing(structure.partner), _smooth_rates(structure)
    if structure.partner == "space":
        pushed = _along_the_slip(SLIDING * GRIP, CREEP)
        return {**{s: rate + pushed.get(s, _ZERO) for s, rate in held.items()}, q.gap: _ZERO, q.normal_velocity: _ZERO}
    if structure.partner == "wall":  # since the rebound, `decay` is zero
        begun = {q.last_slide: q.slide, q.last_roll: q.roll}
        moved = {last: held[state] + contact.changes[state] * DRY_FORCE for last, state in begun.items()}
        return {q.gap: _ZERO, q.normal_velocity: _ZERO, q.decay: _ZERO, **moved}
    rubbing_rates = {state: rate + contact.changes.get(state, _ZERO) * DRY_FORCE for state, rate in held.items()}
    return {**rubbing_rates, q.gap: _ZERO, q.normal_velocity: _ZERO}


def resting_power(structure: Structure) -> sp.Expr:
    """Energy taken by sliding in resting contact per x0/v0, over m v0^2."""
    contact = rubbing(structure.partner)
    if structure.partner == "space":
        square = dot(DRY_SLIPS, DRY_SLIPS)
        return contact.energy * SLIDING * GRIP * square / sp.sqrt(square + CREEP**2)
    return contact.energy * SLIDING * GRIP * DRY_SLIP
