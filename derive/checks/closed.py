"""A model's emitted expressions in closed form: intermediates substituted, laws filled, derivatives through laws."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator

import sympy as sp

from ..equations.model import Model
from ..physics.laws import slot_call
from ..physics.laws.base import slot_calls

SIZES = ("centres", "radius", "partner_radius", "spin_inertia", "partner_inertia")
"""Intermediates of an unequal pair that are kept as symbols, so that results hold for any sizes."""


def special_case(
    special: Model, names: Iterable[str], general: Model, rule: Callable[[sp.Expr], sp.Expr], keep: Collection[str] = ()
) -> Iterator[sp.Expr]:
    """What functions of a general model are, under a rule, in excess of those of a special one: zero if they agree."""
    for name in names:
        whole = general.results(name, keep)
        for key, value in special.results(name, keep).items():
            yield rule(whole[key]) - value


def slope_along(energy: sp.Expr, variable: sp.Symbol) -> sp.Expr:
    """Derivative of an energy, with d rise/d offset_squared = stiffness/2 (checked by strings_are_conservative)."""
    heights = {node: sp.Dummy("height") for node in slot_calls(energy)}
    flat = energy.xreplace(heights)
    slope = flat.diff(variable)
    for node, height in heights.items():
        slope += flat.diff(height) * slot_call("strings", "stiffness", *node.args) / 2 * node.args[1].diff(variable)
    return slope
