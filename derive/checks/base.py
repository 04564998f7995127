"""Checks: a statement, and expressions that must vanish identically, or have a sign, for it to hold."""

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cache, wraps
from inspect import signature
from typing import ParamSpec, TypeVar

import sympy as sp
from sympy.polys.rings import PolyElement, xring

from ..equations.model import Model, derive
from ..laws import LAWS, slot_call, slot_calls
from ..physics.structure import Structure, structures
from ..vocabulary import quantities as q

P = ParamSpec("P")
C = TypeVar("C", bound="Check | Iterable[Check]")
Evidence = Iterator["sp.Expr | Sign | bool | tuple[bool | None, str] | str | None"]
"""What a check yields: expressions that must vanish, signs that must be proved, claims that must be true (with what is
wrong if they are not, or else the figure), and the figure to show."""


@dataclass(frozen=True)
class Check:
    """A statement about the derivation, its result (None: reported, not required), and a figure."""

    name: str
    statement: str
    ok: bool | None
    figure: str


Several = Callable[..., Check | Iterable[Check]]
_REGISTERED: dict[str, list[Several]] = defaultdict(list)


def checks(function: Callable[P, C]) -> Callable[P, C]:
    """Decorator that adds a function without arguments to the checks of its module."""
    _REGISTERED[function.__module__].append(function)
    return function


def checks_of(*modules: str) -> list[Several]:
    """The checks of modules, in the order of their definition."""
    return [entry for module in modules for entry in _REGISTERED[module]]


def check(name: str, statement: str) -> Callable[[Callable[P, Evidence]], Callable[P, Check]]:
    """Decorator that makes the check of a statement from a function that yields the evidence for it.

    Arguments:
        name: its name, in which {} stands for an argument of the function, as in "film dissipates: {0.name}".
    """

    def checked(function: Callable[P, Evidence]) -> Callable[P, Check]:
        @wraps(function)
        def run(*args: P.args, **kwargs: P.kwargs) -> Check:
            residuals, false, figure = list[sp.Expr](), list[str](), ""
            for item in function(*args, **kwargs):
                match item:
                    case str():
                        figure = item
                    case bool() | None:
                        false += [] if item else [""]
                    case truth, text:
                        false += [] if truth else [text]
                    case Sign(proved, witness):
                        figure, false = witness, false if proved else [*false, witness]
                    case _:
                        residuals.append(item)
            result = vanishing(name.format(*args), statement, residuals, figure)
            return replace(result, ok=False, figure=false[0] or f"false: {figure}") if false and result.ok else result

        needs = any(given.default is given.empty for given in signature(function).parameters.values())
        return run if needs else checks(run)  # one of a law is run by who has the laws

    return checked


@cache
def once(test: Several) -> tuple[Check, ...]:
    """The results of a check without arguments, which several proofs may need; one function may give several."""
    result = test()
    return (result,) if isinstance(result, Check) else tuple(result)


def vanishing(name: str, statement: str, residuals: list[sp.Expr], figure: str = "") -> Check:
    """A check that every expression vanishes identically; the first that does not is the figure."""
    rest = next(
        (value for value in map(settled, residuals) if value != 0), None
    )  # the others may be expensive to simplify
    text = figure or (f"{len(residuals)} identities" if len(residuals) > 1 else "identity")
    if rest is not None:
        return Check(name, statement, False, f"left over: {readable(rest)}")
    return Check(name, statement, True, text)


def models(chosen: Callable[[Structure], bool] = lambda _: True) -> Iterator[Model]:
    """The models of the structures that are chosen."""
    return (derive(structure) for structure in structures() if chosen(structure))


def settled(expression: sp.Expr) -> sp.Expr:
    """Zero if the expression vanishes identically: seen as a quotient of polynomials, or else simplified.

    Most of what is emitted is rational in symbols, roots and calls of laws. In a ring of these the zero of a numerator
    is seen without the searches of `expand` and `simplify`, about twenty times sooner.
    """
    if vanishes(expression):
        return sp.S.Zero
    expanded = sp.expand(expression)
    return expanded if expanded == 0 else sp.simplify(sp.factor(expanded))


def vanishes(expression: sp.Expr) -> bool:
    """True if an expression is zero for any values of its symbols and of what is not rational in them.

    False says nothing: roots, exponentials and calls count as independent variables here.
    """
    variables = sorted(_variables(expression), key=str)
    ring, generators = xring([f"v{index}" for index in range(len(variables))], sp.QQ)
    values: dict[sp.Expr, tuple[PolyElement, PolyElement]] = {
        variable: (generator, ring.one) for variable, generator in zip(variables, generators, strict=True)
    }

    def quotient(node: sp.Expr) -> tuple[PolyElement, PolyElement]:
        """Numerator and denominator, nothing cancelled."""
        if node not in values:
            top, bottom = ring.one, ring.one
            if node.is_Rational:
                top = top * sp.QQ(int(node.p), int(node.q))
            elif node.is_Add:
                by_bottom: dict[PolyElement, PolyElement] = {}
                for over, under in map(quotient, node.args):
                    by_bottom[under] = by_bottom.get(under, ring.zero) + over
                top = ring.zero
                for under, over in by_bottom.items():
                    top, bottom = top * under + over * bottom, bottom * under
            elif node.is_Mul:
                for over, under in map(quotient, node.args):
                    top, bottom = top * over, bottom * under
            else:
                over, under = quotient(node.base if node.exp.is_Integer else _root(node))
                power = int(node.exp.p)
                top, bottom = (over**power, under**power) if power > 0 else (under**-power, over**-power)
            values[node] = top, bottom
        return values[node]

    return not quotient(expression)[0]


