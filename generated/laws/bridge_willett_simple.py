# Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
# Equations sha256 3a05e8afb536355a9d3f485610ffe65a41c2a105bf56ddde38bde3d9b3d76884
"""bridge law `willett-simple`: closed-form approximation of the full fit, for small bridges.

Source: Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000).
"""

from __future__ import annotations

from typing import Any

from casadi import cos, sqrt


def force(gap_over_radius: Any, volume: Any, contact_angle: Any) -> Any:
    """Capillary attraction over pi R sigma.

    Total operations: 13
    """
    scaled_gap = gap_over_radius/sqrt(volume)
    return 2*cos(contact_angle)/(5*scaled_gap**2/2 + 1.05*scaled_gap + 1)
