"""Friction of the dry contact: the emitted impulse, its loss and the force of resting contact against the equations."""

from dataclasses import replace

import sympy as sp

from ..equations.friction import COMPLIANCE, DRY_SLIP, DRY_SLIPS, GRIP, IMPULSE, LEAST_DIRECTION, ROLLING, SLIDING
from ..equations.intermediates import MOMENTUM
from ..equations.model import Model, derive
from ..physics.contact_friction import beside_wall, equal_spheres, unequal_spheres
from ..physics.forces import SHEAR
from ..physics.law import filled
from ..physics.mechanics import arm
from ..physics.partners.bodies import CENTRES
from ..physics.partners.pair import LEVER, ORBITAL_RATE, PARTNER_RADIUS, RADIUS
from ..physics.partners.space import PARTNER_SLIPS, PARTNER_TWIST, SLIPS, TWIST
from ..physics.partners.vectors import dot, on_the_sphere
from ..physics.structure import Partner, Structure
from ..vocabulary import quantities as q
from .base import MIDGAP, Check, Evidence, check, checks, nonnegative, vanishing

_PARTNERS: tuple[Partner, ...] = ("", "pair", "wall")
_TURNING: tuple[Partner, ...] = ("", "pair", "space")  # partners beside which the line of centres turns
_FREE = tuple(Structure(True, False, False, partner=partner, friction="solid") for partner in _PARTNERS)
_share, _beyond = sp.Symbol("share", positive=True), sp.Symbol("z", nonnegative=True)


def _after(model: Model, expression: sp.Expr) -> sp.Expr:
    """An expression in the states just after `IMPULSE`."""
    jump = model.by_state("rubbed")
    return model.expanded(expression).subs(jump, simultaneous=True)


def _kinetic(model: Model) -> sp.Expr:
    return model.expanded(model["energies"]["kinetic"])


@check("friction: effective mass", "2 m/7 for spheres: equal, unequal, beside a wall (arm 2a)")
def effective_mass() -> Evidence:
    """With the lever arm on the surface, spheres answer a tangential impulse with 2/7 of their reduced mass."""
    answers = (equal_spheres(), unequal_spheres(), beside_wall())
    yield from [answer.compliance.subs({arm: 2 * q.a, LEVER: 1}) - sp.Rational(7, 2) / q.m for answer in answers]


@check("friction: sticking", "v_s' = -beta_0 v_s after the emitted impulse, for any lever arm")
def sticking_reverses_the_slip() -> Evidence:
    """The impulse that sticks leaves -beta_0 times the slip."""
    for structure in _FREE:
        model = derive(structure)
        sticking = model.expanded(model["dry_slip"]["sticking"])
        slip = model.expanded(DRY_SLIP)
        yield _after(model, DRY_SLIP).subs(IMPULSE, sticking) + q.beta_0 * slip


@check("friction: energy", "kinetic energy before - after = friction_loss, for any impulse")
def energy_is_booked() -> Evidence:
    """Any impulse takes from the kinetic energy what `friction_loss` says."""
    for structure in _FREE:
        model = derive(structure)
        kinetic, lost = _kinetic(model), model.expanded(model["friction_loss"]["dry_friction"])
        yield kinetic - _after(model, kinetic) - lost


@check("friction dissipates", "friction_loss >= 0 for any part of the impulse that sticks and 0 <= beta_0 <= 1")
def never_gains() -> Evidence:
    """An impulse of at most the one that sticks dissipates, for 0 <= beta_0 <= 1."""
    lost = derive(_FREE[0])["friction_loss"]["dry_friction"]
    impulse = _share * (1 + 1 / (1 + _beyond)) * DRY_SLIP / COMPLIANCE  # beta_0 = 1/(1 + z)
    yield nonnegative(sp.factor(lost.subs(IMPULSE, impulse)), _share, sp.Integer(1))


@check("friction: angular momentum", "an impulse keeps L (midgap arm)")
def angular_momentum() -> Evidence:
    """L is kept with the lever arm at mid-gap."""
    for structure in _FREE[:2]:
        model = derive(structure)
        yield filled(_after(model, MOMENTUM) - model.expanded(MOMENTUM), MIDGAP)


