"""A model's emitted expressions in closed form: intermediates substituted, laws filled, derivatives through laws."""

from __future__ import annotations

from functools import cache

import sympy as sp
from sympy.core.function import AppliedUndef

from ..equations.model import Model
from ..physics.laws import slot_call
from ..physics.laws.base import filled, is_slot_call

__all__ = ["emitted_rates", "filled", "slope_along"]


@cache
def emitted_rates(model: Model) -> dict[sp.Symbol, sp.Expr]:
    """The emitted right-hand side by state, with every intermediate substituted."""
    named = model["right_hand_side"].by_name
    return {state: model.expanded(named[state.name]) for state in model.states}


# of an unequal pair, kept as symbols
SIZES = ("centres", "radius", "partner_radius", "spin_inertia", "partner_inertia")


def opened(model: Model, expression: sp.Expr) -> sp.Expr:
    """`Model.expanded`, except for the sizes of an unequal pair: results hold for any sizes."""
    for symbol, value in reversed(model.definitions):
        if symbol.name not in SIZES:
            expression = expression.subs(symbol, value)
    return expression


def opened_rates(model: Model) -> dict[sp.Symbol, sp.Expr]:
    """`emitted_rates`, except for the sizes of an unequal pair."""
    named = model["right_hand_side"].by_name
    return {state: opened(model, named[state.name]) for state in model.states}


def slope_along(energy: sp.Expr, variable: sp.Symbol) -> sp.Expr:
    """Derivative of an energy, with d rise/d offset_squared = stiffness/2 (checked by strings_are_conservative)."""
    heights = {node: sp.Dummy("height") for node in energy.atoms(AppliedUndef) if is_slot_call(node)}
    flat = energy.xreplace(heights)
    slope = flat.diff(variable)
    for node, height in heights.items():
        slope += flat.diff(height) * slot_call("strings", "stiffness", *node.args) / 2 * node.args[1].diff(variable)
    return slope
