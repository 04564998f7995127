# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 36e46923a94b238902fde09d8f0a84cd7caa23f0ba2ee09a4e8f1a196b537dce
"""bridge law `rabinovich`: lambert's pressure term and the surface tension along the contact line at the
half-filling angle.

Source: Rabinovich, Esayanur & Moudgil, Langmuir 21, 10992 (2005).
"""

from __future__ import annotations

from typing import Any

from casadi import cos, pi, sin, sqrt


def force(gap_over_radius: Any, volume: Any, contact_angle: Any) -> Any:
    """Capillary attraction over pi R sigma.

    Total operations: 20
    """
    cylinder_reach = sqrt(gap_over_radius**2 + 2*volume/pi)
    half_filling_angle = sqrt(cylinder_reach - gap_over_radius)
    result = (
        2*(1 - gap_over_radius/cylinder_reach)*cos(contact_angle)
        + 2*sin(half_filling_angle)*sin(contact_angle + half_filling_angle)
    )
    return result
