"""Groups: how many are independent, and how the centrifugal number follows from the others."""

from __future__ import annotations

import sympy as sp

from ..quantities import (
    VOCABULARY,
    a,
    aspect,
    capillary,
    centrifugal,
    obliquity,
    omega,
    omega0,
    stokes,
    u,
    x,
    xi,
)
from ..quantities import t as time
from ..scaling import centrifugal_identity, dimension_matrix, group_definitions, paper_normalisation
from .base import Check, vanishing


def centrifugal_number() -> Check:
    """Ce depends on the other groups once the angle is counted among them."""
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
    """Buckingham: the independent groups are as many as the quantities less the rank of their dimension matrix."""
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
