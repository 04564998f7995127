"""C headers with the derivatives of a law by each argument, as series in terms of the law's own series."""

from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from functools import cache, lru_cache

import sympy as sp

from ...physics.law import Law, LawFunction, needed
from ...physics.scaling import as_product
from ...physics.slots import place_of
from ..provenance import header, law_digest
from .c_text import Text
from .chain_rule import Chain
from .constants import Constants
from .law_header import COMPARED, LIMIT, moves
from .layout import comment, documented, each_term, function, struct
from .loops import Loops
from .program import Program, cheapest
from .recurrences import Recurrences

UNUSED = "unused_"  # prefix of an argument that a law ignores


def arguments(slot: str, name: str, count: int, extra: tuple[sp.Symbol, ...] = ()) -> tuple[str, ...]:
    """Names of a slot function's arguments, of which there are so many.

    Arguments:
        extra: additional arguments at the end, passed by a user's model.
    """
    spread = count > len(place_of(slot, name).arguments) + len(extra)
    return tuple(argument.name for argument in (*place_of(slot, name, spread).arguments, *extra))


def _by(argument: sp.Symbol) -> str:
    return f"by_{argument.name.removeprefix(UNUSED)}"


def slopes_header(law: Law, groups: AbstractSet[sp.Symbol] = frozenset()) -> str:
    """The C header with the derivatives of a law; `groups` are a user's."""
    lines = comment(header(law_digest(law)))
    lines += ["", *comment(f"Slopes of the {law.slot} law `{law.name}`."), ""]
    for formula in law.functions:
        if formula.for_proof or formula.name in ("suction", "potential"):  # no force, nor the work of one
            continue
        name = f"{law.slot}_{formula.name}"
        moved = moves(formula.arguments, groups)
        moving = tuple(argument for argument, does in zip(formula.arguments, moved, strict=True) if does)
        if (law.slot, formula.name) in COMPARED:
            lines += _clearance(name, formula)
        elif moving:
            lines += _series(name, formula, moving)
        else:
            lines += _plain(name, formula)
    return "\n".join(lines).rstrip() + "\n"


def _plain(name: str, formula: LawFunction) -> list[str]:
    """Derivatives of a function that is constant along a trajectory."""
    chain, text = Chain(formula.definitions), Text(lambda symbol: symbol.name)
    head = ", ".join(f"vec {argument.name}" for argument in formula.arguments) or "void"
    lines = []
    for argument in formula.arguments:
        slope = sp.simplify(chain.by(formula.result, argument))
        definitions, _ = needed([slope], (*formula.definitions, *chain.named))
        body = [f"(void){other.name};" for other in formula.arguments]
        body += [f"vec {symbol.name} = {text.vector(value)};" for symbol, value in definitions]
        lines += function(f"static inline vec {name}_{_by(argument)}({head})", [*body, f"return {text.vector(slope)};"])
        lines += [""]
    return lines


def _cheapest(program: Program, forms: Iterable[sp.Expr]) -> sp.Expr:
    """The first of the forms of an expression that cost least to continue a program with."""

    def cost(form: sp.Expr) -> float:
        trial = program.continued()
        trial.result(form, "trial")
        return trial.cost

    return min(dict.fromkeys(forms), key=cost)


def shortest(program: Program, forms: Sequence[sp.Expr], name: str) -> str | sp.Expr:
    """The series of the cheapest form of an expression in `program`; the expression itself if constant."""
    return program.series(_cheapest(program, forms), name) if program.moves(forms[0]) else forms[0]


def define_shortest(program: Program, symbol: sp.Symbol, expression: sp.Expr) -> None:
    """Define a symbol as the cheapest form of an expression."""
    program.define(symbol, _cheapest(program, (expression, *factored(expression))))


@cache
def factored(expression: sp.Expr) -> tuple[sp.Expr, ...]:
    """Alternative forms of a sum: the common factor of all terms extracted, or that of most terms."""
    forms = [as_product(expression)]
    if isinstance(expression, sp.Add):
        forms += [sp.collect(expression, symbol) for symbol in sorted(expression.free_symbols, key=str)]
    return tuple(forms)


