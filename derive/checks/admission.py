"""The stick certificate that a model admits: its preconditions, each computed, or the reason for having none."""

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from ..equations.model import derive
from ..laws import LAWS, Law
from ..physics.structure import Structure, structures
from ..vocabulary.quantities import gap
from . import dissipation
from .base import Check, once, readable
from .conservation import strings_are_conservative
from .pendulum_certificate import pendulum_certificate

DEFAULTS = {"film": "finite", "shear": "immersed", "arm": "midgap", "strings": "exact"}


@dataclass(frozen=True)
class Admission:
    """Whether a model admits a stick certificate, and which.

    Arguments:
        structure: of the model.
        argument: the kind of certificate, or "" if there is none.
        held: preconditions that were computed and are satisfied.
        against: why there is no certificate, empty if there is one.
    """

    structure: Structure
    argument: str
    held: tuple[str, ...]
    against: tuple[str, ...]

    @property
    def admitted(self) -> bool:
        return not self.against

    def describe(self) -> str:
        return self.argument if self.admitted else "none: " + "; ".join(self.against)


def certificate(structure: Structure, laws: Mapping[str, Law] | None = None) -> Admission:
    """The certificate of a structure with these laws (slot -> law; where left out, the default).

    Its preconditions: solids, film and shear only dissipate; bridge and strings have a potential; the angular momentum,
    if there is any, is among the invariants found; and the potential has a barrier.
    """
    chosen = {slot: LAWS[slot][name] for slot, name in DEFAULTS.items()} | dict(laws or {})
    checks = [dissipation.film_dissipates(chosen["film"]), *once(dissipation.rebound_dissipates)]
    if structure.bridge:
        checks += once(dissipation.bridge_does_work)
    if structure.strings:
        checks += strings_are_conservative([chosen["strings"]])
    held: list[str] = []
    against: list[str] = []
    if structure.oblique:
        _rotation(structure, chosen, checks, held, against)
    held += [f"{check.name} ({check.statement})" for check in checks if check.ok]
    against += [f"{check.name}: {check.figure}" for check in checks if not check.ok]
    if not _has_barrier(structure):
        against.append("no barrier: L^2/(2 I) falls with the gap and nothing attracts, a doublet parts unless L = 0")
    return Admission(structure, _argument(structure), tuple(held), tuple(against))


def _rotation(
    structure: Structure, laws: Mapping[str, Law], checks: list[Check], held: list[str], against: list[str]
) -> None:
    """Preconditions of the rotation: angular momentum is conserved and the shear dissipates."""
    lever, shear = laws["arm"], laws["shear"]
    conserved = [form.describe() for form in dissipation.conserved(lever, structure) if form.is_angular_momentum]
    held += [f"conserved: {text}" for text in conserved]
    if structure.strings:  # whose torque rules out the energy argument; without a bridge the margins apply
        torque = "strings exert a torque, dL/dt = -r S_t"
        if structure.bridge:
            against.append(f"{torque}: no least energy at fixed L, and beside a bridge no other")
        elif laws["film"] is not LAWS["film"]["finite"]:
            against.append(f"{torque}, and the proof without energy is of the finite film")
        else:
            checks += pendulum_certificate()
    if dissipation.conserves(lever):
        checks.append(dissipation.shear_dissipates(shear, lever))
    else:
        against.append(f"{lever.name} arm: L not conserved, dL/dt = {readable(dissipation.torque(lever))}")


def _has_barrier(structure: Structure) -> bool:
    """True if the least energy can rise with the gap: not if its slope is the centrifugal term only."""
    model = derive(structure)
    if structure.strings or not structure.oblique:
        return True  # head-on with a film only, the film's momentum integral decides instead
    slope = model.expanded(model["effective_potential"]["slope"])
    start = {s: model.expanded(model["start"][s.name]) for s in model.states if s != gap}
    return not sp.factor(-slope.subs(start)).is_nonnegative


def _argument(structure: Structure) -> str:
    if not (structure.oblique or structure.bridge or structure.strings):
        return "momentum: the film's integral up to its rim, u - Lf(s)/St < 0, stops the opening"
    if structure.oblique and structure.strings:
        return "momenta: the strings outweigh the rotation for good and the film stops every rebound"
    parts = ["L^2/(2 I(x))"] * structure.oblique + ["W_c(x)"] * structure.bridge + ["U_s(x)"] * structure.strings
    return f"energy below the barrier ahead of U_eff = {' + '.join(parts)}, which no loss can make up for"


def certificates(*laws: Law) -> tuple[Check, ...]:
    """The certificate of every structure with these laws; a note gives the reason where there is none."""
    checks = []
    for structure in structures():
        if structure.reduced:
            continue
        proof = certificate(structure, {law.slot: law for law in laws})
        statement = "; ".join(proof.held) or "which proof of a stick the model admits"
        checks.append(Check(f"certificate: {structure.name}", statement, proof.admitted or None, proof.describe()))
    return tuple(checks)
