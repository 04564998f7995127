"""Coefficients of the slow manifold in C, as series in the gap, where the laws permit its bounds."""

from __future__ import annotations

import sympy as sp
from sympy.core.function import AppliedUndef

from ...equations.certificates.approach import braking
from ...equations.certificates.slow_manifold import coefficients
from ...equations.model import Model
from ...physics.laws.base import is_slot_call
from ...physics.scaling import DISTANCE
from ...vocabulary.quantities import gap, stokes
from .c_text import Constants, Recurrences
from .certificates import margin_function
from .closed_forms import Calls
from .layout import comment, function
from .program import Program

MEANINGS = {
    "distance": "centre distance over a",
    "slowing": "loss of normal velocity in the film per gap, over v0/x0: f",
    "relaxation": "rate at which shear brings the orbital momentum to its rigid value, per x0/v0: s",
    "rigid": "orbital momentum in rigid rotation: J_r",
    "centrifugal": "centrifugal force over the square of the orbital momentum: c",
    "attractions": "attractive forces: A",
}


def slow_manifold_functions(
    model: Model, constants: Constants, calls: Calls, prepared: dict[tuple[str, str], str]
) -> list[str]:
    """The series of `coefficients` in the gap, compiled only for laws that fall with it.

    Arguments:
        constants: of the structure; factors that do not vary are added to them.
        calls: those of the structure, by the name of their constants.
        prepared: by slot and function, the name of the law's constants in those of the structure.
    """
    program = Program((gap,))
    program.define(DISTANCE, dict(model.definitions)[DISTANCE])
    found: dict[str, str | sp.Expr] = {"distance": DISTANCE.name}
    falling = set()
    for name, expression in coefficients(model).items():
        if program.moves(expression):
            program.define(sp.Symbol(name), expression)
            found[name] = program.series(sp.Symbol(name))
        else:
            found[name] = expression
        for node in expression.atoms(AppliedUndef):
            if is_slot_call(node):
                falling.add(node.func.__name__.replace(".", "_").upper() + "_FALLS")
    where = {(slot, call): name for name, (slot, call, _) in calls.items()}
    made = Recurrences(program, constants, lambda series: f"s->{series}")
    lines = []
    for operation in program.operations:
        if operation.call is not None:  # constants of a law are those of the equations of motion
            operation_name = where[operation.call[:2]]
            assert operation_name == operation.name, operation_name
    fields = ["    vec gap[TERMS];", *(f"    {field}" for field in made.fields())]
    own = {operation.name for operation in program.operations}
    for name, value in found.items():
        if isinstance(value, str) and (value not in own or value != name):
            lines.append(f"s->{name}[k] = {made.coefficient(value)};")
            fields.append(f"    vec {name}[TERMS];")
        elif not isinstance(value, str):
            level = constants.factor(value, name)
            lines.append(f"s->{name}[k] = k == 0 ? splat({level}) : splat(0.0);")
            fields.append(f"    vec {name}[TERMS];")
    meanings = "; ".join(f"`{name}` {meaning}" for name, meaning in MEANINGS.items())
    return [
        f"#if {' && '.join(f'defined({name})' for name in sorted(falling))} && !defined(FILM_CAVITATES)",
        "#define SLOW_MANIFOLD (!CAPILLARY_STATE)",
        *comment(
            f"Inside the film, as series in the gap (derive/equations/certificates/slow_manifold.py): {meanings}."
        ),
        "typedef struct {",
        *fields,
        "} slow_series;",
        "",
        *function(
            "INLINE void slow_coefficients(slow_series *s, const constants *c, int k)",
            ["(void)c;", *made.lines(), *lines],
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
