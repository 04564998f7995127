"""The C header of a structure: constants, Taylor recurrences of its flow, and the functions that the runtime calls."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import sympy as sp
from sympy.core.function import AppliedUndef

from ...equations import friction
from ...equations.model import Model
from ...physics.forces import FILM, SHEAR
from ...physics.laws.base import is_slot_call
from ...vocabulary.quantities import VOCABULARY, normal, normal_velocity
from ..text import needed
from .c_text import Constants, Recurrences
from .certificates import (
    approach_functions,
    attraction_functions,
    pendulum_functions,
    spin_down_functions,
    transfer_functions,
)
from .closed_forms import WORKS, attracting, edge_function, momentum_functions, work_function
from .groups_from_si import scale_function
from .layout import comment, function
from .ledger import Ledger
from .own_events import own_event_functions
from .program import Program
from .resting import FLAGS as RUBBING
from .resting import Resting
from .slow_manifold import slow_manifold_functions

if TYPE_CHECKING:
    from ...user_model.own_events import OwnEvent

_FLAGS = (FILM, SHEAR)


@dataclass(frozen=True)
class Beside:
    """Additions of a user's model to the library's vocabulary.

    Arguments:
        definitions: its groups in SI quantities.
        meanings: of groups and quantities, by name.
        extra: additional arguments of its calls, by slot function.
        events: its declared events.
    """

    definitions: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    meanings: Mapping[str, str] = field(default_factory=dict)
    extra: Mapping[str, tuple[sp.Symbol, ...]] = field(default_factory=dict)
    events: tuple[OwnEvent, ...] = ()


class Header:
    """Text of one structure's header, assembled part by part around its constants."""

    def __init__(self, model: Model, beside: Beside) -> None:
        self.model, self.beside = model, beside
        flags = (*_FLAGS, *RUBBING) if model.structure.friction else _FLAGS
        self.constants = Constants({group: f"c->{group.name}" for group in model.groups}, flags)
        self.calls: dict[str, tuple[str, str, tuple[str | sp.Expr, ...]]] = {}
        self.flow = self._program("right_hand_side")
        self.rates = dict(self._outputs)
        self.turning: str | sp.Expr | None = None
        if "turning_rate" in model and not model.structure.strings:
            self.turning = self._more(self.flow, self.model["turning_rate"].outputs)["rotation"]
        self.work_rate: str | sp.Expr | None = None
        self._work_operations: set[str] = set()
        wanted = [value for key, value in model["energy_rates"].outputs if key in WORKS]
        if wanted:
            before = len(self.flow.operations)
            self.work_rate = self._more(self.flow, (("capillary", sp.Add(*wanted)),))["capillary"]
            self._work_operations = {operation.name for operation in self.flow.operations[before:]}
        self.made = Recurrences(
            self.flow, self.constants, lambda name: f"s->{name}", passing=self.flow.passing(self._work_operations)
        )
        self.ledger = Ledger(model, self.flow, self.made, self.constants)
        rubs = model.structure.friction and model.structure.partner != "space"
        self.resting = self._resting() if rubs else None

    # ---- programs

    def _program(self, name: str) -> Program:
        program = Program(self.model.states)
        outputs = self.model[name].outputs
        kept, _ = needed([expression for _, expression in outputs], self.model.definitions)
        for symbol, expression in kept:
            program.define(symbol, expression)
        self._outputs = {key: self._of(program, expression, f"rate_of_{key}") for key, expression in outputs}
        return program

    def _more(self, program: Program, outputs: tuple[tuple[str, sp.Expr], ...]) -> dict[str, str | sp.Expr]:
        return {key: self._of(program, expression, f"rate_of_{key}") for key, expression in outputs}

    @staticmethod
    def _of(program: Program, expression: sp.Expr, name: str) -> str | sp.Expr:
        expression = sp.sympify(expression)
        return program.series(expression, name) if program.moves(expression) else expression

    def _resting(self) -> Resting:
        """The motion in resting contact with friction."""
        program, forces = Program(self.model.states), self.model["dry_forces"].by_name
        rates = self.model["resting_rates"].outputs
        more = (
            ("slip", friction.DRY_SLIP),
            *((name, forces[name]) for name in ("limit", "holding")),
            ("reaction", self.model["inward_force"].outputs[0][1]),
        )
        turns = self.turning is not None
        turned = self.model["turning_rate"].outputs if turns else ()
        wanted = [expression for _, expression in (*rates, *more, *turned)]
        kept, _ = needed(wanted, self.model.definitions)
        for symbol, expression in kept:
            program.define(symbol, expression)
        found = {key: self._of(program, expression, f"rate_of_{key}") for key, expression in (*rates, *more, *turned)}
        return Resting(self.model, program, self.constants, found, found, found[turned[0][0]] if turns else None)

    # ---- the complete header

    def text(self, digest: str, provenance: str, doc: str) -> str:
        """The header."""
        functions = [*self._coefficients(), *self._values()]
        table, own = own_event_functions(self.model, self.beside.events, self.constants, self._valued)
        lines = comment(f"{provenance}\nEquations sha256 {digest}")
        lines += ["", *comment(f"{doc}\n\nProducts of series: {self.flow.cost:g} and those of the laws."), ""]
        lines += [*self._enumerations(), *table]
        lines += [*self._constants(), *self._series(), *functions, *own]
        return "\n".join(lines).rstrip() + "\n"

    def _enumerations(self) -> list[str]:
        shape = self.model.structure
        states = [state.name for state in self.model.states]
        flags = {
            "OBLIQUE": shape.oblique, "BRIDGE": shape.bridge, "STRINGS": shape.strings, "REDUCED": shape.reduced,
            "ATTRACTION": shape.attraction, "SPREAD": shape.spread, "WALL": shape.partner == "wall",
            "SPACE": shape.partner == "space",
        }  # fmt: skip
        lines = [f"#define {name} {int(value)}" for name, value in flags.items()]
        if shape.friction:
            lines += ["#define FRICTION 1", f"#define FRICTION_ON_GLASS {int(shape.friction == 'all')}"]
        if self.work_rate is not None:
            closed = [f"defined({slot.upper()}_FORCE_WORK)" for slot in attracting(self.model)]
            lines += [
                f"#if {' && '.join([*closed, *(['!WITH_LEDGER'] if self.ledger.there else [])])}",
                "#define CAPILLARY_STATE 0",
                "#else",
                "#define CAPILLARY_STATE 1 /* no closed form, or a ledger: the work is a state */",
                "#endif",
            ]
        else:
            lines.append("#define CAPILLARY_STATE 0")
        lines.append(f"#define TURNING_STATE (WITH_ROTATION && {int(self.turning is not None)})")
        lines += self.ledger.enumerations()
        lines += [
            "/* Index of coefficient k of a series used in sums only; the cases listed also read past coefficients. */",
            "#define PASSING(k) (GRADIENTS || WITH_LEDGER || CAPILLARY_STATE ? (k) : 0)",
        ]
        if shape.partner == "space":
            lines.append(
                f"#define FIRST_VECTOR {normal[0].name.upper()} /* from here on vectors of three components */"
            )
        upper = ", ".join(state.upper() for state in states)
        lines += ["", f"enum {{ {upper}, MODEL_STATES }};"]
        lines += ["enum { STATES = MODEL_STATES + CAPILLARY_STATE + TURNING_STATE + LEDGER_STATES };"]
        lines += ["enum { CAPILLARY_WORK = MODEL_STATES, TURNED = MODEL_STATES + CAPILLARY_STATE };"]
        lines += self.ledger.places()
        lines.append(f"enum {{ GROUPS = {len(self.model.groups)} }};")
        return [*lines, ""]

    def _constants(self) -> list[str]:
        constants = self.constants
        for name, (_, _, arguments) in self.calls.items():
            for position, argument in enumerate(arguments):
                if not isinstance(argument, str) and argument.free_symbols:
                    constants.factor(argument, f"{name}_argument_{position + 1}")
        lines = [*self.ledger.constants_struct(), "typedef struct {"]
        lines += [f"    vec {group.name}; /* {self._meaning(group)} */" for group in self.model.groups]
        lines += [f"    vec {name};" for name in constants.prepared]
        for name, (slot, call, _) in self.calls.items():
            lines.append(f"    {slot}_{call}_constants {name};")
        lines += ["    glass_pressure_clearance_constants glass;", *self.ledger.member(), "} constants;", ""]
        body = [f"c->{name} = {constants.text.vector(value)};" for name, value in constants.prepared.items()]
        for name, (slot, call, arguments) in self.calls.items():
            passed = "".join(f", {self._passed(argument)}" for argument in arguments if not isinstance(argument, str))
            body.append(f"{slot}_{call}_prepare(&c->{name}{passed});")
        body.append(f"glass_pressure_clearance_prepare(&c->glass{self._glass_groups()}, c->glass_number);")
        body += self.ledger.prepare()
        return [
            *lines,
            *scale_function(self.model, self.beside.definitions),
            *comment("Constants computed once per collision from its groups."),
            *function("static inline void prepare(constants *c)", body),
            "",
        ]

    def _meaning(self, group: sp.Symbol) -> str:
        return self.beside.meanings.get(group.name) or VOCABULARY[group.name].meaning

    def _glass_groups(self) -> str:
        """Additional arguments of a user's glass law, as C text."""
        (call,) = (node for node in self.model["events"]["glass"].atoms(AppliedUndef) if is_slot_call(node))
        return "".join(f", {self._passed(argument)}" for argument in call.args[2:])

    def _passed(self, argument: sp.Expr) -> str:
        text = self.constants.factor(argument, "argument")
        return text if argument.free_symbols else f"splat({text})"

    def _series(self) -> list[str]:
        lines = ["typedef struct {"]
        lines += [f"    vec {state.name}[TERMS]; /* {self._meaning(state)} */" for state in self.model.states]
        lines += ["#if CAPILLARY_STATE", "    vec capillary_work[TERMS];", "#endif"]
        lines += ["#if TURNING_STATE", "    vec turned[TERMS];", "#endif", *self.ledger.states()]
        lines += [f"    {field}" for field in self.made.fields()]
        lines += self.ledger.series()
        lines += ["    vec acceleration[TERMS]; /* of the gap, also while it is held */"]
        lines += ["    vec approach[TERMS];", "    glass_pressure_clearance_series glass;"]
        return [*lines, "} series;", "", *(self.resting.struct() if self.resting else ())]

    def _coefficients(self) -> list[str]:
        made, states = self.made, [state.name for state in self.model.states]
        for operation in self.flow.operations:
            if operation.kind == "call":
                assert operation.call is not None
                self.calls[operation.name] = operation.call
        if self.resting:
            for operation in self.resting.made.program.operations:
                if operation.kind == "call":
                    assert operation.call is not None
                    self.calls.setdefault(operation.name, operation.call)
        work = self._work_operations
        body = []
        for operation, line in zip(self.flow.operations, made.lines(), strict=True):
            body += ["#if CAPILLARY_STATE", line, "#endif"] if operation.name in work else [line]
        body.append("double next = 1.0/(k + 1);")
        for name in states:
            rate = self.rates[name]
            if name == normal_velocity.name:
                body.append(f"s->acceleration[k] = {self._rate(rate)};")
                body.append("s->normal_velocity[k + 1] = only(moving, s->acceleration[k]*next);")
            else:
                body.append(f"s->{name}[k + 1] = {self._rate(rate)}*next;")
        if self.work_rate is not None:
            body += ["#if CAPILLARY_STATE", f"s->capillary_work[k + 1] = {self._rate(self.work_rate)}*next;", "#endif"]
        if self.turning is not None:
            body += ["#if TURNING_STATE", f"s->turned[k + 1] = {self._rate(self.turning)}*next;", "#endif"]
        body += self.ledger.coefficients()
        head = "INLINE void coefficients(series *s, const constants *c, vec film, vec shear, mask moving, int k)"
        doc = (
            "Coefficient k of every series and k + 1 of the states. Region: film is 1 inside the film, shear 1 inside "
            "the tangential edge, else 0; the gap is held in lanes that are not moving."
        )
        unused = "(void)film; (void)shear;"
        glass = function(
            "INLINE void glass_coefficients(series *s, const constants *c, int k)",
            [
                "s->approach[k] = -s->normal_velocity[k];",
                "glass_pressure_clearance_next(&s->glass, &c->glass, s->gap, s->approach, k);",
            ],
        )
        return [
            *comment(doc), *function(head, [unused, *body]), "",
            *comment("Coefficient k of the clearance of the glass criterion."), *glass, "",
            *(self.resting.coefficients() if self.resting else ()),
            *function(
                "static inline vec glass_clearance(const constants *c, const vec *y)",
                ["return glass_pressure_clearance_value(&c->glass, y[GAP], -y[NORMAL_VELOCITY]);"],
            ), "",
        ]  # fmt: skip

    def _rate(self, rate: str | sp.Expr) -> str:
        if isinstance(rate, str):
            return self.made.coefficient(rate)
        return f"(k == 0 ? {self.constants.text.vector(rate)} : splat(0.0))"

    # ---- values

    def _value(self, name: str, head: str, results: dict[str, str], doc: str | None = None) -> list[str]:
        """A function of the states `y`; `results` maps outputs to C targets ('return' for the value itself)."""
        outputs = [pair for pair in self.model[name].outputs if pair[0] in results]
        return self._valued(outputs, head, results, doc or self.model[name].doc)

    def _valued(
        self,
        outputs: list[tuple[str, sp.Expr]],
        head: str,
        results: dict[str, str],
        doc: str,
        constants: Constants | None = None,
        given: tuple[sp.Symbol, ...] = (),
    ) -> list[str]:
        constants = constants or self.constants
        program = Program((*self.model.states, *given))
        own_names = {symbol.name for symbol in given}
        kept, _ = needed([expression for _, expression in outputs], self.model.definitions)
        for symbol, expression in kept:
            program.define(symbol, expression)
        found = {key: self._of(program, sp.sympify(expression), key) for key, expression in outputs}

        def where(series: str) -> str:
            return series if series in own_names else f"y[{series.upper()}]"

        made = Recurrences(program, constants, where)
        for operation in program.operations:
            if operation.kind == "call":
                assert operation.call is not None
                self.calls.setdefault(operation.name, operation.call)
        body = ["(void)c; (void)y;", *made.values(found.values())]
        own = {operation.name for operation in program.operations}
        for key, result in found.items():
            if isinstance(result, str):
                text = result if result in own else where(result)
            else:
                text = constants.text.vector(result)
            body.append(f"{results[key]} {text};" if results[key] == "return" else f"{results[key]} = {text};")
        return [*comment(doc), *function(head, body), ""]

    def _values(self) -> list[str]:
        model, shape = self.model, self.model.structure
        states = {state.name: f"y[{state.name.upper()}]" for state in model.states}
        lines = self._value("start", "static inline void start(const constants *c, vec *y)", states)
        after = {name: f"after[{name.upper()}]" for name in states}
        lines += self._value(
            "rebound", "static inline void rebound(const constants *c, const vec *y, vec *after)", after
        )
        lines += self._friction() if shape.friction else []
        lines += self._value(
            "inward_force",
            "static inline vec inward_force(const constants *c, const vec *y)",
            {"inward_force": "return"},
        )
        escape = model["escape_energy" if shape.partner == "wall" else "energies"]
        total = [("energy", sp.Add(*(expression for _, expression in escape.outputs)))]
        lines += self._valued(
            total,
            "static inline vec stored_energy(const constants *c, const vec *y)",
            {"energy": "return"},
            escape.doc + " Their sum.",
        )
        shown = {key: f"shown[{position}]" for position, (key, _) in enumerate(model["outputs"].outputs)}
        lines.append(f"enum {{ OUTPUTS = {len(shown)} }};")
        lines += self._value(
            "outputs", "static inline void outputs(const constants *c, const vec *y, vec *shown)", shown
        )
        if "effective_potential" in model:
            lines += ["#define POTENTIAL 1"]
            for key in ("energy", "slope"):
                lines += self._value(
                    "effective_potential",
                    f"static inline vec potential_{key}(const constants *c, const vec *y)",
                    {key: "return"},
                )
        if any(
            key == "surface" for each in model.functions if each.name == "orbital_margins" for key, _ in each.outputs
        ):
            lines += [
                "#define BY_ORBITAL_MOMENTUM LIBRARY_LAWS",
                "enum { SLIP_RATE, ORBITAL_ENERGY, SLIP_ENERGY, ORBITAL };",
            ]
            lines += self._value(
                "orbital_margins",
                "static inline void orbital_margins(const constants *c, const vec *y, vec *found)",
                {
                    "slip": "found[SLIP_RATE]",
                    "orbital_energy": "found[ORBITAL_ENERGY]",
                    "surface": "found[SLIP_ENERGY]",
                },
                "Slip omega - xi at this gap, J^2/(2 r^2), and the slip energy (lever arm at the surface), over m v0^2 "
                "(derive/equations/certificates/orbital_momentum.py).",
            )
        turning = shape.oblique and not shape.strings and shape.partner != "wall"
        if shape.partner == "space":
            lines += self._value(
                "resting_bound",
                "static inline void resting_bound(const constants *c, const vec *y, vec *found)",
                {"outward": "found[0]", "inward": "found[1]"},
            )
            lines += self._value(
                "wobble", "static inline vec wobble(const constants *c, const vec *y)", {"wobble": "return"}
            )
            lines += self._value(
                "precession",
                "static inline void precession(const constants *c, const vec *y, vec *found)",
                {**{f"momentum_{axis}": f"found[{k}]" for k, axis in enumerate("xyz")}, "per_momentum": "found[3]"},
            )
        elif turning:
            lines += self._value(
                "rigid_rotation",
                "static inline vec rigid_momentum(const constants *c, const vec *y)",
                {"orbital_momentum": "return"},
            )
        if turning and shape.partner != "space" and not shape.reduced:
            lines += self._value(
                "rigid_rotation",
                "static inline void rigid_rotation(const constants *c, const vec *y, vec *rigid)",
                {state.name: f"rigid[{state.name.upper()}]" for state in model.states[2:]},
            )
        if shape.oblique:
            head = "static inline vec surface_slip(const constants *c, const vec *y)"
            lines += self._value("surface_slip", head, {"surface_slip": "return"})
        if "arm" in model.slots and not shape.strings:
            lines += self._value(
                "angular_momentum",
                "static inline vec angular_momentum(const constants *c, const vec *y)",
                {"angular_momentum": "return"},
            )
        prepared = {(slot, call): name for name, (slot, call, _) in self.calls.items()}
        if "pendulum_margins" in model:
            lines += pendulum_functions(model, self.constants, prepared)
        if "attraction_margins" in model:
            lines += attraction_functions(model, self.constants, prepared)
        if "orbital_margins" in model:
            lines += transfer_functions(model, self.constants, prepared)
        if "spin_down_margins" in model:
            lines += spin_down_functions(model, self.constants, prepared)
        if self.beside.events:
            lines += ["#define SLOW_MANIFOLD 0", ""]  # whose tubes know of no declared event
        else:
            lines += slow_manifold_functions(model, self.constants, prepared)
        if "approach_step" in model:
            lines += approach_functions(model, self.constants, prepared)
        if attracting(self.model):
            lines += work_function(model, self.constants, self.calls)
        if (shape.partner == "wall" or not shape.oblique) and not (shape.bridge or shape.strings):
            lines += momentum_functions(model, self.constants, self.calls)
        lines += self.ledger.functions(self._valued)
        if shape.oblique:
            edge = model["events"]["tangential_edge"]
            lines += edge_function(edge, self.constants)
        return lines

    def _friction(self) -> list[str]:
        """The friction of a rebound: impulses, what an impulse does to the states, and what it costs."""
        model = self.model
        names = [key for key, _ in model["dry_slip"].outputs]
        found = {name: f"found[{name.upper()}]" for name in names}
        lines = [f"enum {{ {', '.join(name.upper() for name in names)}, IMPULSES }};"]
        lines += self._value(
            "dry_slip", "static inline void dry_slip(const constants *c, const vec *y, vec *found)", found
        )
        head = "static inline void dry_forces(const constants *c, const vec *y, vec film, vec shear, vec *found)"
        lines += ["enum { GRIP_LIMIT, HOLDING, DRY_FORCES };"]
        if self.resting:
            forces = self._value("dry_forces", head, {"limit": "found[GRIP_LIMIT]", "holding": "found[HOLDING]"})
            forces.insert(forces.index("{") + 1, "    (void)film; (void)shear; /* some models have no edge */")
            lines += forces
        for name, kind, result in (("rubbed", "void", ", vec *after"), ("friction_loss", "vec", "")):
            told, head = (
                model[name],
                f"static inline {kind} {name}(const constants *c, const vec *y, vec impulse{result})",
            )
            places = {key: f"after[{key.upper()}]" if result else "return" for key, _ in told.outputs}
            lines += self._valued(list(told.outputs), head, places, told.doc, given=told.given)
        return lines


def structure_header(model: Model, digest: str, provenance: str, doc: str, beside: Beside | None = None) -> str:
    """The C header of a structure."""
    return Header(model, beside or Beside()).text(digest, provenance, doc)
