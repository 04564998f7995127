# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 672b476bc6acde06a4ee8a2d6138d5c3c5a2763a679af7727c4a1b86c6e97a88
"""bridge law `lambert`: energy approach with a cylindrical bridge, exact at constant volume.

Source: Lambert, Chau, Delchambre & Regnier, Langmuir 24, 3157 (2008).
"""

from __future__ import annotations

from typing import Any

from casadi import cos, pi, sqrt


FALLS = True


def force(gap_over_radius: Any, volume: Any, contact_angle: Any) -> Any:
    """Capillary attraction over pi R sigma.

    Total operations: 11
    """
    cylinder_reach = sqrt(gap_over_radius**2 + 2*volume/pi)
    return 2*(1 - gap_over_radius/cylinder_reach)*cos(contact_angle)
