"""Derivatives by the chain rule with names kept: those of the expressions written out, for every structure and law."""

import math
import random

import pytest
import sympy as sp
from wetdoublet.derive.emit.taylor.chain_rule import Chain
from wetdoublet.derive.laws import LAWS
from wetdoublet.derive.physics.law import Law

DRAW = random.Random(3)
LIBRARY = [law for laws in LAWS.values() for law in laws.values()]


def _slope(expression: sp.Expr, by: sp.Symbol, at: dict[sp.Symbol, float]) -> float:
    """Of an expression, by a central difference."""
    function = sp.lambdify(list(at), expression, "math")
    low, high = (function(*(at | {by: at[by] + step}).values()) for step in (-1e-5, 1e-5))
    return (high - low) / 2e-5


def _somewhere(symbols: set[sp.Symbol]) -> dict[sp.Symbol, float]:
    at = {symbol: DRAW.uniform(0.3, 0.6) for symbol in sorted(symbols, key=str)}
    return at | {symbol: 5.0 for symbol in at if symbol.name == "string_ratio"}  # strings longer than the spheres


def _value(expression: sp.Expr, at: dict[sp.Symbol, float]) -> float:
    return float(sp.lambdify(list(at), expression, "math")(*at.values()))


@pytest.mark.parametrize("law", LIBRARY, ids=lambda law: law.module)
def test_functions_of_a_law(law: Law) -> None:
    """Each function of a law by each argument is the slope of the function written out."""
    for each in law.functions:
        chain, at = Chain(each.definitions), _somewhere(set(each.arguments))
        for argument in each.arguments:
            found = chain.by(each.result, argument)
            for symbol, value in (*reversed(chain.named), *reversed(each.definitions)):
                found = found.subs(symbol, value)
            expected = _slope(each(*each.arguments), argument, at)
            assert math.isclose(_value(found, at), expected, rel_tol=1e-6, abs_tol=1e-8), (each.name, argument)
