"""The transposed recurrences of a structure's flow in C: derivatives of a result propagated backwards over a step.

A step computes the coefficients of all series in sequence and sums those of the states. Each recurrence is linear in a
small change of its operands, so that in reverse order its transpose propagates derivatives of a result by a series to
those by its operands: a product costs two products, a quotient two, whatever the number of groups. The matrix of the
tangent is never formed. Derivatives by the constants of the recurrences are accumulated over the whole trajectory, and
become derivatives by the groups at its end.
"""

import sympy as sp

from ...physics.forces import FILM, SHEAR
from ...physics.law import slot_calls
from ...vocabulary.quantities import normal_velocity
from ..casadi.printer import EmissionError
from .c_text import Text
from .constants import split_flags
from .law_slopes import UNUSED
from .layout import comment, documented, struct
from .linear_flow import LinearFlow
from .program import Operation

_UNUSED = "(void)bar; (void)d; (void)c; (void)film; (void)shear; (void)moving;"
# Cost of a transposed recurrence in products of series; a call costs one for each series that it is given.
TRANSPOSED = {
    "product": 2.0, "square": 1.0, "quotient": 2.0, "sine": 1.0, "cosine": 1.0, "exp": 1.0, "arctangent": 1.0,
    "sqrt": 1.0, "log": 1.0, "reciprocal": 2.0, "power": 2.0,
}  # fmt: skip


