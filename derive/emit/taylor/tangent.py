"""The C header of a structure's tangent: derivatives of rates, start, jumps and outputs by the states and the groups.

A derivative of the states obeys a linear equation, v' = A v + b, whose matrix and source terms are series computed once
per step from those of the flow. A direction then costs as many products as the matrix has varying entries.
"""

from collections.abc import Mapping
from itertools import groupby
from types import MappingProxyType

import sympy as sp

from ...equations.friction import IMPULSE
from ...equations.model import Model
from ...physics.law import Law, filled, slot_calls
from ...physics.slots import MIDGAP
from ..casadi.printer import EmissionError
from ..provenance import header, model_digest
from .adjoint import Adjoint, contraction
from .c_text import Text
from .groups_from_si import scale_slopes
from .guards import check_differentiable
from .header import Beside
from .layout import comment, compiled_if, documented, each_term, struct
from .linear_flow import LinearFlow

_IN = "    "
_ALONG = "const constants *v, const vec *y, const vec *t, int group, "  # arguments of what is derived at a state


class Tangent(LinearFlow):
    """Text of one structure's tangent header."""

    def text(self) -> str:
        """The header."""
        check_differentiable(self.model)
        coefficients, row, source = self._coefficients(), self._row(), self._sources()
        back = Adjoint(self)
        levels = [f"vec {row}_by_{by}[TERMS];" for (row, by), e in self.sources.items() if not isinstance(e, str)]
        per_direction = sum(isinstance(entry, str) for (of, _), entry in self.matrix.items() if of != "turned")
        cost = f"Products of series: {self.program.cost:g} and those of the laws, then {per_direction} a direction; "
        cost += f"backwards {back.cost:g} and those of the laws' derivatives."
        name = self.model.structure.name
        lines = comment(header(model_digest(self.model)))
        lines += ["", *comment(f"Tangent of {name}.h: derivatives of the states by the groups.\n\n{cost}"), ""]
        lines += self._enumerations()
        lines += [
            "#if BACKWARD",
            *back.lines(),
            "#else",
            *self._constants(),
            *comment("Derivatives of the rates: entries of the matrix, and source terms of a direction."),
            *struct("slopes", [*self._law_fields("s->"), *self.recurrences.fields(), *levels]),
            *coefficients,
            *row,
            *source,
            "#endif",
            *contraction(self),
            *self._values(),
            *self._glass(),
            *scale_slopes(self.model, self.beside.definitions),
        ]
        return "\n".join(lines).rstrip() + "\n"

    def _enumerations(self) -> list[str]:
        groups = self._groups
        flags = ", ".join(str(int(name in self.flowing)) for name in groups)
        return [
            f"enum {{ {', '.join(f'BY_{name.upper()}' for name in groups)} }};",
            "const char group_names[] =",
            *(f'    "{name} "' for name in groups[:-1]),
            f'    "{groups[-1]}";',
            *comment("Groups that the rates depend on; the others enter at an event."),
            f"static const unsigned char FLOWS[GROUPS] = {{ {flags} }};",
            "",
        ]

    def _laws(self) -> dict[str, tuple[str, str, tuple[str | sp.Expr, ...]]]:
        return {name: call for name, call in self.header.calls.items() if name in self._calls}

    def _constants(self) -> list[str]:
        laws = self._laws()
        fields = [f"vec {name};" for name in self.constants.prepared]
        fields += [f"{slot}_{call}_slope_constants {name};" for name, (slot, call, _) in laws.items()]
        body = self.constants.assignments()
        body += [f"{slot}_{call}_slope_prepare(&c->{name}, &v->{name});" for name, (slot, call, _) in laws.items()]
        head = "static inline void prepare_slopes(slope_constants *c, const constants *v)"
        doc = "Constants of the derivatives, computed once per collision."
        return [*struct("slope_constants", fields), *documented(doc, head, body)]

    def _law_fields(self, place: str) -> list[str]:
        laws = self._laws().items()
        return [f"{slot}_{call}_slopes {name};" for name, (slot, call, _) in laws if self._law_place(name) == place]

    def _coefficients(self) -> list[str]:
        body = [*self._law_fields(""), *self.recurrences.fields(local=True)]
        body.append("(void)film; (void)shear; (void)c; (void)asked;")
        for name, (slot, call, arguments) in self._laws().items():
            passed = "".join(f", {self.array(a)}" for a in arguments if isinstance(a, str))
            into = f"{self._law_place(name)}{name}"
            body.append(f"{slot}_{call}_slopes_of(&{into}, &c->{name}, &of->{name}, &v->{name}{passed});")
        body += self._guarded()
        for (row, by), entry in self.sources.items():
            if not isinstance(entry, str):
                body.append(each_term(f"s->{row}_by_{by}[k] = {self.constants.level(entry, 'slope')};"))
        return documented(
            "Derivatives of the rates by the states, and by the requested groups.",
            "OUTLINE void expand_slopes(slopes *restrict s, const slope_constants *c, const series *of, "
            "const constants *v, vec film, vec shear, unsigned asked)",
            body,
        )

    def _guarded(self) -> list[str]:
        """C lines of the operations; those needed for some groups only are conditional on these."""
        always = {entry for entry in self.matrix.values() if isinstance(entry, str)}
        needs: dict[str, set[str]] = {}
        for (_, by), entry in self.sources.items():
            if isinstance(entry, str):
                needs.setdefault(entry, set()).add(by)
        sines = {step.series: step.name for step in self.program.operations if step.kind == "sine"}
        for operation in reversed(self.program.operations):
            made_with = (sines[operation.series],) if operation.kind == "cosine" and operation.series in sines else ()
            for series in (*operation.series, *made_with):
                if operation.name in always:
                    always.add(series)
                needs.setdefault(series, set()).update(needs.get(operation.name, ()))
        entries = [*self.matrix.items(), *self.sources.items()]
        turning = {entry for (row, _), entry in entries if row == "turned"}
        turning -= {entry for (row, _), entry in entries if row != "turned"}
        rows = []
        for operation, line in zip(self.program.operations, self.recurrences.lines(), strict=True):
            groups = () if operation.name in always else tuple(g for g in self._groups if g in needs[operation.name])
            loop = [each_term(line)]
            rows.append((groups, compiled_if("TURNING_STATE", loop) if operation.name in turning else loop))
        # operations needed by more groups come first; they never depend on those needed by fewer
        rows.sort(key=lambda row: (bool(row[0]), -len(row[0]), row[0]))
        lines: list[str] = []
        for groups, some in groupby(rows, key=lambda row: row[0]):
            inner = [line for _, block in some for line in block]
            if groups:
                test = f"if (asked & ({' | '.join(f'1u << BY_{group.upper()}' for group in groups)})) {{"
                inner = [test, *(line if line.startswith("#") else _IN + line for line in inner), "}"]
            lines += inner
        return lines

    @property
    def _groups(self) -> list[str]:
        return [group.name for group in self.model.groups]

    def _row(self) -> list[str]:
        body = ["double next = 1.0/(k + 1);", "(void)s; (void)c; (void)of; (void)v; (void)film; (void)shear;"]
        for row, _ in self.rates():
            terms = []
            for state in self.states:
                entry = self.matrix.get((row, state), sp.Integer(0))
                column = f"t[{state.upper()}]"
                if isinstance(entry, str):
                    terms.append(f"product({self.array(entry)}, {column}, k)")
                elif entry == 1:
                    terms.append(f"{column}[k]")
                elif entry != 0:
                    terms.append(f"{self.constants.factor(entry, f'{row}_by_{state}')}*{column}[k]")
            if any(of == row for of, _ in self.sources):
                terms.append(f"source[{row.upper()}][k]")
            line = f"t[{row.upper()}][k + 1] = ({' + '.join(terms) or 'splat(0.0)'})*next;"
            body += compiled_if("TURNING_STATE", [line]) if row == "turned" else [line]
        return documented(
            "Coefficient k + 1 of a derivative of the states, with its source terms.",
            "INLINE void tangent_coefficients(vec (*t)[TERMS], const slopes *s, const slope_constants *c, "
            "const series *of, const constants *v, vec film, vec shear, const vec *const *source, int k)",
            body,
        )

    def _sources(self) -> list[str]:
        body = ["(void)s; (void)of;", "switch (group) {"]
        for group in self.flowing:
            body.append(f"case BY_{group.upper()}:")
            lines = []
            for (row, by), entry in self.sources.items():
                if by == group:
                    array = self.array(entry) if isinstance(entry, str) else f"s->{row}_by_{by}"
                    line = f"{_IN}source[{row.upper()}] = {array};"
                    lines += compiled_if("TURNING_STATE", [line]) if row == "turned" else [line]
            body += [*lines, _IN + "break;"]
        body.append("}")
        head = "static inline void sources(const slopes *s, const series *of, int group, const vec **source)"
        doc = "Source terms of the derivatives by a group; zero ones are left unset."
        return documented(doc, head, body)

    def _values(self) -> list[str]:
        """Start, jump and outputs in a direction: derivatives of the states `t`, and explicit ones by each group."""
        states = {name: f"after[{name.upper()}]" for name in self.states}
        head = "static inline void start_along(const constants *v, int group, vec *after)"
        lines = self._directed("start", head, states, False, "Derivative of the initial state by a group.")
        head = f"static inline void rebound_along({_ALONG}vec *after)"
        lines += self._directed("rebound", head, states, True, "Derivative of the state just after a rebound.")
        lines += self._friction(states) if self.model.structure.friction else []
        places = {key: f"shown[{place}]" for place, key in enumerate(self.model["outputs"].by_name)}
        head = f"static inline void outputs_along({_ALONG}vec *shown)"
        lines += self._directed("outputs", head, places, True, "Derivative of the results for a separated doublet.")
        if self.model.structure.oblique:
            lines += self._edge()
        return lines

    def _glass(self) -> list[str]:
        """Slopes of the glass criterion by the groups that its law takes beside the library's arguments."""
        own = [symbol.name for symbol in self.beside.extra.get("glass.pressure", ())]
        if not own:
            return []
        passed = ["y[GAP]", "-y[NORMAL_VELOCITY]", *(f"c->{name}" for name in own), "c->glass_number"]
        passed += ["by_gap", "by_approach", *(f"&by_own[{place}]" for place in range(len(own))), "&limit"]
        head = "static inline void own_glass_slopes(const constants *c, const vec *y, vec *by_gap, vec *by_approach, "
        return [
            f"#define OWN_GLASS {len(own)}",
            f"static const int OWN_GLASS_GROUP[] = {{ {', '.join(f'BY_{name.upper()}' for name in own)} }};",
            *documented(
                "Slopes of the limit less the pressure, also by groups of a model.", f"{head}vec *by_own)",
                ["vec limit;", f"glass_pressure_margin_slopes({', '.join(passed)});"],
            ),
        ]  # fmt: skip

    def _friction(self, states: dict[str, str]) -> list[str]:
        """The impulses of a rebound, and the state after one, in a direction; for the library's lever arm."""
        impulses = {"sticking": "found[STICKING]", "most": "found[MOST]"}
        jumps = (
            ("dry_slip", "vec *found", impulses, "Derivatives of the impulses of a rebound.", ()),
            ("rubbed", "vec impulse, vec moved, vec *after", states,
             "Derivative of the state just after an impulse, which moves as well.", (IMPULSE,)),
        )  # fmt: skip
        if "arm.lever" in self.beside.extra:
            raise EmissionError("the dry friction of a lever arm of more than the gap has no derivatives in C")
        lines = []
        for name, arguments, targets, doc, moved in jumps:
            head = f"static inline void {name}_along({_ALONG}{arguments})"
            if "arm" not in self.model.slots:
                lines += self._directed(name, head, targets, True, doc, moved)
                continue
            lines += compiled_if("MIDGAP_ARM", self._directed(name, head, targets, True, doc, moved, MIDGAP))
        return [*lines, ""]

    def _directed(
        self,
        name: str,
        head: str,
        targets: dict[str, str],
        moves: bool,
        doc: str,
        moved: tuple[sp.Symbol, ...] = (),
        laws: Mapping[str, Law] = MappingProxyType({}),
    ) -> list[str]:
        """A function's derivative.

        Arguments:
            moved: further arguments of the function, whose derivatives are passed as `moved`.
            laws: that fill their slots.
        """
        outputs = {key: filled(self.model.expanded(sp.sympify(value)), laws) for key, value in self.model[name].outputs}
        names = {s: f"y[{s.name.upper()}]" for s in self.model.states} | {s: s.name for s in moved}
        text = Text(lambda symbol: names.get(symbol, f"v->{symbol.name}"))
        body = ["(void)v;"] + (["(void)y;"] if moves else [])
        for key, target in targets.items():
            terms = [
                f"{text(slope)}*t[{state.name.upper()}]" if (slope := sp.factor(outputs[key].diff(state))) != 1
                else f"t[{state.name.upper()}]"
                for state in self.model.states if moves and outputs[key].diff(state) != 0
            ]  # fmt: skip
            terms += [f"({text(outputs[key].diff(s))})*moved" for s in moved if outputs[key].diff(s) != 0]
            body.append(f"{target} = {' + '.join(terms) or 'splat(0.0)'};")
        cases = []
        for group in self.model.groups:
            slopes = {target: outputs[key].diff(group) for key, target in targets.items()}
            lines = [f"{_IN}{target} += {text(sp.factor(slope))};" for target, slope in slopes.items() if slope != 0]
            cases += [f"case BY_{group.name.upper()}:", *lines, _IN + "break;"] if lines else []
        return documented(doc, head, [*body, *(["switch (group) {", *cases, "}"] if cases else ["(void)group;"])])

    def _edge(self) -> list[str]:
        (call,) = slot_calls(self.model["events"]["tangential_edge"])
        slot, name = call.func.__name__.split(".")
        passed = ", ".join(f"v->{argument}" for argument in call.args)
        body = ["(void)v;", "switch (group) {"]
        for argument, value in zip(self.law_arguments(slot, name, len(call.args)), call.args, strict=True):
            body += [f"case BY_{value.name.upper()}:", f"{_IN}return {slot}_{name}_by_{argument}({passed});"]
        body += ["default:", f"{_IN}return splat(0.0);", "}"]
        head = "static inline vec tangential_edge_along(const constants *v, int group)"
        return documented("Derivative of the gap beyond which there is no tangential force.", head, body)


def tangent_header(model: Model, beside: Beside | None = None) -> str:
    """The C header of a structure's tangent; `beside` is a user's."""
    return Tangent(model, beside or Beside()).text()
