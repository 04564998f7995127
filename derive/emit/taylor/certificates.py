"""Margins of the pendulum and attraction certificates in C, where the laws permit them."""

from __future__ import annotations

import sympy as sp
from sympy.core.function import AppliedUndef

from ...equations.model import Model
from ...physics.laws.base import is_slot_call
from ...physics.slots import places
from ..text import needed
from .c_text import Constants, Text
from .law_header import moves
from .layout import comment, function

# the cheap and usually decisive margins in functions of their own
PARTS = {
    "pendulum_inward": (
        ("outward", "pull"),
        "The strings outweigh the rotation from now on if outward < pull (equations/certificates/pendulum.py).",
    ),
    "pendulum_impulse": (("impulse",), "Bound of the outward impulse of all forces but the film's from now on."),
    "pendulum_stops": (
        ("film", "recoil"),
        "The film then stops the opening and every rebound if film < 0 and recoil < 0, the impulse added.",
    ),
    "pendulum_rebounds": (
        ("rebound", "beneath"),
        "It stops a rebound from this gap and speed, or one from any smaller gap, if these are negative.",
    ),
}


def pendulum_functions(model: Model, constants: Constants, prepared: dict[tuple[str, str], str]) -> list[str]:
    """The functions of PARTS, compiled only for laws with the functions that the certificate uses.

    Arguments:
        constants: of the structure; factors that do not vary are added to them.
        prepared: by slot and function, the name of the law's constants in those of the structure.
    """
    outputs = model["pendulum_margins"].by_name
    asked = {
        node.func.__name__.replace(".", "_").upper()
        for _, expression in (*needed(list(outputs.values()), model.definitions)[0], *outputs.items())
        for node in sp.sympify(expression).atoms(AppliedUndef)
        if is_slot_call(node) and tuple(node.func.__name__.split(".")) not in prepared
    }
    lines = [f"#if {' && '.join(f'defined({name})' for name in sorted(asked))}", "#define PENDULUM MIDGAP_ARM"]
    moving = {state: f"y[{state.name.upper()}]" for state in model.states}
    for name, (keys, doc) in PARTS.items():
        kept, _ = needed([outputs[key] for key in keys], model.definitions)
        lines += margin_function(name, doc, kept, {key: outputs[key] for key in keys}, moving, constants, prepared)
    return [*lines, "#else", "#define PENDULUM 0", "#endif", ""]


def attraction_functions(model: Model, constants: Constants, prepared: dict[tuple[str, str], str]) -> list[str]:
    """The margins of the attraction certificate, for laws whose force decreases with the gap; arguments as above."""
    outputs = model["attraction_margins"].by_name
    falling = [f"defined({slot.upper()}_FORCE_FALLS)" for slot in ("bridge", "attraction") if slot in model.slots]
    moving = {state: f"y[{state.name.upper()}]" for state in model.states}
    kept, _ = needed(list(outputs.values()), model.definitions)
    doc = "The attractions exclude separation if hold > 0, escape < 0 and rebound < 0."
    return [
        f"#if {' && '.join(falling)}",
        "#define ATTRACTION_MARGINS (REDUCED || MIDGAP_ARM)",
        *margin_function("attraction_margins", doc, kept, outputs, moving, constants, prepared),
        "#else",
        "#define ATTRACTION_MARGINS 0",
        "#endif",
        "",
    ]


def spin_down_functions(model: Model, constants: Constants, prepared: dict[tuple[str, str], str]) -> list[str]:
    """The margins of the spin-down certificate, for laws with what it uses; arguments as above.

    The angular momentum at initial contact is one of the constants.
    """
    outputs = model["spin_down_margins"].by_name
    moving = {state: f"y[{state.name.upper()}]" for state in model.states}
    by_state = {key: value for key, value in outputs.items() if key != "momentum"}
    kept, _ = needed(list(by_state.values()), model.definitions)
    constants.define(sp.Symbol("first_momentum"), outputs["momentum"])
    return [
        "#if defined(FILM_STOPPING) && defined(SHEAR_LOG_FACTOR_FALLS)",
        f"#define SPIN_DOWN {'MIDGAP_ARM' if 'arm' in model.slots else '1'}",
        *margin_function(
            "spin_down_margins", model["spin_down_margins"].doc, kept, by_state, moving, constants, prepared
        ),
        "#else",
        "#define SPIN_DOWN 0",
        "#endif",
        "",
    ]


