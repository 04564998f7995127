"""Laws: named pure functions of dimensionless arguments, with their intermediates and their source."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import sympy as sp
from sympy.core.function import AppliedUndef

from .references import Reference

Definition = tuple[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class LawFunction:
    """A function of a law.

    Arguments:
        definitions: named intermediates, in the order in which `result` needs them.
        for_proof: used by a stick certificate only. A law may lack it; then that certificate is not available.
        falls: the function does not increase with its first argument (proved in `checks`), as certificates require.
        references: its publications, if not those of the law.
        kinks: of a user's law, the definitions that vanish at a kink, each with the one that is its sign.
    """

    name: str
    arguments: tuple[sp.Symbol, ...]
    result: sp.Expr
    doc: str
    definitions: tuple[Definition, ...] = ()
    for_proof: bool = False
    falls: bool = False
    references: tuple[Reference, ...] = ()
    kinks: tuple[tuple[sp.Symbol, sp.Symbol], ...] = ()

    def __call__(self, *values: sp.Expr) -> sp.Expr:
        """The closed expression at `values`, all intermediates substituted."""
        expression = self.result
        for symbol, value in reversed(self.definitions):
            expression = expression.subs(symbol, value)
        return expression.subs(dict(zip(self.arguments, values, strict=True)), simultaneous=True)


Range = tuple[sp.Expr | None, sp.Expr | None]
"""Least and largest value, None for no known bound."""
RANGES = ("volume", "contact_angle", "separation")
"""What a law may have a range of: V/R^3, an angle in rad, and the gap over R."""


@dataclass(frozen=True)
class Law:
    """A selectable law: fills the slot `slot` under the name that scene files use.

    Arguments:
        source: its origin, as text.
        validity: ranges for which its source gives it, as far as known.
        references: its publications.
        spread: of a film, its rim follows the volume of the bridge, so that it acts at any gap.
    """

    slot: str
    name: str
    meaning: str
    source: str
    functions: tuple[LawFunction, ...]
    validity: tuple[tuple[str, Range], ...] = ()
    references: tuple[Reference, ...] = ()
    spread: bool = False

    @property
    def module(self) -> str:
        return f"{self.slot}_{self.name.replace('-', '_')}"

    def __getitem__(self, function: str) -> LawFunction:
        return next(member for member in self.functions if member.name == function)


def slot_call(slot: str, function: str, *arguments: sp.Expr) -> sp.Expr:
    """The call `slot.function(arguments)` as a sympy node."""
    return sp.Function(f"{slot}.{function}", real=True)(*arguments)


def is_slot_call(node: sp.Basic) -> bool:
    """True if a node is a call to a law that has not been chosen yet."""
    return isinstance(node, AppliedUndef) and "." in node.func.__name__


def slot_calls(expression: sp.Expr) -> list[AppliedUndef]:
    """The calls to laws in an expression."""
    return [node for node in expression.atoms(AppliedUndef) if is_slot_call(node)]


def fill(expression: sp.Expr, laws: Mapping[str, Law]) -> sp.Expr:
    """The expression with every slot call replaced by the chosen law's expression, inner calls first."""
    while calls := slot_calls(expression):
        replaced = {}
        for node in (node for node in calls if not any(slot_calls(operand) for operand in node.args)):  # the innermost
            slot, function = node.func.__name__.split(".")
            replaced[node] = laws[slot][function](*node.args)
        expression = expression.xreplace(replaced)
    return expression


def filled(expression: sp.Expr, laws: Mapping[str, Law]) -> sp.Expr:
    """`fill` for the slots in `laws` only; the remaining calls stand for any law."""
    open_calls = (node for node in slot_calls(expression) if node.func.__name__.split(".")[0] not in laws)
    calls = {node: sp.Dummy(node.func.__name__.replace(".", "_")) for node in open_calls}
    return fill(expression.xreplace(calls), laws).xreplace({dummy: node for node, dummy in calls.items()})


def needed(outputs: Sequence[sp.Expr], definitions: Sequence[Definition]) -> tuple[list[Definition], set[sp.Symbol]]:
    """The definitions that the outputs depend on, in order, and every symbol that occurs in either."""
    used: set[sp.Symbol] = set()
    for expression in outputs:
        used |= sp.sympify(expression).free_symbols
    needs: list[Definition] = []
    for symbol, expression in reversed(definitions):
        if symbol in used:
            needs.append((symbol, expression))
            used |= expression.free_symbols
    return needs[::-1], used
