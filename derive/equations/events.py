"""Initial state, event functions, and the jump of the state at a rebound with its energy loss."""

from __future__ import annotations

import sympy as sp

from ..physics.laws import slot_call
from ..physics.partners import rotation
from ..physics.structure import Structure
from ..vocabulary import quantities as q
from . import friction
from .automaton import CONTACTS
from .intermediates import inward_force

CONTACT_GAPS = {each.word: q.VOCABULARY[each.limit].symbol for each in CONTACTS}
contact_gap = sp.Max(*CONTACT_GAPS.values())  # gap at which the solids meet


def start(structure: Structure) -> dict[sp.Symbol, sp.Expr]:
    """State at initial contact: closing at v0, with the rotation of the line of centres and the spins of the impact."""
    touching: dict[sp.Symbol, sp.Expr] = {q.gap: sp.Integer(1), q.normal_velocity: sp.Integer(-1)}
    if structure.partner:
        return touching | dict(rotation(structure).start)
    return touching | {
        q.orbital_momentum: (4 + q.aspect) ** 2 * q.initial_turning,
        q.spin: q.initial_spin,
        q.beta: sp.Integer(0),
    }


def events(structure: Structure) -> dict[str, sp.Expr]:
    """Event functions by name, each positive before its event."""
    functions: dict[str, sp.Expr] = {
        "glass": q.glass_number - slot_call("glass", "pressure", q.gap, -q.normal_velocity),
        **{word: q.gap - limit for word, limit in CONTACT_GAPS.items()},
        "turning": q.normal_velocity,
        "rupture": (q.rupture_gap if structure.bridge else 1) - q.gap,
    }
    if structure.bridge and not structure.spread:
        functions["film_edge"] = 1 - q.gap
    if structure.oblique:
        functions["tangential_edge"] = slot_call("shear", "edge", q.aspect) - q.gap
    if structure.oblique and structure.partner != "wall":  # beside a wall there is no centrifugal force
        functions["release"] = inward_force(structure)
    if structure.friction and structure.partner != "space":
        functions["slipping"] = friction.DRY_SLIP
        functions["rolling"] = friction.GRIP - sp.Abs(friction.HOLDING_FORCE)  # negative also beyond release
    if structure.oblique and structure.strings:
        functions["half_turn"] = sp.pi - q.beta
        functions["unwinding"] = q.orbital_momentum
    return functions


def rebound(states: tuple[sp.Symbol, ...]) -> dict[sp.Symbol, sp.Expr]:
    """State just after a rebound: u -> -e_dry u; the other states are continuous."""
    return {state: -q.e_dry * q.normal_velocity if state == q.normal_velocity else state for state in states}


def rebound_loss() -> sp.Expr:
    """Energy lost in a rebound, over m v0^2."""
    return sp.Rational(1, 2) * q.normal_velocity**2 * (1 - q.e_dry**2)
