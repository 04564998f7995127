"""The functions of a structure in the order of emission: motion, changes at events, ledger, margins, least energy.

Each has the docstring of its emitted form; what it computes is in `rates`, `events`, `friction`, `observables` and
`certificates`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from ..physics.partners import rotation
from ..physics.structure import Structure
from ..vocabulary.quantities import beta, normal_velocity
from . import friction, observables
from .certificates import approach, attraction, orbital_momentum, pendulum, spin_down
from .events import events, rebound, rebound_loss, start
from .rates import inward_force, rates, resting_rates, turning_rate

Values = Mapping[str, sp.Expr]


@dataclass(frozen=True)
class ModelFunction:
    """A function of state and groups to be emitted; `outputs` are (name, expression) pairs."""

    name: str
    doc: str
    outputs: tuple[tuple[str, sp.Expr], ...]
    regional: bool = False  # depends on the flags of film and shear
    given: tuple[sp.Symbol, ...] = ()  # further arguments

    @cached_property
    def by_name(self) -> dict[str, sp.Expr]:
        return dict(self.outputs)

    def __getitem__(self, output: str) -> sp.Expr:
        return self.by_name[output]


def _function(
    name: str, doc: str, values: Values, *, regional: bool = False, given: tuple[sp.Symbol, ...] = ()
) -> ModelFunction:
    return ModelFunction(name, doc, tuple(values.items()), regional, given)


def functions(structure: Structure, states: tuple[sp.Symbol, ...]) -> tuple[ModelFunction, ...]:
    """Every function of `structure`, in the order of emission."""
    return (
        *_motion(structure, states),
        *_changes(structure, states),
        *_ledger(structure),
        *_certificates(structure),
        *_least_energy(structure, states),
    )


def _by_state(states: tuple[sp.Symbol, ...], values: Mapping[sp.Symbol, sp.Expr]) -> Values:
    return {state.name: values[state] for state in states}


def _motion(structure: Structure, states: tuple[sp.Symbol, ...]) -> Iterator[ModelFunction]:
    yield _function(
        "right_hand_side", "Rates of the states per v0/x0.", _by_state(states, rates(structure)), regional=True
    )
    if structure.oblique:
        rubs = bool(structure.friction)
        yield _function(
            "resting_rates",
            "Rates of the states per v0/x0 in resting contact: the gap is held, the rotation goes on.",
            _by_state(states, friction.resting_rates(structure) if rubs else resting_rates(structure)),
            regional=True,
            given=(friction.SLIDING, friction.ROLLING) if rubs else (),
        )
        if (turning := turning_rate(structure)) is not None:
            doc = "Angular velocity of the line of centres, rad per x0/v0 (without strings, the angle is no state)."
            yield _function("turning_rate", doc, {beta.name: turning})
    doc = "Sum of the normal forces except the film's, over m v0^2/x0: positive inward."
    yield _function("inward_force", doc, {"inward_force": inward_force(structure)})


def _changes(structure: Structure, states: tuple[sp.Symbol, ...]) -> Iterator[ModelFunction]:
    """Event functions, the state after a rebound, and the initial state."""
    yield _function(
        "events",
        "Event functions, each positive before its event: rebound criteria while closing, `turning` the normal "
        "velocity (negative while closing), `release` in resting contact.",
        events(structure),
        regional=bool(structure.friction),
    )
    doc = "State just after a rebound: u -> -e_dry u; the other states are continuous."
    yield _function("rebound", doc, _by_state(states, rebound(states)))
    if structure.friction:
        yield from _friction(structure, states)
    yield _function("start", "State at initial contact.", _by_state(states, start(structure)))


def _friction(structure: Structure, states: tuple[sp.Symbol, ...]) -> Iterator[ModelFunction]:
    """Friction of the dry contact."""
    yield _function(
        "dry_slip",
        "Friction of a rebound that starts from this state: the slip of the surfaces, the impulse with which they "
        "stick, and the largest impulse, with which they slide, also where the doublet comes to rest.",
        friction.at_rebound(structure),
    )
    given = (friction.IMPULSE,)
    after = _by_state(states, friction.rubbed(structure, states))
    yield _function("rubbed", "State just after a tangential impulse.", after, given=given)
    doc = "Energy that a tangential impulse takes from this state, over m v0^2."
    yield _function("friction_loss", doc, {"dry_friction": friction.loss(structure)}, given=given)
    if structure.partner != "space":
        yield _function(
            "dry_forces",
            "Forces of resting contact, over the unit of the tangential impulse per x0/v0: Coulomb's limit, and "
            "the force that holds the surfaces together where they roll.",
            {"limit": friction.GRIP, "holding": friction.HOLDING_FORCE},
            regional=True,
        )


def _ledger(structure: Structure) -> Iterator[ModelFunction]:
    """Ledger of energy and angular momentum, and the results of a separated doublet."""
    yield _function("energies", "Energies of the state over m v0^2.", observables.energies(structure))
    yield _function(
        "energy_rates",
        "Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2.",
        observables.energy_rates(structure),
        regional=True,
        given=(friction.SLIDING,) if structure.friction else (),
    )
    doc = "Energy lost in a rebound that starts from this state, over m v0^2."
    yield _function("rebound_loss", doc, {"dry_contact": rebound_loss()})
    momentum = observables.angular_momentum(structure) if structure.oblique and not structure.reduced else None
    if momentum is not None:
        doc = "1 + the change of the angular momentum over its size at initial contact."
        yield _function("angular_momentum", doc, {"angular_momentum": momentum})
    doc = "Results for a separated doublet: restitutions, and rates over their scale."
    yield _function("outputs", doc, observables.outputs(structure))
    if structure.oblique:
        doc = "Relative velocity of the surfaces at the contact, at the lever arm of the shear, over a Omega."
        yield _function("surface_slip", doc, {"surface_slip": observables.surface_slip(structure)})


def _certificates(structure: Structure) -> Iterator[ModelFunction]:
    """Margins of the stick certificates."""
    if pendulum.admits(structure):
        yield _function(
            "pendulum_margins",
            "Margins of the pendulum certificate (lever arm at mid-gap): film < 0 and recoil < 0 exclude "
            "separation, with St impulse added unless outward < pull; rebound, beneath: of a gap and speed.",
            pendulum.margins(),
        )
    if attraction.admits(structure):
        yield _function(
            "attraction_margins",
            "Margins of the attraction certificate (lever arm at mid-gap, forces that decrease with the gap): "
            "hold > 0, escape < 0 and rebound < 0 exclude separation.",
            attraction.margins(structure),
        )
    if approach.admits(structure):
        yield _function(
            "approach_step",
            "Bounds over the next part of the film, from a gap and a bound of the closing speed there (the normal "
            "velocity): the part's end, the largest speed there and within it.",
            approach.step(),
        )
        if not structure.strings:
            doc = "Largest outward force before solid contact, over m v0^2/x0, for the rotation of this state."
            yield _function("approach_force", doc, {"outward": approach.outward(structure)})
    if orbital_momentum.admits(structure):
        yield _function(
            "orbital_margins",
            "Margins of the orbital-momentum certificate: slip omega - xi and J^2/(2 r^2) at this gap, and the "
            "slip energy for either lever arm; energies over m v0^2.",
            orbital_momentum.margins(structure),
        )
    if spin_down.admits(structure):
        yield _function(
            "spin_down_margins",
            "Margins of the spin-down certificate (lever arm at mid-gap, a shear that falls with the gap, L = 0): "
            "stays < 0 and rate > 0 exclude separation; momentum is |L| at initial contact beyond rounding error. "
            "So do apart < 0 and inside < 0 where J = 0.",
            spin_down.margins(structure),
        )


def _least_energy(structure: Structure, states: tuple[sp.Symbol, ...]) -> Iterator[ModelFunction]:
    """The least energy at an angular momentum, the state that has it, and bounds that follow from it."""
    if not (structure.oblique and structure.strings):  # rotating strings have no least-energy argument
        yield _function(
            "effective_potential",
            "Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope "
            "of the least energy along the gap, capillary work included.",
            observables.effective_potential(structure),
        )
        if structure.partner == "space":
            motion = rotation(structure)
            yield _function(
                "resting_bound",
                "Normal forces of a doublet in resting contact from now on, over m v0^2/x0: the largest "
                "centrifugal force, and the sum of the others, positive inward.",
                {"outward": motion.outward_at_most, "inward": inward_force(structure) + motion.centrifugal},
            )
            yield _function(
                "wobble",
                "Energy over m v0^2 of all motion but rotation as a rigid doublet across the line of centres, and "
                "twist.",
                {"wobble": normal_velocity**2 / 2 + motion.wobble},
            )
            yield _function(
                "precession",
                "Angular momentum over m a^2 Omega, and the rate per v0/x0, over its length, at which a rigid "
                "doublet turns about it.",
                motion.rigid_rotation,
            )
        else:
            doc = "The state with this least energy: no normal velocity, rigid rotation."
            yield _function("rigid_rotation", doc, _by_state(states, observables.rigid_rotation(structure)))
    if structure.partner == "wall":  # the energy of the motion along the wall cannot lead to separation
        yield _function(
            "escape_energy",
            "Kinetic energy over m v0^2 of the motion along the line of centres, the only one that can separate "
            "sphere and wall.",
            {"kinetic": normal_velocity**2 / 2},
        )
    if not structure.strings and not structure.partner:
        yield _function(
            "restitution_ceiling",
            "Upper bound of e_n^2 for separation at this gap, from the initial energy and angular momentum, "
            "without the work of attractions: 2 (W_c(x_f) - W_c(x0))/(m v0^2) is still to be subtracted.",
            observables.restitution_ceiling(structure),
        )
