"""Invariants linear in the momenta of any model, from the nullspace of a linear system for their coefficients.

The ansatz is I = sum of c_ik gap^k p_i over the momenta p_i. dI/dt along the rates is linear in the c_ik and must
vanish for every value of the states and of every force, so each of its coefficients is one equation. Calls to laws not
yet chosen, and logarithms, roots and exponentials of the states, count as independent variables. Every invariant found
is therefore conserved for any law left open; one that relies on an identity between such functions is not found.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations_with_replacement
from typing import Any, Protocol

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.polys.matrices import DomainMatrix

from ..physics.law import Definition, Law, filled
from ..physics.mechanics import equations_of_motion
from ..physics.scaling import nondimensional
from ..vocabulary.quantities import (
    VOCABULARY,
    a,
    angle_turned,
    beta,
    gap,
    m,
    normal,
    orbital_momenta,
    orbital_momentum,
    rate_scale,
)
from .terms import orbital_inertia

DEGREE = 2  # highest power of the gap in a coefficient: velocities occur with at most r^2
_COORDINATES = (gap, beta, angle_turned)


class System(Protocol):
    """Interface required of a model: its states, its rates, and the expansion of named intermediates."""

    @property
    def states(self) -> tuple[sp.Symbol, ...]: ...

    def __getitem__(self, name: str) -> Any: ...

    def expanded(self, expression: sp.Expr) -> sp.Expr: ...


class OpenSystem(System, Protocol):
    """A model of which some named intermediates are left open."""

    @property
    def definitions(self) -> tuple[Definition, ...]: ...


def open_rates(system: OpenSystem) -> dict[sp.Symbol, sp.Expr]:
    """Rates with named intermediates that vary as symbols, which an invariant then holds for any values of."""
    constant: set[sp.Basic] = {quantity.symbol for quantity in VOCABULARY.values()} - set(system.states)
    whole: dict[sp.Symbol, sp.Expr] = {}
    for symbol, value in system.definitions:
        if value.free_symbols <= constant and not value.atoms(AppliedUndef):
            constant.add(symbol)
            whole[symbol] = value.xreplace(whole)
    named = system["right_hand_side"].by_name
    return {state: sp.sympify(named[state.name]).xreplace(whole) for state in system.states}


class NoInvariantError(ValueError):
    """No invariant contains the state to be eliminated; the message names those found."""


@dataclass(frozen=True)
class Invariant:
    """A conserved quantity, normalised to a first coefficient of 1.

    Arguments:
        coefficients: (momentum, coefficient) pairs, in the order of the states; coefficients in the gap and groups.
    """

    coefficients: tuple[tuple[sp.Symbol, sp.Expr], ...]

    @property
    def expression(self) -> sp.Expr:
        return sp.Add(*(factor * momentum for momentum, factor in self.coefficients))

    @property
    def is_angular_momentum(self) -> bool:
        """True if it is L over m a^2 Omega."""
        return sp.expand(self.expression - angular_momentum()) == 0

    def at(self, state: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
        """Its value in a state."""
        return self.expression.subs(dict(state), simultaneous=True)

    def solved(self, momentum: sp.Symbol, value: sp.Expr) -> sp.Expr:
        """The expression for a momentum if the invariant has this value; NoInvariantError if it does not contain it."""
        if momentum not in dict(self.coefficients):
            raise NoInvariantError(f"{momentum} cannot be eliminated through {self.describe()}")
        return sp.solve(sp.Eq(self.expression, value), momentum)[0]

    def describe(self) -> str:
        """A description such as `orbital_momentum + (32/5) spin: angular momentum L/(m a^2 Omega)`."""
        terms = []
        for momentum, factor in self.coefficients:
            plain = factor.is_Symbol or factor.is_Integer
            terms.append(momentum.name if factor == 1 else f"{factor if plain else f'({factor})'} {momentum.name}")
        meaning = "a combination of momenta"
        if self.is_angular_momentum:
            meaning = "angular momentum L/(m a^2 Omega)"
        elif len(terms) == 1 and self.coefficients[0][0].name in VOCABULARY:
            meaning = VOCABULARY[self.coefficients[0][0].name].meaning
        return f"{' + '.join(terms)}: {meaning}"


@cache
def angular_momentum() -> sp.Expr:
    """L over m a^2 Omega in the states of an oblique doublet."""
    return sp.expand(nondimensional(equations_of_motion().angular_momentum / (m * a**2 * rate_scale)))


def invariants(
    system: System | Mapping[sp.Symbol, sp.Expr],
    laws: Mapping[str, Law] | None = None,
    *,
    coordinates: Sequence[sp.Symbol] = _COORDINATES,
    degree: int = DEGREE,
) -> tuple[Invariant, ...]:
    """A basis of the invariants linear in the momenta; empty if there are none.

    Arguments:
        system: a model, or its rates: state -> time derivative in states, groups and slot calls.
        laws: slot -> law; for slots that are left out the invariants hold for any law.
        coordinates: the states that are not momenta.
        degree: highest power of the gap in a coefficient.
    """
    groups: set[sp.Basic] = set() if isinstance(system, Mapping) else set(getattr(system, "groups", ()))
    inertia = orbital_inertia(getattr(system, "structure", None))
    if not isinstance(system, Mapping):
        named, whole = system["right_hand_side"].by_name, system.expanded
        inertia = None if inertia is None else whole(inertia)
        system = {state: whole(named[state.name]) for state in system.states}
    rates = {state: filled(sp.sympify(rate), laws or {}) for state, rate in system.items()}
    momenta = [state for state in rates if state not in coordinates]
    powers = range(degree + 1 if gap in rates else 1)
    ansatz = [(momentum, gap**power) for momentum in momenta for power in powers]
    ansatz += [(orbital_momentum, inertia)] if inertia is not None else []
    if not ansatz:
        return ()
    field = DomainMatrix.from_Matrix(_conditions(rates, ansatz, groups)).to_field()  # exact, over that of the groups
    basis = field.nullspace().rref()[0].to_Matrix()
    result = []
    for vector in (basis.row(index) for index in range(basis.rows)):
        first = next(value for value in vector if value != 0)
        total: dict[sp.Symbol, sp.Expr] = {}
        for (momentum, power), value in zip(ansatz, vector, strict=True):
            if value != 0:
                total[momentum] = total.get(momentum, sp.Integer(0)) + sp.factor(value / first) * power
        result.append(Invariant(tuple(total.items())))
    return tuple(result)


def conserved_momentum(
    system: System | Mapping[sp.Symbol, sp.Expr], laws: Mapping[str, Law] | None = None
) -> Invariant:
    """The angular momentum, if it is among the invariants found.

    Raises:
        NoInvariantError: it is not; the message gives the invariants found and dL/dt.
    """
    result = invariants(system, laws)
    if momentum := next((invariant for invariant in result if invariant.is_angular_momentum), None):
        return momentum
    conserved = "; ".join(invariant.describe() for invariant in result) or "nothing linear in the momenta"
    chosen = ", ".join(f"{slot} {law.name}" for slot, law in (laws or {}).items()) or "any law"
    raise NoInvariantError(
        f"no spin can be eliminated: angular momentum is not conserved ({chosen}), conserved is {conserved}"
    )


def conserved_components(system: OpenSystem) -> tuple[Invariant, ...]:
    """The three components of the angular momentum of two spheres in space, among the invariants found.

    They are conserved for any torques, which remain open here.

    Raises:
        NoInvariantError: one of them is not.
    """
    result = invariants(open_rates(system), coordinates=(*_COORDINATES, *normal), degree=0)
    matches = [[form for form in result if form.coefficients[0][0] == momentum] for momentum in orbital_momenta]
    if any(len(components) != 1 for components in matches):
        raise NoInvariantError(f"angular momentum is not conserved in space: {[form.describe() for form in result]}")
    return tuple(components[0] for components in matches)


def _conditions(
    rates: Mapping[sp.Symbol, sp.Expr], ansatz: list[tuple[sp.Symbol, sp.Expr]], groups: set[sp.Basic]
) -> sp.Matrix:
    """Matrix whose product with the vector of unknown coefficients gives all coefficients of dI/dt."""
    values: dict[sp.Expr, sp.Symbol] = {}
    givens = {quantity.symbol for quantity in VOCABULARY.values()} | groups

    def rational(expression: sp.Expr) -> sp.Expr:
        return _rational(expression, givens - set(rates), values)

    plain = {state: rational(rate) for state, rate in rates.items()}
    unknown = sp.symbols(f"c:{len(ansatz)}", cls=sp.Dummy)
    change = sp.Integer(0)
    for factor, (momentum, power) in zip(unknown, ansatz, strict=True):
        grows = sp.Add(*(rational(power.diff(state)) * rate for state, rate in plain.items()))
        change += factor * (grows * momentum + rational(power) * plain[momentum])
    top, _ = sp.fraction(sp.together(change))
    equations = sp.Poly(sp.expand(top), *rates, *values.values(), *_flags(change, {*rates, *unknown, *givens})).coeffs()
    return sp.linear_eq_to_matrix(list(dict.fromkeys(equations)), list(unknown))[0]


def _flags(change: sp.Expr, givens: set[sp.Basic]) -> list[sp.Basic]:
    """Symbols that are not known (open forces, flags of film and shear): dI/dt must vanish for all their values."""
    return sorted((s for s in change.free_symbols - givens if not isinstance(s, sp.Dummy)), key=str)


def _rational(expression: sp.Expr, constants: set[sp.Basic], values: dict[sp.Expr, sp.Symbol]) -> sp.Expr:
    """The expression with a symbol for every subexpression that is not rational in states and groups."""
    if isinstance(expression, (sp.Add, sp.Mul)):
        return expression.func(*(_rational(argument, constants, values) for argument in expression.args))
    if isinstance(expression, sp.Pow) and expression.exp.is_Integer:
        return _rational(expression.base, constants, values) ** expression.exp
    if expression.is_Symbol or expression.free_symbols <= constants:
        return expression  # a group, or an expression in groups only
    return values.setdefault(expression, sp.Dummy(f"value{len(values)}"))


def quadratic_invariants(
    rates: Mapping[sp.Symbol, sp.Expr], among: Sequence[sp.Symbol], relation: sp.Expr | None = None
) -> tuple[sp.Expr, ...]:
    """A basis of the invariants that are quadratic forms, normalised to a first coefficient of 1.

    Arguments:
        rates: polynomials in the states and in what is left open; what divides them is constant.
        among: the states of the forms.
        relation: a polynomial that vanishes along every trajectory, monic in the square of its last symbol.
    """
    forms = [variable * other for variable, other in combinations_with_replacement(among, 2)]
    powers = set().union(*(rate.atoms(sp.Pow) for rate in rates.values()))
    constant = set().union(*(power.base.free_symbols for power in powers if power.exp.is_negative))  # sizes
    varying = sorted(set(among).union(*(rate.free_symbols for rate in rates.values())) - constant, key=str)
    if relation is not None:  # a remainder is that by the first generator
        varying.sort(key=lambda symbol: symbol != max(relation.free_symbols, key=str))

    def polynomial(expression: sp.Expr) -> sp.Poly:
        return sp.Poly(expression, *varying)

    moved, changes = {state: polynomial(rate) for state, rate in rates.items()}, []
    for form in forms:
        change = sum((polynomial(form.diff(s)) * moved[s] for s in sorted(form.free_symbols, key=str)), polynomial(0))
        changes.append(dict((change if relation is None else change.rem(polynomial(relation))).terms()))
    rows = sorted(set().union(*changes))
    conditions = sp.Matrix([[change.get(row, 0) for change in changes] for row in rows])
    basis = DomainMatrix.from_Matrix(conditions).to_field().nullspace().rref()[0].to_Matrix()
    return tuple(
        sp.Add(*(factor * form for factor, form in zip(basis.row(k), forms, strict=True))) for k in range(basis.rows)
    )
