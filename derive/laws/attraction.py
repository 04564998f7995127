"""Van der Waals attraction of nearly touching spheres."""

from ..physics.attraction import van_der_waals_force, van_der_waals_potential
from ..physics.references import DERJAGUIN
from ..user import Reference, gap, law, x, x0

HAMAKER = Reference(
    "hamaker1937attraction", ("Hamaker, H. C.",),
    "The London-van der Waals attraction between spherical particles",
    "Physica", "Physica", "4", "1058–1072", 1937, "10.1016/S0031-8914(37)80203-7",
)  # fmt: skip

law(
    "attraction", "van-der-waals", source=(HAMAKER, DERJAGUIN), falls=True,
    meaning="van der Waals attraction of nearly touching spheres, neither retarded nor cut off",
    force=(van_der_waals_force() / van_der_waals_force().subs(x, x0)).subs(x, gap * x0),
    potential=(van_der_waals_potential() / (van_der_waals_force() * x**2 / x0)).subs(x, gap * x0),
)  # fmt: skip
