"""The transposed recurrence of a structure's tangent in C: derivatives of a result propagated backwards over a step.

The tangent of a step computes the coefficients of a direction in sequence and sums them. In reverse order, the same
products propagate derivatives of the result by the sum to derivatives by each coefficient: by the states at the start
of the step, and by all source terms, at a cost that does not depend on the number of groups.
"""

from __future__ import annotations

import sympy as sp
from sympy.core.function import AppliedUndef

from ...physics.laws.base import is_slot_call
from .c_text import Text
from .layout import comment, function
from .linear_flow import LinearFlow


def cotangent(tangent: LinearFlow) -> list[str]:
    """C text of the backward recurrence, and of the contraction rate of the flow."""
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
        "Derivatives of a result by coefficient k of the states, from those by later coefficients, which `after` "
        "holds divided by their number. Contributions of the sum have been added before."
    )
    return [*comment(doc), *function(head, body), ""]


def _contraction(tangent: LinearFlow) -> list[str]:
    """The trace of the matrix, from the leading coefficients of the flow's series."""
    slopes = [_diagonal(tangent, state) for state in tangent.model.states]
    # the slope of a law that depends on a rate is only available in the tangent
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
    doc = "Contraction rate of a volume of states at the start of a step, dominated by the fast modes."
    return [*comment(doc), *function(head, body), ""]


def _diagonal(tangent: LinearFlow, state: sp.Symbol) -> sp.Expr:
    """Derivative of a state's rate by the state itself, in series of the flow and constants."""
    slope = tangent.chain.by(dict(tangent.rates())[state.name], state)
    known = dict(tangent.model.definitions) | dict(tangent.chain.named)
    own = {symbol: value for symbol, value in known.items() if symbol.name not in tangent.flow}
    while own.keys() & slope.free_symbols:
        slope = slope.xreplace(own)
    return slope
