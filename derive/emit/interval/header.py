"""The C headers of a structure and of a law over intervals."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from ...equations.certificates.table import enclosed
from ...equations.events import CONTACT_GAPS, contact_gap
from ...equations.model import Model, without_partner_spin
from ...equations.observables import excess_energy
from ...physics.forces import FILM, SHEAR
from ...physics.law import Definition, Law, needed, slot_call
from ...physics.scaling import group_definitions
from ...physics.structure import Structure
from ...vocabulary import quantities as q
from ..casadi.printer import EmissionError
from ..provenance import header, law_digest, model_digest
from ..taylor.groups_from_si import group_expressions, group_quantities, own_rupture
from ..taylor.law_header import COMPARED, LIMIT, clearance, moves
from ..taylor.layout import comment, documented, function, struct
from ..taylor.program import Program, cheapest
from .text import Constants, dual, recurrences


def refused(structure: Structure) -> str:
    """What of a structure is not enclosed; "" if all of it is."""
    if structure.strings or structure.friction or structure.partner in ("wall", "space"):
        return "a structure with strings, friction, a wall's rotation or rotation in space"
    if structure.oblique and not (structure.reduced or structure.partner):
        return "a lever arm that is not at mid-gap"
    return "a film that follows the bridge's volume" if structure.spread else ""


def law_header(law: Law) -> str:
    """The C header of a law: its constants, its recurrences, and its functions of constants."""
    lines = [*comment(header(law_digest(law))), "", *comment(f"{law.slot} law `{law.name}`: {law.meaning}."), ""]
    for entry in law.functions:
        if entry.name == "suction":
            raise EmissionError("the force has another form while opening")
        if entry.for_proof or entry.name == "potential":
            continue
        name, intermediates = f"{law.slot}_{entry.name}", needed([entry.result], entry.definitions)[0]
        moving = tuple(a for a, moved in zip(entry.arguments, moves(entry.arguments), strict=True) if moved)
        fixed = [argument for argument in entry.arguments if argument not in moving]
        if not moving:
            body = [f"dual {s.name} = {dual(value, lambda symbol: symbol.name)};" for s, value in intermediates]
            head = f"static dual {name}({', '.join(f'dual {argument.name}' for argument in fixed)})"
            lines += documented(entry.doc, head, [*body, f"return {dual(entry.result, lambda symbol: symbol.name)};"])
            continue
        if (law.slot, entry.name) in COMPARED:
            expression, fixed = clearance(entry, moving)[0], [*fixed, LIMIT]
        else:
            expression = entry.result
        program, result = cheapest(expression, intermediates, moving)
        lines += _law_function(name, entry.doc, program, result, moving, fixed)
    return "\n".join(lines).rstrip() + "\n"


def _law_function(
    name: str, doc: str, program: Program, result: str | sp.Expr, moving: tuple[sp.Symbol, ...], fixed: list[sp.Symbol]
) -> list[str]:
    constants = Constants(fixed)
    given = {argument.name for argument in moving}

    def where(series: str) -> str:
        return series if series in given else "result" if series == result else f"&s->{series}"

    lines = recurrences(program, constants, where)
    if not isinstance(result, str):
        lines.append(f"s_constant(result, &{constants.name(result)}, k);")
    elif result in given:
        raise EmissionError(f"{name} is its own argument")
    own = [operation.name for operation in program.operations if operation.name != result]
    members = [f"dual {member};" for member in (*(a.name for a in fixed), *constants.prepared)]
    series = "".join(f", const series *{argument.name}" for argument in moving)
    return [
        *struct(f"{name}_constants", members or ["dual none;"]),
        *struct(f"{name}_series", [f"series {entry};" for entry in own] or ["char none;"]),
        *function(
            f"static void {name}_prepare({name}_constants *c{''.join(f', dual {a.name}' for a in fixed)})",
            ["(void)c;", *(f"c->{argument.name} = {argument.name};" for argument in fixed), *constants.assignments()],
        ),
        "",
        *documented(
            f"{doc} Coefficient k of its series.",
            f"static void {name}_next({name}_series *s, series *result, const {name}_constants *c{series}, int k)",
            ["(void)s; (void)c;" + "".join(f" (void){argument.name};" for argument in moving), *lines],
        ),
    ]


def structure_header(model: Model) -> str:
    """The C header of a structure.

    Raises:
        EmissionError: collisions of this structure cannot be enclosed.
    """
    shape = model.structure
    if reason := refused(shape):
        raise EmissionError(f"{reason} is not enclosed")
    model = without_partner_spin(model)
    constants = Constants((*model.groups, FILM, SHEAR))
    rates = model["right_hand_side"].by_name
    program = Program.for_outputs(model.states, rates.values(), model.definitions)
    results = {name: program.result(rate, f"rate_of_{name}") for name, rate in rates.items()}
    states = [state.name for state in model.states]
    places = {name: f"&s->state[{name.upper()}]" for name in states}

    def where(series: str) -> str:
        return places.get(series, f"&s->{series}")

    minus = constants.name(sp.Integer(-1))
    flow = recurrences(program, constants, where)
    for name, rate in results.items():
        source = f"{where(rate)}, NULL" if isinstance(rate, str) else f"NULL, &{constants.name(rate)}"
        flow.append(f"s_advance({places[name]}, {source}, k);")
    calls = {operation.name: operation.call for operation in program.operations if operation.kind == "call"}
    prepare = []
    for name, (slot, call, arguments) in calls.items():
        still = "".join(f", {constants.name(a)}" for a in arguments if not isinstance(a, str))
        prepare.append(f"{slot}_{call}_prepare(&c->{name}_constants{still});")
    prepare.append("glass_pressure_prepare(&c->glass, c->glass_number);")
    lines = [*comment(header(model_digest(model))), ""]
    lines += [f"enum {{ {', '.join(name.upper() for name in states)}, STATES }};"]
    words = ("oblique", "bridge", "attraction")
    lines += [f"enum {{ {', '.join(f'{word.upper()} = {int(getattr(shape, word))}' for word in words)} }};"]
    lines += ['#include "series.h"', ""]
    values = _values(model, constants)
    members = [
        f"dual {member};" for member in (*(g.name for g in model.groups), FILM.name, SHEAR.name, *constants.prepared)
    ]
    members += [f"{slot}_{call}_constants {name}_constants;" for name, (slot, call, _) in calls.items()]
    lines += struct("constants", [*members, "glass_pressure_constants glass;"])
    lines += _scale(model)
    lines += documented(
        "Constants from the groups and the region's flags.",
        "static void prepare(constants *c)",
        [*constants.assignments(), *prepare],
    )
    series = [f"series {operation.name};" for operation in program.operations]
    series += [f"{slot}_{call}_series {name}_parts;" for name, (slot, call, _) in calls.items()]
    lines += struct(
        "flow", ["series state[STATES];", *series, "series approach, clearance;", "glass_pressure_series glass;"]
    )
    lines += documented(
        "Coefficient k of every series and k + 1 of the states.",
        "static void advance(flow *s, const constants *c, int k)",
        flow,
    )
    lines += documented(
        "Coefficient k of the clearance of the glass criterion.",
        "static void advance_clearance(flow *s, const constants *c, int k)",
        [
            f"s_scaled(&s->approach, &s->state[NORMAL_VELOCITY], &{minus}, k);",
            "glass_pressure_next(&s->glass, &s->clearance, &c->glass, &s->state[GAP], &s->approach, k);",
        ],
    )
    return "\n".join([*lines, *values]).rstrip() + "\n"


def _scale(model: Model) -> list[str]:
    """The groups from quantities in SI; a contact gap whose quantities are absent (NaN) is 0."""
    expressions = group_expressions(model, {})
    symbols = group_quantities(expressions)
    places = {symbol: f"q[SI_{symbol.name.upper()}]" for symbol in symbols}
    members = {group for group, expression in expressions.items() if group != expression}

    def name(symbol: sp.Symbol) -> str:
        return f"c->{symbol.name}" if symbol in members else places[symbol]

    body = []
    for group, expression in expressions.items():
        text = dual(_over_larger(expression, expressions), name)
        if group in CONTACT_GAPS.values():
            absent = " || ".join(f"d_absent({places[s]})" for s in symbols if s in expression.free_symbols)
            text = f"{absent} ? d_ratio(0.0, 1.0) : {text}"
        if group == q.rupture_gap:
            own = dual(own_rupture(), name).replace("bridge_rupture_distance", "BRIDGE_RUPTURE_DISTANCE")
            text = f"OWN_RUPTURE ? {own} : {text}"
        body.append(f"c->{group.name} = {text};")
    names = [*(symbol.name for symbol in symbols), q.stokes.name]
    lines = [f"enum {{ {', '.join(f'SI_{name.upper()}' for name in names)}, QUANTITIES }};"]
    lines += [f'static const char quantity_names[] = "{" ".join(names)}";', ""]
    speed = sp.solve(sp.Eq(group_definitions()[q.stokes], q.stokes), q.v0)[0]
    text = dual(speed, lambda symbol: f"q[SI_{symbol.name.upper()}]")
    body = ["if (!d_absent(q[SI_STOKES]))", f"    q[SI_SPEED] = {text};", *body]
    doc = "The groups of a collision from its quantities in SI; the speed from the Stokes number, if that is given."
    return lines + documented(doc, "static void scale(constants *c, dual *q)", body)


def _over_larger(ratio: sp.Expr, groups: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """A ratio x/T with T = max(x, y) as 1/max(1, y/x), which is exact where y is 0."""
    over, under = ratio.as_numer_denom()
    largest = groups.get(under, under)
    if not (isinstance(largest, sp.Max) and over in largest.args):
        return ratio
    return 1 / sp.Max(*(size / over for size in largest.args))


def _values(model: Model, constants: Constants) -> list[str]:
    """Functions of values: levels of the gap, the state at the start and behind a rebound, energies."""
    shape = model.structure
    edge = dual(slot_call("shear", "edge", q.aspect), constants.name) if shape.oblique else "d_ratio(1e300, 1.0)"
    rupture = constants.name(q.rupture_gap) if shape.bridge else "d_ratio(1.0, 1.0)"
    body = [
        f"level[CONTACT_GAP] = {dual(contact_gap, constants.name)};",
        f"level[RUPTURE_GAP] = {rupture};",
        f"level[TANGENTIAL_EDGE] = {edge};",
    ]
    lines = ["enum { CONTACT_GAP, RUPTURE_GAP, TANGENTIAL_EDGE, LEVELS };"]
    lines += documented("Gaps of events.", "static void levels(const constants *c, dual *level)", body)
    for name, array in (("start", "y"), ("rebound", "after")):
        passed = ", const dual *y, dual *after" if array == "after" else ", dual *y"
        wanted = {f"{array}[{state.name.upper()}]": model[name][state.name] for state in model.states}
        lines += _value(model, constants, f"static void {name}(const constants *c{passed})", model[name].doc, wanted)
    least = model["effective_potential"]
    held = sp.Add(*model["energies"].by_name.values())
    doc = "Energy above the least at the same gap and angular momentum, over m v0^2."
    lines += _energy(model, constants, "excess", doc, excess_energy(held))
    lines += _energy(model, constants, "least", least.doc, least["energy"])
    held, needed_there, further = enclosed(shape) or (held, least["energy"], ())
    lines += _energy(model, constants, "held", "Energy over m v0^2 that may carry the state to a larger gap.", held)
    doc = "What is needed of it at this gap with this momentum, over m v0^2, without work."
    return lines + _energy(model, constants, "needed", doc, needed_there, further)


def _energy(
    model: Model, constants: Constants, name: str, doc: str, value: sp.Expr, further: tuple[Definition, ...] = ()
) -> list[str]:
    head = f"static dual {name}_energy(const constants *c, const dual *y)"
    return _value(model, constants, head, doc, {"return": value}, further)


def _value(
    model: Model,
    constants: Constants,
    head: str,
    doc: str,
    wanted: Mapping[str, sp.Expr],
    further: tuple[Definition, ...] = (),
) -> list[str]:
    """A C function of the states `y`, by C text of each target, or "return"; `further` definitions are its own."""
    places = {state: f"y[{state.name.upper()}]" for state in model.states}
    intermediates = needed(list(wanted.values()), (*model.definitions, *further))[0]
    definitions = [definition for definition in intermediates if definition[0] not in constants]
    local = {symbol: symbol.name for symbol, _ in definitions}

    def name(symbol: sp.Symbol) -> str:
        return places.get(symbol) or local.get(symbol) or constants.name(symbol)

    body = ["(void)c; (void)y;", *(f"dual {symbol.name} = {dual(value, name)};" for symbol, value in definitions)]
    for target, value in wanted.items():
        text = dual(sp.sympify(value), name)
        body.append(f"return {text};" if target == "return" else f"{target} = {text};")
    return documented(doc, head, body)
