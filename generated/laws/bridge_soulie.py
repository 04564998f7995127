# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 8ae8f5d0d1f3a56bcd8b692dbaee4bcc8ceb364871fd1fed87a9903744733ff7
"""bridge law `soulie`: mikami's form refitted for polydisperse spheres.

Source: Soulie, Cherblanc, El Youssoufi & Saix, Int. J. Numer. Anal. Meth. Geomech. 30, 213 (2006).
"""

from __future__ import annotations

from typing import Any

from casadi import exp, log


FALLS = True


def force(gap_over_radius: Any, volume: Any, contact_angle: Any) -> Any:
    """Capillary attraction over pi R sigma.

    Total operations: 26
    """
    log_volume = log(volume)
    decay = -1.1/volume**0.53
    offset = contact_angle**2*(-0.148*log_volume - 0.96) - 0.0082*log_volume + 0.48
    tail = 0.0018*log_volume + 0.078
    return tail + exp(decay*gap_over_radius + offset)


def rupture_distance(volume: Any, contact_angle: Any) -> Any:
    """Rupture distance over R that goes with this law.

    Source: Lian, Thornton & Adams, J. Colloid Interface Sci. 161, 138 (1993), which Soulie et al. (2006) use.

    Total operations: 5
    """
    return volume**(1/3)*(contact_angle/2 + 1)
