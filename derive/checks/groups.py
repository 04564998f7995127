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
from ..vocabulary.quantities import (
    VOCABULARY,
    a,
    aspect,
    capillary,
    centrifugal,
    m,
    mu,
    obliquity,
    omega,
    omega0,
    sigma,
    stokes,
    theta0,
    u,
    v0,
    x,
    x0,
    xi,
)
from ..vocabulary.quantities import t as time
from .base import Check, readable, vanishing


def centrifugal_number() -> Check:
    """Ce is a function of the other groups if the angle is counted among them."""
    expected = sp.pi / 8 * aspect * obliquity**2 * stokes * capillary
    found = centrifugal_identity()
    return vanishing(
        "centrifugal number", "Ce = (pi/8) (x0/a) tan^2(theta0) St Ca", [found - expected], f"Ce = {found}"
    )


def normalisation_of_the_paper() -> Check:
    """The centrifugal term over a sigma is Ce times a function of the state alone."""
    expected = centrifugal * (4 + x / a) * (omega / omega0) ** 2
    return vanishing(
        "paper's normalisation",
        "m r omega^2/(a sigma) = Ce (4 + x/a) (omega/omega0)^2",
        [paper_normalisation() - expected],
    )


def number_of_groups() -> Check:
    """Buckingham: as many independent groups as quantities minus the rank of their dimension matrix."""
    motion = {time, x, u, omega, xi, omega0}
    used = {s for group in group_definitions().values() for s in group.free_symbols}
    given = [q.symbol for q in VOCABULARY.values() if any(q.dimension.exponents) and q.symbol in used - motion]
    dimensions = dimension_matrix(given)
    # exponent of a quantity in a group: d ln(group)/d ln(quantity)
    powers = sp.Matrix(
        [[sp.simplify(group.diff(s) * s / group) for s in given] for group in group_definitions().values()]
    )
    found, rank = powers.rank(), dimensions.rank()
    left = [sp.Integer(found - (len(given) - rank)), *(dimensions * powers.T)]
    statement = "groups = dimensional quantities - rank of their dimension matrix (density included)"
    return vanishing("number of groups", statement, left, f"{found} = {len(given)} - {rank}")


def groups_span_the_nullspace() -> Check:
    """St, Ca and Ce are combinations of the dimensionless monomials of their quantities (nullspace)."""
    left, shown = [], []
    for group, label in ((stokes, "St"), (capillary, "Ca"), (centrifugal, "Ce")):
        definition = group_definitions()[group]
        used = [
            q.symbol for q in VOCABULARY.values() if q.symbol in definition.free_symbols and any(q.dimension.exponents)
        ]
        powers = sp.Matrix([sp.simplify(definition.diff(s) * s / definition) for s in used])
        monomials = pi_groups(used)
        basis = (
            sp.Matrix.hstack(*(exponents(each, used) for each in monomials)) if monomials else sp.zeros(len(used), 1)
        )
        left.append(sp.Integer(sp.Matrix.hstack(basis, powers).rank() - len(monomials)))
        shown.append(f"{label} = {readable(definition)}")
    return vanishing("St, Ca, Ce", "each in the span of the nullspace of its dimension matrix", left, "; ".join(shown))


def groups_are_the_papers() -> Check:
    """St, Ca and Ce as ratios of terms are the paper's numbers, Ce with omega0 = v0 tan(theta0)/(4a)."""
    expected = {
        stokes: m * v0 / (6 * sp.pi * mu * a**2),
        capillary: 3 * mu * a * v0 / (sigma * x0),
        centrifugal: m * (v0 * sp.tan(theta0) / (4 * a)) ** 2 / sigma,
    }
    left = [group_definitions()[group] - value for group, value in expected.items()]
    return vanishing(
        "paper's groups", "St = m v0/(6 pi mu a^2), Ca = 3 mu a v0/(sigma x0), Ce = m omega0^2/sigma", left
    )
