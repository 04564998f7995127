"""A model's emitted expressions in closed form: intermediates substituted, laws filled, derivatives through laws."""

from __future__ import annotations

import sympy as sp
from sympy.core.function import AppliedUndef

from ..physics.laws import slot_call
from ..physics.laws.base import is_slot_call

SIZES = ("centres", "radius", "partner_radius", "spin_inertia", "partner_inertia")
"""Intermediates of an unequal pair that are kept as symbols, so that results hold for any sizes."""


def slope_along(energy: sp.Expr, variable: sp.Symbol) -> sp.Expr:
    """Derivative of an energy, with d rise/d offset_squared = stiffness/2 (checked by strings_are_conservative)."""
    heights = {node: sp.Dummy("height") for node in energy.atoms(AppliedUndef) if is_slot_call(node)}
    flat = energy.xreplace(heights)
    slope = flat.diff(variable)
    for node, height in heights.items():
        slope += flat.diff(height) * slot_call("strings", "stiffness", *node.args) / 2 * node.args[1].diff(variable)
    return slope
