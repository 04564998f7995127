# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 a3f53c3c41ee427dfee2236248413a3a980dea39ca5f912ac583c869cd832dd0
"""bridge law `mikami-log10`: mikami with decimal logarithms in B and C (closer to Young-Laplace for phi > 0).

Source: Mikami, Kamiya & Horio, Chem. Eng. Sci. 53, 1927 (1998), read with log10.
"""

from __future__ import annotations

from typing import Any

from casadi import exp, log


def force(gap_over_radius: Any, volume: Any, contact_angle: Any) -> Any:
    """Capillary attraction over pi R sigma.

    Total operations: 28
    """
    log_volume = log(volume)/log(10)
    decay = -1.1/volume**0.53
    offset = contact_angle**2*(-0.34*log_volume - 0.96) - 0.019*log_volume + 0.48
    tail = 0.0042*log_volume + 0.078
    return tail + exp(decay*gap_over_radius + offset)