def _variables(node: sp.Expr) -> set[sp.Expr]:
    """What an expression is rational in."""
    if node.is_Rational:
        return set()
    if node.is_Add or node.is_Mul:
        return set().union(*map(_variables, node.args))
    if node.is_Pow and node.exp.is_Rational:
        return _variables(node.base) if node.exp.is_Integer else {_root(node)}
    return {node}


def _root(power: sp.Pow) -> sp.Expr:
    return sp.Pow(power.base, sp.Rational(1, power.exp.q))


def readable(expression: sp.Expr) -> str:
    """The expression as text, with the literature's symbols for quantities."""
    quantities = (quantity for quantity in q.VOCABULARY.values() if quantity.symbol in expression.free_symbols)
    latex = {quantity.symbol: quantity.latex for quantity in quantities if any(quantity.dimension.exponents)}
    without = str.maketrans("", "", "\\_{},")
    return str(expression.xreplace({symbol: sp.Symbol(text.translate(without)) for symbol, text in latex.items()}))


MIDGAP = {"arm": LAWS["arm"]["midgap"]}
"""The law that conserves the angular momentum."""

SIZES = ("centres", "radius", "partner_radius", "spin_inertia", "partner_inertia")
"""Intermediates of an unequal pair that are kept as symbols, so that results hold for any sizes."""


def special_case(
    special: Model, names: Iterable[str], general: Model, rule: Callable[[sp.Expr], sp.Expr], keep: Collection[str] = ()
) -> Iterator[sp.Expr]:
    """Differences between the functions of a general model, under a rule, and a special one's: zero if they agree."""
    for name in names:
        whole = general.results(name, keep)
        for key, value in special.results(name, keep).items():
            yield rule(whole[key]) - value


def slope_along(energy: sp.Expr, variable: sp.Symbol) -> sp.Expr:
    """Derivative of an energy, with d rise/d offset_squared = stiffness/2 (checked by strings_are_conservative)."""
    heights = {node: sp.Dummy("height") for node in slot_calls(energy)}
    flat = energy.xreplace(heights)
    slope = flat.diff(variable)
    for node, height in heights.items():
        slope += flat.diff(height) * slot_call("strings", "stiffness", *node.args) / 2 * node.args[1].diff(variable)
    return slope


_BEYOND = sp.Symbol("y", nonnegative=True)


@dataclass(frozen=True)
class Sign:
    """The result of a proof about the sign of an expression on a region.

    Arguments:
        proved: True if the expression is never negative, False if it is negative at `witness`, None if undecided.
        witness: the product that proves it, or the point that refutes it.
    """

    proved: bool | None
    witness: str


def nonnegative(expression: sp.Expr, variable: sp.Symbol, edge: sp.Expr) -> Sign:
    """Proof that `expression` is >= 0 for 0 < variable <= edge, other symbols by their own assumptions.

    The proof uses the expression as given, or with variable = edge/(1 + y) or edge exp(-y), y >= 0, which is the same
    region: a product of even powers, exponentials and nonnegative symbols, or a quotient of sums of such. If that fails
    it is evaluated on a grid, where a negative value refutes it.
    """
    ways = (("", variable), (f"{edge}/(1 + y)", edge / (1 + _BEYOND)), (f"{edge} exp(-y)", edge * sp.exp(-_BEYOND)))
    for text, value in ways:
        form = sp.factor(sp.expand_log(sp.simplify(expression.subs(variable, value))))
        if _known(form):
            where = f" with {variable} = {text}, y >= 0" if text else ""
            return Sign(True, f"{form}{where}")
    return _sampled(expression, variable, edge)


def _known(form: sp.Expr) -> bool:
    """True if sympy knows the sign of each factor, or of each term of numerator and denominator when expanded."""
    if form.is_nonnegative:
        return True
    top, bottom = sp.fraction(sp.together(form))
    return all(factor.is_nonnegative or sp.expand(factor).is_nonnegative for factor in (top, bottom))


def _sampled(expression: sp.Expr, variable: sp.Symbol, edge: sp.Expr) -> Sign:
    others = sorted(expression.free_symbols - {variable}, key=str)
    for base in (sp.Rational(1, 3), sp.Rational(7, 5), sp.Rational(-2, 3)):
        values = [base + sp.sign(base) * sp.Rational(index, 7) for index in range(len(others))]
        fixed = {s: abs(value) if s.is_nonnegative else value for s, value in zip(others, values, strict=True)}
        rim = sp.sympify(edge).subs(fixed)
        for k in range(1, 40):
            at = rim * sp.Rational(k, 40)
            value = sp.N(expression.subs(fixed).subs(variable, at))
            if not value.is_real or value < 0:
                places = {variable: sp.N(at, 3), **fixed}
                point = ", ".join(f"{symbol} = {number}" for symbol, number in places.items())
                return Sign(False, f"{sp.N(value, 3)} at {point}")
    return Sign(None, "no proof found, and no negative value on a grid either")


def positive(expression: sp.Expr) -> bool:
    """True if a quotient of polynomials in non-negative symbols has non-negative coefficients only."""
    return all(map(no_negative, sp.fraction(sp.together(sp.expand(expression)))))


def no_negative(expression: sp.Expr) -> bool:
    """True for a positive number, or a polynomial without a negative coefficient."""
    expanded = sp.expand(expression)
    symbols = sorted(expanded.free_symbols, key=str)
    return all(c >= 0 for c in sp.Poly(expanded, *symbols).coeffs()) if symbols else bool(expanded > 0)
