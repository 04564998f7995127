"""Kinks of a law: each a guard, on either side of which the law is smooth.

`Abs`, `Max`, `Min`, `sign` and the conditions of a `Piecewise` have no Taylor series where they change. Each becomes a
guard k, a named part of the law, and a side, k/|k|, so that |k| is side k. Steps and phases end where a guard is zero.
Where a side is not fixed it is k/sqrt(k^2 + WIDTH^2), which no result can tell from it. Powers, roots and logarithms of
what may vanish are rounded alike, and what vanishes is a guard: that of an arcsine or arccosine is 1 - s^2.
"""

from collections.abc import Collection, Iterable
from dataclasses import replace

import sympy as sp
from sympy.core.relational import Relational
from sympy.logic.boolalg import BooleanFunction

from ..physics.law import LawFunction, needed
from ..physics.scaling import ScalingError, as_product
from ..vocabulary.quantities import normal_velocity

WIDTH = sp.Rational(1, 10**10)
_SQUARE = sp.Symbol("squared_width", positive=True)  # named: sympy factors no numbers of twenty digits
_FLAT = (sp.Max, sp.Min, sp.Piecewise, sp.Heaviside)  # may vanish over a range, not only at a point


class KinkError(ScalingError):
    """A condition that is no guard; the message names it and says what is."""


def smooth(function: LawFunction, still: Collection[sp.Symbol], positive: Collection[sp.Expr] = ()) -> LawFunction:
    """A law's function that is smooth on either side of guards, one for each kink; itself if it has none.

    Arguments:
        still: arguments that are constant along a trajectory.
        positive: expressions that are never zero along one.

    Raises:
        KinkError: a condition that is no comparison of numbers.
    """
    if function.for_proof:  # called with values, not along a trajectory
        return function
    smoothing = _Smoothing({argument for argument in function.arguments if argument not in still}, positive)
    for symbol, value in function.definitions:
        smoothing.definitions.append((symbol, smoothing(value)))
        smoothing.written[symbol] = value
    result = smoothing(function.result)
    definitions = needed([result, *(kink for kink, _ in smoothing.kinks)], smoothing.definitions)[0]
    return replace(function, result=result, definitions=tuple(definitions), kinks=tuple(smoothing.kinks))


def freed(expression: sp.Expr) -> sp.Expr:
    """An expression with positive common factors, and with them dimensions, in front of its kinks and powers."""

    def front(node: sp.Basic) -> sp.Basic:
        marks = sp.symbols(f"part:{len(node.args)}", cls=sp.Dummy, positive=True)
        parts = _factors(sp.Add(*(mark * term for mark, term in zip(marks, node.args, strict=True))))
        factors = [factor for factor in parts if factor.is_positive and not factor.has(*marks)]
        return sp.Mul(*factors) * node.func(*(sp.expand(term / sp.Mul(*factors)) for term in node.args))

    def compared(node: Relational) -> sp.Basic:
        factors = _factors(node.lhs - node.rhs)
        return node.func(sp.Mul(*(-1 if term.is_negative else term for term in factors if not term.is_positive)), 0)

    def powered(node: sp.Pow) -> sp.Basic:
        parts, exponent = sp.Mul.make_args(sp.factor_terms(node.base)), node.exp
        whole = sp.Mul(*(factor for factor in parts if not factor.is_positive))
        return sp.Mul(*(factor**exponent for factor in parts if factor.is_positive)) * whole**exponent

    result = expression.replace(lambda node: isinstance(node, sp.Pow) and not node.exp.is_Integer, powered)
    result = result.replace(lambda node: isinstance(node, (sp.Abs, sp.Max, sp.Min)), front)  # the inner ones first
    return result.xreplace({node: compared(node) for node in result.atoms(Relational)})


def _factors(expression: sp.Expr) -> tuple[sp.Expr, ...]:
    """The factors of an expression, in which exponentials count as symbols.

    To sympy s exp(-z) - r is (s - r exp(z)) exp(-z), which overflows.
    """
    exponentials = list(sp.ordered(expression.atoms(sp.exp)))
    names = [sp.Dummy(f"exponential_{k}", positive=True) for k in range(len(exponentials))]
    product = as_product(expression.xreplace(dict(zip(exponentials, names, strict=True))))
    return sp.Mul.make_args(product.xreplace(dict(zip(names, exponentials, strict=True))))


def guarded(expression: sp.Expr, moving: Collection[sp.Symbol]) -> list[sp.Expr]:
    """What vanishes at the kinks of an expression, where these symbols vary."""
    smoothing = _Smoothing(moving)
    smoothing(expression)
    values = dict(smoothing.definitions)
    return [values[kink] for kink, _ in smoothing.kinks]


