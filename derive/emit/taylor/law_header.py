"""C headers of the laws: constants, recurrences and values of each function; antiderivatives of forces and resistances.

A structure calls a law through its slot (`bridge_force_next`), so every law of a slot fits every structure.
"""

from collections.abc import Sequence
from collections.abc import Set as AbstractSet

import sympy as sp

from ...equations.model import GROUPS
from ...physics.law import Definition, Law, LawFunction, needed
from ..provenance import header, law_digest
from .c_text import Text
from .constants import Constants
from .layout import comment, documented, function, struct
from .loops import Loops
from .program import Program, cheapest
from .recurrences import Recurrences

COMPARED = {("glass", "pressure")}  # slot functions that an event compares with a limit
LIMIT = sp.Symbol("limit", positive=True)


def moves(arguments: tuple[sp.Symbol, ...], groups: AbstractSet[sp.Symbol] = frozenset()) -> tuple[bool, ...]:
    """For each argument of a law's function, whether it varies along a trajectory: all except groups do.

    Arguments:
        groups: those of a user's model, beside the library's.
    """
    return tuple(argument not in groups and argument not in GROUPS for argument in arguments)


def law_header(law: Law, groups: AbstractSet[sp.Symbol] = frozenset()) -> str:
    """The C header of a law; `groups` are a user's."""
    lines = comment(header(law_digest(law)))
    lines += ["", *comment(f"{law.slot} law `{law.name}`: {law.meaning}.\n\nSource: {law.source}."), ""]
    for formula in law.functions:
        if formula.name == "suction":
            lines += ["#define FILM_CAVITATES 1 /* no force while opening */", ""]
        elif formula.for_proof:
            name = f"{law.slot}_{formula.name}"
            lines += [f"#define {name.upper()} 1", *_plain(name, formula)]
        elif formula.name != "potential":  # serves `_closed_integral` only
            lines += _function(law, formula, moves(formula.arguments, groups))
    return "\n".join(lines).rstrip() + "\n"


def _plain(name: str, formula: LawFunction) -> list[str]:
    """A C function of values, without series: constant along a trajectory, or called by a stick certificate only."""
    text = Text(lambda symbol: symbol.name)
    intermediates, used = needed([formula.result], formula.definitions)
    body = [f"(void){argument.name};" for argument in formula.arguments if argument not in used]
    body += [f"vec {symbol.name} = {text.vector(value)};" for symbol, value in intermediates]
    arguments = ", ".join(f"vec {argument.name}" for argument in formula.arguments) or "void"
    head = f"static inline vec {name}({arguments})"
    return documented(formula.doc, head, [*body, f"return {text.vector(formula.result)};"])


def _function(law: Law, formula: LawFunction, series: tuple[bool, ...]) -> list[str]:
    moving = tuple(argument for argument, moved in zip(formula.arguments, series, strict=True) if moved)
    fixed = tuple(argument for argument in formula.arguments if argument not in moving)
    name = f"{law.slot}_{formula.name}"
    intermediates, _ = needed([formula.result, *(kink for kink, _ in formula.kinks)], formula.definitions)
    if not moving:
        return _plain(name, formula)
    if (law.slot, formula.name) in COMPARED:
        return _clearance(name, formula, intermediates, moving, fixed)
    program, result = cheapest(formula.result, intermediates, moving)
    constants = Constants({argument: f"c->{argument.name}" for argument in fixed})
    lines = _recurrences(name, formula.doc, program, result, constants, moving, [kink for kink, _ in formula.kinks])
    if formula.falls:
        lines += [f"#define {name.upper()}_FALLS 1 /* never increases with its first argument */", ""]
    integral = _closed_integral(law, formula, intermediates, moving, constants)
    if integral is not None:
        lines += work_lines(name, integral, constants, moving[0])
    # later lines may hoist more constants, so the struct is written last
    return [*_constants(name, constants, fixed), *lines]


