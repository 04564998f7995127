"""Invariants quadratic in given states, from the nullspace of a linear system for their coefficients.

As in `invariants`, dI/dt must vanish for every value of the states and of whatever is left open, here on the surface of
a relation that is conserved itself.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations_with_replacement

import sympy as sp


def quadratic_invariants(
    rates: Mapping[sp.Symbol, sp.Expr], among: Sequence[sp.Symbol], relation: sp.Expr | None = None
) -> tuple[sp.Expr, ...]:
    """A basis of the invariants that are quadratic forms, normalised to a first coefficient of 1.

    Arguments:
        rates: polynomials in the states and in what is left open; what divides them is constant.
        among: the states of the forms.
        relation: a polynomial that vanishes along every trajectory, monic in the square of its last symbol.
    """
    forms = [one * other for one, other in combinations_with_replacement(among, 2)]
    unknown = sp.symbols(f"c:{len(forms)}", cls=sp.Dummy)
    change = sp.Integer(0)
    for factor, form in zip(unknown, forms, strict=True):
        change += factor * sp.Add(*(form.diff(state) * rates[state] for state in form.free_symbols))
    change = sp.expand(change)
    if relation is not None:
        last = max(relation.free_symbols, key=lambda symbol: str(symbol))
        change = sp.rem(sp.Poly(change, last), sp.Poly(relation, last)).as_expr()
    divided = [power.base for power in change.atoms(sp.Pow) if power.exp.is_negative]  # constants: sizes
    constant = set(unknown).union(*(base.free_symbols for base in divided))
    varying = sorted(change.free_symbols - constant, key=str)
    equations = sp.Poly(sp.expand(change), *varying).coeffs()
    matrix = sp.linear_eq_to_matrix(list(dict.fromkeys(equations)), list(unknown))[0]
    result = []
    for vector in matrix.nullspace():
        first = next(value for value in vector if value != 0)
        result.append(sp.Add(*(value / first * form for value, form in zip(vector, forms, strict=True))))
    return tuple(result)
