"""The transposed recurrence of a structure's tangent: a result's derivatives taken back over a step, in C.

A step's tangent makes coefficients of a direction one after the other and sums them. Read backwards, the same products
lead from the result's derivatives by the sum to those by each coefficient: by the states at the step's start, and by
all that drives a direction, whatever the number of groups.
"""

from __future__ import annotations

import sympy as sp
from sympy.core.function import AppliedUndef

from ...physics.laws.base import is_slot_call
from .c_text import Text
from .layout import comment, function
from .linear_flow import LinearFlow


def cotangent(tangent: LinearFlow) -> list[str]:
    """The recurrence, and the rate at which the flow contracts."""
    return [*_recurrence(tangent), *_contraction(tangent)]


def _recurrence(tangent: LinearFlow) -> list[str]:
    body = ["(void)s; (void)c; (void)v; (void)film; (void)shear;"]
    for state in tangent.states:
        terms: list[str] = []
        turned: list[str] = []
        for (row, by), entry in tangent.matrix.items():
            if by != state:
                continue
            after = f"after[{row.upper()}]"
            if isinstance(entry, str):
                term = f"correlated({tangent.array(entry)}, {after}, k)"
            elif entry == 1:
                term = f"{after}[k]"
            else:
                term = f"{tangent.constants.factor(entry, f'{row}_by_{by}')}*{after}[k]"
            (turned if row == "turned" else terms).append(term)
        target = f"w[{state.upper()}][k] +="
        if terms:
            body.append(f"{target} {' + '.join(terms)};")
        if turned:
            body += ["#if TURNING_STATE", f"{target} {' + '.join(turned)};", "#endif"]
    head = (
        "INLINE void cotangent_coefficients(vec (*w)[TERMS], vec (*after)[TERMS], const slopes *s, "
        "const slope_constants *c, const constants *v, vec film, vec shear, int k)"
    )
    doc = (
        "A result's derivatives by coefficient k of the states, from those by coefficient k + 1 and later, in `after` "
        "over that number; what the sum gives is there."
    )
    return [*comment(doc), *function(head, body), ""]


def _contraction(tangent: LinearFlow) -> list[str]:
    """The trace of the matrix, out of what the flow's series begin with."""
    slopes = [_diagonal(tangent, state) for state in tangent.model.states]
    # a law that depends on a rate itself has its slope in the tangent only
    known = [slope for slope in slopes if not any(symbol.name in tangent.slopes for symbol in slope.free_symbols)]
    trace = sum(known, sp.Integer(0))
    calls = {node: tangent.header.flow.series(node) for node in trace.atoms(AppliedUndef) if is_slot_call(node)}
    shown = {node: sp.Symbol(f"{name}.result", real=True) for node, name in calls.items()}
    moving = {f"{name}.result" for name in calls.values()} | tangent.flow

    def name(symbol: sp.Symbol) -> str:
        return f"of->{symbol.name}[0]" if symbol.name in moving else tangent.constants.name(symbol)

    body = [
        "(void)of; (void)v; (void)film; (void)shear;",
        f"return {Text(name).vector(sp.factor_terms(-trace.xreplace(shown)))};",
    ]
    head = "static inline vec contraction(const series *of, const constants *v, vec film, vec shear)"
    doc = "The rate at which a volume of states shrinks where a step starts: that of its fast modes."
    return [*comment(doc), *function(head, body), ""]


def _diagonal(tangent: LinearFlow, state: sp.Symbol) -> sp.Expr:
    """How a state's rate changes with the state itself, in series of the flow and constants."""
    slope = tangent.chain.by(dict(tangent.rates())[state.name], state)
    known = dict(tangent.model.definitions) | dict(tangent.chain.named)
    own = {symbol: value for symbol, value in known.items() if symbol.name not in tangent.flow}
    while own.keys() & slope.free_symbols:
        slope = slope.xreplace(own)
    return slope
