"""A liquid whose stress is a power of the shear rate; its viscosity is that at a reference rate."""

from wetdoublet.derive.laws.liquids.generalised import Liquid, film_laws, index_factor
from wetdoublet.derive.user import Reference, let, quantity, sp, v0, x0

RODIN = Reference(
    "rodin1996squeeze", ("Rodin, G. J.",),
    "Squeeze film between two spheres in a power-law fluid",
    "Journal of Non-Newtonian Fluid Mechanics", "J. Non-Newton. Fluid Mech.", "63", "141–152", 1996,
)  # fmt: skip

index = quantity("flow_index", "n", bounds="> 0 and <= 2", meaning="slope of the stress over the rate")
reference = quantity("reference_rate", r"\dot\gamma_r", unit="1/s", over=v0 / x0, meaning="rate of that viscosity")
lowest = quantity("plateau_rate", r"\dot\gamma_p", unit="1/s", over=v0 / x0, meaning="rate below which it is constant")
at_reference, rest = let("at_reference", reference * x0 / v0), let("rest", (lowest * x0 / v0) ** 2)
at_wall = let("at_wall", index_factor(index) ** index)


def viscosity(rate: sp.Expr) -> sp.Expr:
    """Of a squared rate, over `liquid.viscosity`."""
    return (rate / at_reference**2) ** ((index - 1) / 2)


def in_slit(rate: sp.Expr) -> sp.Expr:
    """The same of a flow between plates."""
    return at_wall * viscosity(rate)


film_laws(Liquid("power-law", (RODIN,), "stress as a power of the shear rate", viscosity, in_slit, rest))
