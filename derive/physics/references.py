"""Publications, for sources in text and for `wetdoublet cite`; those of one file of laws stand there.

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
    "donahue2012mechanisms", ("Donahue, C. M.", "Davis, R. H.", "Kantak, A. A.", "Hrenya, C. M."),
    "Mechanisms for agglomeration and deagglomeration following oblique collisions of wet particles",
    "Physical Review E", "Phys. Rev. E", "86", "021303", 2012, "10.1103/PhysRevE.86.021303",
)  # fmt: skip
RAGER = Reference(
    "davis2002rebound", ("Davis, R. H.", "Rager, D. A.", "Good, B. T."),
    "Elastohydrodynamic rebound of spheres from coated surfaces",
    "Journal of Fluid Mechanics", "J. Fluid Mech.", "468", "107–119", 2002,
)  # fmt: skip
SERAYSSOL = Reference(
    "davis1986collision", ("Davis, R. H.", "Serayssol, J.-M.", "Hinch, E. J."),
    "The elastohydrodynamic collision of two spheres",
    "Journal of Fluid Mechanics", "J. Fluid Mech.", "163", "479–497", 1986, "10.1017/S0022112086002392",
)  # fmt: skip
JEFFREY = Reference(
    "jeffrey1984calculation", ("Jeffrey, D. J.", "Onishi, Y."),
    "Calculation of the resistance and mobility functions for two unequal rigid spheres in low-Reynolds-number flow",
    "Journal of Fluid Mechanics", "J. Fluid Mech.", "139", "261–290", 1984, "10.1017/S0022112084000355",
)  # fmt: skip
WALTON = Reference(
    "walton1986viscosity", ("Walton, O. R.", "Braun, R. L."),
    "Viscosity, granular-temperature, and stress calculations for shearing assemblies of inelastic, frictional disks",
    "Journal of Rheology", "J. Rheol.", "30", "949–980", 1986,
)  # fmt: skip
GOLDMAN = Reference(
    "goldman1967slow", ("Goldman, A. J.", "Cox, R. G.", "Brenner, H."),
    "Slow viscous motion of a sphere parallel to a plane wall. I. Motion through a quiescent fluid",
    "Chemical Engineering Science", "Chem. Eng. Sci.", "22", "637–651", 1967, "10.1016/0009-2509(67)80047-2",
)  # fmt: skip
LIAN = Reference(
    "lian1993theoretical", ("Lian, G.", "Thornton, C.", "Adams, M. J."),
    "A theoretical study of the liquid bridge forces between two rigid spherical bodies",
    "Journal of Colloid and Interface Science", "J. Colloid Interface Sci.", "161", "138–147", 1993,
    "10.1006/jcis.1993.1452",
)  # fmt: skip
DERJAGUIN = Reference(
    "derjaguin1934reibung", ("Derjaguin, B.",),
    "Untersuchungen über die Reibung und Adhäsion, IV. Theorie des Anhaftens kleiner Teilchen",
    "Kolloid-Zeitschrift", "Kolloid-Z.", "69", "155–164", 1934, "10.1007/BF01433225",
)  # fmt: skip
