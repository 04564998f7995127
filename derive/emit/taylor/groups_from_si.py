"""C function from quantities in SI to the groups of a collision."""

from collections.abc import Callable, Mapping

import sympy as sp

from ...equations.model import Model
from ...physics.law import slot_call
from ...physics.scaling import group_definitions, impact_groups, scale_definitions
from ...vocabulary import quantities as q
from .c_text import Text
from .layout import comment, documented

_PER_DISTANCE = q.R / q.x0


def own_rupture() -> sp.Expr:
    """The rupture gap by the distance of the bridge law itself."""
    return _PER_DISTANCE * slot_call("bridge", "rupture_distance", q.volume, q.contact_angle)


def scale_function(model: Model, user_groups: Mapping[sp.Symbol, sp.Expr]) -> list[str]:
    """The groups from SI quantities; names and order of the quantities are exported.

    Arguments:
        user_groups: groups of a user's model in SI quantities.
    """
    expressions = group_expressions(model, user_groups)
    names = [symbol.name for symbol in group_quantities(expressions)]
    text = Text(_place("c", expressions))
    lines = [f"enum {{ {', '.join(f'SI_{name.upper()}' for name in names)}, QUANTITIES }};"]
    lines += ["const char quantity_names[] =", *(f'    "{name} "' for name in names[:-1]), f'    "{names[-1]}";', ""]
    body = [f"c->{group.name} = {text.vector(value)};" for group, value in expressions.items()]
    if q.rupture_gap in expressions:
        body += ["#if OWN_RUPTURE", f"c->rupture_gap = {text.vector(own_rupture())};", "#endif"]
    doc = "The groups of a collision from its quantities in SI."
    lines += documented(doc, "static inline void scale(constants *c, const vec *q)", body)
    if q.obliquity not in expressions:
        return lines
    scales = {"": q.rate_scale, "wall": q.rate_scale_wall, "pair": q.rate_scale_pair, "space": q.rate_scale_pair}
    value = scale_definitions()[scales[model.structure.partner]]
    head = "static inline vec rate_scale(const constants *c, const vec *q)"
    return lines + documented("Omega, the unit of angular velocities, in rad/s.", head, [f"return {text(value)};"])


def group_expressions(model: Model, user_groups: Mapping[sp.Symbol, sp.Expr]) -> dict[sp.Symbol, sp.Expr]:
    """The groups of a model in SI quantities."""
    definitions = {**group_definitions(), **impact_groups(model.structure.partner), **user_groups}
    return {group: definitions.get(group, group) for group in model.groups}


def _place(constants: str, expressions: Mapping[sp.Symbol, sp.Expr]) -> Callable[[sp.Symbol], str]:
    """The C text of a symbol: a group that has a formula, or a quantity in SI."""
    members = {group for group, expression in expressions.items() if group != expression}
    return lambda symbol: f"{constants}->{symbol.name}" if symbol in members else f"q[SI_{symbol.name.upper()}]"


def group_quantities(expressions: Mapping[sp.Symbol, sp.Expr]) -> list[sp.Symbol]:
    """The quantities in groups: those of the vocabulary in its order, then those declared by a user."""
    used = set().union(*(expression.free_symbols for expression in expressions.values())) - {q.obliquity}
    result = [quantity.symbol for quantity in q.VOCABULARY.values() if quantity.symbol in used]
    return result + sorted(used - set(result), key=lambda symbol: str(symbol.name))


def scale_slopes(model: Model, user_groups: Mapping[sp.Symbol, sp.Expr]) -> list[str]:
    """Derivatives of the groups by the quantities in SI, and the groups that each quantity affects."""
    wanted, shape = group_expressions(model, user_groups), (q.volume, q.contact_angle)
    text = Text(_place("v", wanted))
    bits: dict[sp.Symbol, int] = dict.fromkeys(group_quantities(wanted), 0)
    body = ["(void)v; (void)q;", "memset(slope, 0, sizeof(vec)*GROUPS);", "switch (quantity) {"]
    for symbol in bits:
        body.append(f"case SI_{symbol.name.upper()}:")
        for place, (group, expression) in enumerate(wanted.items()):
            slope = _power_slope(expression, symbol, group)
            if slope != 0 and group != q.obliquity:  # a scale: no result depends on it
                bits[symbol] |= 1 << place
                line = f"    slope[BY_{group.name.upper()}] = {text.vector(slope)};"
                if group == q.rupture_gap:
                    by_own = _power_slope(_PER_DISTANCE, symbol, q.rupture_gap)  # for the law's own distance
                    if symbol in shape:
                        by_own = _PER_DISTANCE * slot_call("bridge", f"rupture_distance_by_{symbol.name}", *shape)
                    own_line = f"    slope[BY_RUPTURE_GAP] = {text.vector(by_own)};"
                    body += ["#if OWN_RUPTURE", own_line, "#else", line, "#endif"]
                else:
                    body.append(line)
        body.append("    break;")
    body.append("}")
    head = "static inline void scale_along(const constants *v, const vec *q, int quantity, vec *slope)"
    moved = f"const unsigned moved_groups[QUANTITIES] = {{ {', '.join(map(str, bits.values()))} }};"
    lines = [*comment("The groups that each quantity in SI moves, as bits."), moved, ""]
    return lines + documented("How the groups change with a quantity in SI.", head, body)


def _power_slope(expression: sp.Expr, symbol: sp.Symbol, group: sp.Symbol) -> sp.Expr:
    """Derivative of a group by `symbol`; in terms of the group if the symbol is a factor that is never zero."""
    if expression == symbol:
        return sp.Integer(1)
    power = expression.as_powers_dict().get(symbol, 0)
    if symbol.is_positive and power != 0 and not (expression / symbol**power).has(symbol):
        return power * group / symbol
    return sp.diff(expression, symbol)
