"""From a structure to its nondimensional equations, events, jumps, ledger and outputs, ready to be emitted.

A model combines `intermediates` and the definitions of the certificates with `functions`, and names the states, groups
and slots that they use.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from functools import cache

import sympy as sp

from ..physics.forces import FILM, SHEAR
from ..physics.law import Definition, filled, needed
from ..physics.partners import rotation
from ..physics.slots import MIDGAP
from ..physics.structure import Structure
from ..vocabulary import quantities as q
from . import friction, terms
from .certificates.table import CERTIFICATES
from .events import CONTACT_GAPS, TARGET_GROUPS, start
from .functions import ModelFunction, functions
from .intermediates import MOMENTUM, intermediates, inward_force
from .invariants import Invariant, conserved_components, conserved_momentum
from .store import stored


@dataclass(frozen=True)
class Model:
    """The nondimensional model of a structure."""

    structure: Structure
    states: tuple[sp.Symbol, ...]
    groups: tuple[sp.Symbol, ...]
    slots: tuple[str, ...]
    definitions: tuple[Definition, ...]
    functions: tuple[ModelFunction, ...]

    def __contains__(self, name: str) -> bool:
        return any(function.name == name for function in self.functions)

    def __getitem__(self, name: str) -> ModelFunction:
        return next(function for function in self.functions if function.name == name)

    def expanded(self, expression: sp.Expr, keep: Collection[str] = ()) -> sp.Expr:
        """`expression` with every named intermediate substituted, except those whose names are in `keep`."""
        definitions = tuple(pair for pair in self.definitions if pair[0].name not in keep)
        return _expanded(sp.sympify(expression), dict(definitions), _without_names(definitions))

    def by_state(self, name: str, keep: Collection[str] = ()) -> dict[sp.Symbol, sp.Expr]:
        """The expanded outputs of a function that has one for each state."""
        return {state: self.expanded(self[name][state.name], keep) for state in self.states}

    def results(self, name: str, keep: Collection[str] = ()) -> dict[str, sp.Expr]:
        """The expanded outputs of a function by name."""
        return {key: self.expanded(value, keep) for key, value in self[name].outputs}


def without_partner_spin(model: Model) -> Model:
    """The model, of an unequal pair with the partner's spin from the angular momentum, lever arm at mid-gap."""
    if model.structure.partner != "pair":
        return model
    first = {state: model["start"][state.name] for state in model.states}
    definitions: list[Definition] = []
    for symbol, value in model.definitions:
        definitions.append((symbol, filled(value, MIDGAP)))
        if symbol == MOMENTUM:
            (spin,) = sp.solve(sp.Eq(value, MOMENTUM), q.partner_spin)
            definitions[-1:] = [(MOMENTUM, value.subs(first, simultaneous=True)), (q.partner_spin, spin)]
    functions = tuple(
        replace(function, outputs=tuple(output for output in function.outputs if output[0] != q.partner_spin.name))
        for function in model.functions
    )
    return replace(model, states=model.states[:-1], definitions=tuple(definitions), functions=functions)


@cache
def _without_names(_definitions: tuple[Definition, ...]) -> dict[sp.Basic, sp.Expr]:
    """Expanded intermediates, filled as they are needed: bounds of bounds are costly to expand."""
    return {}


def _expanded(expression: sp.Expr, definitions: Mapping[sp.Basic, sp.Expr], values: dict[sp.Basic, sp.Expr]) -> sp.Expr:
    """The expression with every intermediate substituted; those that it needs are added to `values`."""
    for symbol in (expression.free_symbols & definitions.keys()) - values.keys():
        values[symbol] = _expanded(sp.sympify(definitions[symbol]), definitions, values)
    return expression.xreplace(values)


@cache
def derive(structure: Structure) -> Model:
    """The nondimensional model of `structure`; ValueError if an equation uses a group that is not among GROUPS."""
    return _derived(structure) if structure.terms else stored(structure.name, lambda: _derived(structure))


def _derived(structure: Structure) -> Model:
    states = _states(structure)
    members = functions(structure, states)
    definitions = _definitions(structure)
    used = needed([expression for function in members for _, expression in function.outputs], definitions)[1]
    further = {symbol for function in members for symbol in function.further}
    own = structure.terms.groups if structure.terms is not None else ()
    unlisted = used - {*states, *GROUPS, *own, FILM, SHEAR, *further, *(symbol for symbol, _ in definitions)}
    if unlisted:
        names = ", ".join(sorted(map(str, unlisted)))
        raise ValueError(f"{structure.name} uses {names}: neither a state nor an intermediate, nor among GROUPS")
    return Model(
        structure,
        states,
        groups=tuple(group for group in (*GROUPS, *own) if group in used),
        slots=_slots(structure),
        definitions=tuple((symbol, expression) for symbol, expression in definitions if symbol in used),
        functions=members,
    )


# In the order in which modules list those that they use.
GROUPS = (
    q.stokes, q.aspect, q.obliquity, q.initial_turning, q.initial_spin, q.initial_partner_spin, q.capillary, q.volume,
    q.contact_angle, q.adhesion, q.weight, q.string_ratio, q.radius_ratio, q.mass_ratio, *q.initial_normals,
    *q.initial_turnings, *q.initial_spins, *q.initial_partner_spins, q.glass_number, *CONTACT_GAPS.values(),
    q.rupture_gap, *TARGET_GROUPS, q.e_dry, q.mu_f, q.beta_0,
)  # fmt: skip


def _definitions(structure: Structure) -> tuple[Definition, ...]:
    """The named intermediates of the equations, then those of the certificates and of friction."""
    definitions = intermediates(structure, _conserved(structure) if structure.reduced else ())
    for certificate in CERTIFICATES:
        if structure.terms is None and certificate.admits(structure):
            definitions += certificate.definitions(structure)
    if structure.friction:
        definitions += friction.definitions(structure, terms.mass(structure) * inward_force(structure))
    return definitions


def _conserved(structure: Structure) -> tuple[tuple[Invariant, sp.Expr], ...]:
    """The angular momentum and its initial value, as found in the full equations with the lever arm at mid-gap.

    In space, its three components.

    Raises:
        NoInvariantError: the full equations do not conserve it.
    """
    full = derive(replace(structure, reduced=False))
    if structure.partner == "space":
        result = conserved_components(full)
    else:
        result = (conserved_momentum(full, MIDGAP),)
    return tuple((invariant, invariant.at(start(structure))) for invariant in result)


def _states(structure: Structure) -> tuple[sp.Symbol, ...]:
    states = [q.gap, q.normal_velocity]
    if structure.partner:
        return (*states, *rotation(structure).states)
    if structure.oblique:
        states += [q.orbital_momentum, *([] if structure.reduced else [q.spin])]
        states += [q.beta] if structure.strings else []
    return (*states, *terms.clocks(structure))


def _slots(structure: Structure) -> tuple[str, ...]:
    slots = ["film", "glass"]
    if structure.oblique:
        slots += ["shear"] + ([] if structure.reduced or structure.partner in ("wall", "space") else ["arm"])
    slots += [slot for slot in ("bridge", "strings", "attraction") if getattr(structure, slot)]
    return tuple(slots)
