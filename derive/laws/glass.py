"""Where an approach rebounds because the film pressure on the axis reaches the glass transition."""

import sympy as sp

from ..user import Reference, a, approach, gap, glass_number, law, mu, u, x, x0
from .film import axis_pressure

CRADLE = Reference(
    "donahue2010cradle",
    ("Donahue, C. M.", "Hrenya, C. M.", "Davis, R. H.", "Nakagawa, K. J.", "Zelinskaya, A. P.", "Joseph, G. G."),
    "Stokes' cradle: normal three-body collisions between wetted particles",
    "Journal of Fluid Mechanics", "J. Fluid Mech.", "650", "479–504", 2010,
)  # fmt: skip


def _criterion(name: str, axis: sp.Expr, meaning: str) -> None:
    """A criterion for a pressure on the axis, and the largest gap at which an approach meets it.

    The pressure decreases with the gap.
    """
    scaled = sp.simplify(axis * x0**2 / (3 * mu * a)).subs({x: gap * x0, u: -approach}, simultaneous=True)
    pressure, fast = sp.factor(sp.simplify(scaled)), sp.Symbol("approach", positive=True)
    (farthest,) = (root for root in sp.solve(pressure.subs(approach, fast) - glass_number, gap) if root.is_positive)
    reach = sp.simplify(farthest).subs(fast, approach)
    remark = "; derived from the film pressure"
    law("glass", name, meaning=meaning, source=CRADLE, remark=remark, pressure=pressure, reach=reach)


_UNBOUNDED = sp.limit(axis_pressure(), x0, sp.oo)  # 3 mu a |u|/x^2
_criterion("literal", _UNBOUNDED, "3 mu a |u|/x^2 as published: can fire at initial contact")
_criterion("film-corrected", axis_pressure(), "with the film's rim, 1/x^2 - 1/x0^2: zero at initial contact")
