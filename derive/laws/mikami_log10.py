"""Mikami's bridge law as it may have been meant: which logarithm B and C have is not printed."""

from ..user import V, law, log
from .mikami import MIKAMI, RUPTURE, fit

law(
    "bridge", "mikami-log10", source=MIKAMI, remark=", read with log10", falls=True,
    meaning="mikami with decimal logarithms in B and C (closer to Young-Laplace for phi > 0)",
    force=fit(log(V) / log(10)), rupture_distance=RUPTURE,
)  # fmt: skip
