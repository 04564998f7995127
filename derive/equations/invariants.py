"""Invariants linear in the momenta, found for any model: a linear system in unknown coefficients, and its nullspace.

An invariant is sought as I = sum of c_ik gap^k p_i over the momenta p_i. Along the rates dI/dt is linear in the c_ik
and must vanish for every value of the states and of every force: each of its coefficients is one equation. Calls to
laws not chosen, and logarithms, roots and exponentials of the states, count as values of their own. So all that is
found is conserved, for every law left open; an invariant that needs an identity between such functions is not seen.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Protocol

import sympy as sp
from sympy.polys.matrices import DomainMatrix

from ..physics.laws.base import Law, filled
from ..physics.mechanics import equations_of_motion
from ..physics.scaling import nondimensional
from ..vocabulary.quantities import VOCABULARY, a, beta, gap, m, omega0

DEGREE = 2  # of the coefficients in the gap: r^2 is the highest power that stands before a velocity
_COORDINATES = (gap, beta)


class System(Protocol):
    """What is asked of a model: its states, and its rates with named intermediates that can be expanded."""

    @property
    def states(self) -> tuple[sp.Symbol, ...]: ...

    def __getitem__(self, name: str) -> Any: ...

    def expanded(self, expression: sp.Expr) -> sp.Expr: ...


class NoInvariantError(ValueError):
    """A state cannot be eliminated, for nothing that contains it is conserved; the message says what is."""


@dataclass(frozen=True)
class Invariant:
    """A conserved quantity, its first coefficient 1.

    Arguments:
        coefficients: (momentum, coefficient) pairs, in the order of the states; coefficients in the gap and groups.
    """

    coefficients: tuple[tuple[sp.Symbol, sp.Expr], ...]

    @property
    def expression(self) -> sp.Expr:
        return sum((factor * momentum for momentum, factor in self.coefficients), sp.Integer(0))

    @property
    def is_angular_momentum(self) -> bool:
        """Whether it is L over m a^2 omega0."""
        return sp.expand(self.expression - angular_momentum()) == 0

    def at(self, state: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
        """Its value at a state."""
        return self.expression.subs(dict(state), simultaneous=True)

    def solved(self, momentum: sp.Symbol, value: sp.Expr) -> sp.Expr:
        """The momentum that it leaves when it has this value.

        Raises:
            NoInvariantError: it does not contain the momentum.
        """
        if momentum not in dict(self.coefficients):
            raise NoInvariantError(f"{momentum} cannot be eliminated through {self.describe()}")
        return sp.solve(sp.Eq(self.expression, value), momentum)[0]

    def describe(self) -> str:
        """In words: `orbital_momentum + (32/5) spin: angular momentum L/(m a^2 omega0)`."""
        terms = []
        for momentum, factor in self.coefficients:
            plain = factor.is_Symbol or factor.is_Integer
            terms.append(momentum.name if factor == 1 else f"{factor if plain else f'({factor})'} {momentum.name}")
        return f"{' + '.join(terms)}: {self._meaning()}"

    def _meaning(self) -> str:
        if self.is_angular_momentum:
            return "angular momentum L/(m a^2 omega0)"
        if len(self.coefficients) == 1 and self.coefficients[0][0].name in VOCABULARY:
            return VOCABULARY[self.coefficients[0][0].name].meaning
        return "a combination of momenta"


@cache
def angular_momentum() -> sp.Expr:
    """L over m a^2 omega0 in the states of an oblique doublet."""
    return sp.expand(nondimensional(equations_of_motion().angular_momentum / (m * a**2 * omega0)))


def invariants(
    system: System | Mapping[sp.Symbol, sp.Expr],
    laws: Mapping[str, Law] | None = None,
    *,
    coordinates: Sequence[sp.Symbol] = _COORDINATES,
    degree: int = DEGREE,
) -> tuple[Invariant, ...]:
    """A basis of the invariants linear in the momenta; empty if there are none.

    Arguments:
        system: a model, or its rates: state -> time derivative in states, groups and calls to law slots.
        laws: slot -> law; a slot without one stays open, and what is found holds for any law in it.
        coordinates: the states that are no momenta.
        degree: highest power of the gap in a coefficient.
    """
    if not isinstance(system, Mapping):
        named = dict(system["right_hand_side"].outputs)
        system = {state: system.expanded(named[state.name]) for state in system.states}
    rates = {state: filled(sp.sympify(rate), laws or {}) for state, rate in system.items()}
    momenta = [state for state in rates if state not in coordinates]
    powers = range(degree + 1 if gap in rates else 1)
    ansatz = [(momentum, gap**power) for momentum in momenta for power in powers]
    if not ansatz:
        return ()
    field = DomainMatrix.from_Matrix(_conditions(rates, ansatz)).to_field()  # exact, over the groups
    basis = field.nullspace().rref()[0].to_Matrix()
    return tuple(_normalised(ansatz, basis.row(index)) for index in range(basis.rows))


def conserved_momentum(
    system: System | Mapping[sp.Symbol, sp.Expr], laws: Mapping[str, Law] | None = None
) -> Invariant:
    """The angular momentum, if it is among the invariants found.

    Raises:
        NoInvariantError: it is not; the message says what is conserved, and at what rate L changes.
    """
    found = invariants(system, laws)
    for each in found:
        if each.is_angular_momentum:
            return each
    conserved = "; ".join(each.describe() for each in found) or "nothing linear in the momenta"
    chosen = ", ".join(f"{slot} {law.name}" for slot, law in (laws or {}).items()) or "any law"
    raise NoInvariantError(
        f"no spin can be eliminated: angular momentum is not conserved ({chosen}), conserved is {conserved}"
    )


def _conditions(rates: Mapping[sp.Symbol, sp.Expr], ansatz: list[tuple[sp.Symbol, sp.Expr]]) -> sp.Matrix:
    """Matrix whose product with the unknown coefficients is every coefficient of dI/dt."""
    values: dict[sp.Expr, sp.Symbol] = {}
    plain = {state: _rational(rate, set(rates), values) for state, rate in rates.items()}
    unknown = sp.symbols(f"c:{len(ansatz)}", cls=sp.Dummy)
    change = sp.Integer(0)
    for factor, (momentum, power) in zip(unknown, ansatz, strict=True):
        change += factor * (power.diff(gap) * plain.get(gap, sp.Integer(0)) * momentum + power * plain[momentum])
    top, _ = sp.fraction(sp.together(change))
    equations = sp.Poly(sp.expand(top), *rates, *values.values(), *_flags(change, rates, unknown)).coeffs()
    return sp.linear_eq_to_matrix(list(dict.fromkeys(equations)), list(unknown))[0]


def _flags(change: sp.Expr, rates: Mapping[sp.Symbol, sp.Expr], unknown: Sequence[sp.Symbol]) -> list[sp.Symbol]:
    """Symbols outside the vocabulary (forces left open, the region's flags): dI/dt must vanish for all their values."""
    own = {quantity.symbol for quantity in VOCABULARY.values()}
    outside = change.free_symbols - set(rates) - set(unknown) - own
    return sorted((s for s in outside if not isinstance(s, sp.Dummy)), key=str)


def _rational(expression: sp.Expr, states: set[sp.Symbol], values: dict[sp.Expr, sp.Symbol]) -> sp.Expr:
    """The expression with a symbol for every node that is no rational function of states and groups."""
    if isinstance(expression, (sp.Add, sp.Mul)):
        return expression.func(*(_rational(part, states, values) for part in expression.args))
    if isinstance(expression, sp.Pow) and expression.exp.is_Integer:
        return _rational(expression.base, states, values) ** expression.exp
    constants = {quantity.symbol for quantity in VOCABULARY.values()} - states
    if expression.is_Symbol or expression.free_symbols <= constants:
        return expression  # a group, or a number made of groups
    return values.setdefault(expression, sp.Dummy(f"value{len(values)}"))


def _normalised(ansatz: list[tuple[sp.Symbol, sp.Expr]], vector: sp.Matrix) -> Invariant:
    first = next(value for value in vector if value != 0)
    total: dict[sp.Symbol, sp.Expr] = {}
    for (momentum, power), value in zip(ansatz, vector, strict=True):
        if value != 0:
            total[momentum] = total.get(momentum, sp.Integer(0)) + sp.factor(value / first) * power
    return Invariant(tuple(total.items()))
