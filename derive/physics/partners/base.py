"""What the rotation of a structure with an unequal partner is made of, nondimensional and ready to be emitted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from ..laws.base import Definition


@dataclass(frozen=True)
class Rotation:
    """States and expressions of all that is not along the line of centres.

    Arguments:
        states: the states beside gap and normal velocity.
        definitions: named intermediates, in order.
        centrifugal: what opens the gap, over m v0^2/x0; 0 if nothing turns.
        rates: of the states, per v0/x0.
        turning: rate of the angle turned by the line of centres, None if it cannot turn.
        kinetic: energy over m v0^2.
        power: taken by the tangential film, over m v0^3/x0.
        momentum: angular momentum over its start value, None if none is conserved.
        outputs: what a separated pair shows.
        least: (least rotational energy over m v0^2 for the state's angular momentum, its slope along the gap).
        rigid: the state of least energy.
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
