"""Groups: the number of independent ones, and the centrifugal number in terms of the others."""

from __future__ import annotations

import sympy as sp

from ..physics.scaling import (
    centrifugal_identity,
    dimension_matrix,
    exponents,
    group_definitions,
    paper_normalisation,
    pi_groups,
)
from ..vocabulary import quantities as q
from .base import Check, Evidence, check, readable, vanishing


@check("centrifugal number", "Ce = (pi/8) (x0/a) tan^2(theta0) St Ca")
def centrifugal_number() -> Evidence:
    """Ce is a function of the other groups if the angle is counted among them."""
    expected = sp.pi / 8 * q.aspect * q.obliquity**2 * q.stokes * q.capillary
    found = centrifugal_identity()
    yield found - expected
    yield f"Ce = {found}"


@check("paper's normalisation", "m r omega^2/(a sigma) = Ce (4 + x/a) (omega/omega0)^2")
def normalisation_of_the_paper() -> Evidence:
    """The centrifugal term over a sigma is Ce times a function of the state alone."""
    expected = q.centrifugal * (4 + q.x / q.a) * (q.omega / q.omega0) ** 2
    yield paper_normalisation() - expected


@check("number of groups", "groups = dimensional quantities - rank of their dimension matrix (density included)")
def number_of_groups() -> Evidence:
    """Buckingham: as many independent groups as quantities minus the rank of their dimension matrix."""
    motion = {q.t, q.x, q.u, q.omega, q.xi, q.omega0}
    used = {s for group in group_definitions().values() for s in group.free_symbols}
    given = [
        each.symbol for each in q.VOCABULARY.values() if any(each.dimension.exponents) and each.symbol in used - motion
    ]
    dimensions = dimension_matrix(given)
    # exponent of a quantity in a group: d ln(group)/d ln(quantity)
    powers = sp.Matrix(
        [[sp.simplify(group.diff(s) * s / group) for s in given] for group in group_definitions().values()]
    )
    found, rank = powers.rank(), dimensions.rank()
    yield from (sp.Integer(found - (len(given) - rank)), *(dimensions * powers.T))
    yield f"{found} = {len(given)} - {rank}"


def groups_span_the_nullspace() -> Check:
    """St, Ca and Ce are combinations of the dimensionless monomials of their quantities (nullspace)."""
    left, shown = [], []
    for group, label in ((q.stokes, "St"), (q.capillary, "Ca"), (q.centrifugal, "Ce")):
        definition = group_definitions()[group]
        used = [
            each.symbol
            for each in q.VOCABULARY.values()
            if each.symbol in definition.free_symbols and any(each.dimension.exponents)
        ]
        powers = sp.Matrix([sp.simplify(definition.diff(s) * s / definition) for s in used])
        monomials = pi_groups(used)
        basis = (
            sp.Matrix.hstack(*(exponents(each, used) for each in monomials)) if monomials else sp.zeros(len(used), 1)
        )
        left.append(sp.Integer(sp.Matrix.hstack(basis, powers).rank() - len(monomials)))
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


CHECKS = (
    groups_span_the_nullspace, groups_are_the_papers, centrifugal_number, normalisation_of_the_paper, number_of_groups,
)  # fmt: skip
