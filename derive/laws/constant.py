"""A bridge whose attraction does not depend on the gap."""

from ..physics.references import DERJAGUIN
from ..user import cos, law, phi

law(
    "bridge", "constant", source=DERJAGUIN, remark=": 2 cos(phi), the limit at h = 0", falls=True,
    meaning="gap-independent upper bound, the force at contact",
    force=2 * cos(phi),
)  # fmt: skip
