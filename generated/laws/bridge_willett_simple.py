# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 b1c085b7f7ff297bcaa3a55727c03de42c344fcd4b502a3e3e517a42df32c334
"""bridge law `willett-simple`: closed-form approximation of the full fit, for small bridges.

Source: Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000).
"""

from __future__ import annotations

from typing import Any

from casadi import cos, sqrt


VALIDITY: dict[str, tuple[float | None, float | None]] = {
    "volume": (None, 0.001),
    "contact_angle": (None, 0.8726646259971648),
    "separation": (None, None),
}
VALIDITY_SOURCE = "Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000)"


FALLS = True


def force(gap_over_radius: Any, volume: Any, contact_angle: Any) -> Any:
    """Capillary attraction over pi R sigma.

    Total operations: 13
    """
    scaled_gap = gap_over_radius/sqrt(volume)
    return 2*cos(contact_angle)/(5*scaled_gap**2/2 + 1.05*scaled_gap + 1)


def rupture_distance(volume: Any, contact_angle: Any) -> Any:
    """Rupture distance over R that goes with this law.

    Source: Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000).

    Total operations: 9
    """
    return (contact_angle/2 + 1)*(0.1*volume**(2/3) + volume**(1/3))