def _constants(name: str, constants: Constants, fixed: tuple[sp.Symbol, ...]) -> list[str]:
    names = [*(argument.name for argument in fixed), *constants.prepared]
    fields = f"vec {', '.join(names or ['none'])};"  # C has no empty structures
    arguments = "".join(f", vec {argument.name}" for argument in fixed)
    body = [f"c->{argument.name} = {argument.name};" for argument in fixed]
    body += constants.assignments()
    head = f"static inline void {name}_prepare({name}_constants *c{arguments})"
    struct_line = f"typedef struct {{ {fields} }} {name}_constants;"
    return [struct_line, "", *function(head, body or ["c->none = splat(0.0);"]), ""]


def _recurrences(
    name: str,
    doc: str,
    program: Program,
    result: str | sp.Expr,
    constants: Constants,
    moving: tuple[sp.Symbol, ...],
    kinks: Sequence[sp.Symbol] = (),
) -> list[str]:
    recurrences = Recurrences(program, constants, lambda series: series, loops=Loops(program.operations))
    value: str
    if not isinstance(result, str):
        ending, value = [f"s->result[k] = {constants.level(result, 'level')};"], constants.vector(result, "level")
    elif result == "result" and program.operations and program.operations[-1].name == "result":
        ending, value = [], result
    else:
        ending, value = [f"s->result[k] = {recurrences.array(result)}[k];"], result
    fields = recurrences.fields() + (["vec result[TERMS];"] if ending else [])
    places = {kink.name: recurrences.array(program.series(kink)) for kink in kinks}
    for kink, array in places.items():
        if array != f"s->{kink}":  # of an argument, or of a part that has its own name
            fields.append(f"vec {kink}[TERMS];")
            ending.append(f"s->{kink}[k] = {array}[k];")
    series = "".join(f", const vec *{argument.name}" for argument in moving)
    values = "".join(f", vec {argument.name}" for argument in moving)
    unused = "".join(f"(void){argument.name}; " for argument in moving) + "(void)c;"
    return [
        *struct(f"{name}_series", fields),
        *([f"#define {name}_kinks(s) {', '.join(f'(s)->{kink}' for kink in places)}", ""] if places else []),
        *documented(
            f"{doc} Coefficient k of its series; products of series: {program.cost:g}.",
            f"INLINE void {name}_next({name}_series *s, const {name}_constants *c{series}, int k)",
            [unused, *recurrences.lines(), *ending],
        ),
        *documented(
            doc,
            f"static inline vec {name}_value(const {name}_constants *c{values})",
            [unused, *recurrences.values([value]), f"return {value};"],
        ),
    ]


def _closed_integral(
    law: Law, formula: LawFunction, intermediates: list[Definition], moving: tuple[sp.Symbol, ...], constants: Constants
) -> sp.Expr | None:
    """Antiderivative of a force (its work) or of the film's resistance (momentum taken), in closed form.

    It is the law's potential or follows by rules, else None; constants that it needs are added to `constants`.
    """
    if formula.name not in ("force", "resistance") or len(moving) != 1:
        return None
    for other in law.functions:
        if (other.name, other.arguments) == ("potential", formula.arguments):
            potential = other(*other.arguments)
            if sp.simplify(potential.diff(moving[0]) - formula(*formula.arguments)) == 0:
                return potential
    if formula.kinks:  # no rule has them
        return None
    force, change = formula.result, {moving[0]}  # what changes with the gap, directly or by another intermediate
    for symbol, value in intermediates:
        if value.free_symbols & change:
            change.add(symbol)
        else:
            constants.define(symbol, value)
    for symbol, value in reversed(intermediates):
        if symbol in change:
            force = force.subs(symbol, value)
    return antiderivative(force, moving[0])


def work_lines(name: str, integral: sp.Expr, constants: Constants, moving: sp.Symbol) -> list[str]:
    """The C function of an antiderivative, and the macro that says it exists."""
    program = Program((moving,))
    result = program.series(integral, "work")
    recurrences = Recurrences(program, constants, lambda series: series)
    head = f"static inline vec {name}_work(const {name}_constants *c, vec {moving.name})"
    body = ["(void)c;", *recurrences.values([result]), f"return {result};"]
    return [f"#define {name.upper()}_WORK 1", *documented("Antiderivative, in closed form.", head, body)]


