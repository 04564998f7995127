"""The viscosity of Cross: two plateaus, and between them a power of the shear rate."""

from wetdoublet.derive.laws.liquids.generalised import plateau_laws
from wetdoublet.derive.user import Rational, Reference

CROSS = Reference(
    "cross1965rheology", ("Cross, M. M.",),
    "Rheology of non-Newtonian fluids: A new flow equation for pseudoplastic systems",
    "Journal of Colloid Science", "J. Colloid Sci.", "20", "417–437", 1965, "10.1016/0095-8522(65)90022-X",
)  # fmt: skip

plateau_laws(
    "cross", CROSS, "has half thinned", lambda squared, index: 1 / (1 + squared ** ((1 - index) / 2)),
    floor=lambda deborah: Rational(1, 10**12) / deborah**2,  # the power of a vanishing rate has no slope
)  # fmt: skip
