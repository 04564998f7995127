# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 e2728e7698e6b442818266f09dd85d527a7cc4866ffddb7228c9011a4043ab76
"""bridge law `mikami-log10`: mikami with decimal logarithms in B and C (closer to Young-Laplace for phi > 0).

Source: Mikami, Kamiya & Horio, Chem. Eng. Sci. 53, 1927 (1998), read with log10.
"""

from __future__ import annotations

from typing import Any

from casadi import exp, log


FALLS = True


def force(gap_over_radius: Any, volume: Any, contact_angle: Any) -> Any:
    """Capillary attraction over pi R sigma.

    Total operations: 28
    """
    log_volume = log(volume)/log(10)
    decay = -1.1/volume**0.53
    offset = contact_angle**2*(-0.34*log_volume - 0.96) - 0.019*log_volume + 0.48
    tail = 0.0042*log_volume + 0.078
    return tail + exp(decay*gap_over_radius + offset)


def rupture_distance(volume: Any, contact_angle: Any) -> Any:
    """Rupture distance over R that goes with this law.

    Source: Mikami, Kamiya & Horio, Chem. Eng. Sci. 53, 1927 (1998).

    Total operations: 7
    """
    return volume**0.34*(0.62*contact_angle + 0.99)
