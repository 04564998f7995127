"""Margins of the stick certificates, and the coefficients of the slow manifold, in C."""

from collections.abc import Mapping, Sequence

import sympy as sp
from sympy.core.function import AppliedUndef

from ...equations.certificates.pendulum import braking
from ...equations.certificates.slow_manifold import admits, coefficients
from ...equations.certificates.table import CERTIFICATES
from ...equations.model import Model
from ...physics.law import Definition, needed, slot_calls
from ...physics.scaling import DISTANCE
from ...physics.slots import places
from ...vocabulary.quantities import gap, stokes
from .c_text import Text
from .constants import Constants
from .law_header import moves
from .layout import comment, function, struct
from .program import Program
from .recurrences import Recurrences


def margins(model: Model, constants: Constants, prepared: Mapping[tuple[str, str], str]) -> list[str]:
    """The functions of every certificate that a structure has, compiled where its laws meet the premises.

    Arguments:
        constants: of the structure; factors that do not vary are added to them.
        prepared: by slot and function, the name of the law's constants in those of the structure.
    """
    lines = []
    moving = {state: f"y[{state.name.upper()}]" for state in model.states}
    for row in CERTIFICATES:
        functions = [entry for entry in model.functions if entry.certificate == row.name]
        if not functions:
            continue
        body: list[str] = []
        required = set(row.premises(model.structure))
        for entry in functions:
            definitions, _ = needed(list(entry.by_name.values()), model.definitions)
            calls = [slot_calls(sp.sympify(value)) for _, value in (*definitions, *entry.outputs)]
            names = {tuple(call.func.__name__.split(".")) for several in calls for call in several}
            optional = {name for name in names - prepared.keys() if any(moves(places()[".".join(name)].arguments))}
            required |= {"_".join(name).upper() for name in optional}
            body += margin_function(entry.name, entry.doc, definitions, entry.by_name, moving, constants, prepared)
        holds = ["MIDGAP_ARM"] * ("arm" in model.slots) + ["LIBRARY_LAWS"] * row.library_only
        condition, macro = " && ".join(f"defined({name})" for name in sorted(required)), f"{row.name.upper()}_MARGINS"
        body = [f"#define {macro} ({' && '.join(holds) or 1})", *body, ""]
        if condition:
            body = [f"#if {condition}", *body[:-1], "#else", f"#define {macro} 0", "#endif", ""]
        lines += body
    return lines


def margin_function(
    name: str,
    doc: str,
    definitions: Sequence[Definition],
    outputs: Mapping[str, sp.Expr],
    moving: Mapping[sp.Symbol, str],
    constants: Constants,
    prepared: Mapping[tuple[str, str], str],
) -> list[str]:
    """A C function of the states with several results.

    Arguments:
        kept: intermediates in order; those that do not vary become constants of the structure.
        moving: C text of what varies.
    """
    local = dict(moving)
    # C calls of laws with prepared constants, and the position of the varying argument
    calls = {
        f"{slot}.{law}": (f"{slot}_{law}_value(&c->{at}, ", moves(places()[f"{slot}.{law}"].arguments).index(True))
        for (slot, law), at in prepared.items()
    }
    text = Text(lambda symbol: local.get(symbol) or constants.name(symbol), calls)
    body = []
    for symbol, expression in definitions:
        if expression.free_symbols & set(local) or expression.atoms(AppliedUndef):
            body.append(f"vec {symbol.name} = {text.vector(expression)};")
            local[symbol] = symbol.name
        else:
            constants.define(symbol, expression)
    names = {symbol.name for symbol, _ in definitions}
    results = {key: f"{key}_margin" if key in names else key for key in outputs}
    body += [f"*{results[key]} = {text.vector(expression)};" for key, expression in outputs.items()]
    pointers = ", ".join(f"vec *{result}" for result in results.values())
    head = f"static inline void {name}(const constants *c, const vec *y, {pointers})"
    return [*comment(doc), *function(head, body)]


MEANINGS = {
    "distance": "centre distance over a",
    "slowing": "loss of normal velocity in the film per gap, over v0/x0: f",
    "relaxation": "rate at which shear brings the orbital momentum to its rigid value, per x0/v0: s",
    "rigid": "orbital momentum in rigid rotation: J_r",
    "centrifugal": "centrifugal force over the square of the orbital momentum: c",
    "attractions": "attractive forces: A",
}


def slow_manifold_functions(model: Model, constants: Constants, prepared: dict[tuple[str, str], str]) -> list[str]:
    """The series of `coefficients` in the gap, compiled only for laws that fall with it; none where they are not given.

    Arguments:
        constants: of the structure; factors that do not vary are added to them.
        prepared: by slot and function, the name of the law's constants in those of the structure.
    """
    terms = coefficients(model) if admits(model.structure) else None
    if terms is None:
        return ["#define SLOW_MANIFOLD 0", ""]
    program = Program((gap,))
    program.define(DISTANCE, dict(model.definitions)[DISTANCE])
    result: dict[str, str | sp.Expr] = {"distance": DISTANCE.name}
    falling = set()
    for name, expression in terms.items():
        result[name] = expression
        if program.moves(expression):
            program.define(sp.Symbol(name), expression)
            result[name] = program.series(sp.Symbol(name))
        falling |= {f"{call.func.__name__.replace('.', '_').upper()}_FALLS" for call in slot_calls(expression)}
    recurrences = Recurrences(program, constants, lambda series: f"s->{series}")
    lines: list[str] = []
    fields = ["vec gap[TERMS];", *recurrences.fields()]
    names = {operation.name for operation in program.operations}
    for name, value in result.items():
        if value == name and name in names:
            continue
        fields.append(f"vec {name}[TERMS];")
        if isinstance(value, str):
            lines.append(f"s->{name}[k] = {recurrences.coefficient(value)};")
        else:
            lines.append(f"s->{name}[k] = k == 0 ? splat({constants.factor(value, name)}) : splat(0.0);")
    meanings = "; ".join(f"`{name}` {meaning}" for name, meaning in MEANINGS.items())
    return [
        f"#if {' && '.join(f'defined({name})' for name in sorted(falling))} && !defined(FILM_CAVITATES)",
        "#define SLOW_MANIFOLD 1",
        *comment(
            f"Inside the film, as series in the gap (derive/equations/certificates/slow_manifold.py): {meanings}."
        ),
        *struct("slow_series", fields),
        *function(
            "INLINE void slow_coefficients(slow_series *s, const constants *c, int k)",
            ["(void)c;", *recurrences.lines(), *lines],
        ),
        "",
        "#if defined(FILM_BRAKING)",
        *margin_function(
            "film_taken",
            "Velocity that the film takes from x0 to a gap, over v0.",
            [],
            {"taken": braking(model.structure, gap) / stokes},
            {gap: "y[GAP]"},
            constants,
            prepared,
        ),
        "#endif",
        "#else",
        "#define SLOW_MANIFOLD 0",
        "#endif",
        "",
    ]
