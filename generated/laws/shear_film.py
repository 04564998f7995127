# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 cd50827de71ee8d5b1944e89ef39cdf4365c92d8da787e6a4b98f2198be4915d
"""shear law `film`: leading logarithm cut off at the rim of the film, x0.

Source: Couette shear integrated over the wetted disc.
"""

from __future__ import annotations

from typing import Any

from casadi import log


FALLS = True


def log_factor(gap: Any, aspect: Any) -> Any:
    """Tangential force over 8 pi mu a^2 (omega - xi), inside its edge.

    Total operations: 2
    """
    return -log(gap)


def edge(aspect: Any) -> Any:
    """Gap (in film thicknesses) beyond which there is no tangential force.

    Total operations: 0
    """
    return 1