@checks
def resting_contact() -> tuple[Check, ...]:
    """In resting contact sliding takes what the ledger books, and rolling keeps the slip."""
    booked, held = [], []
    for structure in (_FREE[0], _FREE[2]):
        model = derive(structure)
        rates = model.by_state("resting_rates")
        taken = model["energy_rates"].by_name
        spent = model.expanded(taken["tangential_lubrication"] + taken["dry_friction"])
        sliding, rolling = {SLIDING: SLIDING, ROLLING: 0}, {SLIDING: 0, ROLLING: 1}
        still = {q.decay: sp.Integer(0)}  # beside a wall, since the rebound
        kinetic, slip = _kinetic(model), model.expanded(DRY_SLIP)
        changing = [s for s in model.states if rates[s] != 0]
        booked.append((sum(kinetic.diff(s) * rates[s] for s in changing) + spent).subs(sliding).subs(still))
        held.append(sum(slip.diff(s) * rates[s] for s in changing).subs(rolling).subs(still))
    return (
        vanishing("friction: sliding at rest", "d(kinetic)/dt = -(shear + friction power) in resting contact", booked),
        vanishing("friction: rolling at rest", "d(slip)/dt = 0 with the emitted force of rolling", held),
    )


@check("friction: reaction at rest", "dN/dt = -k N at rest without shear and strings, k finite")
def reaction_is_never_exhausted() -> Evidence:
    """Friction, proportional to the reaction N, is all that changes the rotation: N keeps its sign."""
    for partner in _TURNING:
        model = derive(Structure(True, True, False, attraction=True, partner=partner, friction="solid"))
        opened = ("bridge_force", "attraction_force", GRIP.name)
        rates = model.by_state("resting_rates", opened)
        reaction = model.expanded(model["inward_force"]["inward_force"], opened)
        changing = [s for s in model.states if rates[s] != 0]
        change = sp.Add(*(reaction.diff(s) * rates[s].subs(SHEAR, 0) for s in changing))
        if partner == "space":
            change = on_the_sphere(change.subs(GRIP, 0), q.normal, q.orbital_momenta)
        yield change.subs(GRIP, 0)
        share = sp.cancel(model.expanded(GRIP, opened[:2]) / reaction)
        yield from (share.diff(s) for s in model.states)


@checks
def in_space() -> tuple[Check, ...]:
    """The slip lies across n, and the impulse along it, within the cone, with the plane's answer in each component.

    Energy and angular momentum are those of the plane for each component, so what is shown there holds in space.
    """
    model, pair = derive(replace(_FREE[1], partner="space")), derive(_FREE[1])
    jump, planar = (form["rubbed"].by_name for form in (model, pair))
    midgap = {LEVER: dict(model.definitions)[LEVER]}
    twist = [RADIUS * TWIST + PARTNER_RADIUS * PARTNER_TWIST]
    slips = [dict(model.definitions)[symbol] for symbol in DRY_SLIPS]
    flat = dict(pair.definitions)[DRY_SLIP].subs(midgap)
    size, residuals = sp.sqrt(dot(DRY_SLIPS, DRY_SLIPS) + LEAST_DIRECTION**2), []
    twists = {TWIST: dot(SLIPS, q.normal), PARTNER_TWIST: dot(PARTNER_SLIPS, q.normal)}
    across = on_the_sphere(dot(slips, q.normal).subs(twists), q.normal, q.orbital_momenta)
    planes = {q.orbital_momentum: q.orbital_momenta, q.spin: q.spins, q.partner_spin: q.partner_spins}
    for k, slip in enumerate(slips):
        rate = SLIPS[k] + q.spins[k]
        of_plane = {ORBITAL_RATE: rate, q.spin: q.spins[k], q.partner_spin: rate - PARTNER_SLIPS[k]}
        expected = sp.expand(flat.subs(of_plane, simultaneous=True) - midgap[LEVER] * twist[0] * q.normal[k])
        residuals.append((slip - expected).subs(CENTRES, RADIUS + PARTNER_RADIUS))
        for state, vector in planes.items():
            change = (planar[state.name] - state) * DRY_SLIPS[k] / size
            residuals.append(jump[vector[k].name] - vector[k] - change)
    margin = sp.together(1 - dot(DRY_SLIPS, DRY_SLIPS) / size**2)
    return (
        vanishing("friction in space: direction", "the slip lies across the line of centres", [across]),
        vanishing("friction in space: answer", "each component of slip and impulse is the plane's", residuals),
        Check("friction in space: cone", "|impulse| <= Coulomb's limit", margin.is_nonnegative, str(margin)),
    )
