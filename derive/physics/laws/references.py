"""The publications of the laws, each declared once, for sources in text and for `wetdoublet cite`.

A DOI is given where it is certain.
"""

import unicodedata
from dataclasses import dataclass

_MOST = 4  # authors named in a short citation


@dataclass(frozen=True)
class Reference:
    """An article in a journal.

    Arguments:
        key: of its BibTeX entry.
        authors: "Family, Initials" each, in order.
        abbreviated: the journal as a short citation has it.
        pages: "first–last", or the number of the article.
    """

    key: str
    authors: tuple[str, ...]
    title: str
    journal: str
    abbreviated: str
    volume: str
    pages: str
    year: int
    doi: str = ""

    @property
    def short(self) -> str:
        """A citation in plain ASCII: families, journal, volume, first page, year."""
        families = [author.split(",")[0] for author in self.authors]
        if len(families) > _MOST:
            named = f"{families[0]} et al."
        else:
            named = " & ".join([", ".join(families[:-1]), families[-1]] if len(families) > 1 else families)
        text = f"{named}, {self.abbreviated} {self.volume}, {self.pages.split('–')[0]} ({self.year})"
        return unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()


PAPER = Reference(
    "donahue2012mechanisms",
    ("Donahue, C. M.", "Davis, R. H.", "Kantak, A. A.", "Hrenya, C. M."),
    "Mechanisms for agglomeration and deagglomeration following oblique collisions of wet particles",
    "Physical Review E", "Phys. Rev. E", "86", "021303", 2012, "10.1103/PhysRevE.86.021303",
)  # fmt: skip
DOUBLETS = Reference(
    "donahue2012doublets",
    ("Donahue, C. M.", "Brewer, W. M.", "Davis, R. H.", "Hrenya, C. M."),
    "Agglomeration and de-agglomeration of rotating wet doublets",
    "Journal of Fluid Mechanics", "J. Fluid Mech.", "708", "128–148", 2012,
)  # fmt: skip
CRADLE = Reference(
    "donahue2010cradle",
    ("Donahue, C. M.", "Hrenya, C. M.", "Davis, R. H.", "Nakagawa, K. J.", "Zelinskaya, A. P.", "Joseph, G. G."),
    "Stokes' cradle: normal three-body collisions between wetted particles",
    "Journal of Fluid Mechanics", "J. Fluid Mech.", "650", "479–504", 2010,
)  # fmt: skip
KANTAK = Reference(
    "kantak2006elastohydrodynamic",
    ("Kantak, A. A.", "Davis, R. H."),
    "Elastohydrodynamic theory for wet oblique collisions",
    "Powder Technology", "Powder Technol.", "168", "42–52", 2006,
)  # fmt: skip
RAGER = Reference(
    "davis2002rebound",
    ("Davis, R. H.", "Rager, D. A.", "Good, B. T."),
    "Elastohydrodynamic rebound of spheres from coated surfaces",
    "Journal of Fluid Mechanics", "J. Fluid Mech.", "468", "107–119", 2002,
)  # fmt: skip
SERAYSSOL = Reference(
    "davis1986collision",
    ("Davis, R. H.", "Serayssol, J.-M.", "Hinch, E. J."),
    "The elastohydrodynamic collision of two spheres",
    "Journal of Fluid Mechanics", "J. Fluid Mech.", "163", "479–497", 1986, "10.1017/S0022112086002392",
)  # fmt: skip
BARNOCKY = Reference(
    "barnocky1988collision",
    ("Barnocky, G.", "Davis, R. H."),
    "Elastohydrodynamic collision and rebound of spheres: Experimental verification",
    "Physics of Fluids", "Phys. Fluids", "31", "1324–1329", 1988,
)  # fmt: skip
PITOIS = Reference(
    "pitois2000bridge",
    ("Pitois, O.", "Moucheront, P.", "Chateau, X."),
    "Liquid bridge between two moving spheres: an experimental study of viscosity effects",
    "Journal of Colloid and Interface Science", "J. Colloid Interface Sci.", "231", "26–31", 2000,
    "10.1006/jcis.2000.7096",
)  # fmt: skip
ONEILL = Reference(
    "oneill1970asymmetrical",
    ("O'Neill, M. E.", "Majumdar, R."),
    "Asymmetrical slow viscous fluid motions caused by the translation or rotation of two spheres. Part I: The "
    "determination of exact solutions for any values of the ratio of radii and separation parameters",
    "Zeitschrift für angewandte Mathematik und Physik", "ZAMP", "21", "164–179", 1970,
)  # fmt: skip
JEFFREY = Reference(
    "jeffrey1984calculation",
    ("Jeffrey, D. J.", "Onishi, Y."),
    "Calculation of the resistance and mobility functions for two unequal rigid spheres in low-Reynolds-number flow",
    "Journal of Fluid Mechanics", "J. Fluid Mech.", "139", "261–290", 1984, "10.1017/S0022112084000355",
)  # fmt: skip
WALTON = Reference(
    "walton1986viscosity",
    ("Walton, O. R.", "Braun, R. L."),
    "Viscosity, granular-temperature, and stress calculations for shearing assemblies of inelastic, frictional disks",
    "Journal of Rheology", "J. Rheol.", "30", "949–980", 1986,
)  # fmt: skip
GOLDMAN = Reference(
    "goldman1967slow",
    ("Goldman, A. J.", "Cox, R. G.", "Brenner, H."),
    "Slow viscous motion of a sphere parallel to a plane wall. I. Motion through a quiescent fluid",
    "Chemical Engineering Science", "Chem. Eng. Sci.", "22", "637–651", 1967, "10.1016/0009-2509(67)80047-2",
)  # fmt: skip
LIAN = Reference(
    "lian1993theoretical",
    ("Lian, G.", "Thornton, C.", "Adams, M. J."),
    "A theoretical study of the liquid bridge forces between two rigid spherical bodies",
    "Journal of Colloid and Interface Science", "J. Colloid Interface Sci.", "161", "138–147", 1993,
    "10.1006/jcis.1993.1452",
)  # fmt: skip
MIKAMI = Reference(
    "mikami1998numerical",
    ("Mikami, T.", "Kamiya, H.", "Horio, M."),
    "Numerical simulation of cohesive powder behavior in a fluidized bed",
    "Chemical Engineering Science", "Chem. Eng. Sci.", "53", "1927–1940", 1998, "10.1016/S0009-2509(97)00325-4",
)  # fmt: skip
WILLETT = Reference(
    "willett2000capillary",
    ("Willett, C. D.", "Adams, M. J.", "Johnson, S. A.", "Seville, J. P. K."),
    "Capillary bridges between two spherical bodies",
    "Langmuir", "Langmuir", "16", "9396–9405", 2000, "10.1021/la000657y",
)  # fmt: skip
RABINOVICH = Reference(
    "rabinovich2005capillary",
    ("Rabinovich, Y. I.", "Esayanur, M. S.", "Moudgil, B. M."),
    "Capillary forces between two spheres with a fixed volume liquid bridge: theory and experiment",
    "Langmuir", "Langmuir", "21", "10992–10997", 2005, "10.1021/la0517639",
)  # fmt: skip
LAMBERT = Reference(
    "lambert2008comparison",
    ("Lambert, P.", "Chau, A.", "Delchambre, A.", "Régnier, S."),
    "Comparison between two capillary forces models",
    "Langmuir", "Langmuir", "24", "3157–3163", 2008,
)  # fmt: skip
SOULIE = Reference(
    "soulie2006influence",
    ("Soulié, F.", "Cherblanc, F.", "El Youssoufi, M. S.", "Saix, C."),
    "Influence of liquid bridges on the mechanical behaviour of polydisperse granular materials",
    "International Journal for Numerical and Analytical Methods in Geomechanics",
    "Int. J. Numer. Anal. Meth. Geomech.", "30", "213–228", 2006, "10.1002/nag.476",
)  # fmt: skip
HAMAKER = Reference(
    "hamaker1937attraction",
    ("Hamaker, H. C.",),
    "The London-van der Waals attraction between spherical particles",
    "Physica", "Physica", "4", "1058–1072", 1937, "10.1016/S0031-8914(37)80203-7",
)  # fmt: skip
DERJAGUIN = Reference(
    "derjaguin1934reibung",
    ("Derjaguin, B.",),
    "Untersuchungen über die Reibung und Adhäsion, IV. Theorie des Anhaftens kleiner Teilchen",
    "Kolloid-Zeitschrift", "Kolloid-Z.", "69", "155–164", 1934, "10.1007/BF01433225",
)  # fmt: skip
