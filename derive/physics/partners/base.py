"""The rotational part of a structure with an unequal partner, nondimensional."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp

from ..law import Definition


@dataclass(frozen=True)
class Rotation:
    """States and expressions of the motion other than along the line of centres.

    Arguments:
        states: the states beside gap and normal velocity.
        definitions: named intermediates, in order.
        centrifugal: centrifugal force on the gap, over m v0^2/x0; 0 beside a wall.
        rates: of the states, per v0/x0.
        turning: angular velocity of the line of centres, None beside a wall.
        kinetic: energy over m v0^2.
        power: dissipated by the tangential film force, over m v0^3/x0.
        momentum: 1 + the change of the angular momentum over its first size, None if it is not conserved.
        outputs: results for a separated pair.
        surface_slip: relative velocity of the surfaces at the contact, over a times the scale of rates.
        least: (least rotational energy over m v0^2 for the state's angular momentum, its slope along the gap).
        rigid: the state with that energy; empty in space, where it also depends on the direction of n.
        start: the state at initial contact.
        wobble: in space, energy over m v0^2 of neither rigid rotation across the line of centres nor twist.
        outward_at_most: in space, a bound of the centrifugal force on a resting doublet from now on, over m v0^2/x0.
        rigid_rotation: in space, the angular momentum's components, and rate of rotation per v0/x0 by which they turn
            the doublet's line of centres, of each.
    """

    states: tuple[sp.Symbol, ...]
    definitions: tuple[Definition, ...]
    centrifugal: sp.Expr
    rates: Mapping[sp.Symbol, sp.Expr]
    turning: sp.Expr | None
    kinetic: sp.Expr
    power: sp.Expr
    momentum: sp.Expr | None
    outputs: Mapping[str, sp.Expr]
    surface_slip: sp.Expr
    least: tuple[sp.Expr, sp.Expr]
    rigid: Mapping[sp.Symbol, sp.Expr]
    start: Mapping[sp.Symbol, sp.Expr]
    outward_at_most: sp.Expr = sp.S.Zero
    wobble: sp.Expr = sp.S.Zero
    rigid_rotation: Mapping[str, sp.Expr] = field(default_factory=dict)


def relative_change(momentum: sp.Expr, first: Sequence[sp.Expr]) -> sp.Expr:
    """1 + the change of an angular momentum over the sum of the magnitudes of its first parts."""
    size = sp.Add(*(sp.Abs(term) for term in first))
    return 1 + (momentum - sp.Add(*first)) / size
