"""Bridge law of Soulie et al.: the form of Mikami's, fitted for polydisperse spheres."""

from ..physics.references import LIAN
from ..physics.scaling import rupture_distance
from ..user import Formula, R, Reference, V, law, log
from .mikami import exponential

SOULIE = Reference(
    "soulie2006influence", ("Soulié, F.", "Cherblanc, F.", "El Youssoufi, M. S.", "Saix, C."),
    "Influence of liquid bridges on the mechanical behaviour of polydisperse granular materials",
    "International Journal for Numerical and Analytical Methods in Geomechanics",
    "Int. J. Numer. Anal. Meth. Geomech.", "30", "213–228", 2006, "10.1002/nag.476",
)  # fmt: skip

law(
    "bridge", "soulie", source=SOULIE, falls=True,
    meaning="mikami's form refitted for polydisperse spheres",
    force=exponential(log(V), -0.148, -0.0082, 0.0018),
    rupture_distance=Formula(rupture_distance() / R, source=LIAN, remark=", which Soulie et al. (2006) use"),
)  # fmt: skip