class Adjoint:
    """Text of the backward recurrences of one structure, and of what they need."""

    def __init__(self, tangent: LinearFlow) -> None:
        self._tangent = tangent
        self._header = tangent.header
        self._flow = self._header.recurrences
        self._rates = {state.name: self._header.rates[state.name] for state in tangent.model.states}
        self._operations = self._contributing()
        self._constants: dict[sp.Expr, int] = {}  # their expressions in the groups, and their places
        self._arrays: list[str] = []
        self._ahead = 0
        self._steps = self._recurrences()

    @property
    def cost(self) -> float:
        """Products of series of a step backwards, without those of the flow and of the laws."""
        calls = sum(len(operation.series) for operation in self._operations if operation.kind == "call")
        return calls + sum(TRANSPOSED.get(operation.kind, 0.0) for operation in self._operations)

    def lines(self) -> list[str]:
        """The emitted declarations and functions."""
        fields = [
            "vec constant[CONSTANTS];",
            f"vec ahead[{max(self._ahead, 1)}];",
            *(f"vec {name}[TERMS];" for name in self._arrays),
        ]
        doc = "Derivatives of a result by the coefficients of the series of a step, and by the constants so far."
        count = f"enum {{ CONSTANTS = {max(len(self._constants), 1)} }};"
        struct_lines = [count, *comment(doc), *struct("adjoint", fields)]
        return [*self._law_slopes(), *struct_lines, *self._function(), *self._along_constants()]

    def _correlated(self, factor: str, adjoint: str, function: str = "correlated") -> str:
        self._ahead += 1
        return f"{function}({factor}, {adjoint}, &bar->ahead[{self._ahead - 1}], k)"

    def _contributing(self) -> list[Operation]:
        """Operations that the rates of the states depend on, in order."""
        wanted = {rate for rate in self._rates.values() if isinstance(rate, str)}
        selection = []
        for operation in reversed(self._header.flow.operations):
            if operation.kind == "sine" and f"cosine_of_{operation.series[0]}" in wanted:
                wanted.add(operation.name)
            if operation.name in wanted:
                selection.append(operation)
                wanted.update(operation.series)
        return selection[::-1]

    def _law_slopes(self) -> list[str]:
        calls = [(operation.name, *operation.call) for operation in self._operations if operation.kind == "call"]
        prepare, expand = ["(void)c; (void)v;"], ["(void)s; (void)c; (void)of; (void)v;"]
        for name, slot, call, arguments in calls:
            passed = "".join(f", {self._array(a)}" for a in arguments if isinstance(a, str))
            prepare.append(f"{slot}_{call}_slope_prepare(&c->{name}, &v->{name});")
            expand.append(f"{slot}_{call}_slopes_of(&s->{name}, &c->{name}, &of->{name}, &v->{name}{passed});")
        constants = [f"{slot}_{call}_slope_constants {name};" for name, slot, call, _ in calls]
        slopes = [f"{slot}_{call}_slopes {name};" for name, slot, call, _ in calls]
        return [
            *struct("slope_constants", constants or ["char none[0];"]),
            *struct("slopes", slopes or ["char none[0];"]),
            *documented(
                "Constants of the laws' derivatives, computed once per collision.",
                "static inline void prepare_slopes(slope_constants *c, const constants *v)",
                prepare,
            ),
            *documented(
                "Derivatives of the laws by their arguments.",
                "OUTLINE void expand_slopes(slopes *restrict s, const slope_constants *c, const series *of, "
                "const constants *v)",
                expand,
            ),
        ]

    # ---- recurrences

    def _array(self, name: str) -> str:
        return self._flow.array(name).replace("s->", "of->", 1)

    def _accumulate(self, factor: sp.Expr, change: str, first: bool = False) -> list[str]:
        """C statement that adds a change to the derivative by a constant; none if that depends on no group.

        Arguments:
            factor: the constant, with the flags of the region as factors.
            first: only for coefficient 0.
        """
        flags, whole = split_flags(factor, (FILM, SHEAR))
        named = self._header.flow.named
        while named.keys() & whole.free_symbols:
            whole = whole.xreplace(named)
        if not whole.free_symbols:
            return []
        place = f"bar->constant[{self._constants.setdefault(whole, len(self._constants))}]"
        product = "*".join([*(flag.name for flag in flags), change])
        return [f"{'if (k == 0) ' if first else ''}{place} += {product};"]

    def _recurrences(self) -> list[str]:
        self._pulls: dict[str, list[str]] = {}
        body: list[str] = []
        for state, rate in self._rates.items():
            after, value = f"after_{state}", f"w[{state.upper()}]*next"
            body.append(f"vec {after} = {f'only(moving, {value})' if state == normal_velocity.name else value};")
            if isinstance(rate, str):
                self._pull(rate, after)
            elif rate != 0:
                body += self._accumulate(rate, after, first=True)
        for operation in reversed(self._operations):
            body += self._transposed(operation)
        for state in self._tangent.states:
            pulls = self._pulls.pop(state, [])
            body.append(f"w[{state.upper()}] = {' + '.join([f'of_sum[{state.upper()}]*power', *pulls])};")
        assert not self._pulls, self._pulls
        return body

    def _pull(self, name: str, term: str) -> None:
        self._pulls.setdefault(name, []).append(term)

    def _transposed(self, operation: Operation) -> list[str]:
        name, kind = operation.name, operation.kind
        total = " + ".join(self._pulls.pop(name, [])) or "splat(0.0)"
        if kind == "linear":
            return self._linear(operation, total)
        self._arrays.append(name)
        adjoint = f"bar->{name}"
        if kind == "quotient":
            over, under = operation.series
            self._pull(over, f"{adjoint}[k]")
            self._pull(under, f"(-by_{name})")
            lines = [
                f"{adjoint}[k] = ({total} - {self._correlated(self._array(under), adjoint, 'beyond')})*of->over_{name};"
            ]
            return [*lines, f"vec by_{name} = {self._correlated(self._array(name), adjoint)};"]
        lines = [f"{adjoint}[k] = {total};"]
        if kind == "product":
            return lines + self._product(operation)
        if kind == "call":
            return lines + self._call(operation)
        if kind in ("sqrt", "log", "power"):
            return self._divided(operation, total)
        operand = operation.series[0]
        factors = {  # the series that a change is correlated with, and what of it goes to the operand
            "square": (operand, f"2.0*by_{name}"),
            "sine": (f"cosine_of_{operand}", f"by_{name}"),
            "cosine": (f"sine_of_{operand}", f"(-by_{name})"),
            "exp": (name, f"by_{name}"),
            "arctangent": (operation.series[-1], f"by_{name}"),
            "reciprocal": (name, f"(-by_{name})"),
        }
        if kind not in factors:  # in laws only, whose derivatives have headers of their own
            raise EmissionError(f"no transposed recurrence of {name}, a {kind}")
        beside, term = factors[kind]
        if kind == "reciprocal":
            self._arrays.append(f"once_{name}")
            lines.append(f"bar->once_{name}[k] = {self._correlated(self._array(name), adjoint)};")
            adjoint = f"bar->once_{name}"
        self._pull(operand, term)
        return [*lines, f"vec by_{name} = {self._correlated(self._array(beside), adjoint)};"]

    def _divided(self, operation: Operation, total: str) -> list[str]:
        """Of a root, a logarithm or a power: a change of its operand over a series, 2 q, a, or a/(r q)."""
        name, (operand,) = operation.name, operation.series
        adjoint, lines, under, twice = f"bar->{name}", list[str](), operand, ""
        if operation.kind == "sqrt":
            under, twice = name, "2.0*"
        if operation.kind == "power":
            if operation.factors[0].free_symbols:
                raise EmissionError(f"no transposed recurrence of {name}, a power with an exponent of its own")
            self._arrays.append(f"once_{name}")
            lines.append(f"bar->once_{name}[k] = {total};")
            whole = self._correlated(self._array(name), f"bar->once_{name}")
            total = f"{self._flow.factors[name][0]}*{whole}"
        beyond = self._correlated(self._array(under), adjoint, "beyond")
        self._pull(operand, f"{adjoint}[k]")
        return [*lines, f"{adjoint}[k] = ({total} - {twice}{beyond})*of->over_{name};"]

    def _linear(self, operation: Operation, total: str) -> list[str]:
        weight = f"by_{operation.name}"
        lines = [f"vec {weight} = {total};"]
        texts = self._flow.factors[operation.name]
        for operand, factor, text in zip(operation.series, operation.factors, texts, strict=False):
            self._pull(operand, _scaled(text, weight))
            lines += self._accumulate(factor, f"{self._array(operand)}[k]*{weight}")
        return lines + self._accumulate(operation.factors[-1], weight, first=True)

    def _product(self, operation: Operation) -> list[str]:
        name, adjoint = operation.name, f"bar->{operation.name}"
        text = self._flow.factors[name][0]
        first, second = operation.series
        lines = []
        for operand, other in ((first, second), (second, first)):
            lines.append(f"vec {operand}_by_{name} = {self._correlated(self._array(other), adjoint)};")
            self._pull(operand, _scaled(text, f"{operand}_by_{name}"))
        return lines + self._accumulate(operation.factors[0], f"{self._array(first)}[k]*{first}_by_{name}")

    def _call(self, operation: Operation) -> list[str]:
        slot, call, arguments = operation.call
        adjoint, lines = f"bar->{operation.name}", []
        names = self._tangent.law_arguments(slot, call, len(arguments))
        for argument, value in zip(names, arguments, strict=True):
            slope = f"d->{operation.name}.by_{argument.removeprefix(UNUSED)}"
            if isinstance(value, str):
                lines.append(f"vec {operation.name}_{argument} = {self._correlated(slope, adjoint)};")
                self._pull(value, f"{operation.name}_{argument}")
            else:
                lines += self._accumulate(value, f"{slope}[k]*{adjoint}[k]")
        return lines

    # ---- text

    def _function(self) -> list[str]:
        return documented(
            "Transposed recurrences of coefficient k. `w` holds the derivatives of a result by coefficient k + 1 of "
            f"the states, then by coefficient k; `of_sum` those by their sums. Products of series: {self.cost:g}.",
            "INLINE void adjoint_coefficients(adjoint *bar, vec *w, const vec *of_sum, vec power, const series *of, "
            "const slopes *d, const constants *c, vec film, vec shear, mask moving, int k)",
            ["double next = 1.0/(k + 1);", _UNUSED, *self._steps],
        )

    def _along_constants(self) -> list[str]:
        text = Text(lambda symbol: f"v->{symbol.name}")
        body = ["(void)v; (void)constant;"]
        for group in self._tangent.model.groups:
            terms = []
            for expression, place in self._constants.items():
                slope = sp.factor_terms(sp.diff(expression, group))
                if slot_calls(slope):
                    raise EmissionError(f"no derivative of the constant {expression}")
                if slope == 1:
                    terms.append(f"constant[{place}]")
                elif slope != 0:
                    factor = f"({text(slope)})" if slope.is_Add else text(slope)
                    terms.append(f"{factor}*constant[{place}]")
            if terms:
                body.append(f"by_group[BY_{group.name.upper()}] += {' + '.join(terms)};")
        head = "static inline void along_constants(const constants *v, const vec *constant, vec *by_group)"
        doc = "From derivatives by the constants of the recurrences to those by the groups."
        return documented(doc, head, body)


