"""The viscosity of Carreau: a plateau, and a power law that sets in smoothly."""

from wetdoublet.derive.laws.liquids.generalised import Liquid, film_laws, representative_squared
from wetdoublet.derive.user import Reference, let, mu, positive, quantity, sp, v0, x0

CARREAU = Reference(
    "carreau1972rheological", ("Carreau, P. J.",),
    "Rheological equations from molecular network theories",
    "Transactions of the Society of Rheology", "Trans. Soc. Rheol.", "16", "99–127", 1972, "10.1122/1.549276",
)  # fmt: skip

index = quantity("flow_index", "n", bounds="> 0 and <= 1", meaning="slope of the stress over the rate where it thins")
time = quantity("relaxation_time", r"\lambda", unit="s", over=x0 / v0, meaning="inverse rate where it begins to thin")
infinite = quantity("infinite_shear_viscosity", r"\mu_\infty", unit="Pa s", bounds=">= 0", over=mu)
deborah, plateau = let("deborah", time * v0 / x0), let("plateau", infinite / mu)
at_wall = let("at_wall", representative_squared(index))


def viscosity(rate: sp.Expr) -> sp.Expr:
    """Of a squared rate, over `liquid.viscosity`."""
    return plateau + (1 - plateau) * positive(1 + deborah**2 * rate) ** ((index - 1) / 2)


def in_slit(rate: sp.Expr) -> sp.Expr:
    """The same of a flow between plates."""
    return viscosity(at_wall * rate)


film_laws(Liquid("carreau", (CARREAU,), "viscosity between two plateaus, by Carreau", viscosity, in_slit))
