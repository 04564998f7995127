"""From quantities in SI to the groups of a collision, in C."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from ..laws.base import slot_call
from ..model import Model
from ..quantities import VOCABULARY, R, contact_angle, rupture_gap, volume, x0
from ..scaling import group_definitions
from .taylor_c import Text, comment, function

_OWN_RUPTURE = R * slot_call("bridge", "rupture_distance", volume, contact_angle) / x0  # the law's own


def scale_function(model: Model, own: Mapping[sp.Symbol, sp.Expr]) -> list[str]:
    """The groups from SI quantities, whose names are exported in the order they are given in.

    Arguments:
        own: groups of a user's model in SI quantities.
    """
    definitions = {**group_definitions(), **own}
    expressions = {group: definitions.get(group, group) for group in model.groups}
    used = set().union(*(expression.free_symbols for expression in expressions.values()))
    names = [name for name in VOCABULARY if VOCABULARY[name].symbol in used]
    names += sorted(symbol.name for symbol in used if symbol.name not in names)
    text = Text(lambda symbol: f"q[SI_{symbol.name.upper()}]")
    lines = [f"enum {{ {', '.join(f'SI_{name.upper()}' for name in names)}, QUANTITIES }};"]
    lines += ["const char quantity_names[] =", *(f'    "{name} "' for name in names[:-1]), f'    "{names[-1]}";', ""]
    body = [f"c->{group.name} = {text.vector(value)};" for group, value in expressions.items()]
    if rupture_gap in expressions:
        body += ["#if OWN_RUPTURE", f"c->rupture_gap = {text.vector(_OWN_RUPTURE)};", "#endif"]
    doc = "The groups of a collision from its quantities in SI."
    return [*lines, *comment(doc), *function("static inline void scale(constants *c, const vec *q)", body), ""]