def transfer_functions(model: Model, constants: Constants, prepared: dict[tuple[str, str], str]) -> list[str]:
    """What the orbital-momentum certificate takes from a state with the lever arm at mid-gap; arguments as above."""
    outputs = {key: value for key, value in model["orbital_margins"].outputs if key in ("slip", "midgap")}
    moving = {state: f"y[{state.name.upper()}]" for state in model.states}
    kept, _ = needed(list(outputs.values()), model.definitions)
    doc = (
        "Slip omega - xi at this gap, and the slip energy over m v0^2 that shear can still transfer before it (lever "
        "arm at mid-gap; derive/equations/certificates/orbital_momentum.py)."
    )
    made = margin_function("transferable", doc, kept, outputs, moving, constants, prepared)
    return ["#define ORBITAL_MARGINS LIBRARY_LAWS", *made, ""]


def approach_functions(model: Model, constants: Constants, prepared: dict[tuple[str, str], str]) -> list[str]:
    """The functions of the approach certificate, for laws with what it uses; arguments as above."""
    falling = [f"defined({slot.upper()}_FORCE_FALLS)" for slot in ("bridge", "attraction") if slot in model.slots]
    moving = {state: f"y[{state.name.upper()}]" for state in model.states}
    lines = [f"#if {' && '.join(['defined(FILM_BRAKING)', 'defined(GLASS_REACH)', *falling])}"]
    lines.append(f"#define APPROACH_BOUNDS {'MIDGAP_ARM' if 'arm' in model.slots else '1'}")
    for each in (each for each in model.functions if each.name in ("approach_step", "approach_force")):
        outputs = dict(each.outputs)
        kept, _ = needed(list(outputs.values()), model.definitions)
        lines += margin_function(each.name, each.doc, kept, outputs, moving, constants, prepared)
    return [*lines, "#else", "#define APPROACH_BOUNDS 0", "#endif", ""]


def margin_function(
    name: str,
    doc: str,
    kept: list[tuple[sp.Symbol, sp.Expr]],
    outputs: dict[str, sp.Expr],
    moving: dict[sp.Symbol, str],
    constants: Constants,
    prepared: dict[tuple[str, str], str],
) -> list[str]:
    """A C function of the states with several results.

    Arguments:
        kept: intermediates in order; those that do not vary become constants of the structure.
        moving: C text of what varies.
    """
    local = dict(moving)
    text = Text(lambda symbol: local.get(symbol) or constants.name(symbol), _calls(prepared))
    body = []
    for symbol, expression in kept:
        if expression.free_symbols & set(local) or expression.atoms(AppliedUndef):
            body.append(f"vec {symbol.name} = {text.vector(expression)};")
            local[symbol] = symbol.name
        else:
            constants.define(symbol, expression)
    taken = {symbol.name for symbol, _ in kept}
    into = {key: f"{key}_margin" if key in taken else key for key in outputs}
    body += [f"*{into[key]} = {text.vector(expression)};" for key, expression in outputs.items()]
    results = ", ".join(f"vec *{name}" for name in into.values())
    head = f"static inline void {name}(const constants *c, const vec *y, {results})"
    return [*comment(doc), *function(head, body)]


def _calls(prepared: dict[tuple[str, str], str]) -> dict[str, tuple[str, int]]:
    """C calls of laws with prepared constants, and the position of the varying argument."""
    return {
        f"{slot}.{name}": (
            f"{slot}_{name}_value(&c->{where}, ",
            moves(places()[f"{slot}.{name}"].arguments).index(True),
        )
        for (slot, name), where in prepared.items()
    }
