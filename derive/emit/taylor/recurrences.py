"""C text of series programs: one recurrence per line, and values of order zero."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from collections.abc import Set as AbstractSet

import sympy as sp

from .constants import Constants
from .loops import Loops
from .program import Operation, Program

_NUMBER = re.compile(r"\(?-?[\d.]+(e[-+]?\d+)?\)?")  # as `number` prints it
# C text of the recurrence of an operation and of its value at order zero: `{0}`, `{1}` are its operands, `whole` is
# its own series; `over`, `slope` and `inner` are auxiliary series (functions of `engines/taylor/runtime/series.h`).
_SIDE = "vec_larger(splat(-1.0), vec_smaller(splat(1.0), 2.5e9*{}))"  # 1/ON_KINK of engines/taylor/runtime/kinks.h
_HALF = "choose({} < 0.0, splat(0.0), splat(1.0))"
_RECURRENCES = {
    "square": "square({0}, k)", "reciprocal": "reciprocal({0}, {whole}, k)",
    "quotient": "quotient({0}, {1}, {whole}, {over}, k)", "sqrt": "root({0}, {whole}, {over}, k)",
    "power": "power({0}, {whole}, {factor}, {over}, k)", "exp": "exponential({0}, {inner}, {whole}, k)",
    "log": "logarithm({0}, {whole}, {slope}, {over}, k)", "arctangent": "arctangent({0}, {inner}, {1}, k)",
    "side": f"k == 0 ? {_SIDE.format('{0}[0]')} : splat(0.0)",
    "half": f"k == 0 ? {_HALF.format('{0}[0]')} : splat(0.0)",
}  # fmt: skip
_VALUES = {
    "square": "{0}*{0}", "reciprocal": "1.0/{0}", "quotient": "{0}/{1}", "power": "vec_exp({factor}*vec_log({0}))",
    "sqrt": "vec_sqrt({0})", "exp": "vec_exp({0})", "log": "vec_log({0})", "sine": "vec_sin({0})",
    "cosine": "vec_cos({0})", "arctangent": "vec_atan({0})", "side": _SIDE.format("{0}"),
    "half": _HALF.format("{0}"),
}  # fmt: skip


class Recurrences:
    """C lines of a program: `s->name[k]` for its own series, `c->name` for constants.

    Arguments:
        where: C text of a series that the program does not compute itself.
        local: for each of its own series, whether it is a local variable instead of a member of `s`.
        passing: series whose coefficients are needed for the next sums only, stored at PASSING(k) for coefficient k.
        loops: over nodes; with them `where` is asked for arrays over nodes.
    """

    def __init__(
        self,
        program: Program,
        constants: Constants,
        where: Callable[[str], str],
        local: Callable[[str], bool] = lambda name: False,
        passing: AbstractSet[str] = frozenset(),
        loops: Loops | None = None,
    ) -> None:
        self.program, self.constants, self._where, self._local = program, constants, where, local
        self._passing, self.loops, self._node = passing, loops or Loops(program.operations[:0]), ""
        self._own = {operation.name for operation in program.operations}
        self._calls = {operation.name for operation in program.operations if operation.kind == "call"}
        for symbol, expression in program.named.items():
            constants.define(symbol, expression)
        self.factors = {operation.name: self._factors(operation) for operation in program.operations}
        self._tables: list[str] = []
        for first, members in self.loops.families.items():
            columns = zip(*(self.factors[member.name] for member in members), strict=True)
            for place, column in enumerate(columns):
                if len(set(column)) > 1:
                    self._tables.append(self._table(f"{first}_{place}", column))
                    self.factors[first][place] = f"{first}_{place}[node]"

    @staticmethod
    def _table(name: str, texts: Sequence[str]) -> str:
        """C text of constants over nodes."""
        plain = [_NUMBER.fullmatch(text) is not None for text in texts]
        if all(plain):
            return f"static const double {name}[{len(texts)}] = {{{', '.join(texts)}}};"
        vectors = (f"splat({text})" if number else text for text, number in zip(texts, plain, strict=True))
        return f"const vec {name}[{len(texts)}] = {{{', '.join(vectors)}}};"

    def _factors(self, operation: Operation) -> list[str]:
        hints = [f"{operation.name}_factor"]
        if operation.kind == "power":  # its exponent is an argument of a function of vectors
            return [self.constants.vector(operation.factors[0], hints[0])]
        if operation.kind == "linear":
            hints = [f"{operation.name}_per_{series}" for series in operation.series] + [f"{operation.name}_offset"]
        return [self.constants.factor(factor, hint) for factor, hint in zip(operation.factors, hints, strict=False)]

    def array(self, name: str) -> str:
        """C text of the array of a series."""
        if name in self._calls:
            return f"s->{name}.result"
        return self._at(name, self._place(name)) if name in self._own else self._at(name)

    def _at(self, name: str, place: str = "", what: str = "") -> str:
        """C text of an array of a series that the program computes at a place, or of another series.

        Arguments:
            what: the name of an array beside that of the series, with an underscore.
        """
        first, node = self.loops.places.get(name, (name, None))
        whole = f"{place}{what}{first}" if what or first in self._own else self._where(first)
        return whole if node is None else f"{whole}[{self._node or node}]"

    def coefficient(self, name: str) -> str:
        """C text of coefficient k of a series."""
        return f"{self.array(name)}[{'PASSING(k)' if name in self._passing else 'k'}]"

    def rate(self, rate: str | sp.Expr) -> str:
        """C text of coefficient k of a series, or of a constant."""
        if isinstance(rate, str):
            return self.coefficient(rate)
        return f"(k == 0 ? {self.constants.text.vector(rate)} : splat(0.0))"

    def _place(self, name: str) -> str:
        return "" if self._local(name) else "s->"

    def fields(self, local: bool = False) -> list[str]:
        """Declarations of the arrays: of the local ones, or of the others."""
        lines = []
        for operation in self.program.operations:
            first, node = self.loops.places.get(operation.name, ("", 0))
            if self._local(operation.name) != local or node:
                continue
            nodes = f"[{len(self.loops.families[first])}]" if first else ""
            if operation.kind == "call":
                lines.append(f"{operation.call[0]}_{operation.call[1]}_series {operation.name};")
                continue
            arrays = [operation.name]
            if operation.kind in ("exp", "sine", "arctangent"):
                arrays.append(f"slope_of_{self.loops.places.get(operation.series[0], operation.series)[0]}")
            if operation.kind == "log":
                arrays.append(f"slope_of_{operation.name}")
            size = "PASSING(ORDER) + 1" if operation.name in self._passing else "TERMS"
            lines.append("vec " + ", ".join(f"{name}{nodes}[{size}]" for name in arrays) + ";")
            if operation.kind in ("quotient", "sqrt", "log", "power"):
                lines.append(f"vec over_{operation.name}{nodes};")
        return list(dict.fromkeys(lines))

    def lines(self, statement: Callable[[str], str] = str) -> list[str]:
        """The recurrences, as statements; those of families in loops."""
        if not self.loops.families:
            return [statement(self._line(operation)) for operation in self.program.operations]
        return self._staged(lambda operation: statement(self._line(operation)))

    def _staged(self, line: Callable[[Operation], str]) -> list[str]:
        lines = [*self._tables]
        for count, operations in self.loops.stages():
            self._node = "node" if count else ""
            inside = list(filter(None, map(line, operations)))
            loop = f"for (int node = 0; node < {count}; node++) {{"
            lines += [loop, *(f"    {text}" for text in inside), "}"] if count else inside
        self._node = ""
        return lines

    def _line(self, operation: Operation) -> str:
        name, kind = operation.name, operation.kind
        series = [self.array(operand) for operand in operation.series]
        factors = self.factors[name]
        place = self._place(name)
        whole = self.array(name)
        target = f"{whole}[{'PASSING(k)' if name in self._passing else 'k'}]"
        if kind == "linear":
            terms = _terms(factors[:-1], [self.coefficient(operand) for operand in operation.series])
            offset = factors[-1]
            if offset == "0.0":
                return f"{target} = {terms};"
            return f"{target} = k == 0 ? {terms} + {offset} : {terms};"
        if kind == "product":
            ages = {
                op.name: age for age, op in enumerate(self.program.operations)
            }  # series that the program does not compute come first
            older, newer = (self.array(term) for term in sorted(operation.series, key=lambda term: ages.get(term, -1)))
            return f"{target} = {_times(factors[0])}product({older}, {newer}, k);"
        if kind in _RECURRENCES:
            inner = self._at(operation.series[0], place, "slope_of_")
            over, slope = "&" + self._at(name, place, "over_"), self._at(name, place, "slope_of_")
            recurrence = _RECURRENCES[kind].format(
                *series, whole=whole, over=over, slope=slope, inner=inner, factor=factors[0] if factors else ""
            )
            return f"{target} = {recurrence};"
        if kind == "sine":
            inner = operation.series[0]
            cosine = self.array(f"cosine_of_{inner}")
            return f"circular({series[0]}, {place}slope_of_{inner}, {whole}, {cosine}, k);"
        if kind == "cosine":
            return f"/* {name} comes with its sine */"
        slot, function, arguments = operation.call
        passed = "".join(f", {self.array(a)}" for a in arguments if isinstance(a, str))
        return f"{slot}_{function}_next(&s->{name}, &c->{name}{passed}, k);"

    def values(self, results: Iterable[object]) -> list[str]:
        """Declarations of local variables with the values at order zero; `where` of given series must be values too.

        Arguments:
            results: the names that are used; the value of a cosine needed only by the recurrence of its sine is left
                out.
        """
        read = {*results, *(name for op in self.program.operations for name in op.series)}
        if not self.loops.families:
            return [f"vec {op.name} = {self._value(op)};" for op in self.program.operations if op.name in read]
        arrays = [f"vec {name}[{len(members)}];" for name, members in self.loops.families.items()]
        typed = {name for name in self._own if name not in self.loops.places}

        def line(op: Operation) -> str:
            return f"{'vec ' * (op.name in typed)}{self._at(op.name)} = {self._value(op)};" * (op.name in read)

        return [*arrays, *self._staged(line)]

    def _value(self, operation: Operation) -> str:
        kind, factors = operation.kind, self.factors[operation.name]
        series = [self._at(name) for name in operation.series]
        if kind == "linear":
            terms = _terms(factors[:-1], series)
            return terms if factors[-1] == "0.0" else f"{terms} + {factors[-1]}"
        if kind == "product":
            return f"{_times(factors[0])}{series[0]}*{series[1]}"
        if kind == "call":
            slot, function, _ = operation.call
            return f"{slot}_{function}_value(&c->{operation.name}, {', '.join(series)})"
        return _VALUES[kind].format(*series, factor=factors[0] if factors else "")


def _times(factor: str) -> str:
    return {"1.0": "", "(-1.0)": "-"}.get(factor, f"{factor}*")


def _terms(factors: list[str], series: list[str]) -> str:
    text = ""
    for factor, name in sorted(zip(factors, series, strict=True), key=lambda pair: pair[0].startswith("(-")):
        negative = factor.startswith("(-")
        bare = factor[2:-1] if negative else factor
        body = name if bare == "1.0" else f"{bare}*{name}"
        text += (" - " if negative else " + ") + body if text else ("-" if negative else "") + body
    return text
