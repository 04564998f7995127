"""Attraction certificate: three inequalities on the state that exclude separation, with their derivation.

For oblique collisions with attractions F that decrease with the gap, with or without strings, lever arm at mid-gap,
per unit mass:

1. F_t reduces the slip omega - xi, so that J = r^2 omega tends to the share s = r^2/(r^2 + (32/5) a^2) of L, that of
   rigid rotation at the present gap. s grows with the gap and |L| never does (strings take from L >= 0). So |J| never
   exceeds J_max, the larger of |J| and of |s L| at the farthest gap, for L and J of any sign, opposite ones too.
2. F decreases with the gap, S_n increases with gap and angle. So at every later gap the force inward, lubrication
   excluded, is at least `hold` = F(x_f) + S_n(contact, beta) - J_max^2/r^3 (in contact), which must be > 0.
3. A doublet that opens now, or rebounds with e_dry times the present approach velocity, is stopped before x_f: its
   kinetic energy is below hold (x_f - x) (`escape` < 0).
4. A doublet that closes from the gap X to x gains at most the work of F + max S_n. A rebound leaves the fraction
   e_dry^2 of it, and this is less than the energy needed to return to X if
   e_dry^2 (F + max S_n) < F + S_n - J_max^2/r^3 at every gap; the least F is the worst case (`rebound` < 0). So no
   maximum of the gap exceeds the one before.

The energy certificate covers most sticks earlier. This one also covers doublets that still spin fast or chatter on a
liquid in its glassy state.
"""

import sympy as sp

from ...physics.law import Definition
from ...physics.structure import Structure
from ...vocabulary import quantities as q
from ..events import contact_gap
from ..intermediates import MOMENTUM, attractions
from . import pendulum
from .certificate import Certificate, Functions, Proof

LEAST, HOLD = sp.symbols("least_attraction hold", real=True)


def admits(structure: Structure) -> bool:
    """True for the structures covered: oblique, equal spheres, with an attraction."""
    attracts = structure.bridge or structure.attraction
    return structure.oblique and attracts and not (structure.partner or structure.friction)


def _end(structure: Structure) -> sp.Expr:
    """The rupture gap; without a bridge x0, the edge of the film."""
    return q.rupture_gap if structure.bridge else sp.S.One


def definitions(structure: Structure) -> tuple[Definition, ...]:
    """Named intermediates of the margins, in order."""
    end = _end(structure)
    pull = pendulum.pull_at(pendulum.CONTACT, q.beta) if structure.strings else sp.Integer(0)
    momenta = (q.orbital_momentum, pendulum.SPUN_UP)
    result = (
        (pendulum.CONTACT, contact_gap),
        (pendulum.NEAREST, 4 + q.aspect * pendulum.CONTACT),
        (pendulum.FARTHEST, 4 + q.aspect * end),
        (pendulum.SPUN_UP, pendulum.rigid_momentum(MOMENTUM, pendulum.FARTHEST)),
        (pendulum.LARGEST_MOMENTUM, sp.Max(*momenta, *(-momentum for momentum in momenta))),
        (LEAST, attractions(structure, end)),
        (HOLD, LEAST + pull - pendulum.outward_at(pendulum.LARGEST_MOMENTUM, pendulum.NEAREST)),
    )
    return (*result, (pendulum.LARGEST_PULL, pendulum.pull_at(end, sp.pi))) if structure.strings else result


def functions(structure: Structure) -> Functions:
    """The margins, over m v0^2/x0 and m v0^2."""
    doc = (
        "Margins of the attraction certificate (lever arm at mid-gap, forces that decrease with the gap): "
        "hold > 0, escape < 0 and rebound < 0 exclude separation."
    )
    end = _end(structure)
    outward = sp.Max(q.normal_velocity, -q.e_dry * q.normal_velocity)
    pulled = LEAST + (pendulum.LARGEST_PULL if structure.strings else 0)
    escape = outward**2 / 2 - HOLD * (end - q.gap)
    yield "attraction_margins", doc, {"hold": HOLD, "escape": escape, "rebound": q.e_dry**2 * pulled - HOLD}


def _premises(structure: Structure) -> tuple[str, ...]:
    return tuple(f"{slot.upper()}_FORCE_FALLS" for slot in ("bridge", "attraction") if getattr(structure, slot))


ROW = Certificate(
    "attraction",
    "an attraction lets no maximum of the gap exceed the one before",
    (
        Proof("attraction_holds", "the attraction lets no maximum of the gap exceed the one before",
              "gap >= contact*(1 - margin) and hold > 0 and rebound < -margin*hold and escape < -margin*energy"),
    ),
    ("attraction_certificate",), admits, definitions, functions, _premises,
)  # fmt: skip
