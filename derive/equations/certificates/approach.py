"""Approach certificate: bounds of the closing speed and of the outward force from initial contact on.

Per unit mass, with g the film's resistance, P the largest force inward and C the largest centrifugal force on the way
in, for any partner and any rotation at the start:

1. The centrifugal force slows the approach, so over the depth y = x0 - x the closing speed w obeys
   dw/dy <= P/w - g/St. Over one part of the film, of length h, w thus stays below
   w + min(P h/left, sqrt(2 P h)) - (loss in the film), where left = w - (loss over the part): of the two, the first
   needs left > 0. So `gain` = P h/max(left, sqrt(P h/2)) bounds what w gains against the film, and w is at most
   max(left, 0) + gain at the end of the part, at most w + gain within it. Parts follow each other down to a depth.
2. The glass pressure grows with the speed and as the gap closes. If it stays below its limit at the end of each part
   for the largest speed within the part, and the gap above solid contact, no criterion is met.
3. C = 2 E_orb/r, and the energy of rotation, E_rot >= E_orb, only gains the work of C: E_rot r^2 never grows on the
   way in, and C <= 2 E_rot(x0) r0^2/r_contact^3. E_rot includes the spins, whatever their sense, so that what they
   give to the orbit is in it, and the shear only takes from their sum. Attractions that decrease with the gap pull
   with F(x0) at least. So E_rot + W gains at most `outward` = max(C - F(x0), 0) times the depth.
4. Hence, without a criterion before, a doublet that is still closing at the depth y has at most the energy
   w^2/2 + E_rot + W + outward y, with E_rot and W of initial contact, and one that has turned before has less. If this
   is below the energy barrier beyond the film, it sticks, whatever happens afterwards.

On strings the same bound of w, with the largest pull for P, limits every rebound (`pendulum`).
"""

import sympy as sp

from ...physics.forces import FILM
from ...physics.laws import slot_call
from ...physics.laws.base import Definition, slot_calls
from ...physics.scaling import DISTANCE
from ...physics.structure import Structure
from ...vocabulary.quantities import aspect, gap, normal_velocity, stokes
from ..automaton import APPROACH_PARTS, DEEPEST_PART
from ..events import contact_gap
from ..intermediates import FILM_FORCE, attractions, forces
from ..observables import energies
from .pendulum import LARGEST_PULL, Functions

RATIO, DEEPER, LARGEST_FORCE, PATH, GAIN = sp.symbols("part_ratio deeper largest_force path gain", positive=True)
LEFT = sp.Symbol("left", real=True)


def admits(structure: Structure) -> bool:
    """True for the structures covered: attractions without strings, or strings alone."""
    attracts = structure.bridge or structure.attraction
    by_strings = structure.strings and not (attracts or structure.friction)
    held = by_strings or (attracts and not structure.strings)
    return held and (structure.oblique or attracts)


def braking(structure: Structure, at: sp.Expr) -> sp.Expr:
    """Velocity, over v0/St, that the film takes from x0 to a gap: the film's call, but of its antiderivative."""
    (call,) = slot_calls(forces(structure)[FILM_FORCE].subs(FILM, 1))
    return slot_call("film", "braking", at, *call.args[1:])


def definitions(structure: Structure) -> tuple[Definition, ...]:
    """Named intermediates of a part of the film, in order."""
    most = LARGEST_PULL if structure.strings else sp.Max(attractions(structure, DEEPER), 0)
    lost = (braking(structure, DEEPER) - braking(structure, gap)) / stokes
    return (
        (RATIO, sp.exp(sp.log(sp.Max(contact_gap, sp.nsimplify(DEEPEST_PART))) / APPROACH_PARTS)),
        (DEEPER, gap * RATIO),
        (LARGEST_FORCE, most),
        (PATH, gap - DEEPER),
        (LEFT, -normal_velocity - lost),
        (GAIN, LARGEST_FORCE * PATH / sp.Max(LEFT, sp.sqrt(LARGEST_FORCE * PATH / 2))),
    )


def functions(structure: Structure) -> Functions:
    """The bounds over the next part of the film, and of the outward force from a state on."""
    doc = (
        "Bounds over the next part of the film, from a gap and a bound of the closing speed there (the normal "
        "velocity): the part's end, the largest speed there and within it."
    )
    step = {"deeper_gap": DEEPER, "slowed": sp.Max(LEFT, 0) + GAIN, "fastest": -normal_velocity + GAIN}
    yield "approach_step", doc, step
    if structure.strings:
        return
    first = DISTANCE - aspect * gap
    rotating = energies(structure)["kinetic"] - normal_velocity**2 / 2
    thrown = sp.Integer(0)
    if structure.oblique and structure.partner != "wall":
        thrown = 2 * aspect * rotating * DISTANCE**2 / (first + aspect * contact_gap) ** 3
    doc = "Largest outward force before solid contact, over m v0^2/x0, for the rotation of this state."
    yield "approach_force", doc, {"outward": sp.Max(thrown - attractions(structure, gap), 0)}
