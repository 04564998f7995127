# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 8ca29c7559078c070dbdd6849e539cc8cbb76262ceafda2504523838994270d9
"""shear law `immersed`: leading logarithm of nearly touching, fully immersed spheres: cut off at the sphere
radius 2a.

Source: O'Neill & Majumdar, ZAMP 21, 164 (1970), without its constant term.
"""

from __future__ import annotations

from typing import Any

from casadi import log


FALLS = True


def log_factor(gap: Any, aspect: Any) -> Any:
    """Tangential force over 8 pi mu a^2 (omega - xi), inside its edge.

    Total operations: 3
    """
    return log(2/(aspect*gap))


def edge(aspect: Any) -> Any:
    """Gap (in film thicknesses) beyond which there is no tangential force.

    Total operations: 1
    """
    return 2/aspect
