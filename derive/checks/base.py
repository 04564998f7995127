"""Checks: a statement, and expressions that must vanish identically for it to hold."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import wraps
from itertools import chain
from typing import ParamSpec, TypeVar

import sympy as sp

from ..vocabulary.quantities import VOCABULARY

P = ParamSpec("P")
C = TypeVar("C")
Evidence = Iterator[sp.Expr | tuple[bool | None, str] | str]
"""What a check yields: expressions that must vanish, claims (truth, figure if false), and the figure to show."""


@dataclass(frozen=True)
class Check:
    """A statement about the derivation, its result (None: reported, not required), and a figure."""

    name: str
    statement: str
    ok: bool | None
    figure: str


Several = Callable[[], Check | Iterable[Check]]
_REGISTERED: dict[str, list[Several]] = defaultdict(list)


def checks(function: Callable[P, C]) -> Callable[P, C]:
    """Decorator: the function, which needs no argument, is among the checks of its module."""
    _REGISTERED[function.__module__].append(function)
    return function


def checks_of(*modules: str) -> list[Several]:
    """The checks of modules, in the order of their definition."""
    return [each for module in modules for each in _REGISTERED[module]]


def check(name: str, statement: str) -> Callable[[Callable[P, Evidence]], Callable[P, Check]]:
    """Decorator that makes the check of a statement from a function that yields the evidence for it."""

    def checked(function: Callable[P, Evidence]) -> Callable[P, Check]:
        @wraps(function)
        def run(*args: P.args, **kwargs: P.kwargs) -> Check:
            left, false, figure = list[sp.Expr](), list[str](), ""
            for part in function(*args, **kwargs):
                if isinstance(part, str):
                    figure = part
                elif isinstance(part, tuple):
                    false += [] if part[0] else [part[1]]
                else:
                    left.append(part)
            result = vanishing(name, statement, left, figure)
            return replace(result, ok=False, figure=false[0]) if false and result.ok else result

        return checks(run)

    return checked


def run(several: Iterable[Several]) -> tuple[Check, ...]:
    """The results of checks; one function may give several."""
    results = (each() for each in several)
    return tuple(chain.from_iterable([each] if isinstance(each, Check) else each for each in results))


def vanishing(name: str, statement: str, left: list[sp.Expr], figure: str = "", *, holds: bool | None = True) -> Check:
    """A check that every expression of `left` vanishes identically; the first that does not is the figure.

    Arguments:
        holds: the value of `ok` if they do; None for a known violation, which is reported but not required to pass.
    """
    rest = next((value for value in map(settled, left) if value != 0), None)  # the others may be expensive to simplify
    shown = figure or (f"{len(left)} identities" if len(left) > 1 else "identity")
    if rest is not None:
        return Check(name, statement, False, f"left over: {readable(rest)}")
    return Check(name, statement, holds, shown)


def settled(expression: sp.Expr) -> sp.Expr:
    """Zero if the expression vanishes identically: expanded, as one fraction, or simplified if neither shows it."""
    expanded = sp.expand(expression)
    if expanded == 0:
        return expanded
    top, _ = sp.fraction(sp.together(expression))  # not of the expanded form, whose terms have a denominator each
    return sp.S.Zero if sp.expand(top) == 0 else sp.simplify(sp.factor(expanded))


def readable(expression: sp.Expr) -> str:
    """The expression as text, with the literature's symbols for quantities."""
    quantities = (each for each in VOCABULARY.values() if each.symbol in expression.free_symbols)
    latex = {each.symbol: each.latex for each in quantities if any(each.dimension.exponents)}
    without = str.maketrans("", "", "\\_{},")
    return str(expression.xreplace({symbol: sp.Symbol(text.translate(without)) for symbol, text in latex.items()}))
