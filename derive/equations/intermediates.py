"""Named intermediates of a structure by their emitted names, and the rates of its states per v0/x0 in terms of them."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import sympy as sp

from ..physics.forces import TANGENTIAL, force_laws, scaled_strings
from ..physics.law import Definition, slot_call
from ..physics.mechanics import F_c, F_n, F_t, F_w, M_beta, M_x, S_n, S_t, arm, doublet_inertia, equations_of_motion
from ..physics.partners import rotation, space
from ..physics.partners.pair import PARTNER_INERTIA, SPIN_INERTIA
from ..physics.pendulum import offset_squared
from ..physics.scaling import DISTANCE, INERTIA, nondimensional
from ..physics.structure import Structure
from ..vocabulary import quantities as q
from . import terms
from .invariants import Invariant

ORBITAL_RATE, SLIP = sp.symbols("orbital_rate slip", real=True)
FILM_FORCE, BRIDGE_FORCE, SHEAR_FORCE = sp.symbols("film_force bridge_force shear_force", real=True)
STRING_PULL, STRING_SIDEWAYS, CENTRIFUGAL_FORCE = sp.symbols("string_pull string_sideways centrifugal_force", real=True)
ATTRACTION_FORCE = sp.Symbol("attraction_force", real=True)
LEVER, INERTIA_RATIO = sp.symbols("lever inertia_ratio", positive=True)
MOMENTUM = sp.Symbol("momentum", real=True)


Conserved = tuple[Invariant, sp.Expr]  # an invariant and its initial value


def intermediates(structure: Structure, conserved: Sequence[Conserved] = ()) -> tuple[Definition, ...]:
    """Every named intermediate of `structure`, in the order of the derivation.

    Arguments:
        conserved: the invariant that eliminates the spin of a reduced structure, and its initial value; in space one
            for each component.
    """
    laws = force_laws(structure.spread)
    definitions: list[Definition] = [(DISTANCE, 4 + q.aspect * q.gap)]
    if structure.partner == "space" and conserved:
        definitions = list(space.definitions(_eliminated(conserved)))
    elif structure.partner:
        definitions = list(rotation(structure).definitions)
    elif structure.oblique:
        definitions += _rotation(conserved[0] if conserved else None)
        slip_form = nondimensional(laws[F_t] / TANGENTIAL)
        definitions.append((SHEAR_FORCE, sp.factor(by_orbital_rate(slip_form)).subs(ORBITAL_RATE - q.spin, SLIP)))
        definitions.append((CENTRIFUGAL_FORCE, by_orbital_rate(nondimensional(q.m * q.r * q.omega**2 / INERTIA))))
    acting = [(FILM_FORCE, F_n, True), (BRIDGE_FORCE, F_c, structure.bridge)]
    acting.append((ATTRACTION_FORCE, F_w, structure.attraction))
    definitions += [(name, nondimensional(laws[force] / INERTIA)) for name, force, acts in acting if acts]
    if structure.strings:
        pull, sideways, swing = scaled_strings(structure.oblique)
        definitions += [(offset_squared, swing), (STRING_PULL, pull)]
        definitions += [(STRING_SIDEWAYS, sideways)] if structure.oblique else []
    if structure.oblique and not structure.reduced and not structure.partner:
        definitions.append((LEVER, slot_call("arm", "lever", DISTANCE)))
    return (*definitions, *terms.definitions(structure))


def _eliminated(conserved: Sequence[Conserved]) -> space.Eliminated:
    """The components of L, and those of the partner's spin that they give."""
    sizes = dict(space.sizes())
    names = {sp.factor(sizes[name]): name for name in (SPIN_INERTIA, PARTNER_INERTIA)}  # moments of inertia by name
    momenta, spun = [], []
    for (invariant, value), momentum, partner_spin in zip(conserved, space.MOMENTA, q.partner_spins, strict=True):
        named = tuple((state, names.get(sp.factor(factor), factor)) for state, factor in invariant.coefficients)
        momenta.append((momentum, value))
        spun.append((partner_spin, sp.expand(Invariant(named).solved(partner_spin, momentum))))
    return (*momenta, *spun)


def _rotation(conserved: Conserved | None) -> list[Definition]:
    """Orbital rate, angular momentum, the spin if eliminated, slip and inertia."""
    definitions: list[Definition] = [(ORBITAL_RATE, nondimensional(q.omega / q.rate_scale))]
    if conserved is not None:
        invariant, value = conserved
        definitions.append((MOMENTUM, value))
        definitions.append((q.spin, invariant.solved(q.spin, MOMENTUM)))
    else:
        definitions.append(
            (MOMENTUM, nondimensional(equations_of_motion().angular_momentum / (q.m * q.a**2 * q.rate_scale)))
        )
    definitions.append((SLIP, ORBITAL_RATE - q.spin))
    definitions.append((INERTIA_RATIO, nondimensional(doublet_inertia() / (q.m * q.a**2))))
    return definitions


