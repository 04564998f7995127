"""The viscosity of Cross: two plateaus, and between them a power of the shear rate."""

from wetdoublet.derive.laws.liquids.generalised import Liquid, film_laws, representative_squared
from wetdoublet.derive.user import Rational, Reference, let, mu, quantity, sp, v0, x0

CROSS = Reference(
    "cross1965rheology", ("Cross, M. M.",),
    "Rheology of non-Newtonian fluids: A new flow equation for pseudoplastic systems",
    "Journal of Colloid Science", "J. Colloid Sci.", "20", "417–437", 1965, "10.1016/0095-8522(65)90022-X",
)  # fmt: skip

index = quantity("flow_index", "n", bounds="> 0 and <= 1", meaning="slope of the stress over the rate where it thins")
time = quantity("relaxation_time", r"\lambda", unit="s", over=x0 / v0, meaning="inverse rate where it has half thinned")
infinite = quantity("infinite_shear_viscosity", r"\mu_\infty", unit="Pa s", bounds=">= 0", over=mu)
deborah, plateau = let("deborah", time * v0 / x0), let("plateau", infinite / mu)
at_wall = let("at_wall", representative_squared(index))


def viscosity(rate: sp.Expr) -> sp.Expr:
    """Of a squared rate, over `liquid.viscosity`."""
    return plateau + (1 - plateau) / (1 + (deborah**2 * rate) ** ((1 - index) / 2))


def in_slit(rate: sp.Expr) -> sp.Expr:
    """The same of a flow between plates."""
    return viscosity(at_wall * rate)


# The power of a rate that vanishes has no slope: a millionth of 1/lambda is as good as none
rest = let("rest", Rational(1, 10**12) / deborah**2)
film_laws(Liquid("cross", (CROSS,), "viscosity between two plateaus, by Cross", viscosity, in_slit, rest))
