"""Groups: the number of independent ones, and the centrifugal number in terms of the others."""

from __future__ import annotations

import sympy as sp

from ..physics.scaling import dimension_matrix, group_definitions, nondimensional
from ..vocabulary import quantities as q
from .base import Check, Evidence, check, checks, readable, vanishing


def _dimensional(symbols: set[sp.Basic]) -> list[sp.Symbol]:
    """Those of the symbols that have a dimension, in the order of the vocabulary."""
    return [s for s, dimension in q.DIMENSIONS.items() if s in symbols and any(dimension.exponents)]


@check("centrifugal number", "Ce = (pi/8) (x0/a) tan^2(theta0) St Ca")
def centrifugal_number() -> Evidence:
    """Ce is a function of the other groups if the angle is counted among them."""
    by_groups = nondimensional(group_definitions()[q.centrifugal].subs(sp.tan(q.theta0), q.obliquity))
    yield by_groups - sp.pi / 8 * q.aspect * q.obliquity**2 * q.stokes * q.capillary
    yield f"Ce = {by_groups}"


@check("paper's normalisation", "m r omega^2/(a sigma) = Ce (4 + x/a) (omega/omega0)^2")
def normalisation_of_the_paper() -> Evidence:
    """The centrifugal term over a sigma is Ce times a function of the state alone."""
    term = (q.m * q.r * q.omega**2 / (q.a * q.sigma)).subs(q.m, q.centrifugal * q.sigma / q.omega0**2)
    yield term - q.centrifugal * (4 + q.x / q.a) * (q.omega / q.omega0) ** 2


@check("number of groups", "groups = dimensional quantities - rank of their dimension matrix (density included)")
def number_of_groups() -> Evidence:
    """Buckingham: as many independent groups as quantities minus the rank of their dimension matrix."""
    groups = group_definitions().values()
    used = set().union(*(group.free_symbols for group in groups))
    quantities = _dimensional(used - {q.t, q.x, q.u, q.omega, q.xi, q.omega0})
    dimensions = dimension_matrix(quantities)
    # exponent of a quantity in a group: d ln(group)/d ln(quantity)
    powers = sp.Matrix([[sp.simplify(group.diff(s) * s / group) for s in quantities] for group in groups])
    independent, rank = powers.rank(), dimensions.rank()
    yield sp.Integer(independent - (len(quantities) - rank))
    yield from dimensions * powers.T
    yield f"{independent} = {len(quantities)} - {rank}"


@checks
def groups_span_the_nullspace() -> Check:
    """St, Ca and Ce are combinations of the dimensionless monomials of their quantities (nullspace)."""
    left, shown = [], []
    for group, label in ((q.stokes, "St"), (q.capillary, "Ca"), (q.centrifugal, "Ce")):
        definition = group_definitions()[group]
        used = _dimensional(definition.free_symbols)
        powers = sp.Matrix([sp.simplify(definition.diff(s) * s / definition) for s in used])
        basis = dimension_matrix(used).nullspace()
        left.append(sp.Integer(sp.Matrix.hstack(*basis, powers).rank() - len(basis)))
        shown.append(f"{label} = {readable(definition)}")
    return vanishing("St, Ca, Ce", "each in the span of the nullspace of its dimension matrix", left, "; ".join(shown))


@check("paper's groups", "St = m v0/(6 pi mu a^2), Ca = 3 mu a v0/(sigma x0), Ce = m omega0^2/sigma")
def groups_are_the_papers() -> Evidence:
    """St, Ca and Ce as ratios of terms are the paper's numbers, Ce with omega0 = v0 tan(theta0)/(4a)."""
    expected = {
        q.stokes: q.m * q.v0 / (6 * sp.pi * q.mu * q.a**2),
        q.capillary: 3 * q.mu * q.a * q.v0 / (q.sigma * q.x0),
        q.centrifugal: q.m * (q.v0 * sp.tan(q.theta0) / (4 * q.a)) ** 2 / q.sigma,
    }
    yield from [group_definitions()[group] - value for group, value in expected.items()]
