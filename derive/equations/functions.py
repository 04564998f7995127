"""The functions of a structure in the order of emission: motion, changes at events, ledger, margins, least energy.

Each has the docstring of its emitted form; what it computes is in `rates`, `events`, `friction`, `observables` and
`certificates`.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Any

import sympy as sp

from ..physics.partners import rotation
from ..physics.partners.space import torque_coefficients
from ..physics.structure import Structure
from ..vocabulary import quantities as q
from . import friction, observables, terms
from .certificates.table import CERTIFICATES
from .events import events, rebound, rebound_loss, start
from .intermediates import FILM_FORCE, forces, inward_force, rates, resting_rates, turning_rate

Values = Mapping[str, sp.Expr]


@dataclass(frozen=True)
class ModelFunction:
    """A function of state and groups to be emitted; `outputs` are (name, expression) pairs.

    Arguments:
        regional: it depends on the flags of film and shear.
        further: its arguments beside states, groups, laws and flags.
        certificate: the name of the stick certificate whose margins it gives: emitted in C only.
    """

    name: str
    doc: str
    outputs: tuple[tuple[str, sp.Expr], ...]
    regional: bool = False
    further: tuple[sp.Symbol, ...] = ()
    certificate: str = ""

    @cached_property
    def by_name(self) -> dict[str, sp.Expr]:
        return dict(self.outputs)

    def __getitem__(self, output: str) -> sp.Expr:
        return self.by_name[output]


Emitted = Iterator[tuple[str, str, Values] | tuple[str, str, Values, Mapping[str, Any]]]
"""Name, docstring and outputs of functions, and what else of `ModelFunction` is not its default."""
_REGIONAL = {"regional": True}


def functions(structure: Structure, states: tuple[sp.Symbol, ...]) -> tuple[ModelFunction, ...]:
    """Every function of `structure`, in the order of emission."""
    parts = (
        _motion(structure, states), _changes(structure, states), _ledger(structure), _certificates(structure),
        _least_energy(structure, states),
    )  # fmt: skip
    return tuple(
        ModelFunction(name, doc, tuple(values.items()), **(more[0] if more else {}))
        for name, doc, values, *more in chain(*parts)
    )


def _by_state(states: tuple[sp.Symbol, ...], values: Mapping[sp.Symbol, sp.Expr]) -> Values:
    return {state.name: values[state] for state in states}


def _motion(structure: Structure, states: tuple[sp.Symbol, ...]) -> Emitted:
    yield "right_hand_side", "Rates of the states per v0/x0.", _by_state(states, rates(structure)), _REGIONAL
    if structure.oblique:
        held = friction.resting_rates(structure) if structure.friction else resting_rates(structure)
        doc = "Rates of the states per v0/x0 in resting contact: the gap is held, the rotation goes on."
        flags = (friction.SLIDING, friction.ROLLING) if structure.friction else ()
        yield "resting_rates", doc, _by_state(states, held), {**_REGIONAL, "further": flags}
        if (turning := turning_rate(structure)) is not None:
            doc = "Angular velocity of the line of centres, rad per x0/v0 (without strings, the angle is no state)."
            yield "turning_rate", doc, {q.beta.name: turning}
    doc = "Sum of the normal forces except the film's, over m v0^2/x0: positive inward."
    yield "inward_force", doc, {"inward_force": inward_force(structure)}
    if structure.partner == "space":
        doc = (
            "How a doublet whose line of centres is held answers: the film force over the normal velocity and the "
            "attractions, over m v0^2/x0 and v0, and the symmetric matrix that takes slips across the line of centres "
            "to torques, over m a^2 v0/x0."
        )
        held = {"resistance": forces(structure)[FILM_FORCE] / q.normal_velocity}
        held["attraction"] = inward_force(structure) + rotation(structure).centrifugal
        yield "held_response", doc, held | torque_coefficients(), _REGIONAL


def _changes(structure: Structure, states: tuple[sp.Symbol, ...]) -> Emitted:
    """Event functions, the state after a rebound, friction of the dry contact, and the initial state."""
    doc = (
        "Event functions, each positive before its event: rebound criteria while closing, `turning` the normal "
        "velocity (negative while closing), `release` in resting contact."
    )
    yield "events", doc, events(structure), {"regional": bool(structure.friction)}
    doc = "State just after a rebound: u -> -e_dry u; the other states are continuous."
    yield "rebound", doc, _by_state(states, rebound(states))
    if structure.friction:
        doc = (
            "Friction of a rebound that starts from this state: the slip of the surfaces, the impulse with which they "
            "stick, and the largest impulse, with which they slide, also where the doublet comes to rest."
        )
        yield "dry_slip", doc, friction.at_rebound(structure)
        further = {"further": (friction.IMPULSE,)}
        after = _by_state(states, friction.rubbed(structure, states))
        yield "rubbed", "State just after a tangential impulse.", after, further
        doc = "Energy that a tangential impulse takes from this state, over m v0^2."
        yield "friction_loss", doc, {"dry_friction": friction.loss(structure)}, further
        if structure.partner != "space":
            doc = (
                "Forces of resting contact, over the unit of the tangential impulse per x0/v0: Coulomb's limit, and "
                "the force that holds the surfaces together where they roll."
            )
            yield "dry_forces", doc, {"limit": friction.GRIP, "holding": friction.HOLDING_FORCE}, _REGIONAL
    yield "start", "State at initial contact.", _by_state(states, start(structure))


def _ledger(structure: Structure) -> Emitted:
    """Ledger of energy and angular momentum, and the results of a separated doublet."""
    yield "energies", "Energies of the state over m v0^2.", observables.energies(structure)
    doc = "Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2."
    sliding = (friction.SLIDING,) if structure.friction else ()
    yield "energy_rates", doc, observables.energy_rates(structure), {**_REGIONAL, "further": sliding}
    doc = "Energy lost in a rebound that starts from this state, over m v0^2."
    yield "rebound_loss", doc, {"dry_contact": rebound_loss(structure)}
    momentum = observables.angular_momentum(structure) if structure.oblique and not structure.reduced else None
    if momentum is not None:
        doc = "1 + the change of the angular momentum over its size at initial contact."
        yield "angular_momentum", doc, {"angular_momentum": momentum}
    doc = "Results for a separated doublet: restitutions, and rates over their scale."
    yield "outputs", doc, observables.outputs(structure)
    if structure.oblique:
        doc = "Relative velocity of the surfaces at the contact, at the lever arm of the shear, over a Omega."
        yield "surface_slip", doc, {"surface_slip": observables.surface_slip(structure)}


def _certificates(structure: Structure) -> Emitted:
    """Margins of the stick certificates."""
    for certificate in CERTIFICATES:
        if structure.terms is None and certificate.admits(structure):
            for name, doc, values in certificate.functions(structure):
                yield name, doc, values, {"certificate": certificate.name}


def _least_energy(structure: Structure, states: tuple[sp.Symbol, ...]) -> Emitted:
    """The least energy at an angular momentum, the state that has it, and bounds that follow from it."""
    barrier = structure.terms is None or structure.terms.admits_barrier
    if barrier and not (structure.oblique and structure.strings):  # rotating strings have no least-energy argument
        doc = (
            "Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope "
            "of the least energy along the gap, capillary work included."
        )
        yield "effective_potential", doc, observables.effective_potential(structure)
        if structure.partner != "space":
            doc = "The state with this least energy: no normal velocity, rigid rotation."
            yield "rigid_rotation", doc, _by_state(states, observables.rigid_rotation(structure))
    if structure.partner == "space":
        motion = rotation(structure)
        doc = (
            "Normal forces of a doublet in resting contact from now on, over m v0^2/x0: the largest "
            "centrifugal force, and the sum of the others, positive inward."
        )
        inward = terms.mass(structure) * inward_force(structure) + motion.centrifugal
        yield "resting_bound", doc, {"outward": motion.outward_at_most, "inward": inward}
        doc = "Energy over m v0^2 of all motion but rotation as a rigid doublet across the line of centres, and twist."
        yield "wobble", doc, {"wobble": q.normal_velocity**2 / 2 + motion.wobble}
        doc = (
            "Angular momentum over m a^2 Omega, and the rate per v0/x0, over its length, at which a rigid "
            "doublet turns about it."
        )
        yield "precession", doc, motion.rigid_rotation
    if structure.partner == "wall":  # the energy of the motion along the wall cannot lead to separation
        doc = (
            "Kinetic energy over m v0^2 of the motion along the line of centres, the only one that can separate "
            "sphere and wall."
        )
        yield "escape_energy", doc, {"kinetic": q.normal_velocity**2 / 2, **terms.stored(structure)}
    if structure.terms is None and not structure.strings and not structure.partner:
        doc = (
            "Upper bound of e_n^2 for separation at this gap, from the initial energy and angular momentum, "
            "without the work of attractions: 2 (W_c(x_f) - W_c(x0))/(m v0^2) is still to be subtracted."
        )
        yield "restitution_ceiling", doc, observables.restitution_ceiling(structure)