def _clearance(
    name: str,
    formula: LawFunction,
    intermediates: list[Definition],
    moving: tuple[sp.Symbol, ...],
    fixed: tuple[sp.Symbol, ...],
) -> list[str]:
    """The C of `clearance`.

    Sides stay within a step: no state's series has them, so nothing else makes steps as short as a rounded side needs.
    """
    sides = {side: sp.sign(kink) for kink, side in formula.kinks}
    expression, positive = clearance(formula, moving)
    definitions = [(symbol, sides.get(symbol, value)) for symbol, value in intermediates]
    program, series = cheapest(expression, definitions, moving)
    constants = Constants({argument: f"c->{argument.name}" for argument in (*fixed, LIMIT)})
    doc = f"Limit minus value{', times the positive denominator' if positive else ''}: the sign of the event function."
    kinks = [kink for kink, _ in formula.kinks]
    lines = _recurrences(f"{name}_clearance", doc, program, series, constants, moving, kinks)
    return [*_constants(f"{name}_clearance", constants, (*fixed, LIMIT)), *lines]


def clearance(formula: LawFunction, moving: tuple[sp.Symbol, ...]) -> tuple[sp.Expr, bool]:
    """`limit - value` times the positive denominator of the value: same sign, without division along a trajectory.

    Returns:
        The expression, and whether the denominator is positive; without one, and for a law with kinks, whose guards
        lose their digits in it, it is the difference itself.
    """
    over, under = sp.fraction(sp.together(formula.result))
    positive = bool(under.is_positive) and not formula.kinks
    margin = LIMIT * under - over if positive else LIMIT - formula.result
    return sp.collect(sp.expand(margin), moving[-1]), positive  # approach*(gap^2 - 1) vanishes exactly at the rim


def antiderivative(force: sp.Expr, variable: sp.Symbol) -> sp.Expr | None:
    """The antiderivative of `force` in `variable`, verified by differentiation; None if no rule applies to a term."""
    total = sp.Integer(0)
    for term in sp.Add.make_args(sp.expand(force, power_exp=False, power_base=False, log=False, trig=False)):
        integral = _of_term(term, variable)
        if integral is None:
            return None
        total += integral
    residue = sp.simplify(sp.expand(total.diff(variable) - force))
    return total if residue == 0 else None


def _of_term(term: sp.Expr, variable: sp.Symbol) -> sp.Expr | None:
    constant, moving = term.as_independent(variable, as_Add=False)
    if moving == 1:
        return constant * variable
    if moving.is_Pow and moving.base == variable and moving.exp != -1 and not moving.exp.has(variable):
        return constant * variable ** (moving.exp + 1) / (moving.exp + 1)
    if moving == 1 / variable:
        return constant * sp.log(variable)
    if moving == variable:
        return constant * variable**2 / 2
    if isinstance(moving, sp.exp):
        slope = moving.args[0].diff(variable)
        return None if slope.has(variable) or slope == 0 else constant * moving / slope
    return _gap_over_root(constant, moving, variable)


def _gap_over_root(constant: sp.Expr, moving: sp.Expr, variable: sp.Symbol) -> sp.Expr | None:
    """The rule h/sqrt(q) -> 2 sqrt(q)/(q'/h), for q' proportional to h."""
    roots = [factor for factor in sp.Mul.make_args(moving) if factor.is_Pow and factor.exp == -sp.Rational(1, 2)]
    if len(roots) != 1 or sp.simplify(moving * sp.sqrt(roots[0].base)) != variable:
        return None
    share = sp.simplify(roots[0].base.diff(variable) / variable)
    return None if share.has(variable) else constant * 2 * sp.sqrt(roots[0].base) / share
