"""Pendulum strings, from the potential of two equal spheres hung from pivots one diameter apart."""

import sympy as sp

from ..physics.pendulum import height, rise
from ..user import Reference, law, offset_squared, positive, string_ratio

DOUBLETS = Reference(
    "donahue2012doublets", ("Donahue, C. M.", "Brewer, W. M.", "Davis, R. H.", "Hrenya, C. M."),
    "Agglomeration and de-agglomeration of rotating wet doublets",
    "Journal of Fluid Mechanics", "J. Fluid Mech.", "708", "128–148", 2012,
)  # fmt: skip

positive(string_ratio**2 - offset_squared)  # a string that is taut is not horizontal


def _strings(name: str, small_angle: bool, meaning: str) -> None:
    height_gained, remark = rise(small_angle), ": vertical tension balances the weight"
    slope = sp.simplify(2 * height(small_angle).diff(offset_squared))
    law("strings", name, meaning=meaning, source=DOUBLETS, remark=remark, rise=height_gained, stiffness=slope)


_strings("exact", False, "strings of length l, exact geometry")
_strings("small-angle", True, "linearised in the swing: sqrt(l^2 - d^2) -> l")
