"""From a structure to its nondimensional equations, events, jumps, ledger and outputs, ready to be emitted.

A model combines the results of `intermediates`, `rates`, `events` and `observables`: states, groups, slots, definitions
and functions, each with the docstring of its emitted form.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache

import sympy as sp

from ..physics.forces import FILM, SHEAR
from ..physics.laws import LAWS
from ..physics.laws.base import Definition
from ..physics.partners import rotation
from ..physics.structure import Structure
from ..vocabulary.quantities import (
    adhesion,
    aspect,
    beta,
    beta_0,
    capillary,
    contact_angle,
    e_dry,
    gap,
    glass_number,
    initial_normals,
    initial_partner_spin,
    initial_partner_spins,
    initial_spin,
    initial_spins,
    initial_turning,
    initial_turnings,
    mass_ratio,
    mu_f,
    normal_velocity,
    obliquity,
    orbital_momentum,
    radius_ratio,
    rupture_gap,
    spin,
    stokes,
    string_ratio,
    volume,
    weight,
)
from . import friction
from .certificates import approach, spin_down
from .certificates import attraction as attraction_certificate
from .certificates import orbital_momentum as orbital_certificate
from .certificates.pendulum import definitions as pendulum_definitions
from .certificates.pendulum import margins as pendulum_margins
from .events import CONTACT_GAPS, events, rebound, rebound_loss, start
from .intermediates import intermediates
from .invariants import Invariant, conserved_components, conserved_momentum
from .observables import (
    angular_momentum,
    effective_potential,
    energies,
    energy_rates,
    inward_at_rest,
    outputs,
    outward_at_most,
    precession,
    restitution_ceiling,
    rigid_rotation,
    surface_slip,
    wobble,
)
from .rates import inward_force, rates, resting_rates, turning_rate


@dataclass(frozen=True)
class ModelFunction:
    """A function of state and groups to be emitted; `outputs` are (name, expression) pairs."""

    name: str
    doc: str
    outputs: tuple[tuple[str, sp.Expr], ...]
    regional: bool = False  # depends on the flags of film and shear
    given: tuple[sp.Symbol, ...] = ()  # further arguments


@dataclass(frozen=True)
class Model:
    """The nondimensional model of a structure."""

    structure: Structure
    states: tuple[sp.Symbol, ...]
    groups: tuple[sp.Symbol, ...]
    slots: tuple[str, ...]
    definitions: tuple[Definition, ...]
    functions: tuple[ModelFunction, ...]

    def __getitem__(self, name: str) -> ModelFunction:
        return next(each for each in self.functions if each.name == name)

    def expanded(self, expression: sp.Expr) -> sp.Expr:
        """`expression` with every named intermediate substituted."""
        return _expanded(sp.sympify(expression), dict(self.definitions), _whole(self.definitions))


@cache
def _whole(_definitions: tuple[Definition, ...]) -> dict[sp.Basic, sp.Expr]:
    """Intermediates without any other, as far as they have been asked for: bounds of bounds are costly to expand."""
    return {}


def _expanded(expression: sp.Expr, definitions: Mapping[sp.Basic, sp.Expr], whole: dict[sp.Basic, sp.Expr]) -> sp.Expr:
    """The expression with every intermediate substituted; those that it needs are added to `whole`."""
    for symbol in (expression.free_symbols & definitions.keys()) - whole.keys():
        whole[symbol] = _expanded(sp.sympify(definitions[symbol]), definitions, whole)
    return expression.xreplace(whole)


@cache
def derive(structure: Structure) -> Model:
    """The nondimensional model of `structure`.

    Raises:
        ValueError: an equation uses a group that is not among GROUPS.
    """
    states = _states(structure)
    functions = _functions(structure, states)
    definitions = intermediates(structure, _conserved(structure) if structure.reduced else ())
    if _pendulum(structure):
        definitions += pendulum_definitions()
    elif attraction_certificate.admits(structure):
        definitions += attraction_certificate.definitions(structure)
    if approach.admits(structure):
        definitions += approach.definitions(structure)
    if orbital_certificate.admits(structure):
        definitions += orbital_certificate.definitions(structure)
    if spin_down.admits(structure):
        definitions += spin_down.definitions(structure)
    if structure.friction:
        definitions += friction.definitions(structure, inward_force(structure))
    used = _closure(functions, definitions)
    given = {symbol for function in functions for symbol in function.given}
    unlisted = used - {*states, *GROUPS, FILM, SHEAR, *given, *(symbol for symbol, _ in definitions)}
    if unlisted:
        names = ", ".join(sorted(map(str, unlisted)))
        raise ValueError(f"{structure.name} uses {names}: neither a state nor an intermediate, nor among GROUPS")
    return Model(
        structure,
        states,
        groups=tuple(q for q in GROUPS if q in used),
        slots=_slots(structure),
        definitions=tuple((symbol, expression) for symbol, expression in definitions if symbol in used),
        functions=functions,
    )


def _pendulum(structure: Structure) -> bool:
    """True if the pendulum certificate covers the structure: oblique, strings, and a film only."""
    return (
        structure.oblique and structure.strings and not (structure.bridge or structure.attraction or structure.friction)
    )


# In the order in which modules list those that they use.
GROUPS = (
    stokes, aspect, obliquity, initial_turning, initial_spin, initial_partner_spin, capillary, volume, contact_angle,
    adhesion, weight, string_ratio, radius_ratio, mass_ratio, *initial_normals, *initial_turnings, *initial_spins,
    *initial_partner_spins, glass_number, *CONTACT_GAPS.values(), rupture_gap, e_dry,
    mu_f, beta_0,
)  # fmt: skip


def _conserved(structure: Structure) -> tuple[tuple[Invariant, sp.Expr], ...]:
    """The angular momentum and its initial value, as found in the full equations with the lever arm at mid-gap.

    In space, its three components.

    Raises:
        NoInvariantError: the full equations do not conserve it.
    """
    if structure.partner == "space":
        found = conserved_components(derive(replace(structure, reduced=False)))
        return tuple((invariant, invariant.at(start(structure))) for invariant in found)
    invariant = conserved_momentum(derive(replace(structure, reduced=False)), {"arm": LAWS["arm"]["midgap"]})
    return ((invariant, invariant.at(start(structure))),)


def _states(structure: Structure) -> tuple[sp.Symbol, ...]:
    states = [gap, normal_velocity]
    if structure.partner:
        return (*states, *rotation(structure.partner, structure.friction, structure.reduced).states)
    if structure.oblique:
        states += [orbital_momentum] + ([] if structure.reduced else [spin]) + ([beta] if structure.strings else [])
    return tuple(states)


def _slots(structure: Structure) -> tuple[str, ...]:
    slots = ["film", "glass"]
    if structure.oblique:
        slots += ["shear"] + ([] if structure.reduced or structure.partner in ("wall", "space") else ["arm"])
    slots += [slot for slot in ("bridge", "strings", "attraction") if getattr(structure, slot)]
    return tuple(slots)


def _closure(functions: tuple[ModelFunction, ...], definitions: tuple[Definition, ...]) -> set[sp.Basic]:
    used: set[sp.Basic] = set()
    for function in functions:
        for _, expression in function.outputs:
            used |= expression.free_symbols
    for symbol, expression in reversed(definitions):
        if symbol in used:
            used |= expression.free_symbols
    return used


def _friction(structure: Structure, states: tuple[sp.Symbol, ...]) -> tuple[ModelFunction, ...]:
    """The functions of the dry contact's friction."""
    after = friction.rubbed(structure, states)
    return (
        ModelFunction(
            "dry_slip",
            "Friction of a rebound that starts from this state: the slip of the surfaces, the impulse with which they "
            "stick, and the largest impulse, with which they slide, also where the doublet comes to rest.",
            tuple(friction.at_rebound(structure).items()),
        ),
        ModelFunction(
            "rubbed",
            "State just after a tangential impulse.",
            tuple((state.name, after[state]) for state in states),
            given=(friction.IMPULSE,),
        ),
        ModelFunction(
            "friction_loss",
            "Energy that a tangential impulse takes from this state, over m v0^2.",
            (("dry_friction", friction.loss(structure)),),
            given=(friction.IMPULSE,),
        ),
    ) + (
        ()
        if structure.partner == "space"
        else (
            ModelFunction(
                "dry_forces",
                "Forces of resting contact, over the unit of the tangential impulse per x0/v0: Coulomb's limit, and "
                "the force that holds the surfaces together where they roll.",
                (("limit", friction.GRIP), ("holding", friction.HOLDING_FORCE)),
                regional=True,
            ),
        )
    )


