"""The rotational part of a structure with an unequal partner, nondimensional."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from ..laws.base import Definition


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
        momentum: angular momentum over its initial value, None if it is not conserved.
        outputs: results for a separated pair.
        least: (least rotational energy over m v0^2 for the state's angular momentum, its slope along the gap).
        rigid: the state with that energy.
        start: the state at initial contact.
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
    least: tuple[sp.Expr, sp.Expr]
    rigid: Mapping[sp.Symbol, sp.Expr]
    start: Mapping[sp.Symbol, sp.Expr]
