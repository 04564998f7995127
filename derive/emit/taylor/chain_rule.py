"""Derivatives of named definitions by a state or a group: the chain rule with names kept.

Intermediates and values of laws stay symbols, so derivatives are as short as the definitions and reuse the series that
the flow has already computed.
"""

from collections.abc import Callable, Collection, Sequence
from functools import cache

import sympy as sp
from sympy.core.function import AppliedUndef

from ...physics.law import Definition, slot_calls

Slope = Callable[[AppliedUndef, int], sp.Expr]


class Chain:
    """Total derivatives through definitions.

    Arguments:
        definitions: in order, each in terms of those before it.
        slope: the symbol for the derivative of a law's call by its argument of that number.
        constant: symbols that do not vary along a trajectory, by which division is cheap.
    """

    def __init__(
        self, definitions: Sequence[Definition], slope: Slope | None = None, constant: Collection[sp.Symbol] = ()
    ) -> None:
        self._constant = constant
        self._definitions = dict(definitions)
        self._slope = slope
        self._known: dict[tuple[sp.Basic, sp.Symbol], sp.Expr] = {}
        self.named: list[Definition] = []  # derivatives with more than one term, as definitions of their own

    def by(self, expression: sp.Expr, variable: sp.Symbol) -> sp.Expr:
        """Derivative of `expression` by `variable`, with all other states and groups held."""
        calls = {node: sp.Dummy(positive=True) for node in slot_calls(expression)}
        hidden = expression.xreplace(calls)
        nodes = {dummy: node for node, dummy in calls.items()}
        total = sp.diff(hidden, variable)
        for symbol in sorted(hidden.free_symbols & self._definitions.keys(), key=str):
            total += sp.diff(hidden, symbol) * self._of(symbol, variable)
        for node, dummy in calls.items():
            total += sp.diff(hidden, dummy) * self._of_call(node, variable)
        return _expanded(total).xreplace(nodes)

    def _of(self, symbol: sp.Symbol, variable: sp.Symbol) -> sp.Expr:
        key = symbol, variable
        if key not in self._known:
            self._known[key] = self._name(self._short(symbol, variable), f"{symbol.name}_by_{variable.name}")
        return self._known[key]

    def _of_call(self, node: AppliedUndef, variable: sp.Symbol) -> sp.Expr:
        key = node, variable
        if key not in self._known:
            total = sp.Integer(0)
            for position, argument in enumerate(node.args):
                inner = self.by(argument, variable)
                if inner != 0:
                    assert self._slope is not None, f"{node} is called, and nothing is known of its slopes"
                    total += self._slope(node, position) * inner
            call = node.func.__name__.replace(".", "_")
            self._known[key] = self._name(_expanded(total), f"{call}_by_{variable.name}")
        return self._known[key]

    def _name(self, derivative: sp.Expr, name: str) -> sp.Expr:
        """A derivative under its own name if it is a sum or a product of varying factors; quotients are cancelled."""
        moving = [factor for factor in sp.Mul.make_args(derivative) if factor.free_symbols - set(self._constant)]
        several = len(moving) > 1 and not any(factor.is_Pow and factor.exp.is_negative for factor in moving)
        if not (isinstance(derivative, sp.Add) or several):
            return derivative
        symbol = sp.Symbol(name, real=True)
        self.named.append((symbol, derivative))
        return symbol

    def _short(self, symbol: sp.Symbol, variable: sp.Symbol) -> sp.Expr:
        """The derivative of a definition; for a power in a product, in terms of the product if that cannot be zero."""
        value = self._definitions[symbol]
        powers = value.as_powers_dict().values()
        if isinstance(value, sp.Add) or any(sp.sympify(power).free_symbols for power in powers):  # exponentials
            return self.by(value, variable)
        total = sp.Integer(0)
        for base, power in value.as_powers_dict().items():
            inner = self.by(base, variable)
            if inner == 0:
                continue
            positive = base.is_Symbol and base.is_positive and (power != 1 or base in self._constant)
            whole = symbol / base if positive else value / base
            total += power * whole * inner
        return _expanded(total)


@cache
def _expanded(expression: sp.Expr) -> sp.Expr:
    """Products over sums expanded, so that like terms combine; functions are left unchanged.

    Each node once: sympy walks a whole tree for every hint, and derivatives share most of theirs.
    """
    if not expression.args:
        return expression
    return _distributed(expression.func(*map(_expanded, expression.args)))


def _distributed(product: sp.Expr) -> sp.Expr:
    """An expansion of a product of what is expanded."""
    factors = sp.Mul.make_args(product)
    total = next((factor for factor in factors if factor.is_Add), None)
    if total is not None and len(factors) > 1:
        rest = sp.Mul(*(factor for factor in factors if factor is not total))
        return sp.Add(*(_distributed(rest * term) for term in total.args))
    if not any(_opens(factor) for factor in factors):
        return product
    plain = [factor for factor in factors if factor.is_Symbol or isinstance(factor, AppliedUndef)]
    powers = _opened(sp.Mul(*(factor for factor in factors if factor not in plain)))
    return sp.Add(*(sp.Mul(*plain, term) for term in sp.Add.make_args(powers)))


def _opens(factor: sp.Expr) -> bool:
    """True for a power of a sum, or one over it, that is a sum when it is expanded."""
    return bool(factor.is_Pow and factor.base.is_Add and factor.exp.is_Rational and abs(factor.exp) >= 1)


@cache  # the same few of many products: denominators
def _opened(powers: sp.Expr) -> sp.Expr:
    return sp.expand(powers, power_exp=False, power_base=False, log=False, trig=False)
