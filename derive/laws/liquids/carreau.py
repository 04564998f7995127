"""The viscosity of Carreau: a plateau, and a power law that sets in smoothly."""

from wetdoublet.derive.laws.liquids.generalised import plateau_laws
from wetdoublet.derive.user import Reference, positive

CARREAU = Reference(
    "carreau1972rheological", ("Carreau, P. J.",),
    "Rheological equations from molecular network theories",
    "Transactions of the Society of Rheology", "Trans. Soc. Rheol.", "16", "99–127", 1972, "10.1122/1.549276",
)  # fmt: skip

plateau_laws("carreau", CARREAU, "begins to thin", lambda squared, index: positive(1 + squared) ** ((index - 1) / 2))