def _scaled(factor: str, term: str) -> str:
    return {"1.0": term, "(-1.0)": f"(-{term})"}.get(factor, f"{factor}*{term}")


def contraction(tangent: LinearFlow) -> list[str]:
    """C text of the contraction rate: minus the trace of the matrix, from the leading coefficients of the series."""
    rates = dict(tangent.rates())
    slopes = [tangent.chain.by(rates[state.name], state) for state in tangent.model.states]
    named = dict(tangent.model.definitions) | dict(tangent.chain.named)
    constants = {symbol: value for symbol, value in named.items() if symbol.name not in tangent.flow}
    for place, slope in enumerate(slopes):  # in series of the flow and constants
        while constants.keys() & slopes[place].free_symbols:
            slopes[place] = slope = slope.xreplace(constants)
    # the slope of a law that depends on a rate is only available in the tangent
    terms = [slope for slope in slopes if not any(symbol.name in tangent.slopes for symbol in slope.free_symbols)]
    trace = sp.Add(*terms)
    calls = {node: tangent.header.flow.series(node) for node in slot_calls(trace)}
    results = {node: sp.Symbol(f"{name}.result", real=True) for node, name in calls.items()}
    moving = {f"{name}.result" for name in calls.values()} | tangent.flow

    def name(symbol: sp.Symbol) -> str:
        return f"of->{symbol.name}[0]" if symbol.name in moving else tangent.constants.name(symbol)

    body = [
        "(void)of; (void)v; (void)film; (void)shear;",
        f"return {Text(name).vector(sp.factor_terms(-trace.xreplace(results)))};",
    ]
    head = "static inline vec contraction(const series *of, const constants *v, vec film, vec shear)"
    doc = "Contraction rate of a volume of states at the start of a step, dominated by the fast modes."
    return documented(doc, head, body)
