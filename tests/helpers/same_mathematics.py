"""Whether two expressions are the same mathematics."""

import math
from random import Random

import sympy as sp
from sympy.core.function import AppliedUndef

_SAME, _POINTS = 1e-11, 4


def same(one: sp.Expr, other: sp.Expr) -> bool:
    """True if two expressions are equal, as written or in value at random points (simplification may not end)."""
    if one == other:
        return True
    calls = {node: sp.Symbol(f"call {node}", positive=True) for e in (one, other) for node in e.atoms(AppliedUndef)}
    pair = [expression.xreplace(calls) for expression in (one, other)]
    free = sorted(set().union(*(e.free_symbols for e in pair)), key=str)
    compiled = sp.lambdify(free, pair, modules=["math"], dummify=True)
    draw, compared = Random(1), 0
    for _ in range(5 * _POINTS):
        try:
            left, right = (float(value) for value in compiled(*(draw.uniform(0.05, 0.95) for _ in free)))
        except (ArithmeticError, ValueError, TypeError):
            continue
        if not abs(left - right) <= _SAME * max(abs(left), abs(right)):
            return False
        compared += math.isfinite(left)
        if compared >= _POINTS:
            return True
    return compared > 0
