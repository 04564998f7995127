"""Conserved quantities and governing groups of a user's model, in words."""

from dataclasses import replace
from functools import cache

import sympy as sp

from ..emit.provenance import law_digest, model_digest
from ..equations.invariants import invariants
from ..equations.model import Model
from ..equations.store import stored
from ..laws import LAWS, Law, filled
from ..physics.structure import BRIDGED
from ..user.own_events import OwnEvent
from ..user.structures import UserModel
from .conservation import momentum_rate

_ANGULAR_MOMENTUM = "angular momentum L = m [r^2 omega + (32/5) a^2 xi]"


def _arm(model: UserModel) -> Law:
    return next((law for law in model.laws if law.slot == "arm"), LAWS["arm"]["midgap"])


def torque(model: UserModel, law: Law | None = None) -> sp.Expr:
    """dL/dt without strings, scaled, with the model's own laws; other laws except the arm stay open."""
    return _torque(replace(model, events=()).derived(BRIDGED), law or _arm(model))


@cache  # for the check and the sentence
def _torque(equations: Model, arm: Law) -> sp.Expr:
    rate = filled(momentum_rate(equations, {}), {"arm": arm})  # filled last: sympy factors no fractional powers in time
    lever = arm["lever"](*arm["lever"].arguments)
    return sp.simplify(rate) if lever.is_rational_function() else rate


def _of_terms(model: UserModel) -> list[str]:
    """Sentences on what the declared terms are shown to do, and on the proofs that remain."""
    terms = model.terms
    if terms is None:
        return []
    acts = [f"a force on the {on}" for on, _ in terms.forces] + ["inertia"] * (terms.kinetic != 0)
    line = f"Terms: {', '.join([*acts, *['a potential'] * (terms.potential != 0)])}. "
    if terms.forces:
        line += (
            "The forces are shown to only take energy. "
            if terms.takes
            else "That the forces only take energy is not shown. "
        )
    if model.events:
        line += "Beside them and the events no stick is proved but at rest, head-on and in space."
    elif terms.admits_barrier:
        line += "Of the stick proofs, that by an energy barrier holds, and that by the film alone beside a mere drag."
    else:
        line += "No stick is proved but at rest, head-on and in space: no barrier of the energy is known."
    if terms.rotates:
        line += " They are of equal spheres in a plane, whose spin is then not eliminated by the angular momentum."
    return [line]


def _of_event(event: OwnEvent, proofs: bool) -> str:
    """Sentences on what the checks show of a declared event, and on the `proofs` of sticks that it leaves."""
    ends = {"": "", "separated": ", ends the collision as separated", "stick": ", cuts the collision off as a stick"}
    text = f"Event {event.proposed.word}, {event.proposed.where}{ends[event.proposed.ends]}: "
    if event.jump:
        text += "its jump is shown to add no kinetic energy" if event.takes else (
            "that its jump adds no kinetic energy is not shown, and tested at each"
        )  # fmt: skip
        text += "; angular momentum jumps. " if event.spins else "; angular momentum is kept. "
    else:
        text += "the motion is continuous. "
    if not proofs:
        return text.rstrip()
    if event.harmless:
        return text + "The energy certificate holds beside it."
    if event.reach(BRIDGED).is_known:
        return text + "Sticks are proved where the energy does not suffice for it, or after it."
    return text + "Sticks are proved after it only."


def conserved(model: UserModel) -> tuple[str, ...]:
    """The conserved quantities without strings and rebounds, for any other laws."""
    return _conserved(replace(model, events=()).derived(BRIDGED), _arm(model))


@cache  # the library's equations are those of most models
def _conserved(equations: Model, arm: Law) -> tuple[str, ...]:
    def described() -> tuple[str, ...]:
        result = invariants(equations, {"arm": arm})
        return tuple(_ANGULAR_MOMENTUM if item.is_angular_momentum else item.describe() for item in result)

    return stored(f"conserved-{model_digest(equations)[:32]}-{law_digest(arm)[:32]}", described)


def in_words(model: UserModel) -> tuple[str, ...]:
    """Sentences on conserved quantities, dissipation, and the groups of an oblique collision with a bridge."""
    if conserved(model):
        lines = [f"Conserved without strings, for every law in the other slots: {'; '.join(conserved(model))}."]
    else:
        lines = [f"Angular momentum is not conserved: d/dt of L over its scale is {torque(model)}."]
    lines += _of_terms(model)
    takers = "Mechanical energy is not conserved: film and shear take it, the solids' dry contact as well"
    marks = ", and on the marks of events that it reads" if model.events else ""
    lines.append(f"{takers}; the bridge stores it (its force depends on the gap alone{marks}).")
    groups = model.derived(BRIDGED).groups
    new = {group.symbol: group for group in model.groups}
    names = ", ".join(symbol.name for symbol in groups if symbol not in new)
    lines.append(f"An oblique collision with a bridge is governed by the library's groups {names}.")
    for group in model.groups:
        name, meaning = group.symbol.name, group.quantity.meaning
        plain = group.symbol == group.quantity.symbol
        as_group = (
            f", a plain number ({meaning})" if plain else f" = {group.definition} ({meaning}, made dimensionless)"
        )
        lines.append(f"New group: {name}{as_group}.")
    lines += [] if model.groups else ["No new group."]
    return (*lines, *(_of_event(event, model.terms is None) for event in model.events))