@lru_cache(maxsize=16)  # for the header, and for the check that compares it with CasADi's
def slope_program(
    formula: LawFunction, moving: tuple[sp.Symbol, ...]
) -> tuple[Program, str | sp.Expr, Program, dict[sp.Symbol, str | sp.Expr]]:
    """The program of a function and its result, its continuation by the slopes, and these by argument."""
    definitions, _ = needed([formula.result, *(kink for kink, _ in formula.kinks)], formula.definitions)
    value, result = cheapest(formula.result, definitions, moving)
    program, chain = value.continued(), Chain(definitions)
    slopes = {argument: chain.by(formula.result, argument) for argument in formula.arguments}
    for symbol, expression in chain.named:
        program.define(symbol, expression)
    rounds = any(
        value.is_Number for _, value in definitions
    )  # a kink's width: sympy factors such expressions for minutes
    forms = {argument: (slope,) if rounds else (slope, as_product(slope)) for argument, slope in slopes.items()}
    results = {argument: shortest(program, form, _by(argument)) for argument, form in forms.items()}
    return value, result, program, results


def _series(name: str, formula: LawFunction, moving: tuple[sp.Symbol, ...]) -> list[str]:
    value, _, program, results = slope_program(formula, moving)
    law_series = {operation.name for operation in value.operations}
    places = {symbol: f"v->{symbol.name}" for symbol in (*formula.arguments, *value.named) if symbol not in moving}
    constants = Constants(places)
    loops = Loops(program.operations, Loops(value.operations))
    recurrences = Recurrences(
        program, constants, lambda series: f"of->{series}" if series in law_series else series, loops=loops
    )
    ending, fields = [], recurrences.fields()
    for argument, result in results.items():
        target = _by(argument)
        if isinstance(result, str):
            if result != target:
                ending.append(each_term(f"s->{target}[k] = {recurrences.array(result)}[k];"))
        else:
            ending.append(each_term(f"s->{target}[k] = {constants.level(result, f'level_{target}')};"))
        if not isinstance(result, str) or result != target:
            fields.append(f"vec {target}[TERMS];")
    names = [*constants.prepared]
    inputs = "".join(f", const vec *{argument.name}" for argument in moving)
    unused = "".join(f"(void){argument.name}; " for argument in moving) + "(void)of; (void)c; (void)v;"
    members = f"vec {', '.join(names)}" if names else "char none[0]"
    return [
        f"typedef struct {{ {members}; }} {name}_slope_constants;",
        "",
        *function(
            f"static inline void {name}_slope_prepare({name}_slope_constants *c, const {name}_constants *v)",
            ["(void)c; (void)v;", *constants.assignments()],
        ),
        "",
        *struct(f"{name}_slopes", fields),
        *documented(
            f"Derivatives of {name} by its arguments; products of series: {program.cost:g}.",
            f"INLINE void {name}_slopes_of({name}_slopes *restrict s, const {name}_slope_constants *c, "
            f"const {name}_series *of, const {name}_constants *v{inputs})",
            [unused, *recurrences.lines(each_term), *ending],
        ),
    ]


def _clearance(name: str, formula: LawFunction) -> list[str]:
    """Derivatives of `limit - value`: on the event surface, those of the clearance up to its positive denominator."""
    chain, text = Chain(formula.definitions), Text(lambda symbol: symbol.name)
    given = (*formula.arguments, LIMIT)
    body = [f"(void){argument.name};" for argument in given]
    result = LIMIT - formula.result
    slopes: dict[sp.Symbol, sp.Expr | str] = {argument: chain.by(result, argument) for argument in given}
    if formula.definitions:  # operations, in loops, of arguments that all vary
        program = Program.for_outputs(given, slopes.values(), (*formula.definitions, *chain.named))
        slopes = {argument: program.result(slope, f"slope_{_by(argument)}") for argument, slope in slopes.items()}
        constants = Constants({}, place="")
        recurrences = Recurrences(program, constants, lambda series: series, loops=Loops(program.operations))
        body += [f"vec {name} = {text.vector(value)};" for name, value in constants.prepared.items()]
        body += recurrences.values(slopes.values())
    for argument, slope in slopes.items():
        body.append(f"*by_{argument.name} = {slope if isinstance(slope, str) else text.vector(slope)};")
    inputs = ", ".join(f"vec {argument.name}" for argument in given)
    outputs = ", ".join(f"vec *by_{argument.name}" for argument in given)
    head = f"static inline void {name}_margin_slopes({inputs}, {outputs})"
    return documented("Slopes of the limit less the value.", head, body)
