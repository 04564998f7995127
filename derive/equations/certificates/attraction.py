"""Attraction certificate: three inequalities on the state that exclude separation at any energy, with their proof.

Oblique, with attractions F that fall with the gap, strings or not, midgap arm, per unit mass:

1. As in `pendulum`, L never grows and F_t pulls omega and xi together: J = r^2 omega never exceeds J_max.
2. F falls with the gap, S_n grows with gap and angle: at every gap, from now on, at least
   `hold` = F(x_f) + S_n(contact, beta) - J_max^2/r^3 (in contact) pulls inward, beside lubrication; it must be > 0.
3. What moves outward now, or rebounds with e_dry of the present approach, is stopped before x_f: its kinetic energy is
   below hold (x_f - x) (`escape` < 0).
4. What falls from X to x gains at most the work of F + max S_n; a rebound leaves e_dry^2 of it, and less than that is
   needed to come back to X: e_dry^2 (F + max S_n) < F + S_n - J_max^2/r^3 at every gap, worst where F is least
   (`rebound` < 0). So no maximum of the gap exceeds the one before.

Energy proves most sticks sooner; this one also proves those that still spin fast, or chatter on glassy liquid.
"""

from __future__ import annotations

import sympy as sp

from ...physics.structure import Structure
from ...vocabulary.quantities import (
    aspect,
    beta,
    e_dry,
    gap,
    normal_velocity,
    orbital_momentum,
    rupture_gap,
)
from ..events import contact_gap
from ..intermediates import ATTRACTION_FORCE, BRIDGE_FORCE, MOMENTUM, intermediates
from .pendulum import (
    CONTACT,
    FARTHEST,
    LARGEST_MOMENTUM,
    LARGEST_PULL,
    NEAREST,
    SPUN_UP,
    outward_at,
    pull_at,
    rigid_momentum,
)

LEAST, HOLD = sp.symbols("least_attraction hold", real=True)


def admits(structure: Structure) -> bool:
    """Whether the proof is about this structure: equal spheres that turn, and something that attracts."""
    attracts = structure.bridge or structure.attraction
    return structure.oblique and attracts and not structure.partner


def _least(structure: Structure) -> sp.Expr:
    """The attractions at the rupture distance (without a bridge at x0, where the film ends)."""
    forces = dict(intermediates_of(structure))
    end = rupture_gap if structure.bridge else sp.Integer(1)
    named = [force for force in (BRIDGE_FORCE, ATTRACTION_FORCE) if force in forces]
    return sum((forces[force].subs(gap, end) for force in named), sp.Integer(0))


def intermediates_of(structure: Structure) -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    """The named forces of a structure; what is conserved does not enter them."""
    full = Structure(
        structure.oblique, structure.bridge, structure.strings, attraction=structure.attraction, spread=structure.spread
    )
    return intermediates(full)


def definitions(structure: Structure) -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    """Named intermediates of `margins`, in order."""
    end = rupture_gap if structure.bridge else sp.Integer(1)
    pull = pull_at(CONTACT, beta) if structure.strings else sp.Integer(0)
    largest = pull_at(end, sp.pi) if structure.strings else sp.Integer(0)
    found = [
        (CONTACT, contact_gap),
        (NEAREST, 4 + aspect * CONTACT),
        (FARTHEST, 4 + aspect * end),
        (SPUN_UP, rigid_momentum(MOMENTUM, FARTHEST)),
        (LARGEST_MOMENTUM, sp.Max(orbital_momentum, SPUN_UP)),
        (LEAST, _least(structure)),
        (HOLD, LEAST + pull - outward_at(LARGEST_MOMENTUM, NEAREST)),
    ]
    return (*found, (LARGEST_PULL, largest)) if structure.strings else tuple(found)


def margins(structure: Structure) -> dict[str, sp.Expr]:
    """A stick is proved where `hold` > 0, `escape` < 0 and `rebound` < 0; forces over m v0^2/x0, energy over m v0^2."""
    end = rupture_gap if structure.bridge else sp.Integer(1)
    outward = sp.Max(normal_velocity, -e_dry * normal_velocity)
    pulled = LEAST + (LARGEST_PULL if structure.strings else 0)
    return {
        "hold": HOLD,
        "escape": outward**2 / 2 - HOLD * (end - gap),
        "rebound": e_dry**2 * pulled - HOLD,
    }