def _functions(structure: Structure, states: tuple[sp.Symbol, ...]) -> tuple[ModelFunction, ...]:
    """Every function of `structure`, in the order of emission."""

    def of_states(values: Mapping[sp.Symbol, sp.Expr]) -> tuple[tuple[str, sp.Expr], ...]:
        return tuple((state.name, values[state]) for state in states)

    functions = [
        ModelFunction("right_hand_side", "Rates of the states per v0/x0.", of_states(rates(structure)), regional=True)
    ]
    if structure.oblique:
        functions += [
            ModelFunction(
                "resting_rates",
                "Rates of the states per v0/x0 in resting contact: the gap is held, the rotation goes on.",
                of_states(friction.resting_rates(structure) if structure.friction else resting_rates(structure)),
                regional=True,
                given=(friction.SLIDING, friction.ROLLING) if structure.friction else (),
            ),
        ]
        turning = turning_rate(structure)
        if turning is not None:
            functions.append(
                ModelFunction(
                    "turning_rate",
                    "Angular velocity of the line of centres, rad per x0/v0 (without strings, the angle is no state).",
                    ((beta.name, turning),),
                )
            )
    functions += [
        ModelFunction(
            "inward_force",
            "Sum of the normal forces except the film's, over m v0^2/x0: positive inward.",
            (("inward_force", inward_force(structure)),),
        ),
        ModelFunction(
            "events",
            "Event functions, each positive before its event: rebound criteria while closing, `turning` the normal "
            "velocity (negative while closing), `release` in resting contact.",
            tuple(events(structure).items()),
            regional=bool(structure.friction),
        ),
        ModelFunction(
            "rebound",
            "State just after a rebound: u -> -e_dry u; the other states are continuous.",
            of_states(rebound(states)),
        ),
        *(_friction(structure, states) if structure.friction else ()),
        ModelFunction("start", "State at initial contact.", of_states(start(structure))),
        ModelFunction("energies", "Energies of the state over m v0^2.", tuple(energies(structure).items())),
        ModelFunction(
            "energy_rates",
            "Energy taken from the motion per x0/v0 by film, attractions and shear, over m v0^2.",
            tuple(energy_rates(structure).items()),
            regional=True,
            given=(friction.SLIDING,) if structure.friction else (),
        ),
        ModelFunction(
            "rebound_loss",
            "Energy lost in a rebound that starts from this state, over m v0^2.",
            (("dry_contact", rebound_loss()),),
        ),
    ]
    momentum = angular_momentum(structure) if structure.oblique and not structure.reduced else None
    if momentum is not None:
        functions.append(
            ModelFunction(
                "angular_momentum",
                "1 + the change of the angular momentum over its size at initial contact.",
                (("angular_momentum", momentum),),
            )
        )
    functions.append(
        ModelFunction(
            "outputs",
            "Results for a separated doublet: restitutions, and rates over their scale.",
            tuple(outputs(structure).items()),
        )
    )
    if structure.oblique:
        functions.append(
            ModelFunction(
                "surface_slip",
                "Relative velocity of the surfaces at the contact, at the lever arm of the shear, over a Omega.",
                (("surface_slip", surface_slip(structure)),),
            )
        )
    if _pendulum(structure):
        functions.append(
            ModelFunction(
                "pendulum_margins",
                "Margins of the pendulum certificate (lever arm at mid-gap): film < 0 and recoil < 0 exclude "
                "separation, with St impulse added unless outward < pull; rebound, beneath: of a gap and speed.",
                tuple(pendulum_margins().items()),
            )
        )
    if attraction_certificate.admits(structure):
        functions.append(
            ModelFunction(
                "attraction_margins",
                "Margins of the attraction certificate (lever arm at mid-gap, forces that decrease with the gap): "
                "hold > 0, escape < 0 and rebound < 0 exclude separation.",
                tuple(attraction_certificate.margins(structure).items()),
            )
        )
    if approach.admits(structure):
        functions.append(
            ModelFunction(
                "approach_step",
                "Bounds over the next part of the film, from a gap and a bound of the closing speed there (the normal "
                "velocity): the part's end, the largest speed there and within it.",
                tuple(approach.step().items()),
            )
        )
    if approach.admits(structure) and not structure.strings:
        functions.append(
            ModelFunction(
                "approach_force",
                "Largest outward force before solid contact, over m v0^2/x0, for the rotation of this state.",
                (("outward", approach.outward(structure)),),
            )
        )
    if orbital_certificate.admits(structure):
        functions.append(
            ModelFunction(
                "orbital_margins",
                "Margins of the orbital-momentum certificate: slip omega - xi and J^2/(2 r^2) at this gap, and the "
                "slip energy for either lever arm; energies over m v0^2.",
                tuple(orbital_certificate.margins(structure).items()),
            )
        )
    if spin_down.admits(structure):
        functions.append(
            ModelFunction(
                "spin_down_margins",
                "Margins of the spin-down certificate (lever arm at mid-gap, a shear that falls with the gap, L = 0): "
                "stays < 0 and rate > 0 exclude separation; momentum is |L| at initial contact beyond rounding error. "
                "So do apart < 0 and inside < 0 where J = 0.",
                tuple(spin_down.margins(structure).items()),
            )
        )
    if not (structure.oblique and structure.strings):  # rotating strings have no least-energy argument
        functions.append(
            ModelFunction(
                "effective_potential",
                "Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope "
                "of the least energy along the gap, capillary work included.",
                tuple(effective_potential(structure).items()),
            )
        )
        if structure.partner == "space":
            functions.append(
                ModelFunction(
                    "resting_bound",
                    "Normal forces of a doublet in resting contact from now on, over m v0^2/x0: the largest "
                    "centrifugal force, and the sum of the others, positive inward.",
                    (("outward", outward_at_most(structure)), ("inward", inward_at_rest(structure))),
                )
            )
            functions.append(
                ModelFunction(
                    "wobble",
                    "Energy over m v0^2 of all motion but rotation as a rigid doublet across the line of centres, and "
                    "twist.",
                    (("wobble", wobble(structure)),),
                )
            )
            functions.append(
                ModelFunction(
                    "precession",
                    "Angular momentum over m a^2 Omega, and the rate per v0/x0, over its length, at which a rigid "
                    "doublet turns about it.",
                    tuple(precession(structure).items()),
                )
            )
        else:
            functions.append(
                ModelFunction(
                    "rigid_rotation",
                    "The state with this least energy: no normal velocity, rigid rotation.",
                    of_states(rigid_rotation(structure)),
                )
            )
    if structure.partner == "wall":  # the energy of the motion along the wall cannot lead to separation
        functions.append(
            ModelFunction(
                "escape_energy",
                "Kinetic energy over m v0^2 of the motion along the line of centres, the only one that can separate "
                "sphere and wall.",
                (("kinetic", normal_velocity**2 / 2),),
            )
        )
    if not structure.strings and not structure.partner:
        functions.append(
            ModelFunction(
                "restitution_ceiling",
                "Upper bound of e_n^2 for separation at this gap, from the initial energy and angular momentum, "
                "without the work of attractions: 2 (W_c(x_f) - W_c(x0))/(m v0^2) is still to be subtracted.",
                tuple(restitution_ceiling(structure).items()),
            )
        )
    return tuple(functions)
