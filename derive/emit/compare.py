"""Comparison of two models as mathematics: the equations that differ, by term."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import groupby
from random import Random

import sympy as sp
from sympy.core.function import AppliedUndef

from ..user.own_events import MARK
from .read import Read, functions

Equations = dict[str, sp.Expr]
"""Name of an equation -> its right side."""
_SAME, _POINTS = 1e-11, 4


@dataclass(frozen=True)
class Change:
    """A term of an equation that was changed, added (`before` is None) or removed (`after` is None)."""

    equation: str
    before: sp.Expr | None
    after: sp.Expr | None

    @property
    def kind(self) -> str:
        return "added" if self.before is None else "removed" if self.after is None else "changed"


def equations(modules: Mapping[str, str]) -> Equations:
    """Every equation of emitted modules, by name; ReadError for a text that is not emitted.

    Arguments:
        modules: room -> text of the module; a law's equations are named after its room (its slot).
    """
    result: Equations = {}
    for room, text in modules.items():
        for function in functions(text):
            result |= _named(room, function)
    return result


def _named(room: str, function: Read) -> Equations:
    prefix = f"{room}: " if room else ""
    named = {f"{prefix}{name}": value for name, value in function.definitions}
    for name, value in function.outputs:
        identity = (function.name.startswith("jump_") and str(value) == name) or name.startswith(MARK)
        if identity or (function.name.startswith("release_") and value == 0):
            continue  # what a declared event leaves as it is, and whether it has happened
        if function.name == "right_hand_side":
            named[f"{prefix}d {name}/dt"] = value
        else:
            named[f"{prefix}{name}" if name == function.name else f"{prefix}{function.name}, {name}"] = value
    return named


def compare(before: Equations, after: Equations) -> tuple[Change, ...]:
    """The terms that differ between two models, equation by equation."""
    result: list[Change] = []
    for name in dict.fromkeys([*before, *after]):
        if name not in after:
            result.append(Change(name, before[name], None))
        elif name not in before:
            result.append(Change(name, None, after[name]))
        elif not same(before[name], after[name]):
            result += _terms(name, before[name], after[name])
    return tuple(result)


def same(term: sp.Expr, other: sp.Expr) -> bool:
    """True if two expressions are equal, as written or in value at random points (simplification may not end)."""
    if term == other:
        return True
    calls = {node: sp.Symbol(f"call {node}", positive=True) for e in (term, other) for node in e.atoms(AppliedUndef)}
    pair = [expression.xreplace(calls) for expression in (term, other)]
    free = sorted(set().union(*(e.free_symbols for e in pair)), key=str)
    compiled = sp.lambdify(free, pair, modules=["math"], dummify=True)
    draw, compared = Random(1), 0
    for _ in range(5 * _POINTS):
        try:
            first, second = (float(value) for value in compiled(*(draw.uniform(0.05, 0.95) for _ in free)))
        except (ArithmeticError, ValueError, TypeError):
            continue
        if not abs(first - second) <= _SAME * max(abs(first), abs(second)):
            return False
        compared += math.isfinite(first)
        if compared >= _POINTS:
            return True
    return compared > 0


def _terms(name: str, before: sp.Expr, after: sp.Expr) -> Iterable[Change]:
    old, new = list(sp.Add.make_args(before)), list(sp.Add.make_args(after))
    # equal terms; those that differ in a numeric factor only; those of the same symbols
    same_factors = lambda first, other: first.as_coeff_Mul()[1] == other.as_coeff_Mul()[1]  # noqa: E731 -- like its neighbours
    for alike in (same, same_factors, lambda first, other: _symbols(first) == _symbols(other)):
        for term in list(old):
            match = next((other for other in new if alike(term, other)), None)
            if match is not None:
                old.remove(term)
                new.remove(match)
                if alike is not same:
                    yield Change(name, term, match)
    if len(old) == len(new) == 1:
        yield Change(name, old[0], new[0])
        return
    yield from (Change(name, term, None) for term in old)
    yield from (Change(name, None, term) for term in new)


def in_lines(changes: Iterable[Change]) -> list[str]:
    """The changes as text, below the name of each equation."""
    lines = []
    for equation, of_equation in groupby(changes, key=lambda change: change.equation):
        lines += ["", equation]
        for change in of_equation:
            if change.kind == "changed":
                lines += [f"  changed  {plain(change.before)}", f"      to   {plain(change.after)}"]
            else:
                lines.append(f"  {change.kind:<8} {plain(change.before if change.after is None else change.after)}")
    return lines


def count(changes: Iterable[Change]) -> str:
    """How many equations differ, in words."""
    number = len({change.equation for change in changes})
    return f"{number or 'no'} equation{'s' if number > 1 else ''} differ{'s' if number < 2 else ''}"


def _symbols(term: sp.Expr) -> frozenset[str]:
    return frozenset([*map(str, term.free_symbols), *(node.func.__name__ for node in term.atoms(AppliedUndef))])


def plain(expression: sp.Expr) -> str:
    """An expression as text, with decimals as decimals."""
    fitted = {n: sp.Float(str(float(n))) for n in expression.atoms(sp.Rational) if n.q > 2 and n.q % 5 == 0}
    return str(sp.sstr(expression.xreplace(fitted), full_prec=False))
