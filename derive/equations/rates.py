"""Rates of the states per v0/x0, from the equations of motion."""

from __future__ import annotations

from functools import cache

import sympy as sp

from ..physics.forces import TANGENTIAL
from ..physics.mechanics import F_c, F_n, F_t, F_w, S_n, S_t, arm, equations_of_motion
from ..physics.partners import rotation
from ..physics.scaling import INERTIA, nondimensional
from ..physics.structure import Structure
from ..vocabulary import quantities as q
from .intermediates import (
    ATTRACTION_FORCE,
    BRIDGE_FORCE,
    CENTRIFUGAL_FORCE,
    FILM_FORCE,
    LEVER,
    SHEAR_FORCE,
    STRING_PULL,
    STRING_SIDEWAYS,
    by_orbital_rate,
)


@cache
def rates(structure: Structure) -> dict[sp.Symbol, sp.Expr]:
    """Time derivatives of the states per v0/x0, from the equations of motion."""
    motion = equations_of_motion()
    named = {
        F_n: FILM_FORCE,
        F_c: BRIDGE_FORCE if structure.bridge else 0,
        F_w: ATTRACTION_FORCE if structure.attraction else 0,
        S_n: STRING_PULL if structure.strings else 0,
    }
    named_tangential = {F_t: SHEAR_FORCE, S_t: STRING_SIDEWAYS if structure.strings else 0}
    normal = {force: INERTIA * value for force, value in named.items()}
    tangential = {force: TANGENTIAL * value for force, value in named_tangential.items()}
    rate: dict[sp.Symbol, sp.Expr] = {q.gap: nondimensional(q.u / q.v0)}
    acceleration = motion.separation_acceleration.subs(normal)
    if not structure.oblique:
        rate[q.normal_velocity] = sp.expand(nondimensional(acceleration.subs(q.omega, 0) * q.x0 / q.v0**2))
        return rate
    if structure.partner:
        beside = rotation(structure)
        forces = sp.expand(nondimensional(acceleration.subs(q.omega, 0) * q.x0 / q.v0**2))
        return rate | {q.normal_velocity: beside.centrifugal + forces} | dict(beside.rates)
    # the centrifugal term has a name of its own: the remainder is minus the forces
    centrifugal = sp.expand(acceleration - acceleration.subs(q.omega, 0))
    assert sp.expand(centrifugal - q.r * q.omega**2) == 0
    rate[q.normal_velocity] = CENTRIFUGAL_FORCE + sp.expand(
        nondimensional(acceleration.subs(q.omega, 0) * q.x0 / q.v0**2)
    )
    pull_round = motion.orbital_momentum_rate.subs(tangential) / (q.m * q.a**2 * q.rate_scale) * q.x0 / q.v0
    rate[q.orbital_momentum] = nondimensional(pull_round)
    if not structure.reduced:
        spin_up = motion.spin_acceleration.subs(tangential).subs(arm, q.a * LEVER)
        rate[q.spin] = nondimensional(spin_up * q.x0 / (q.v0 * q.rate_scale))
    if structure.strings:
        rate[q.beta] = turning_rate()
    return rate


def turning_rate(structure: Structure | None = None) -> sp.Expr | None:
    """Angular velocity of the line of centres; None if it cannot turn."""
    if structure is not None and structure.partner:
        return rotation(structure).turning
    return by_orbital_rate(nondimensional(q.omega * q.x0 / q.v0))


def inward_force(structure: Structure) -> sp.Expr:
    """Sum of all normal forces except the film's, positive inward: positive if a doublet at rest stays in contact."""
    return -(rates(structure)[q.normal_velocity].subs(FILM_FORCE, 0))
