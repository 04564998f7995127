"""A yield stress beside a power of the shear rate, by Herschel and Bulkley; the index 1 is Bingham's plastic.

The flow between plates is one of the stress: with T over the yield stress, y that of the power law without it,
T = 1 + y + n/(n + 1) r/(1 + r^p)^(1/p), r = ((n + 1)/n) ((n + 1)/(2n + 1))^(n/(n + 1)) y^(1/(n + 1)) is exact for small
and for large y, and right to 1.5 % between them with p = 3 (n + 1)/4 (0.3 <= n <= 1).
"""

from wetdoublet.derive.laws.liquids.generalised import Liquid, film_laws, index_factor
from wetdoublet.derive.user import Reference, let, mu, quantity, sp, sqrt, v0, x0

HERSCHEL = Reference(
    "herschel1926konsistenzmessungen", ("Herschel, W. H.", "Bulkley, R."),
    "Konsistenzmessungen von Gummi-Benzollösungen",
    "Kolloid-Zeitschrift", "Kolloid-Z.", "39", "291–300", 1926, "10.1007/BF01432034",
)  # fmt: skip

index = quantity("flow_index", "n", bounds="> 0 and <= 2", meaning="slope of the stress above the yield stress")
reference = quantity("reference_rate", r"\dot\gamma_r", unit="1/s", over=v0 / x0, meaning="rate of that viscosity")
lowest = quantity("plateau_rate", r"\dot\gamma_p", unit="1/s", over=v0 / x0, meaning="rate below which it is constant")
stress = quantity("yield_stress", r"\tau_y", unit="Pa", over=mu * v0 / x0, meaning="yield stress")
at_reference, rest = let("at_reference", reference * x0 / v0), let("rest", (lowest * x0 / v0) ** 2)
yielding, at_wall = let("yielding", stress * x0 / (mu * v0)), let("at_wall", index_factor(index) ** index)
power = let("joining_power", 3 * (index + 1) / 4)
joint = let("joint", (index + 1) / index * ((index + 1) / (2 * index + 1)) ** (index / (index + 1)))
yielded = let("yielded", yielding ** (power / (index + 1)))


def viscous(rate: sp.Expr) -> sp.Expr:
    """The stress without the yield stress."""
    return at_reference ** (1 - index) * rate ** (index / 2)


def viscosity(rate: sp.Expr) -> sp.Expr:
    """Of a squared rate, over `liquid.viscosity`."""
    return (yielding + viscous(rate)) / sqrt(rate)


def in_slit(rate: sp.Expr) -> sp.Expr:
    """The same of a flow between plates."""
    plain = let(f"{rate}_plain", at_wall * viscous(rate))  # named: derivatives of nested powers are short by parts
    flowing = let(f"{rate}_flowing", joint * plain ** (1 / (index + 1)))
    joined = let(f"{rate}_joined", yielded + flowing**power)
    between = yielding * flowing / joined ** (1 / power)
    return (yielding + plain + index / (index + 1) * between) / sqrt(rate)


film_laws(Liquid("herschel-bulkley", (HERSCHEL,), "yield stress and a power law", viscosity, in_slit, rest))