def rounded(expression: sp.Expr) -> sp.Expr:
    """An expression with its kinks rounded within WIDTH."""
    smoothing = _Smoothing(expression.free_symbols)
    result = smoothing(expression)
    for symbol, value in reversed(smoothing.definitions):
        result = result.subs(symbol, value)
    return result


class _Smoothing:
    """Expressions with kinks -> smooth ones; their guards and sides are added to `definitions`."""

    def __init__(self, moving: Collection[sp.Symbol], positive: Collection[sp.Expr] = ()) -> None:
        self.moving, self.positive = set(moving), set(positive)
        self.definitions: list[tuple[sp.Symbol, sp.Expr]] = [(_SQUARE, WIDTH**2)]
        self.written: dict[sp.Symbol, sp.Expr] = {}  # named parts as they were written, in terms of those before
        self._unfolded: dict[sp.Symbol, sp.Expr] = {}  # of them, those that were asked for: sums of many are long
        self.kinks: list[tuple[sp.Symbol, sp.Symbol]] = []
        self._sides: dict[sp.Expr, sp.Expr] = {}
        self._jumps: set[sp.Symbol] = set()  # sides by which a value, and not only a slope, may change

    def __call__(self, node: sp.Expr) -> sp.Expr:
        if isinstance(node, sp.Piecewise):
            return self._named("part", self._piecewise(node))
        if isinstance(node, sp.Pow):
            return self._power(node)
        if isinstance(node, (sp.asin, sp.acos)):
            return self._arcsine(node)
        arguments = [self(argument) for argument in node.args]
        if isinstance(node, sp.Abs):
            return self._side(arguments[0]) * arguments[0]
        if isinstance(node, sp.sign):
            return self._side(arguments[0])
        if isinstance(node, sp.Heaviside):
            return self._step(arguments[0])
        if isinstance(node, (sp.Max, sp.Min)):
            return self._named("part", self._extreme(arguments, 1 if isinstance(node, sp.Max) else -1))
        if isinstance(node, sp.log) and self._vanishes(node.args[0]):
            inner = node.args[0]
            return sp.log(self._squared(self(inner.args[0] if isinstance(inner, sp.Abs) else inner))) / 2
        return node.func(*arguments) if node.args else node

    def _moves(self, expression: sp.Expr) -> bool:
        definitions = dict(self.definitions)
        return any(
            s in self.moving or (s in definitions and self._moves(definitions[s])) for s in expression.free_symbols
        )

    def _vanishes(self, base: sp.Expr) -> bool:
        """True if an expression may pass zero along a trajectory."""
        return base not in self.positive and not self._as_written(base).is_positive and self._moves(base)

    def _as_written(self, expression: sp.Expr) -> sp.Expr:
        """An expression without named parts."""
        symbols = expression.free_symbols & self.written.keys()
        for symbol in symbols - self._unfolded.keys():
            self._unfolded[symbol] = self._as_written(self.written[symbol])
        return expression.xreplace({symbol: self._unfolded[symbol] for symbol in symbols})

    def _side(self, inner: sp.Expr) -> sp.Expr:
        """1 where an expression is positive and -1 where it is negative.

        Of one that jumps it is that on either side of the jump: within WIDTH no number resolves where the jump is zero.
        """
        jump = min(self._jumps & self._within(inner), key=str, default=None)
        if jump is not None:
            upper, lower = (self._side(self._where(inner, jump, side)) for side in (1, -1))
            return (1 + jump) / 2 * upper + (1 - jump) / 2 * lower
        factors = sp.Mul.make_args(sp.factor_terms(inner))
        sign = sp.Mul(*(sp.sign(factor) for factor in factors if factor.is_positive or factor.is_negative))
        rest = sp.Mul(*(factor for factor in factors if not (factor.is_positive or factor.is_negative)))
        largest = max(abs(term.as_coeff_Mul()[0]) for term in sp.Add.make_args(rest))
        if largest > 10**5:  # as of a number of 16 digits in lowest terms: WIDTH over it is lost in rounding
            rest = rest / largest
        if rest == 1 or rest.is_nonnegative:
            return sign
        if -rest in self._sides:
            sign, rest = -sign, -rest
        if rest not in self._sides:
            kink, side = self._named("kink", rest), sp.Symbol(f"side_{len(self._sides) + 1}", real=True)
            self.definitions.append((side, kink / sp.sqrt(kink**2 + _SQUARE)))
            self._sides[rest] = side
            if self._moves(rest):
                self.kinks.append((kink, side))
        return sign * self._sides[rest]

    def _within(self, expression: sp.Expr) -> set[sp.Symbol]:
        """The symbols of an expression and of its named parts."""
        symbols = set(expression.free_symbols)
        for symbol, value in reversed(self.definitions):  # a part stands behind what it is made of
            if symbol in symbols:
                symbols |= value.free_symbols
        return symbols

    def _where(self, expression: sp.Expr, jump: sp.Symbol, side: int) -> sp.Expr:
        """An expression, and its named parts, on one side of a jump."""
        within, fixed = self._within(expression), {jump: sp.Integer(side)}
        for symbol, value in list(self.definitions):
            if symbol != jump and symbol in within and value.free_symbols & fixed.keys():
                fixed[symbol] = self._named("part", value.xreplace(fixed))
        return expression.xreplace(fixed)

    def _named(self, what: str, value: sp.Expr) -> sp.Expr:
        """A part with a name, which no expansion takes apart: differences keep their digits."""
        if (value.is_Symbol or value.is_number) and what != "kink":
            return value
        symbol = sp.Symbol(f"{what}_{len(self.definitions) + 1}", real=True)
        self.definitions.append((symbol, value))
        return symbol

    def _squared(self, inner: sp.Expr) -> sp.Expr:
        """The rounded square of what may vanish, which is a guard."""
        self._side(inner)
        return self._named("base", inner) ** 2 + _SQUARE

    def _step(self, inner: sp.Expr) -> sp.Expr:
        """1 where an expression is positive and 0 where it is negative."""
        side = self._side(inner)
        self._jumps |= side.free_symbols
        return (1 + side) / 2

    def _extreme(self, values: Iterable[sp.Expr], sign: int) -> sp.Expr:
        first, *others = values
        for other in others:
            larger = (1 + sign * self._side(first - other)) / 2
            first = larger * first + (1 - larger) * other
        return first

    def _power(self, node: sp.Pow) -> sp.Expr:
        base, exponent = node.base, self(node.exp)
        if not self._vanishes(base) or (exponent.is_Integer and exponent.is_positive):
            return self(base) ** exponent
        if isinstance(base, sp.Abs):
            return self._squared(self(base.args[0])) ** (exponent / 2)
        inner = self(base)
        if exponent.is_Integer:
            if base == normal_velocity:  # of a force that vanishes with it
                return (inner / self._squared(inner)) ** -exponent
            return inner**exponent
        if isinstance(base, sp.Pow) and base.exp == 2:
            return self._squared(self(base.base)) ** exponent
        if self._as_written(base).has(*_FLAT):  # stays zero where the base is
            return inner * self._squared(inner) ** ((exponent - 1) / 2)
        return self._squared(inner) ** (exponent / 2)

    def _arcsine(self, node: sp.Expr) -> sp.Expr:
        """An arcsine or arccosine by an arctangent, whose root is a guard: the slope is infinite where it vanishes."""
        sine = node.args[0]
        if sine.has(sp.Min, sp.Max, sp.Piecewise):
            branches = sp.piecewise_fold(sine.rewrite(sp.Piecewise)).args
            if any(value**2 == 1 for value, _ in branches):  # constant there, where the root is 0 and its slope is not
                return self(sp.Piecewise(*((node.func(value), condition) for value, condition in branches)))
        named = self._named("sine", self(sine))  # whose slope then stands once, and keeps its digits
        if named not in sine.free_symbols:
            self.written.setdefault(named, sine)
        arcsine = 2 * self(sp.atan(named / (1 + sp.sqrt(1 - named**2))))
        return arcsine if isinstance(node, sp.asin) else sp.pi / 2 - arcsine

    def _piecewise(self, node: sp.Piecewise) -> sp.Expr:
        *cases, (result, last) = node.args
        if last != sp.true:
            raise KinkError(f"{node} says nothing elsewhere: end it with (value, True)")
        result = self(result)
        for value, condition in reversed(cases):
            holds = self._holds(condition)
            result = holds * self(value) + (1 - holds) * result
        return result

    def _holds(self, condition: sp.Basic) -> sp.Expr:
        """1 where a condition holds and 0 where it does not."""
        if condition in (sp.true, sp.false):
            return sp.Integer(condition == sp.true)
        if isinstance(condition, (sp.Eq, sp.Ne)):  # at a point, which a trajectory only passes
            return sp.Integer(isinstance(condition, sp.Ne))
        if isinstance(condition, Relational):
            return self._step(self(condition.gts - condition.lts))
        parts = [self._holds(term) for term in condition.args] if isinstance(condition, BooleanFunction) else []
        if isinstance(condition, sp.And):
            return sp.Mul(*parts)
        if isinstance(condition, sp.Or):
            return 1 - sp.Mul(*(1 - term for term in parts))
        if isinstance(condition, sp.Not):
            return 1 - parts[0]
        raise KinkError(f"the condition {condition} is no comparison; accepted: <, <=, >, >=, &, |, ~")
