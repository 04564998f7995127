"""Margins of the stick certificates, and the coefficients of the slow manifold, in C."""

from collections.abc import Iterable, Mapping, Sequence

import sympy as sp
from sympy.core.function import AppliedUndef

from ...equations.certificates.approach import braking
from ...equations.certificates.slow_manifold import admits, coefficients
from ...equations.model import Model
from ...physics.laws.base import Definition, needed, slot_calls
from ...physics.scaling import DISTANCE
from ...physics.slots import places
from ...vocabulary.quantities import gap, stokes
from .c_text import Constants, Recurrences, Text
from .law_header import moves
from .layout import comment, function, struct
from .program import Program

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


class Margins:
    """The margin functions of one structure.

    Arguments:
        constants: of the structure; factors that do not vary are added to them.
        prepared: by slot and function, the name of the law's constants in those of the structure.
    """

    def __init__(self, model: Model, constants: Constants, prepared: Mapping[tuple[str, str], str]) -> None:
        self.model, self.constants, self.prepared = model, constants, prepared

    def lines(self) -> list[str]:
        """The functions of every certificate that the structure has, but for the bounds of the approach."""
        parts = {
            "pendulum_margins": self._pendulum,
            "attraction_margins": self._attraction,
            "orbital_margins": self._transfer,
            "spin_down_margins": self._spin_down,
        }
        return [line for name, part in parts.items() if name in self.model for line in part()]

    def _pendulum(self) -> list[str]:
        outputs = self.model["pendulum_margins"].by_name
        kept, _ = needed(list(outputs.values()), self.model.definitions)
        nodes = (node for _, expression in (*kept, *outputs.items()) for node in slot_calls(sp.sympify(expression)))
        called = {name for node in nodes if tuple((name := node.func.__name__).split(".")) not in self.prepared}
        lines = []
        for name, (keys, doc) in PARTS.items():
            lines += self._function(name, doc, {key: outputs[key] for key in keys})
        required = sorted(name.replace(".", "_").upper() for name in called)
        return _compiled_with(required, "PENDULUM", "MIDGAP_ARM", lines)

    def _attraction(self) -> list[str]:
        """Margins for laws whose force decreases with the gap."""
        doc = "The attractions exclude separation if hold > 0, escape < 0 and rebound < 0."
        lines = self._function("attraction_margins", doc, self.model["attraction_margins"].by_name)
        return _compiled_with(self._falling(), "ATTRACTION_MARGINS", "(REDUCED || MIDGAP_ARM)", lines)

    def _spin_down(self) -> list[str]:
        """The angular momentum at initial contact is one of the constants."""
        margins = self.model["spin_down_margins"]
        self.constants.define(sp.Symbol("first_momentum"), margins["momentum"])
        by_state = {key: value for key, value in margins.outputs if key != "momentum"}
        lines = self._function("spin_down_margins", margins.doc, by_state)
        return _compiled_with(["FILM_STOPPING", "SHEAR_LOG_FACTOR_FALLS"], "SPIN_DOWN", self._arm(), lines)

    def _transfer(self) -> list[str]:
        """What the orbital-momentum certificate takes from a state with the lever arm at mid-gap."""
        doc = (
            "Slip omega - xi at this gap, and the slip energy over m v0^2 that shear can still transfer before it "
            "(lever arm at mid-gap; derive/equations/certificates/orbital_momentum.py)."
        )
        margins = self.model["orbital_margins"]
        lines = self._function("transferable", doc, {key: margins[key] for key in ("slip", "slip_energy")})
        return ["#define ORBITAL_MARGINS LIBRARY_LAWS", *lines, ""]

    def approach(self) -> list[str]:
        """The functions of the approach certificate; nothing for structures without it."""
        each = [self.model[name] for name in ("approach_step", "approach_force") if name in self.model]
        lines = [line for one in each for line in self._function(one.name, one.doc, one.by_name)]
        required = ["FILM_BRAKING", "GLASS_REACH", *self._falling()]
        return _compiled_with(required, "APPROACH_BOUNDS", self._arm(), lines) if lines else []

    def _falling(self) -> list[str]:
        return [f"{slot.upper()}_FORCE_FALLS" for slot in ("bridge", "attraction") if slot in self.model.slots]

    def _arm(self) -> str:
        return "MIDGAP_ARM" if "arm" in self.model.slots else "1"

    def _function(self, name: str, doc: str, outputs: Mapping[str, sp.Expr]) -> list[str]:
        moving = {state: f"y[{state.name.upper()}]" for state in self.model.states}
        kept, _ = needed(list(outputs.values()), self.model.definitions)
        return margin_function(name, doc, kept, outputs, moving, self.constants, self.prepared)


def _compiled_with(required: Iterable[str], macro: str, value: str, lines: Sequence[str]) -> list[str]:
    """Lines compiled if macros are defined; `macro` then has the value, else 0."""
    condition = " && ".join(f"defined({name})" for name in required)
    return [f"#if {condition}", f"#define {macro} {value}", *lines, "#else", f"#define {macro} 0", "#endif", ""]


def margin_function(
    name: str,
    doc: str,
    kept: Sequence[Definition],
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
    for symbol, expression in kept:
        if expression.free_symbols & set(local) or expression.atoms(AppliedUndef):
            body.append(f"vec {symbol.name} = {text.vector(expression)};")
            local[symbol] = symbol.name
        else:
            constants.define(symbol, expression)
    names = {symbol.name for symbol, _ in kept}
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