def by_orbital_rate(expression: sp.Expr) -> sp.Expr:
    """The nondimensional `expression` with the orbital angular momentum replaced by the orbital rate."""
    return expression.subs(q.orbital_momentum, ORBITAL_RATE * DISTANCE**2)


def forces(structure: Structure) -> dict[sp.Symbol, sp.Expr]:
    """The named intermediates of equal spheres with the same forces along the line of centres, none eliminated."""
    equal = replace(structure, reduced=False, partner="", friction="")
    return dict(intermediates(equal))


def attractions(structure: Structure, at: sp.Expr) -> sp.Expr:
    """The attractions at a gap, over m v0^2/x0."""
    named = forces(structure)
    return sp.Add(*(named[force].subs(q.gap, at) for force in (BRIDGE_FORCE, ATTRACTION_FORCE) if force in named))


@cache
def rates(structure: Structure) -> dict[sp.Symbol, sp.Expr]:
    """Time derivatives of the states per v0/x0, from the equations of motion."""
    motion = equations_of_motion(terms=structure.terms is not None)
    own = terms.named(structure) if structure.terms is not None else {}
    strings = int(structure.strings)
    named = {F_n: FILM_FORCE, F_c: BRIDGE_FORCE * int(structure.bridge), S_n: STRING_PULL * strings}
    named |= {F_w: ATTRACTION_FORCE * int(structure.attraction)}
    normal = {force: INERTIA * value for force, value in named.items()}
    tangential = {F_t: TANGENTIAL * SHEAR_FORCE, S_t: TANGENTIAL * STRING_SIDEWAYS * strings}
    rate: dict[sp.Symbol, sp.Expr] = {q.gap: nondimensional(q.u / q.v0)}
    mass = terms.mass(structure)
    acceleration = motion.separation_acceleration.subs(normal)
    if own:
        acceleration = sp.expand(sp.cancel(acceleration * (1 + M_x / q.m))).subs(own)
    pushed = sp.expand(nondimensional(acceleration.subs(q.omega, 0) * q.x0 / q.v0**2))
    if not structure.oblique:
        return rate | {q.normal_velocity: pushed / mass}
    if structure.partner:
        beside = rotation(structure)
        return rate | {q.normal_velocity: (beside.centrifugal + pushed) / mass} | dict(beside.rates)
    # the centrifugal term has a name of its own: the remainder is minus the forces
    centrifugal = sp.expand(acceleration - acceleration.subs(q.omega, 0))
    assert sp.expand(centrifugal - q.r * q.omega**2) == 0
    rate[q.normal_velocity] = (CENTRIFUGAL_FORCE + pushed) / mass
    pull_round = motion.orbital_momentum_rate
    if own.get(M_beta):  # the state is m r^2 omega, without the added inertia
        pull_round = q.m * (q.r**2 * motion.orbital_acceleration + 2 * q.r * q.u * q.omega)
        pull_round = sp.simplify(pull_round.subs(M_beta, own[M_beta]))
    pull_round = pull_round.subs(tangential).subs(own) / (q.m * q.a**2 * q.rate_scale) * q.x0 / q.v0
    rate[q.orbital_momentum] = nondimensional(pull_round)
    if not structure.reduced:
        spin_up = motion.spin_acceleration.subs(own).subs(tangential).subs(arm, q.a * LEVER)
        rate[q.spin] = nondimensional(spin_up * q.x0 / (q.v0 * q.rate_scale))
    if structure.strings:
        rate[q.beta] = turning_rate()
    return rate | dict.fromkeys(terms.clocks(structure), turning_rate())


def resting_rates(structure: Structure) -> dict[sp.Symbol, sp.Expr]:
    """Rates in resting contact: the gap is held, the rotation goes on."""
    return {**rates(structure), q.gap: sp.Integer(0), q.normal_velocity: sp.Integer(0)}


def turning_rate(structure: Structure | None = None) -> sp.Expr | None:
    """Angular velocity of the line of centres; None if it cannot turn."""
    if structure is not None and structure.partner:
        return rotation(structure).turning
    return by_orbital_rate(nondimensional(q.omega * q.x0 / q.v0))


def inward_force(structure: Structure) -> sp.Expr:
    """Sum of all normal forces except the film's, positive inward: positive if a doublet at rest stays in contact."""
    return -terms.at_rest(structure, rates(structure)[q.normal_velocity].subs(FILM_FORCE, 0))
