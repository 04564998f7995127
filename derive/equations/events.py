"""Initial state, event functions, and the jump of the state at a rebound with its energy loss."""

from collections.abc import Callable

import sympy as sp

from ..physics.law import slot_call
from ..physics.partners import rotation
from ..physics.structure import Structure
from ..vocabulary import quantities as q
from . import friction, terms
from .automaton import CONTACTS, EVENTS, Event
from .intermediates import inward_force

CONTACT_GAPS = {criterion.word: q.VOCABULARY[criterion.limit].symbol for criterion in CONTACTS}
contact_gap = sp.Max(*CONTACT_GAPS.values())  # gap at which the solids meet


def start(structure: Structure) -> dict[sp.Symbol, sp.Expr]:
    """State at initial contact: closing at v0, with the rotation of the line of centres and the spins of the impact."""
    touching: dict[sp.Symbol, sp.Expr] = {q.gap: sp.Integer(1), q.normal_velocity: sp.Integer(-1)}
    if structure.partner:
        return touching | dict(rotation(structure).start)
    return (
        touching
        | terms.clocks(structure)
        | {q.orbital_momentum: (4 + q.aspect) ** 2 * q.initial_turning, q.spin: q.initial_spin, q.beta: sp.Integer(0)}
    )


# What the events of the table watch, and the targets that are no groups
SERIES: dict[str, Callable[[Structure], sp.Expr]] = {
    "gap": lambda _: q.gap,
    "normal_velocity": lambda _: q.normal_velocity,
    "glass_clearance": lambda _: q.glass_number - slot_call("glass", "pressure", q.gap, -q.normal_velocity),
    "acceleration": lambda structure: -inward_force(structure),
    "slip": lambda _: friction.DRY_SLIP,
    "grip_backward": lambda _: friction.GRIP - friction.HOLDING_FORCE,
    "grip_forward": lambda _: friction.GRIP + friction.HOLDING_FORCE,
    "rotation": lambda _: q.beta,
    "orbital_momentum": lambda _: q.orbital_momentum,
}
_TARGETS: dict[str, Callable[[Structure], sp.Expr]] = {
    "": lambda _: sp.Integer(0),
    "rupture": lambda structure: q.rupture_gap if structure.bridge else sp.Integer(1),
    "film edge": lambda _: sp.Integer(1),
    "tangential edge": lambda _: slot_call("shear", "edge", q.aspect),
    "half turn": lambda _: sp.pi,
}
TARGET_GROUPS = tuple(
    dict.fromkeys(q.VOCABULARY[event.target].symbol for event in EVENTS if event.target in q.VOCABULARY)
)


def events(structure: Structure) -> dict[str, sp.Expr]:
    """Event functions by name, each positive before its event (but for the sign of what its direction follows)."""
    present = [event for event in EVENTS if structure.has(*event.structures)]
    return {name: _function(event, name, structure) for event in present for name in event.functions}


def _function(event: Event, name: str, structure: Structure) -> sp.Expr:
    target = CONTACT_GAPS.get(name) or (
        _TARGETS[event.target](structure) if event.target in _TARGETS else q.VOCABULARY[event.target].symbol
    )
    margins = (sp.expand(event.direction * (SERIES[series](structure) - target)) for series in event.series)
    return sp.Min(*margins)  # of several, the first to vanish is the event; a product would be positive beyond both


def rebound(states: tuple[sp.Symbol, ...]) -> dict[sp.Symbol, sp.Expr]:
    """State just after a rebound: u -> -e_dry u; the other states are continuous."""
    return {state: -q.e_dry * q.normal_velocity if state == q.normal_velocity else state for state in states}


def rebound_loss(structure: Structure) -> sp.Expr:
    """Energy lost in a rebound, over m v0^2."""
    return sp.Rational(1, 2) * q.normal_velocity**2 * (1 - q.e_dry**2) * terms.mass(structure)
