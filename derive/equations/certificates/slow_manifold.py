"""The slow manifold of an opening doublet: the motion that every trajectory takes once a film has slowed it.

Inside the film, with the angular momentum conserved and without strings, the rates are

    du/dt = c(x) J^2 - A(x) - f(x) u,        dJ/dt = -s(x) (J - J_r(x)),

with the film's slowing f, the attractions A, the centrifugal coefficient c, the relaxation s of the orbital momentum by
shear, and its value J_r in rigid rotation. Everything but x decays: one slow variable.

The difference (e, j) of two solutions, as functions of the gap while both open, obeys exactly (c J^2 - A = F)

    e' = -F e/(u1 u2) + c (J1 + J2) j/u1,    j' = s (J2 - J_r) e/(u1 u2) - s j/u1,

which is the Jacobian of the two rates, taken at secants. With bounds of u, J and the coefficients over a range of gaps
that hold for both solutions, its logarithmic norm in max(|e|, |j|/p) is at most

    -min(F/u^2 - p c (J1 + J2)/u, s/u - s |J - J_r|/(p u^2)),

each term at its worst. The integral of that bound over the gap is the contraction that the kernel requires before it
replaces a trajectory by the slow manifold (solvers/engines/taylor/runtime/slow_manifold.h). f, s and A fall with the
gap for the laws that are declared so, and c does: their values at the ends of a range bound them within it. J_r is L
times a share that rises with the gap. L and J may have any sign: bounds take |J_r| and |J - J_r|, and a range counts
only where the force F is outward for every J in it. So with L = 0 nothing is replaced.

On the slow manifold u = F/(f + u') and J = J_r - u J'/s, from which its series in x follow by iteration.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import sympy as sp

from ...physics.forces import FILM, SHEAR
from ...physics.scaling import DISTANCE
from ...vocabulary.quantities import normal_velocity, orbital_momentum
from ..intermediates import MOMENTUM

if TYPE_CHECKING:
    from ...physics.structure import Structure
    from ..model import Model


def admits(structure: Structure) -> bool:
    """True for structures with one slow variable: oblique, without strings, the spin eliminated."""
    return structure.oblique and structure.reduced and not structure.strings and not structure.partner


@cache
def coefficients(model: Model) -> dict[str, sp.Expr] | None:
    """f, s, J_r, c and A as functions of the gap and of the centre distance r; None for rates of another form.

    Another form has, for instance, the film of a user's model whose resistance depends on the velocity.
    """
    u, momentum, keep = normal_velocity, orbital_momentum, (DISTANCE.name, MOMENTUM.name)
    rates = model.by_state("right_hand_side", keep)
    push, turn = (rates[state].subs({FILM: 1, SHEAR: 1}) for state in (u, momentum))
    rigid = model.by_state("rigid_rotation", keep)[momentum]
    film = -push.diff(u)
    centrifugal = push.diff(momentum, 2) / 2
    attractions = -push.subs({u: 0, momentum: 0})
    relaxation = -turn.diff(momentum)
    residuals = (push - (centrifugal * momentum**2 - attractions - film * u), turn + relaxation * (momentum - rigid))
    if any(sp.simplify(sp.expand(rest)) != 0 for rest in residuals):
        return None
    names = ("slowing", "relaxation", "rigid", "centrifugal", "attractions")
    values = (film, sp.factor(relaxation), rigid, sp.factor(centrifugal), attractions)
    closed = not any(value.free_symbols & {u, momentum} for value in values)
    return dict(zip(names, values, strict=True)) if closed else None
