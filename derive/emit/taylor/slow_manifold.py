"""Coefficients of the slow manifold in C, as series in the gap, where the laws permit its bounds."""

from __future__ import annotations

import sympy as sp

from ...equations.certificates.approach import braking
from ...equations.certificates.slow_manifold import admits, coefficients
from ...equations.model import Model
from ...physics.laws.base import slot_calls
from ...physics.scaling import DISTANCE
from ...vocabulary.quantities import gap, stokes
from .c_text import Constants, Recurrences
from .certificates import margin_function
from .layout import comment, function, struct
from .program import Program

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
    given = coefficients(model) if admits(model.structure) else None
    if given is None:
        return ["#define SLOW_MANIFOLD 0", ""]
    program = Program((gap,))
    program.define(DISTANCE, dict(model.definitions)[DISTANCE])
    result: dict[str, str | sp.Expr] = {"distance": DISTANCE.name}
    falling = set()
    for name, expression in given.items():
        result[name] = expression
        if program.moves(expression):
            program.define(sp.Symbol(name), expression)
            result[name] = program.series(sp.Symbol(name))
        falling |= {f"{call.func.__name__.replace('.', '_').upper()}_FALLS" for call in slot_calls(expression)}
    made = Recurrences(program, constants, lambda series: f"s->{series}")
    lines: list[str] = []
    fields = ["vec gap[TERMS];", *made.fields()]
    own = {operation.name for operation in program.operations}
    for name, value in result.items():
        if value == name and name in own:
            continue
        fields.append(f"vec {name}[TERMS];")
        if isinstance(value, str):
            lines.append(f"s->{name}[k] = {made.coefficient(value)};")
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
