"""A bridge whose attraction does not depend on the gap."""

from ..physics.references import DERJAGUIN
from ..user import cos, law, phi

law(
    "bridge",
    "constant",
    meaning="gap-independent upper bound, the force at contact",
    source=f"{DERJAGUIN.short}: 2 cos(phi), the limit at h = 0",
    references=(DERJAGUIN,),
    force=2 * cos(phi),
    falls=True,
)
