"""The C header of a structure: constants, Taylor recurrences of its flow, and the functions that the runtime calls."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp

from ...equations import friction
from ...equations.intermediates import LEVER
from ...equations.model import Model
from ...physics.forces import FILM, SHEAR
from ...physics.law import slot_calls
from ...physics.partners.bodies import CENTRES
from ...physics.scaling import DISTANCE
from ...user.own_events import OwnEvent
from ...vocabulary import quantities as q
from ...vocabulary.quantities import VOCABULARY, normal_velocity
from ..provenance import Own, describe, header, model_digest
from .certificates import margins, slow_manifold_functions
from .closed_forms import WORKS, attracting, edge_function, momentum_functions, work_function
from .constants import Constants
from .groups_from_si import scale_function
from .guards import series_of_guards
from .layout import comment, compiled_if, documented, function, struct
from .ledger import BOOKED, Ledger
from .own_events import clock_states, own_event_functions
from .program import Program
from .recurrences import Recurrences
from .resting import FLAGS as RUBBING
from .resting import QUADRATURES, Resting

_FLAGS = (FILM, SHEAR)
_COMPONENTS = {*q.normal, *q.orbital_momenta, *q.spins, *q.partner_spins}  # of the vectors among states in space


@dataclass(frozen=True)
class Beside:
    """Additions of a user's model to the library's vocabulary.

    Arguments:
        definitions: its groups in SI quantities.
        own: unit and meaning of groups and quantities, by name.
        extra: additional arguments of its calls, by slot function.
        events: its declared events.
    """

    definitions: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    own: Own = field(default_factory=dict)
    extra: Mapping[str, tuple[sp.Symbol, ...]] = field(default_factory=dict)
    events: tuple[OwnEvent, ...] = ()


class Header:
    """Text of one structure's header, assembled part by part around its constants."""

    def __init__(self, model: Model, beside: Beside) -> None:
        self.model, self.beside = model, beside
        flags = (*_FLAGS, *RUBBING) if model.structure.friction else _FLAGS
        self.constants = Constants({group: f"c->{group.name}" for group in model.groups}, flags)
        self.calls: dict[str, tuple[str, str, tuple[str | sp.Expr, ...]]] = {}
        rates = model["right_hand_side"].by_name
        self.flow = Program.for_outputs(model.states, rates.values(), model.definitions, whole_angles=True)
        self.rates = self._results(self.flow, "right_hand_side")
        self.turning: str | sp.Expr | None = None
        if "turning_rate" in model and not model.structure.strings:
            self.turning = self._results(self.flow, "turning_rate")["rotation"]
        self.work_rate: str | sp.Expr | None = None
        self._work_operations: set[str] = set()
        wanted = [value for key, value in model["energy_rates"].outputs if key in WORKS]
        if wanted:
            before = len(self.flow.operations)
            self.work_rate = self.flow.result(sp.Add(*wanted), "rate_of_capillary")
            self._work_operations = {operation.name for operation in self.flow.operations[before:]}
        self.recurrences = Recurrences(
            self.flow, self.constants, lambda name: f"s->{name}", passing=self.flow.passing(self._work_operations)
        )
        self.resting = self._resting() if model.structure.friction else None
        booked = self.resting.ledger.constants if self.resting else self.constants.beside(BOOKED)
        self.ledger = Ledger(model, self.flow, self.recurrences, booked, {friction.SLIDING: 0})

    # ---- programs

    def _results(self, program: Program, name: str) -> dict[str, str | sp.Expr]:
        """The outputs of a function, as series of a program or constants."""
        return {key: program.result(expression, f"rate_of_{key}") for key, expression in self.model[name].outputs}

    def _resting(self) -> Resting:
        """The motion in resting contact with friction."""
        turns = self.model["turning_rate"].outputs if self.turning is not None else ()
        outputs = [*self.model["resting_rates"].outputs]
        if "dry_forces" in self.model:
            outputs += [("slip", friction.DRY_SLIP), *self.model["dry_forces"].outputs]
        outputs += [("reaction", self.model["inward_force"]["inward_force"]), *turns]
        program = Program.for_outputs(self.model.states, (value for _, value in outputs), self.model.definitions)
        result = {key: program.result(expression, f"rate_of_{key}") for key, expression in outputs}
        turning = result[turns[0][0]] if turns else None
        return Resting(self.model, program, self.constants, result, turning)

    # ---- the complete header

    def text(self) -> str:
        """The header."""
        functions = [*self._coefficients(), *self._values()]
        table, event_functions = own_event_functions(self.model, self.beside.events, self.constants, self._valued)
        lines = comment(header(model_digest(self.model)))
        doc = describe(self.model, self.beside.own)
        lines += ["", *comment(f"{doc}\n\nProducts of series: {self.flow.cost:g} and those of the laws."), ""]
        lines += [*self._enumerations(), *table]
        lines += [*self._constants(), *self._series(), *functions, *event_functions]
        return "\n".join(lines).rstrip() + "\n"

    def _enumerations(self) -> list[str]:
        shape = self.model.structure
        states = [state.name for state in self.model.states]
        names = ("oblique", "bridge", "strings", "reduced", "attraction", "spread")
        lines = [f"#define {name.upper()} {int(getattr(shape, name))}" for name in names]
        lines += [f"#define {name.upper()} {int(shape.partner == name)}" for name in ("wall", "space")]
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
        doc = "Index of coefficient k of a series used in sums only; the cases listed also read past coefficients."
        lines += [f"/* {doc} */", "#define PASSING(k) (GRADIENTS || WITH_LEDGER || CAPILLARY_STATE ? (k) : 0)"]
        if shape.partner == "space":
            components = [state.name.upper() for state in self.model.states if state in _COMPONENTS]
            lines += [f"#define FIRST_VECTOR {components[0]} /* from here on vectors of three components */"]
            lines += [f"#define END_OF_VECTORS ({components[-1]} + 1)"]
        upper = ", ".join(state.upper() for state in states)
        lines += ["", f"enum {{ {upper}, MODEL_STATES }};"]
        lines += clock_states(self.model)
        lines += ["enum { STATES = MODEL_STATES + CAPILLARY_STATE + TURNING_STATE + LEDGER_STATES };"]
        lines += ["enum { CAPILLARY_WORK = MODEL_STATES, TURNED = MODEL_STATES + CAPILLARY_STATE };"]
        lines += self.ledger.places()
        lines.append(f"enum {{ GROUPS = {len(self.model.groups)} }};")
        if terms := shape.terms:
            barrier = "effective_potential" in self.model and not self.beside.events
            flags = {"": True, "_ROTATE": terms.rotates, "_STORE": terms.potential != 0}
            flags |= {"_ADD_INERTIA": terms.kinetic != 0, "_BARRIER": barrier}
            lines += [f"#define OWN_TERMS{name} {int(flag)}" for name, flag in flags.items()]
        return [*lines, ""]

    def _constants(self) -> list[str]:
        constants = self.constants
        for name, (_, _, arguments) in self.calls.items():
            for position, argument in enumerate(arguments):
                if not isinstance(argument, str) and argument.free_symbols:
                    constants.factor(argument, f"{name}_argument_{position + 1}")
        fields = [f"vec {group.name}; /* {self._meaning(group)} */" for group in self.model.groups]
        fields += [f"vec {name};" for name in constants.prepared]
        fields += [f"{slot}_{call}_constants {name};" for name, (slot, call, _) in self.calls.items()]
        fields += ["glass_pressure_clearance_constants glass;", *self.ledger.member()]
        body = constants.assignments()
        for name, (slot, call, arguments) in self.calls.items():
            still = [argument for argument in arguments if not isinstance(argument, str)]
            passed = "".join(f", {constants.vector(argument, 'argument')}" for argument in still)
            body.append(f"{slot}_{call}_prepare(&c->{name}{passed});")
        (call,) = slot_calls(self.model["events"]["glass"])
        passed = "".join(f", {constants.vector(argument, 'argument')}" for argument in call.args[2:])  # a user's groups
        body.append(f"glass_pressure_clearance_prepare(&c->glass{passed}, c->glass_number);")
        body += self.ledger.prepare()
        return [
            *self.ledger.constants_struct(),
            *struct("constants", fields),
            *scale_function(self.model, self.beside.definitions),
            *documented(
                "Constants computed once per collision from its groups.",
                "static inline void prepare(constants *c)",
                body,
            ),
        ]

    def _meaning(self, group: sp.Symbol) -> str:
        return self.beside.own[group.name][1] if group.name in self.beside.own else VOCABULARY[group.name].meaning

    def _series(self) -> list[str]:
        fields = [f"vec {state.name}[TERMS]; /* {self._meaning(state)} */" for state in self.model.states]
        fields += [*QUADRATURES, *self.ledger.states(), *self.recurrences.fields(), *self.ledger.series()]
        fields += ["vec acceleration[TERMS]; /* of the gap, also while it is held */", "vec approach[TERMS];"]
        fields.append("glass_pressure_clearance_series glass;")
        return [*struct("series", fields), *(self.resting.struct() if self.resting else ())]

    def _coefficients(self) -> list[str]:
        self.flow.collect_calls(self.calls)
        if self.resting:
            self.resting.recurrences.program.collect_calls(self.calls)
        body = ["(void)film; (void)shear;"]
        for operation, line in zip(self.flow.operations, self.recurrences.lines(), strict=True):
            body += compiled_if("CAPILLARY_STATE", [line]) if operation.name in self._work_operations else [line]
        body.append("double next = 1.0/(k + 1);")
        for name, rate in self.rates.items():
            if name == normal_velocity.name:
                body.append(f"s->acceleration[k] = {self.recurrences.rate(rate)};")
                body.append("s->normal_velocity[k + 1] = only(moving, s->acceleration[k]*next);")
            else:
                body.append(f"s->{name}[k + 1] = {self.recurrences.rate(rate)}*next;")
        if self.work_rate is not None:
            line = f"s->capillary_work[k + 1] = {self.recurrences.rate(self.work_rate)}*next;"
            body += compiled_if("CAPILLARY_STATE", [line])
        if self.turning is not None:
            body += compiled_if("TURNING_STATE", [f"s->turned[k + 1] = {self.recurrences.rate(self.turning)}*next;"])
        body += self.ledger.coefficients()
        return [
            *documented(
                "Coefficient k of every series and k + 1 of the states. Region: film is 1 inside the film, shear 1 "
                "inside the tangential edge, else 0; the gap is held in lanes that are not moving.",
                "INLINE void coefficients(series *s, const constants *c, vec film, vec shear, mask moving, int k)",
                body,
            ),
            *documented(
                "Coefficient k of the clearance of the glass criterion.",
                "INLINE void glass_coefficients(series *s, const constants *c, int k)",
                [
                    "s->approach[k] = -s->normal_velocity[k];",
                    "glass_pressure_clearance_next(&s->glass, &c->glass, s->gap, s->approach, k);",
                ],
            ),
            *(self.resting.coefficients() if self.resting else ()),
            *function(
                "static inline vec glass_clearance(const constants *c, const vec *y)",
                ["return glass_pressure_clearance_value(&c->glass, y[GAP], -y[NORMAL_VELOCITY]);"],
            ),
            "",
        ]

    # ---- values

    def _scalar(self, name: str, output: str = "", source: str = "") -> list[str]:
        """A function of the states `y`: an output of a function of the model, by default the one of its name."""
        head = f"static inline vec {name}(const constants *c, const vec *y)"
        return self._value(source or name, head, {output or name: "return"})

    def _vector(self, name: str, into: str, targets: Mapping[str, str], doc: str = "") -> list[str]:
        """A function of the states `y` with several results: output -> C target in the array `into`."""
        head = f"static inline void {name}(const constants *c, const vec *y, vec *{into})"
        return self._value(name, head, targets, doc)

    def _value(self, name: str, head: str, targets: Mapping[str, str], doc: str = "") -> list[str]:
        outputs = [pair for pair in self.model[name].outputs if pair[0] in targets]
        return self._valued(outputs, head, targets, doc or self.model[name].doc)

    def _valued(
        self,
        outputs: Sequence[tuple[str, sp.Expr]],
        head: str,
        targets: Mapping[str, str],
        doc: str,
        constants: Constants | None = None,
        further: tuple[sp.Symbol, ...] = (),
    ) -> list[str]:
        """A C function of outputs; its targets are C text, or "return" for the value itself."""
        constants = constants or self.constants
        values = (expression for _, expression in outputs)
        program = Program.for_outputs((*self.model.states, *further), values, self.model.definitions)
        arguments = {symbol.name for symbol in further}
        results = {key: program.result(expression, key) for key, expression in outputs}

        def where(series: str) -> str:
            return series if series in arguments else f"y[{series.upper()}]"

        recurrences = Recurrences(program, constants, where)
        program.collect_calls(self.calls)
        body = ["(void)c; (void)y;", *recurrences.values(results.values())]
        computed = {operation.name for operation in program.operations}
        for key, result in results.items():
            if isinstance(result, str):
                text = result if result in computed else where(result)
            else:
                text = constants.text.vector(result)
            body.append(f"{targets[key]} {text};" if targets[key] == "return" else f"{targets[key]} = {text};")
        return documented(doc, head, body)

    def _values(self) -> list[str]:
        model, shape = self.model, self.model.structure

        def by_state(array: str, states: Sequence[sp.Symbol] = model.states) -> dict[str, str]:
            return {state.name: f"{array}[{state.name.upper()}]" for state in states}

        lines = self._value("start", "static inline void start(const constants *c, vec *y)", by_state("y"))
        lines += self._vector("rebound", "after", by_state("after"))
        lines += self._friction() if shape.friction else []
        lines += self._scalar("inward_force")
        lines += series_of_guards(self.model, self.constants, self._valued)
        escape = model["escape_energy" if shape.partner == "wall" else "energies"]
        total = [("energy", sp.Add(*escape.by_name.values()))]
        head = "static inline vec stored_energy(const constants *c, const vec *y)"
        lines += self._valued(total, head, {"energy": "return"}, escape.doc + " Their sum.")
        outputs = {key: f"shown[{position}]" for position, key in enumerate(model["outputs"].by_name)}
        lines.append(f"enum {{ OUTPUTS = {len(outputs)} }};")
        lines += self._vector("outputs", "shown", outputs)
        if "effective_potential" in model:
            lines += ["#define POTENTIAL 1"]
            for key in ("energy", "slope"):
                lines += self._scalar(f"potential_{key}", key, "effective_potential")
        if shape.partner == "space":
            head = "static inline void held_response(const constants *c, const vec *y, vec film, vec shear, vec *found)"
            held = {key: f"found[HELD_{key.upper()}]" for key in model["held_response"].by_name}
            lines.append(f"enum {{ {', '.join(f'HELD_{key.upper()}' for key in held)}, RESPONSES }};")
            lines += self._value("held_response", head, held)
            lines += self._vector("resting_bound", "found", {"outward": "found[0]", "inward": "found[1]"})
            lines += self._scalar("wobble")
            momenta = {f"momentum_{axis}": f"found[{k}]" for k, axis in enumerate("xyz")}
            lines += self._vector("precession", "found", {**momenta, "per_momentum": "found[3]"})
        elif "rigid_rotation" in model and shape.oblique and shape.partner != "wall":
            lines += self._scalar("rigid_momentum", "orbital_momentum", "rigid_rotation")
            if not shape.reduced:
                lines += self._vector("rigid_rotation", "rigid", by_state("rigid", model.states[2:]))
        if shape.oblique:
            lines += self._scalar("surface_slip")
        if "arm" in model.slots and not shape.strings:
            lines += self._scalar("angular_momentum")
            doc = "Change of the angular momentum over that of the orbital one: none with the lever arm at mid-gap."
            head = "static inline vec momentum_share(const constants *c, const vec *y)"
            share = 1 - (CENTRES if shape.partner else 2) * LEVER / DISTANCE
            lines += self._valued([("share", share)], head, {"share": "return"}, doc)
        prepared = {(slot, call): name for name, (slot, call, _) in self.calls.items()}
        lines += margins(model, self.constants, prepared)
        if self.beside.events or shape.terms:
            lines += ["#define SLOW_MANIFOLD 0", ""]  # its bounds do not hold with declared events or terms
        else:
            lines += slow_manifold_functions(model, self.constants, prepared)
        if attracting(model):
            lines += work_function(model, self.constants, self.calls)
        if (shape.partner == "wall" or not shape.oblique) and not (shape.bridge or shape.strings):
            lines += momentum_functions(model, self.constants, self.calls)
        lines += self.ledger.functions(self._valued)
        return lines + (edge_function(model["events"]["tangential_edge"], self.constants) if shape.oblique else [])

    def _friction(self) -> list[str]:
        """The friction of a rebound: impulses, what an impulse does to the states, and what it costs."""
        model = self.model
        impulses = {name: f"found[{name.upper()}]" for name in model["dry_slip"].by_name}
        lines = [f"enum {{ {', '.join(name.upper() for name in impulses)}, IMPULSES }};"]
        lines += self._vector("dry_slip", "found", impulses)
        lines += ["enum { GRIP_LIMIT, HOLDING, DRY_FORCES };"]
        if "dry_forces" in model:
            head = "static inline void dry_forces(const constants *c, const vec *y, vec film, vec shear, vec *found)"
            forces = self._value("dry_forces", head, {"limit": "found[GRIP_LIMIT]", "holding": "found[HOLDING]"})
            forces.insert(forces.index("{") + 1, "    (void)film; (void)shear; /* some models have no edge */")
            lines += forces
        for name, kind, result in (("rubbed", "void", ", vec *after"), ("friction_loss", "vec", "")):
            source = model[name]
            head = f"static inline {kind} {name}(const constants *c, const vec *y, vec impulse{result})"
            targets = {key: f"after[{key.upper()}]" if result else "return" for key in source.by_name}
            lines += self._valued(source.outputs, head, targets, source.doc, further=source.further)
        return lines


def structure_header(model: Model, beside: Beside | None = None) -> str:
    """The C header of a structure; `beside` is a user's."""
    return Header(model, beside or Beside()).text()
